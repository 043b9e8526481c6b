//! The size from which slip runs away where strength falls with slip.

use std::f64::consts::PI;

use crate::communicator::Communicator;
use crate::model::Model;

/// Critical length of a line of contacts over the elastic stiffness of the line and under `W`:
/// `h = 1.158 mu*/W` (Uenishi and Rice, 2003).
const OF_A_LINE: f64 = 1.158;

/// Stiffness `mu*` of a line along x in the middle of a sheet, whose other blocks follow without friction; by
/// symmetry the line stays on its axis. In units of `E h`, of Poisson's ratio 1/3.
const LINE_IN_A_SHEET: f64 = 2.25;

/// Stiffness `mu*` of a line along a free edge, in units of `E h`.
const LINE_AT_AN_EDGE: f64 = 1.0;

impl Model {
    /// Sizes along the drive, in blocks, between which the critical size lies: from that size on a patch at
    /// its threshold runs away where strength falls with slip. There is none under other laws, and of a stack
    /// of sheets. All `ranks` of a lattice must call this together.
    ///
    /// Where all blocks touch, both are the size of a long strip across the drive whose blocks have the mean
    /// strength of those in contact, on the mean drive spring `k_s`; without drive springs, where only some
    /// blocks have one. It is infinite where the mount is stiff enough for slip of any size to be stable.
    ///
    /// ```text
    /// L_c = pi sqrt(K_el/(W - k_s)),   W = (S - K)/D_c,   K_el = 9/8, 3/4 of a chain
    /// ```
    ///
    /// Where some do not, that is the least. The most is the smaller of two: the strip on a sheet whose
    /// strength is spread over all blocks, `c W` with the share `c` in contact, to which patterns come that
    /// are fine against it; and the length of a lone line along x with the share `c_r` in contact of the
    /// densest row, `1.158 mu*/(c_r W)` with `mu* = 9/4`. At the edge of an upright sheet both are the length
    /// there, with `mu* = 1` and with the springs along the edge that a continuum lacks, `k_e = 3/8` unless
    /// they are halved:
    ///
    /// ```text
    /// W c_r n = 1.158 + k_e pi^2/n
    /// ```
    pub fn critical_size(&self, ranks: &dyn Communicator) -> Option<[f64; 2]> {
        let weakening = self.weakening().filter(|_| self.sheets.is_empty())?;
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
        // A stiff drive at an edge does not hold a patch far from it.
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

    /// Largest share of the blocks of a row that are in contact.
    fn densest_row(&self, ranks: &dyn Communicator) -> f64 {
        let nx = self.lattice.nx;
        let rows = self.surface.textured.chunks(nx);
        let in_contact = rows.map(|row| row.iter().filter(|&&textured| !textured).count());
        let mut most = [in_contact.max().unwrap_or(0) as f64 / nx as f64];
        ranks.largest(&mut most);
        most[0]
    }
}
