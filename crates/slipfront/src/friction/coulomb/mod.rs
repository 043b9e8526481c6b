//! Eq. 4, and the laws that its thresholds may follow.

mod ageing;
mod interface;
mod law_readings;
mod slip_weakening;
mod update;
mod weakening;

use std::ops::Range;

pub use self::ageing::Ageing;
pub use self::interface::Interface;
pub use self::law_readings::FrictionLaw;
pub use self::slip_weakening::SlipWeakening;
pub use self::weakening::Weakening;

use self::ageing::Aged;
use self::interface::{AlongX, InterfaceContact};
use self::law_readings::{Literal, Projection, Reversal};
use self::slip_weakening::Slipped;
use self::update::friction_forces;
use self::weakening::Weakened;
use super::needs::Needs;
use crate::forces::Forces;
use crate::state::State;
use crate::surface::{Adhesion, Surface};
use crate::vector_field::VectorField;
use slipfront_kernel::Integrator;

/// Coulomb friction (Eq. 4), and the dependences of its thresholds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// Reading of Eq. 4.
    pub law: FrictionLaw,
    /// Kinetic friction that falls with speed.
    pub weakening: Option<Weakening>,
    /// Static friction that grows while a block is stuck.
    pub ageing: Option<Ageing>,
    /// Strength that falls with slip; not combined with weakening by speed or ageing.
    pub slip_weakening: Option<SlipWeakening>,
    /// Friction of an upright sheet, which acts along x alone; only under the default reading of Eq. 4, and
    /// not combined with ageing.
    pub interface: Option<Interface>,
}

impl From<FrictionLaw> for Coulomb {
    fn from(law: FrictionLaw) -> Self {
        Self {
            law,
            weakening: None,
            ageing: None,
            slip_weakening: None,
            interface: None,
        }
    }
}

impl Coulomb {
    /// Needs of the law with its options.
    pub(super) fn needs(&self) -> Needs {
        let reading = Needs {
            is_fused: self.law == FrictionLaw::Projection,
            ..Needs::NONE
        };
        reading
            .and(self.weakening.map(|_| Weakening::NEEDS))
            .and(self.ageing.map(|_| Ageing::NEEDS))
            .and(self.slip_weakening.map(slip_weakening::needs))
            .and(self.interface.map(|_| Interface::NEEDS))
    }

    /// Kinetic friction in steady sliding at `speed`, from the kinetic friction `at_rest`, which includes
    /// `adhesion`.
    pub(super) fn steady_force(&self, at_rest: f64, adhesion: f64, speed: f64) -> f64 {
        self.weakening
            .map_or(at_rest, |law| law.kinetic_force(at_rest, adhesion, speed))
    }

    /// Pull of drive springs of stiffness `k` at which a block with this threshold slips; the pull rises as
    /// `k V t`.
    pub(super) fn first_slip_pull(&self, surface: &Surface, threshold: f64, k: f64, speed: f64) -> f64 {
        let adhesion = surface.adhesion().of_static;
        self.ageing.map_or(threshold, |law| {
            law.first_slip_pull(threshold, adhesion, k * speed)
        })
    }
}

/// Coulomb's law for the blocks of a band, with the thresholds of the present step where they differ from
/// those of the surface.
#[derive(Debug)]
pub(crate) struct CoulombContact {
    law: FrictionLaw,
    weakened: Option<Weakened>,
    aged: Option<Aged>,
    slipped: Option<Slipped>,
    /// Boxed, since few sliders have one.
    interface: Option<Box<InterfaceContact>>,
}

impl CoulombContact {
    pub(super) fn new(coulomb: &Coulomb, adhesion: Adhesion, n_blocks: usize) -> Self {
        Self {
            law: coulomb.law,
            weakened: coulomb
                .weakening
                .map(|law| Weakened::new(law, adhesion, n_blocks)),
            aged: coulomb.ageing.map(|law| Aged::new(law, adhesion, n_blocks)),
            slipped: coulomb.slip_weakening.map(|law| Slipped::new(law, n_blocks)),
            interface: coulomb
                .interface
                .map(|interface| Box::new(InterfaceContact::new(interface, n_blocks))),
        }
    }

    /// Columns that a checkpoint keeps.
    pub(super) fn columns(&self) -> Vec<&[f64]> {
        let of_age = self.aged.iter().map(|aged| &aged.stopped_at[..]);
        of_age
            .chain(self.slipped.iter().flat_map(Slipped::columns))
            .collect()
    }

    /// Columns that a checkpoint keeps, to be filled.
    pub(super) fn columns_mut(&mut self) -> Vec<&mut [f64]> {
        let of_age = self.aged.iter_mut().map(|aged| &mut aged.stopped_at[..]);
        let of_slip = self.slipped.iter_mut().flat_map(Slipped::columns_mut);
        of_age.chain(of_slip).collect()
    }

    /// Adds the slip of some blocks in the step that ends now to the memory of the law.
    #[inline(always)]
    pub(super) fn add_slip(&mut self, blocks: &Range<usize>, velocity: &VectorField, dt_star: f64) {
        if let Some(slipped) = &mut self.slipped {
            let velocity = match &mut self.interface {
                Some(interface) => interface.slip_velocity(blocks, velocity),
                None => velocity,
            };
            slipped.add_slip(blocks, velocity, dt_star);
        }
    }

    /// Finds friction, the next velocities and the blocks that slide, for some of the blocks. `limits`:
    /// static thresholds at age 0 and kinetic thresholds at rest.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // As many as the law needs, each once.
    pub(super) fn apply(
        &mut self,
        surface: &Surface,
        blocks: &Range<usize>,
        [young, at_rest]: [&[f64]; 2],
        state: &State,
        integrator: impl Fn(usize) -> Integrator,
        forces: &mut Forces,
        time_star: f64,
    ) {
        let velocity = match &mut self.interface {
            Some(interface) => interface.slip_velocity(blocks, &state.velocity),
            None => &state.velocity,
        };
        if let Some(weakened) = &mut self.weakened {
            weakened.update(blocks, at_rest, velocity);
        }
        if let Some(aged) = &mut self.aged {
            let pull = [&forces.drive, &forces.lattice];
            aged.update(blocks, young, velocity, pull, time_star);
        }
        if let Some(slipped) = &mut self.slipped {
            slipped.update(blocks, [young, at_rest], velocity, time_star);
        }
        let now = match &self.slipped {
            Some(slipped) => [&slipped.static_limit[..], &slipped.kinetic_force],
            None => [
                self.aged.as_ref().map_or(young, |aged| &aged.static_limit),
                self.weakened
                    .as_ref()
                    .map_or(at_rest, |weakened| &weakened.kinetic_force),
            ],
        };
        if let Some(interface) = &mut self.interface {
            let now = interface.under_normal_force(surface, blocks, &state.displacement, now);
            friction_forces(&AlongX, integrator, blocks, now, state, forces);
            return;
        }
        match self.law {
            FrictionLaw::Projection => friction_forces(&Projection, integrator, blocks, now, state, forces),
            FrictionLaw::Reversal => friction_forces(&Reversal, integrator, blocks, now, state, forces),
            FrictionLaw::Literal => friction_forces(&Literal, integrator, blocks, now, state, forces),
        }
        if let Some(aged) = &mut self.aged {
            aged.note_stops(blocks, &state.velocity, &forces.slides, time_star);
        }
    }
}
