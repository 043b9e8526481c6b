//! The size from which slip runs away if strength falls with slip.

use std::f64::consts::PI;

use crate::communicator::Communicator;
use crate::model::Model;

/// Critical length `h` of a line of contacts, times `W` and over the elastic stiffness `mu*` of the line:
/// `h = 1.158 mu*/W` (Uenishi and Rice, 2003).
const OF_A_LINE: f64 = 1.158;

/// Stiffness `mu*` of a line along x in the middle of a sheet, in units of `E h`. The other blocks of the
/// sheet follow without friction; by symmetry the line stays on its axis. Poisson's ratio is 1/3.
const LINE_IN_A_SHEET: f64 = 2.25;

/// Stiffness `mu*` of a line along a free edge, in units of `E h`.
const LINE_AT_AN_EDGE: f64 = 1.0;

impl Model {
    /// Lower and upper bound on the critical size along the drive, in blocks: from this size on, a patch at
    /// its threshold runs away if strength falls with slip. None under other laws, and for a bulk body.
    /// All `ranks` of a lattice must call this together.
    ///
    /// Where all blocks are in contact, both bounds are the size of a long strip across the drive, with the
    /// mean strength of the blocks and the mean drive spring `k_s`. Where only some blocks have a drive
    /// spring, `k_s` counts as 0. The size is infinite where the mount is stiff enough for slip of any size
    /// to be stable.
    ///
    /// ```text
    /// L_c = pi sqrt(K_el/(W - k_s)),   W = (S - K)/D_c,   K_el = 9/8, 3/4 of a chain
    /// ```
    ///
    /// Where some blocks are not in contact, this size is the lower bound, with the mean strength of those in
    /// contact. The upper bound is the smaller of two. The first is the size of the strip if strength is
    /// spread over all blocks, `c W` with the share `c` in contact: the limit of fine patterns. The second is
    /// the length of a single line along x with the largest share in contact of any row, `c_r`:
    /// `1.158 mu*/(c_r W)` with `mu* = 9/4`. At the edge of an upright sheet both bounds are the length of a
    /// line there, with `mu* = 1`, and with the stiffness `k_e = 3/8` of the springs along the edge, which a
    /// continuum lacks; `k_e = 0` where these springs are halved:
    ///
    /// ```text
    /// W c_r n = 1.158 + k_e pi^2/n
    /// ```
    pub fn critical_size(&self, ranks: &dyn Communicator) -> Option<[f64; 2]> {
        let weakening = self.weakening().filter(|_| self.body.is_none())?;
        let row = self.densest_row(ranks);
        let is_chain = self.lattice.ny == 1;
        if self.friction.interface().is_some() && !is_chain {
            let excess = if self.slider.halves_edge_springs {
                0.0
            } else {
                0.375
            };
            let (line, weakening) = (OF_A_LINE * LINE_AT_AN_EDGE, weakening * row);
            let root = (line * line + 4.0 * weakening * excess * PI * PI).sqrt();
            return Some([(line + root) / (2.0 * weakening); 2]);
        }
        let mean_spring = self.slider.sum_of_drive_springs(&self.lattice) / self.n_blocks() as f64;
        // A stiff drive at an edge does not stabilise a patch far from it.
        let mount = if self.slider.drives_some {
            0.0
        } else {
            self.drive.k_drive * mean_spring
        };
        let strip = |weakening: f64| {
            let unstable = weakening - mount;
            if unstable > 0.0 {
                PI * (self.lattice.stiffness_along() / unstable).sqrt()
            } else {
                f64::INFINITY
            }
        };
        let least = strip(weakening);
        let in_contact = self.surface.n_contact() as f64 / self.n_blocks() as f64;
        if in_contact == 1.0 {
            return Some([least; 2]);
        }
        let spread = strip(in_contact * weakening);
        let line = if is_chain {
            spread
        } else {
            OF_A_LINE * LINE_IN_A_SHEET / (row * weakening)
        };
        Some([least, spread.min(line).max(least)])
    }

    /// Largest share of blocks in contact in any row.
    fn densest_row(&self, ranks: &dyn Communicator) -> f64 {
        let nx = self.lattice.nx;
        let rows = self.surface.textured.chunks(nx);
        let in_contact = rows.map(|row| row.iter().filter(|&&textured| !textured).count());
        ranks.largest_of(in_contact.max().unwrap_or(0) as f64 / nx as f64)
    }
}
