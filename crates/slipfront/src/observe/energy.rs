//! The energy balance: the work of the drive is stored in blocks and springs or lost to friction and damping.
//!
//! All energies are in units of `P mu_s l^2` times `P mu_s l^2/(E h)`.

use serde::{Deserialize, Serialize};

use crate::measure::pull_of_springs;
use crate::snapshot::Snapshot;
use crate::totals::StoredEnergy;

/// Energies stored at an instant, and supplied and lost since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// Energy stored at this instant.
    pub stored: StoredEnergy,
    /// Work done by the drive and the dead load since the start.
    pub work: f64,
    /// Energy lost to friction since the start.
    pub friction_loss: f64,
    /// Energy lost to damping since the start.
    pub damping_loss: f64,
    /// Energy lost to the dampers between blocks since the start.
    pub viscous_loss: f64,
    /// Energy stored in springs between blocks and substrate at this instant.
    pub contact_springs: f64,
    /// Energy stored in the foundation under an interface at this instant, including that of the load on it.
    pub foundation: f64,
    /// Energy lost with springs between blocks and substrate that broke since the start.
    pub broken_springs_loss: f64,
    /// Part of the friction loss since the start that is weakening energy, see
    /// [`Snapshot::weakening_energy`](crate::Snapshot::weakening_energy).
    pub weakening_loss: f64,
    /// Energy stored at the start.
    pub stored_at_start: f64,
}

impl Energies {
    /// Error of the balance, relative to all energy supplied:
    ///
    /// ```text
    /// error = (work - (stored - stored at start) - losses)/(|work| + stored at start)
    /// ```
    ///
    /// The error is proportional to the square of the time step: the balance misses the kinetic energy that a
    /// block loses in the last step of a slip, at most `(mu_k F_n dt)^2/2`. As long as no block stops and
    /// springs are linear, the errors of the steps cancel, except for the first and the present step. With
    /// the force **F** of the springs between blocks and to the drive, and the change of velocity from half a
    /// step before to half a step after,
    ///
    /// ```text
    /// missing = (dt/4) [(sum F . (v_after - v_before)) at the start - the same now]
    /// ```
    ///
    /// so that in steady sliding only rounding errors remain.
    pub fn error(&self) -> f64 {
        let supplied = self.work.abs() + self.stored_at_start;
        let stored = self.stored.total() + self.contact_springs + self.foundation;
        let losses = self.friction_loss + self.damping_loss + self.viscous_loss + self.broken_springs_loss;
        let missing = self.work - (stored - self.stored_at_start) - losses;
        if supplied > 0.0 { missing / supplied } else { 0.0 }
    }
}

/// The pull of the drive springs at one instant, and powers: of friction, of damping and of the dampers
/// between blocks.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Powers {
    /// Force along the path of the drive, `sum F_s . d`; for a rotation the torque over the largest radius.
    pull: f64,
    friction: f64,
    damping: f64,
    viscous: f64,
}

impl Powers {
    fn at(now: &Snapshot) -> Self {
        let (model, totals) = (now.model, &now.totals);
        Self {
            pull: pull_of_springs(model, totals, now.drive_time_star)[0] * model.mu_star_divisor(),
            friction: -totals.friction_power,
            damping: model.damping * totals.velocity_square,
            viscous: now.engine.viscous_power(),
        }
    }
}

/// Integrates powers over the steps by the trapezoidal rule. The work of the drive in a step, at a speed that
/// is constant within it, is `(F_n + F_n+1)/2 (X_n+1 - X_n)`, or torque times angle; the work of the dead
/// load follows from the displacements.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Ledger {
    before: Option<Powers>,
    totals: Energies,
    /// Work of the dead load from the rest sites to the start.
    dead_load_at_start: f64,
}

impl Ledger {
    /// Adds the step that ends now. Must be called at every step.
    pub(crate) fn add(&mut self, now: &Snapshot) {
        let powers = Powers::at(now);
        self.totals.contact_springs = now.contact.spring_energy;
        self.totals.broken_springs_loss += now.contact.broken_energy;
        self.totals.friction_loss += now.contact.slip_work;
        match self.before {
            Some(before) => {
                let half = 0.5 * now.dt_star;
                let moved = now.clock.drive_moved();
                let at_speed = || now.model.drive.speed_after(now.clock.drive_time_before());
                let speed = if moved { at_speed() } else { 0.0 };
                self.totals.work += half * (before.pull * speed + powers.pull * speed);
                self.totals.friction_loss += half * (before.friction + powers.friction);
                self.totals.damping_loss += half * (before.damping + powers.damping);
                self.totals.viscous_loss += half * (before.viscous + powers.viscous);
            }
            None => {
                let of_contact = now.contact.spring_energy + now.contact.broken_energy;
                self.totals.stored_at_start =
                    now.stored_energy().total() + now.foundation_energy() + of_contact;
                self.dead_load_at_start = now.dead_load_work();
            }
        }
        self.before = Some(powers);
    }

    /// The balance at this instant, without the energy stored in blocks and springs.
    pub(crate) fn counts(&self, now: &Snapshot) -> Energies {
        Energies {
            work: self.totals.work + (now.dead_load_work() - self.dead_load_at_start),
            foundation: now.foundation_energy(),
            weakening_loss: now.weakening_energy(),
            ..self.totals
        }
    }
}
