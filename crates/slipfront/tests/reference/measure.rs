//! Measures of the whole slider at t_n.

use slipfront::Friction;

use super::springs::elastic_energy;
use super::vector::{Vector, difference, dot, left_of, length, sum, times};
use super::{Reference, drive};

/// Powers at an instant.
#[derive(Clone, Copy, Debug, Default)]
struct Powers {
    /// Force of the drive springs along their direction, `sum F_s . g`, which does work along the path X.
    pull: f64,
    friction: f64,
    damping: f64,
    viscosity: f64,
}

/// Work of the drive and losses since the start.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Losses {
    pub(crate) work: f64,
    pub(crate) friction: f64,
    pub(crate) damping: f64,
    pub(crate) viscosity: f64,
    pub(crate) broken_springs: f64,
    /// Powers at the instant before.
    before: Option<Powers>,
}

impl Reference<'_> {
    /// Velocity of block `b` at t_n, the mean of the half steps around it.
    pub(super) fn velocity_now(&self, b: usize) -> Vector {
        times(0.5, sum(self.velocity_before[b], self.velocity[b]))
    }

    /// Pull of the drive spring of block `b`, without the dead load.
    fn pull(&self, b: usize) -> Vector {
        difference(self.drive_force(b), self.blocks[b].dead_load)
    }

    pub(super) fn sum_over(&self, of_block: impl Fn(usize) -> f64) -> f64 {
        (0..self.blocks.len()).map(of_block).sum()
    }

    /// Number of existing blocks, N.
    fn n_blocks(&self) -> f64 {
        self.blocks.iter().filter(|block| block.exists).count() as f64
    }

    /// mu* and the component to the left of the drive (Eq. 9): for a translation `sum (F_s + F_0) . d/N`, for
    /// a rotation `sum F_s . (z x r)/sum r`, the torque over the sum of radii.
    pub(crate) fn mu_star(&self) -> [f64; 2] {
        let over = match self.model.drive.rotation {
            None => self.n_blocks(),
            Some(_) => self.sum_over(|b| length(self.blocks[b].direction)),
        };
        let along = self.sum_over(|b| dot(self.drive_force(b), self.blocks[b].direction));
        let across = self.sum_over(|b| dot(self.drive_force(b), left_of(self.blocks[b].direction)));
        [along / over, across / over]
    }

    /// Number of sliding blocks, and number of sliding blocks in contact.
    pub(crate) fn sliding(&self) -> [usize; 2] {
        let slides = |b: &usize| self.slides[*b];
        let all = (0..self.blocks.len()).filter(slides);
        let in_contact = all.clone().filter(|&b| self.blocks[b].in_contact);
        [all.count(), in_contact.count()]
    }

    /// N*, in % of all existing blocks (Eq. 11a); for an upright sheet, sliding blocks in contact in % of the
    /// facing blocks.
    pub(crate) fn n_star(&self) -> f64 {
        let [sliding, slipping] = self.sliding();
        match self.interface() {
            Some(_) => {
                let faces = |b: &usize| self.contact.faces.as_ref().is_none_or(|faces| faces[*b]);
                let facing = (0..self.blocks.len()).filter(|b| self.blocks[*b].exists && faces(b));
                100.0 * slipping as f64 / facing.count() as f64
            }
            None => 100.0 * sliding as f64 / self.n_blocks(),
        }
    }

    /// Contact stress `tau_c = |F_f + F_c|` (Eq. 10).
    pub(crate) fn contact_stress(&self, b: usize) -> f64 {
        length(sum(self.force_friction[b], self.force_lattice[b]))
    }

    /// The largest contact stress of the blocks in contact.
    pub(crate) fn largest_contact_stress(&self) -> f64 {
        let in_contact = (0..self.blocks.len()).filter(|&b| self.blocks[b].in_contact);
        in_contact.map(|b| self.contact_stress(b)).fold(0.0, f64::max)
    }

    /// Mean state of the contacts under rate and state, 0 under other laws.
    pub(crate) fn mean_state(&self) -> f64 {
        let in_contact = |b: usize| f64::from(u8::from(self.blocks[b].in_contact));
        let state = |b: usize| in_contact(b) * self.memory[b].theta;
        self.sum_over(state) / self.sum_over(in_contact)
    }

    /// Kinetic energy, `m v^2/2` as the mean of the half steps around t_n.
    pub(crate) fn kinetic_energy(&self) -> f64 {
        let square = |v: Vector| dot(v, v);
        self.sum_over(|b| {
            let mean = 0.5 * (square(self.velocity_before[b]) + square(self.velocity[b]));
            0.5 * self.blocks[b].mass * mean
        })
    }

    /// Energy of the springs between blocks, `k_ij (r_ij - d_ij)^2/2`, or of a body, `-u_i . F_c,i/2`.
    pub(crate) fn lattice_energy(&self) -> f64 {
        if self.body.is_some() {
            return self.sum_over(|b| -0.5 * dot(self.displacement[b], self.force_lattice[b]));
        }
        let epsilon = self.model.epsilon;
        self.sum_over(|b| elastic_energy(b, &self.blocks[b].springs, &self.displacement, epsilon))
    }

    /// Energy of the drive springs, `k_s,i (X g_i - u_i)^2/2`.
    pub(crate) fn drive_energy(&self) -> f64 {
        let path = drive::path(self.model, self.drive_time());
        self.sum_over(|b| {
            let block = &self.blocks[b];
            let stretch = difference(times(path, block.direction), self.pulled_displacement(b));
            0.5 * block.drive_stiffness * dot(stretch, stretch)
        })
    }

    /// Energy of the contact springs, `k_t (u - a)^2/2`, after those that yield now have lost theirs.
    pub(crate) fn contact_energy(&self) -> f64 {
        let Friction::ContactSprings(law) = self.model.friction else {
            return 0.0;
        };
        self.sum_over(|b| {
            let stretch = difference(self.displacement[b], self.memory[b].anchor);
            let is_held = self.blocks[b].in_contact;
            if is_held {
                0.5 * law.stiffness * dot(stretch, stretch)
            } else {
                0.0
            }
        })
    }

    /// Energy of the foundation under an interface and of the load on it: the work against `N - F_n`.
    pub(crate) fn foundation_energy(&self) -> f64 {
        let Some(interface) = self.interface() else {
            return 0.0;
        };
        let stiffness = interface.foundation;
        self.sum_over(|b| {
            let (load, rise) = (self.load(b), self.displacement[b][1]);
            match self.blocks[b].in_contact {
                true if stiffness * rise < load => 0.5 * stiffness * rise * rise,
                true if stiffness > 0.0 => load * (rise - 0.5 * load / stiffness),
                _ => 0.0,
            }
        })
    }

    /// Powers at t_n. Energy of contact springs is stored, and lost when they break.
    fn powers(&self) -> Powers {
        let is_stored = matches!(self.model.friction, Friction::ContactSprings(_));
        let friction = |b: usize| -dot(self.force_friction[b], self.velocity_now(b));
        let damping = |b: usize| {
            let v = self.velocity_now(b);
            self.model.damping * self.blocks[b].mass * dot(v, v)
        };
        Powers {
            pull: self.sum_over(|b| dot(self.pull(b), self.blocks[b].direction)),
            friction: if is_stored { 0.0 } else { self.sum_over(friction) },
            damping: self.sum_over(damping),
            viscosity: self.sum_over(|b| -dot(self.force_dampers[b], self.velocity_now(b))),
        }
    }

    /// Work of the dead load in the step from t_n on, `sum F_0,i . (u_n+1 - u_n)`.
    pub(super) fn work_of_dead_load(&self) -> f64 {
        self.dt * self.sum_over(|b| dot(self.blocks[b].dead_load, self.velocity[b]))
    }

    /// Adds the step that ends at t_n, by the trapezoidal rule: the work of the drive is
    /// `(F_n-1 + F_n)/2 (X_n - X_n-1)`.
    pub(super) fn add_losses(&mut self) {
        let now = self.powers();
        let lost = [0, 1].map(|k| self.sum_over(|b| self.lost[b][k]));
        let losses = &mut self.losses;
        losses.broken_springs += lost[0];
        losses.friction += lost[1];
        if let Some(before) = losses.before.replace(now) {
            let mean = |of: fn(&Powers) -> f64| 0.5 * (of(&before) + of(&now));
            let paths = [self.drive_steps_before, self.drive_steps]
                .map(|step| drive::path(self.model, step as f64 * self.dt));
            losses.work += mean(|powers| powers.pull) * (paths[1] - paths[0]);
            losses.friction += self.dt * mean(|powers| powers.friction);
            losses.damping += self.dt * mean(|powers| powers.damping);
            losses.viscosity += self.dt * mean(|powers| powers.viscosity);
        }
    }

    /// Work and losses since the start.
    pub(crate) fn losses(&self) -> Losses {
        self.losses
    }
}
