//! The ledger of energies: what the drive gives is held by blocks and springs or lost to friction and damping.
//!
//! All in units of `P mu_s l^2` times `P mu_s l/E`.

use crate::kernel::Forces;
use crate::lanes;
use crate::lattice::{Bond, Lattice};
use crate::vector_field::dot;
use crate::width::widest;
use crate::{Snapshot, VectorField};

/// Energies held at an instant, and given and lost since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Kinetic energy, the mean of the half steps before and after.
    pub kinetic: f64,
    /// Held by the springs between blocks.
    pub lattice: f64,
    /// Held by the drive springs.
    pub drive_springs: f64,
    /// Work done by the drive (and by a constant force) since the start.
    pub work: f64,
    /// Lost to friction since the start.
    pub friction_loss: f64,
    /// Lost to damping since the start.
    pub damping_loss: f64,
    /// What was held at the start.
    pub held_at_start: f64,
}

impl Energies {
    /// Energy held now.
    pub fn held(&self) -> f64 {
        self.kinetic + self.lattice + self.drive_springs
    }

    /// How far the ledger is from closing, relative to all energy that went in:
    ///
    /// ```text
    /// error = (work - (held - held at start) - losses)/(|work| + held at start)
    /// ```
    ///
    /// It falls with the square of the time step: what it misses is the motion that the last step of a slip takes
    /// from a block, at most `(mu_k F_n dt)^2/2`. A slider that only slides closes to rounding.
    pub fn error(&self) -> f64 {
        let put_in = self.work.abs() + self.held_at_start;
        let missing = self.work - (self.held() - self.held_at_start) - self.friction_loss - self.damping_loss;
        if put_in > 0.0 { missing / put_in } else { 0.0 }
    }
}

/// Powers at one instant.
#[derive(Clone, Copy, Debug, Default)]
struct Powers {
    work: f64,
    friction: f64,
    damping: f64,
}

/// Sums works and losses over the steps, by the trapezoidal rule.
#[derive(Debug, Default)]
pub struct Ledger {
    before: Option<Powers>,
    totals: Energies,
}

impl Ledger {
    /// Adds the step that ends now. To be called at every step.
    pub(crate) fn add(&mut self, now: &Snapshot) {
        let powers = powers(now);
        match self.before {
            Some(before) => {
                let half = 0.5 * now.dt_star;
                self.totals.work += half * (before.work + powers.work);
                self.totals.friction_loss += half * (before.friction + powers.friction);
                self.totals.damping_loss += half * (before.damping + powers.damping);
            }
            None => self.totals.held_at_start = held(now).held(),
        }
        self.before = Some(powers);
    }

    /// The ledger at this instant.
    pub(crate) fn energies(&self, now: &Snapshot) -> Energies {
        let Energies {
            kinetic,
            lattice,
            drive_springs,
            ..
        } = held(now);
        Energies {
            kinetic,
            lattice,
            drive_springs,
            ..self.totals
        }
    }
}

/// Work of the drive `V . sum F_s`, of friction and of damping per time, with the velocity at t_n taken as the
/// mean of the half steps around it.
fn powers(now: &Snapshot) -> Powers {
    let (before, forces) = (&now.state.velocity, now.forces);
    let motion = widest!(motion(before: &VectorField, forces: &Forces) -> Motion);
    let drive = &now.model.drive;
    let pull = now.point.mu_star * before.len() as f64 * drive.v_star;
    Powers {
        work: pull + dot(drive.constant_force, motion.velocity),
        friction: -motion.friction,
        damping: now.model.damping * motion.square,
    }
}

/// Sums over all blocks, with velocities at t_n.
struct Motion {
    /// `sum v`.
    velocity: [f64; 2],
    /// `sum v^2`.
    square: f64,
    /// `sum F_f . v`.
    friction: f64,
}

#[inline(always)]
fn motion(before: &VectorField, forces: &Forces) -> Motion {
    let n = before.len();
    let (before_x, before_y) = (&before.x[..n], &before.y[..n]);
    let (after_x, after_y) = (&forces.velocity_after.x[..n], &forces.velocity_after.y[..n]);
    let (friction_x, friction_y) = (&forces.friction.x[..n], &forces.friction.y[..n]);
    let vx = |b: usize| 0.5 * (before_x[b] + after_x[b]);
    let vy = |b: usize| 0.5 * (before_y[b] + after_y[b]);
    Motion {
        velocity: [lanes::sum(n, vx), lanes::sum(n, vy)],
        square: lanes::sum(n, |b| vx(b) * vx(b) + vy(b) * vy(b)),
        friction: lanes::sum(n, |b| friction_x[b] * vx(b) + friction_y[b] * vy(b)),
    }
}

fn held(now: &Snapshot) -> Energies {
    let (model, u) = (now.model, &now.state.displacement);
    let (blocks, epsilon) = (&model.lattice, model.epsilon);
    let lattice = widest!(lattice_energy(blocks: &Lattice, u: &VectorField, epsilon: f64) -> f64);
    let reach = model.drive.reach(now.time_star);
    let half_squares = |v: &VectorField| 0.5 * v.x.iter().chain(&v.y).map(|v| v * v).sum::<f64>();
    let stretch = |b: usize| [reach[0] - u.x[b], reach[1] - u.y[b]];
    let drive_springs =
        0.5 * model.drive.k_drive * (0..u.len()).map(|b| dot(stretch(b), stretch(b))).sum::<f64>();
    Energies {
        kinetic: 0.5 * (half_squares(&now.state.velocity) + half_squares(&now.forces.velocity_after)),
        lattice,
        drive_springs,
        ..Energies::default()
    }
}

/// Energy of all springs between blocks at displacements `u`.
#[inline(always)]
fn lattice_energy(lattice: &Lattice, u: &VectorField, epsilon: f64) -> f64 {
    let energy = |bond: &Bond, b: usize, n: usize| bond.energy([u.x[n] - u.x[b], u.y[n] - u.y[b]], epsilon);
    let of_row = |bond: &Bond, j: usize| -> f64 {
        // The one block of the row whose neighbour may stand beyond its end; the others stand all alike.
        let (end, first) = match bond.offset[0] {
            1 => (Some(lattice.nx - 1), 0),
            -1 => (Some(0), 1),
            _ => (None, 0),
        };
        let beyond = end.and_then(|i| {
            Some(energy(
                bond,
                lattice.block(i, j),
                lattice.neighbour(i, j, bond.offset)?,
            ))
        });
        let inside = lattice.nx - usize::from(end.is_some());
        let beside = if inside > 0 {
            lattice.neighbour(first, j, bond.offset)
        } else {
            None
        };
        let along = beside.map_or(0.0, |beside| {
            let block = lattice.block(first, j);
            lanes::sum(inside, |k| energy(bond, block + k, beside + k))
        });
        along + beyond.unwrap_or(0.0)
    };
    Bond::ALL
        .iter()
        .map(|bond| (0..lattice.ny).map(|j| of_row(bond, j)).sum::<f64>())
        .sum()
}
