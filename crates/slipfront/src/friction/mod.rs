//! The laws of friction: what the force and motion of a block become where it touches the substrate.

mod ageing;
mod contact_springs;
mod coulomb;
mod rate_and_state;
mod weakening;

pub use self::ageing::Ageing;
pub use self::contact_springs::ContactSprings;
pub use self::coulomb::FrictionLaw;
pub(crate) use self::coulomb::{BlockState, Integrator, Law, Literal, Projection, Reversal};
pub use self::rate_and_state::RateAndState;
pub(crate) use self::rate_and_state::{LogFactors, Sliding};
pub use self::weakening::Weakening;
use crate::surface::Surface;

/// The law of friction of all blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// Static and kinetic coefficients (Eq. 4).
    Coulomb(Coulomb),
    /// Coefficients that follow speed and state, without a stuck state.
    RateAndState(RateAndState),
    /// Springs to the substrate that break and form again.
    ContactSprings(ContactSprings),
}

/// Eq. 4, and what its thresholds may depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// Reading of Eq. 4.
    pub law: FrictionLaw,
    /// Kinetic friction that falls with speed.
    pub weakening: Option<Weakening>,
    /// Static friction that grows while a block is stuck.
    pub ageing: Option<Ageing>,
}

impl Friction {
    /// Numbers of a block that the law remembers beside its velocity: columns of a checkpoint.
    pub fn n_columns(&self) -> usize {
        match self {
            // When it has stopped.
            Self::Coulomb(coulomb) => usize::from(coulomb.ageing.is_some()),
            // Its state.
            Self::RateAndState(_) => 1,
            // The anchor of its spring, and how often this has broken.
            Self::ContactSprings(_) => 3,
        }
    }

    /// Mean friction of all blocks in steady sliding at a speed, in units of `P mu_s l^2`; of springs in contact, which are torn off at
    /// all extensions alike, half the mean of their thresholds.
    pub(crate) fn steady_force(&self, surface: &Surface, speed: f64) -> f64 {
        match self {
            Self::Coulomb(coulomb) => {
                let at_rest = surface.mean_kinetic_force();
                coulomb.weakening.map_or(at_rest, |law| {
                    law.kinetic_force(at_rest, surface.mean_kinetic_adhesion(), speed)
                })
            }
            Self::RateAndState(law) => surface.mean_normal_force() * law.steady_coefficient(speed),
            Self::ContactSprings(_) => 0.5 * surface.mean_static_force(),
        }
    }

    /// Friction of block `b` in steady sliding at a speed, in the same units.
    pub(crate) fn steady_force_of(&self, surface: &Surface, b: usize, speed: f64) -> f64 {
        match self {
            Self::Coulomb(coulomb) => {
                let at_rest = surface.kinetic_force(b);
                let adhesion = if surface.textured[b] {
                    0.0
                } else {
                    surface.adhesion().of_kinetic
                };
                coulomb
                    .weakening
                    .map_or(at_rest, |law| law.kinetic_force(at_rest, adhesion, speed))
            }
            Self::RateAndState(law) => surface.normal_force(b) * law.steady_coefficient(speed),
            Self::ContactSprings(_) => 0.5 * surface.static_limit(b),
        }
    }

    /// Pull `F` of the drive springs of stiffness `k`, which rises as `k V t`, at which a block of this threshold slips on a surface
    /// without texture: for springs in contact the pull that the whole slider would need if they did not yield. Ageing is that of a threshold
    /// above kinetic friction. Under rate and state no block slips at a moment; the pull is that of steady sliding.
    pub(crate) fn first_slip_pull(&self, surface: &Surface, threshold: f64, k: f64, speed: f64) -> f64 {
        match self {
            Self::Coulomb(Coulomb { ageing: None, .. }) => threshold,
            Self::Coulomb(Coulomb {
                ageing: Some(law), ..
            }) => {
                // The threshold grows more slowly than the pull, from a pull at which it is higher: each round comes nearer.
                let adhesion = surface.adhesion().of_static;
                let aged = |pull: f64| law.static_limit(threshold, adhesion, pull / (k * speed));
                (0..MAX_ROUNDS).fold(threshold, |pull, _| aged(pull))
            }
            Self::RateAndState(_) => self.steady_force(surface, speed),
            Self::ContactSprings(law) => threshold * (k + law.stiffness) / law.stiffness,
        }
    }

    /// By how much longer a drive through springs of stiffness `k` takes to load contacts that yield than rigid ones.
    pub(crate) fn loading_delay(&self, k: f64) -> f64 {
        match self {
            Self::ContactSprings(law) => (k + law.stiffness) / law.stiffness,
            Self::Coulomb(_) | Self::RateAndState(_) => 1.0,
        }
    }
}

/// Rounds after which a fixed point that is approached by at least a factor of 2 in each is found to the last bit.
const MAX_ROUNDS: usize = 60;

impl From<FrictionLaw> for Friction {
    fn from(law: FrictionLaw) -> Self {
        Self::Coulomb(Coulomb {
            law,
            weakening: None,
            ageing: None,
        })
    }
}
