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
pub use self::weakening::Weakening;

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

impl From<FrictionLaw> for Friction {
    fn from(law: FrictionLaw) -> Self {
        Self::Coulomb(Coulomb {
            law,
            weakening: None,
            ageing: None,
        })
    }
}
