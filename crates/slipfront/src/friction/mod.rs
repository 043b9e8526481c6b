//! The laws of friction, which act on blocks in contact with the substrate.
//!
//! Each law has its file, which holds its parameters, declares its [`Needs`], and computes it in the general
//! kernel, with the memory of the law for every block. [`Friction`] and [`BandContact`] here have a row for
//! each law.

mod contact_springs;
mod coulomb;
mod needs;
mod rate_and_state;

use std::ops::Range;

use serde::{Deserialize, Serialize};
use slipfront_kernel::Integrator;

pub use self::contact_springs::{AfterBreak, ContactSprings};
pub use self::coulomb::*;
pub use self::needs::Needs;
pub use self::rate_and_state::RateAndState;

use self::contact_springs::SpringContact;
use self::rate_and_state::StateContact;
use crate::dead_load::DeadLoad;
use crate::forces::Forces;
use crate::state::State;
use crate::surface::Surface;
use slipfront_kernel::fixed_point::RunningSum;

/// The law of friction of all blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// Static and kinetic coefficients (Eq. 4).
    Coulomb(Coulomb),
    /// Coefficients that depend on speed and state, without a stuck state.
    RateAndState(RateAndState),
    /// Springs to the substrate that break.
    ContactSprings(ContactSprings),
}

impl From<FrictionLaw> for Friction {
    fn from(law: FrictionLaw) -> Self {
        Self::Coulomb(law.into())
    }
}

impl From<ContactSprings> for Friction {
    fn from(law: ContactSprings) -> Self {
        Self::ContactSprings(law)
    }
}

impl Friction {
    /// Coulomb's law with strength that falls over a slip of `length`, and is whole again after this time of
    /// stick if there is one.
    pub(crate) fn of_falling_strength(length: f64, healing_time: Option<f64>) -> Self {
        Self::Coulomb(Coulomb {
            slip_weakening: Some(SlipWeakening { length, healing_time }),
            ..FrictionLaw::Projection.into()
        })
    }

    /// Needs of the law in addition to the thresholds of the blocks.
    pub fn needs(&self) -> Needs {
        match self {
            Self::Coulomb(law) => law.needs(),
            Self::RateAndState(_) => RateAndState::NEEDS,
            Self::ContactSprings(_) => ContactSprings::NEEDS,
        }
    }

    /// Number of columns that the law adds to a checkpoint: numbers per block that it remembers in addition
    /// to the velocity.
    pub fn n_columns(&self) -> usize {
        self.needs().columns
    }

    /// Whether blocks are held up to a threshold, so that friction falls when they slip.
    pub fn has_thresholds(&self) -> bool {
        !matches!(self, Self::RateAndState(_))
    }

    /// Whether a block may take the threshold of any other block, so that every process must know all
    /// thresholds.
    pub fn lends_thresholds(&self) -> bool {
        matches!(
            self,
            Self::ContactSprings(ContactSprings {
                after_break: AfterBreak::FormsAgain { redraw: Some(_) },
                ..
            })
        )
    }

    /// Stiffness of the contact that holds a block to the substrate until it slips, in units of `E h`; 0 for
    /// rigid contacts.
    pub(crate) fn contact_stiffness(&self) -> f64 {
        match self {
            Self::Coulomb(_) | Self::RateAndState(_) => 0.0,
            Self::ContactSprings(law) => law.stiffness,
        }
    }

    /// Eq. 4 with its options, if the law is Coulomb's.
    pub(crate) fn coulomb(&self) -> Option<&Coulomb> {
        match self {
            Self::Coulomb(law) => Some(law),
            Self::RateAndState(_) | Self::ContactSprings(_) => None,
        }
    }

    /// The interface of an upright sheet, if friction acts along x alone.
    pub fn interface(&self) -> Option<Interface> {
        self.coulomb()?.interface
    }

    /// Law by which strength falls with slip, if the law of friction has one.
    pub(crate) fn strength_over_slip(&self) -> Option<SlipWeakening> {
        self.coulomb()?.slip_weakening
    }

    /// Mean friction of all blocks in steady sliding at `speed`, in units of `P mu_s l^2`.
    pub(crate) fn steady_force(&self, surface: &Surface, speed: f64) -> f64 {
        let limits = [surface.mean_static_force(), surface.mean_kinetic_force()];
        let adhesion = surface.mean_kinetic_adhesion();
        self.steady_force_under(surface.mean_normal_force(), limits, adhesion, speed)
    }

    /// Friction of block `b` in steady sliding at `speed`, in units of `P mu_s l^2`.
    pub(crate) fn steady_force_of(&self, surface: &Surface, b: usize, speed: f64) -> f64 {
        let limits = [surface.static_limit(b), surface.kinetic_force(b)];
        let adhesion = if surface.textured[b] {
            0.0
        } else {
            surface.adhesion().of_kinetic
        };
        self.steady_force_under(surface.normal_force(b), limits, adhesion, speed)
    }

    /// Friction in steady sliding under a normal force, from static and kinetic friction and its adhesion.
    fn steady_force_under(
        &self,
        normal_force: f64,
        [of_static, of_kinetic]: [f64; 2],
        adhesion: f64,
        speed: f64,
    ) -> f64 {
        match self {
            Self::Coulomb(law) => law.steady_force(of_kinetic, adhesion, speed),
            Self::RateAndState(law) => normal_force * law.steady_coefficient(speed),
            Self::ContactSprings(law) => law.steady_force(of_static, of_kinetic),
        }
    }

    /// Pull `F` of the drive springs of stiffness `k` at which a block with this threshold slips on a surface
    /// without texture; the pull rises as `k V t`. Contact springs are loaded [later](Self::loading_delay).
    /// Under rate and state slip has no definite start, and the pull is that of steady sliding.
    pub(crate) fn first_slip_pull(&self, surface: &Surface, threshold: f64, k: f64, speed: f64) -> f64 {
        match self {
            Self::Coulomb(law) => law.first_slip_pull(surface, threshold, k, speed),
            Self::RateAndState(_) => self.steady_force(surface, speed),
            Self::ContactSprings(_) => threshold,
        }
    }

    /// Factor by which a drive through springs of stiffness `k` takes longer to load contacts that yield than
    /// rigid ones.
    pub(crate) fn loading_delay(&self, k: f64) -> f64 {
        match self {
            Self::Coulomb(_) | Self::RateAndState(_) => 1.0,
            Self::ContactSprings(law) => law.pull_over_rigid(k),
        }
    }
}

/// Sums over all blocks under laws of friction that store energy or have a state; 0 under all others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactTotals {
    /// Energy at t_n of the springs between blocks and substrate that have not broken.
    pub spring_energy: f64,
    /// Energy lost with the springs that break at t_n.
    pub broken_energy: f64,
    /// Work against friction of the blocks that slide on springs, in the step that ends at t_n.
    pub slip_work: f64,
    /// Mean state variable of the blocks in contact, t*.
    pub mean_state: f64,
}

impl ContactTotals {
    /// Totals from the sums of [`BandContact::add_up`].
    pub(crate) fn from_sums(
        [spring_energy, broken_energy, third]: [f64; 3],
        friction: &Friction,
        surface: &Surface,
    ) -> Self {
        let (slip_work, state) = match friction {
            Friction::ContactSprings(_) => (third, 0.0),
            Friction::Coulomb(_) | Friction::RateAndState(_) => (0.0, third),
        };
        Self {
            spring_energy,
            broken_energy,
            slip_work,
            mean_state: state / surface.n_contact() as f64,
        }
    }
}

/// A law of friction with its memory for the blocks of a band of the general kernel.
#[derive(Debug)]
pub(crate) enum BandContact {
    Coulomb(CoulombContact),
    RateAndState(StateContact),
    Springs(SpringContact),
}

impl BandContact {
    /// The memory of a law at the start. `dead_load`: constant forces on the blocks of the band;
    /// `first_block`: number of its first block in the whole lattice.
    pub(crate) fn new(
        friction: &Friction,
        surface: &Surface,
        dead_load: &DeadLoad,
        first_block: usize,
    ) -> Self {
        let n = surface.n_blocks();
        match friction {
            Friction::Coulomb(law) => Self::Coulomb(CoulombContact::new(law, surface.adhesion(), n)),
            Friction::RateAndState(law) => Self::RateAndState(StateContact::new(*law, surface)),
            Friction::ContactSprings(law) => {
                Self::Springs(SpringContact::new(*law, surface, dead_load, first_block))
            }
        }
    }

    /// The [`Friction::n_columns`] columns that a checkpoint keeps. They are the same before and after the
    /// present instant is evaluated.
    pub(crate) fn columns(&self) -> Vec<&[f64]> {
        match self {
            Self::Coulomb(thresholds) => thresholds.columns(),
            Self::RateAndState(contact) => vec![&contact.theta],
            Self::Springs(springs) => vec![&springs.anchor.x, &springs.anchor.y, &springs.breaks],
        }
    }

    /// The columns that a checkpoint keeps, to be filled.
    pub(crate) fn columns_mut(&mut self) -> Vec<&mut [f64]> {
        match self {
            Self::Coulomb(thresholds) => thresholds.columns_mut(),
            Self::RateAndState(contact) => vec![&mut contact.theta],
            Self::Springs(springs) => {
                let SpringContact { anchor, breaks, .. } = springs;
                vec![&mut anchor.x, &mut anchor.y, breaks]
            }
        }
    }

    /// Finds the static thresholds that follow from the columns of a checkpoint.
    pub(crate) fn resume(&self, surface: &Surface, static_limit: &mut [f64]) {
        if let Self::Springs(springs) = self {
            springs.find_thresholds(surface, static_limit);
        }
    }

    /// Updates the memory of the law with the motion of some blocks in the step before, which `forces` holds,
    /// before these blocks move over a step.
    #[inline(always)]
    pub(crate) fn remember(
        &mut self,
        surface: &Surface,
        blocks: &Range<usize>,
        state: &State,
        forces: &Forces,
        static_limit: &mut [f64],
        dt_star: f64,
    ) {
        match self {
            Self::Coulomb(thresholds) => thresholds.add_slip(blocks, &state.velocity, dt_star),
            Self::RateAndState(contact) => contact.evolve(blocks, &state.velocity, dt_star),
            Self::Springs(springs) => {
                springs.move_anchors(surface, blocks, &state.displacement, &forces.slides, static_limit);
            }
        }
    }

    /// Eqs. 4-7: friction and damping of some blocks, their velocities half a step later and whether they
    /// slide. `limits`: static and kinetic thresholds of all blocks; `integrator`: one for each of these
    /// blocks.
    #[inline(always)]
    pub(crate) fn apply(
        &mut self,
        surface: &Surface,
        blocks: &Range<usize>,
        limits: [&[f64]; 2],
        (state, time_star): (&State, f64),
        integrator: impl Fn(usize) -> Integrator,
        forces: &mut Forces,
    ) {
        match self {
            Self::Coulomb(thresholds) => {
                thresholds.apply(surface, blocks, limits, state, integrator, forces, time_star);
            }
            Self::RateAndState(contact) => contact.apply(blocks, state, integrator, forces),
            Self::Springs(springs) => springs.apply(surface, blocks, state, limits[0], integrator, forces),
        }
    }

    /// Adds the terms of [`ContactTotals`] for some blocks, after their next velocities have been computed.
    /// The sums have room for two numbers of each block.
    #[inline(always)]
    pub(crate) fn add_up(
        &self,
        surface: &Surface,
        blocks: &Range<usize>,
        state: &State,
        slides: &[bool],
        [held, broken, third]: [&mut RunningSum; 3],
        room: [&mut [f64]; 2],
    ) {
        match self {
            Self::Coulomb(_) => {}
            Self::RateAndState(contact) => contact.add_states(surface, blocks, third, room[0]),
            Self::Springs(springs) => {
                let u = &state.displacement;
                springs.add_energies(surface, blocks, u, slides, [held, broken, third], room);
            }
        }
    }
}
