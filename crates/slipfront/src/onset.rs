//! Estimates of the time at which the slider begins to slip.

use crate::communicator::Communicator;
use crate::lattice::{Edges, K_DIAGONAL, K_DRIVE, springs_on_a_lone_block};
use crate::model::{Model, ONSET_PATH};
use crate::vector_field::length;

impl Model {
    /// Earliest and latest t* at which the onset is expected. The later one is Eq. 12 for blocks that each
    /// bear their load alone: it is later by the factor f of the [largest
    /// load](crate::Surface::largest_load), which exceeds 1 where only some blocks are in contact or the
    /// pressure differs from block to block. The earlier one is Eq. 12 for blocks that bear the load
    /// together, with a share c of all in contact, or, if that is later, for single blocks that their free
    /// neighbours push too:
    ///
    /// ```text
    /// max(2.5 c f, f/A k_2)/V* ... 2.5 f/V*
    /// ```
    ///
    /// with A = [`springs_on_a_lone_block`] and the [loading speed](Self::loading_speed) in place of V*; c f
    /// is 1 if the load of textured blocks is redistributed. The pull that a sheet of free blocks transmits
    /// to blocks in contact is known only for a drive on every block. Any other drive has no `largest_load`,
    /// and pulls all blocks together. A dead load tau shortens each path by tau/k_2, and adhesion lengthens
    /// it by its part of the threshold over k_2. Contact springs take longer to load, by the factor
    /// (k_s + k_t)/k_t. Under a program the results are the times at which the drive has moved by these
    /// paths.
    pub fn onset_estimate(&self, largest_load: Option<f64>) -> [f64; 2] {
        let speed = self.loading_speed();
        let together = ONSET_PATH * self.share_of_load();
        let [early, late] = match largest_load {
            None => [together; 2],
            Some(factor) => {
                let late = ONSET_PATH * factor.max(1.0);
                let lone = factor / (springs_on_a_lone_block(self.drive.k_drive) * K_DRIVE);
                [lone.clamp(together, late), late]
            }
        };
        let [borne, _] = self.mean_dead_load();
        let adhesion = self.surface.adhesion().of_static * self.surface.share_in_contact();
        let more = (adhesion - borne * self.share_along_friction()) / K_DRIVE;
        let delay = self.friction.loading_delay(self.drive.k_drive);
        [early, late].map(|path| {
            let path = (path + more).max(0.0) * delay;
            match self.drive.program {
                None => path / speed,
                Some(_) => self.drive.time_of_path(path * (self.drive.v_star / speed)),
            }
        })
    }

    /// Exact time of the first slip of a block in contact on a surface without texture. For a drive at
    /// constant speed along a direction
    ///
    /// ```text
    /// t* = min_i max(mu_si, mu_ki) F_n,i/(k_s,i V*)
    /// ```
    ///
    /// In general, this is the time t at which the path of the drive reaches the path at constant speed at
    /// this time, `path(t) = V* t*`. A dead load reduces each threshold by its part.
    /// All `ranks` of a lattice must call this together.
    ///
    /// None if the slider bends before any block slips: for contact springs under drive springs that differ,
    /// and for an upright sheet, unless its blocks are equal and it is periodic along x.
    pub fn first_slip_estimate(&self, ranks: &dyn Communicator) -> Option<f64> {
        let through_rows = self.pull_through_rows();
        let is_joined = self.lattice.edges[0] == Edges::Periodic;
        let bends = match self.friction.interface() {
            Some(_) => through_rows.is_none() || (!is_joined && self.lattice.ny > 1),
            None => self.friction.contact_stiffness() > 0.0 && self.slider.drive_springs.is_some(),
        };
        if bends {
            return None;
        }
        let k_drive = through_rows.unwrap_or(self.drive.k_drive);
        let v_star = self.drive.v_star;
        // All contact springs have the same delay, at any radius.
        let delay = self.friction.loading_delay(k_drive);
        let pull =
            |threshold: f64, k: f64| self.friction.first_slip_pull(&self.surface, threshold, k, v_star);
        if self.drive.rotation.is_none() {
            let threshold = if self.dead_load.acts() || through_rows.is_some() {
                let in_contact = (0..self.surface.n_blocks()).filter(|&b| !self.surface.textured[b]);
                // A block that slips at once may have no drive spring.
                let missing = in_contact.map(|b| match self.missing_pull(b) {
                    0.0 => 0.0,
                    pull => pull / self.slider.drive_spring(b),
                });
                ranks.least_of(missing.fold(f64::INFINITY, f64::min))
            } else {
                self.surface.min_slip_threshold()
            };
            let mut pull = pull(threshold, k_drive);
            if !self.friction.has_thresholds() {
                pull -= self.mean_dead_load()[0];
            }
            return Some(match self.drive.program {
                None => delay * pull / (k_drive * v_star),
                Some(_) => self.drive.time_of_path(delay * pull / k_drive),
            });
        }
        let path = |b: usize| {
            let limit = self.slip_threshold(b);
            let k = k_drive * self.slider.drive_spring(b) * self.relative_radius(b);
            if k > 0.0 {
                pull(limit, k) / k
            } else {
                f64::INFINITY
            }
        };
        let in_contact = (0..self.surface.n_blocks()).filter(|&b| !self.surface.textured[b]);
        let least = ranks.least_of(in_contact.map(path).fold(f64::INFINITY, f64::min));
        Some(self.drive.time_of_path(least * delay))
    }

    /// Pull along the drive at which block `b` slips, in addition to its dead load; 0 if the dead load alone
    /// makes it slip:
    ///
    /// ```text
    /// sqrt(T^2 - F_0,across^2) - F_0,along,   T = max(mu_s, mu_k) F_n
    /// (T - F_0,x sgn(d_x))/|d_x|              of an upright sheet, with the direction d of the drive
    /// ```
    fn missing_pull(&self, b: usize) -> f64 {
        if self.slips_at_once(b) {
            return 0.0;
        }
        if self.friction.interface().is_some() {
            let [pull, _] = self.drive.direction;
            let [load, _] = self.dead_load_of(b);
            return (self.slip_threshold(b) - load * pull.signum()) / pull.abs();
        }
        let ([along, across], threshold) = (self.dead_load_on(b), self.slip_threshold(b));
        (threshold * threshold - across * across).sqrt() - along
    }

    /// The force that makes block `b` slip: the larger of its static threshold and its kinetic friction
    /// (D12).
    fn slip_threshold(&self, b: usize) -> f64 {
        self.surface.static_limit(b).max(self.surface.kinetic_force(b))
    }

    /// Whether the dead load alone makes block `b` slip.
    pub fn slips_at_once(&self, b: usize) -> bool {
        let load = match self.friction.interface() {
            Some(_) => self.dead_load_of(b)[0].abs(),
            None => length(self.dead_load_on(b)),
        };
        load > self.slip_threshold(b)
    }

    /// Stiffness with which the drive pulls a block of the lowest row of an upright sheet while that row does
    /// not move, if all blocks have equal drive springs: its own drive spring, and all rows above in series,
    /// each with the drive springs of its blocks, behind the shear stiffness of two diagonal springs.
    ///
    /// ```text
    /// p_j = k_2 (k_s + p_j+1)/(k_2 + k_s + p_j+1),   p = 0 above the last row
    /// ```
    ///
    /// None for another slider, if blocks differ, or if the drive pulls them off a foundation.
    pub(crate) fn pull_through_rows(&self) -> Option<f64> {
        let slider = &self.slider;
        let is_uniform =
            slider.stiffness.is_none() && slider.outline.is_none() && slider.drive_springs.is_none();
        let interface = self.friction.interface().filter(|_| is_uniform)?;
        // A pull off a foundation changes the normal force.
        if interface.foundation > 0.0 && self.drive.direction[1] != 0.0 {
            return None;
        }
        let k_drive = self.drive.k_drive;
        let above = (1..self.lattice.ny).fold(0.0, |pull, _| {
            K_DIAGONAL * (k_drive + pull) / (K_DIAGONAL + k_drive + pull)
        });
        Some(k_drive + above)
    }
}
