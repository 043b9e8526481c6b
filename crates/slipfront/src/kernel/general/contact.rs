//! What a law of friction keeps of every block beside its thresholds.

use super::contact_springs::SpringContact;
use super::rate_and_state::StateContact;
use super::thresholds::Thresholds;
use crate::friction::Friction;
use crate::model::Model;

/// By law.
#[derive(Debug)]
pub(super) enum Contact {
    Coulomb(Thresholds),
    RateAndState(StateContact),
    Springs(SpringContact),
}

impl Contact {
    pub(super) fn new(model: &Model) -> Self {
        let n = model.surface.n_blocks();
        match &model.friction {
            Friction::Coulomb(coulomb) => {
                Self::Coulomb(Thresholds::new(coulomb, model.surface.adhesion(), n))
            }
            Friction::RateAndState(law) => Self::RateAndState(StateContact::new(*law, model)),
            Friction::ContactSprings(law) => Self::Springs(SpringContact::new(*law, model)),
        }
    }

    /// Bytes per block: the columns of a checkpoint, and what is found from them anew.
    pub(super) fn bytes_per_block(friction: &Friction) -> usize {
        let found = match friction {
            Friction::Coulomb(coulomb) => {
                // Kinetic friction at the present speed; the threshold at the present age, and whether age counts.
                let weakened = usize::from(coulomb.weakening.is_some()) * size_of::<f64>();
                let aged = usize::from(coulomb.ageing.is_some()) * (size_of::<f64>() + size_of::<bool>());
                weakened + aged
            }
            // The load.
            Friction::RateAndState(_) => size_of::<f64>(),
            Friction::ContactSprings(_) => 0,
        };
        friction.n_columns() * size_of::<f64>() + found
    }

    /// The columns that a checkpoint keeps of it: [`Friction::n_columns`] of them. They are those before the present instant is
    /// evaluated, or the same after it.
    pub(super) fn columns(&self) -> Vec<&[f64]> {
        match self {
            Self::Coulomb(thresholds) => thresholds.aged.iter().map(|aged| &aged.stopped_at[..]).collect(),
            Self::RateAndState(contact) => vec![&contact.theta],
            Self::Springs(springs) => vec![&springs.anchor.x, &springs.anchor.y, &springs.breaks],
        }
    }

    /// The same, to be filled.
    pub(super) fn columns_mut(&mut self) -> Vec<&mut [f64]> {
        match self {
            Self::Coulomb(thresholds) => thresholds
                .aged
                .iter_mut()
                .map(|aged| &mut aged.stopped_at[..])
                .collect(),
            Self::RateAndState(contact) => vec![&mut contact.theta],
            Self::Springs(springs) => {
                let SpringContact { anchor, breaks, .. } = springs;
                vec![&mut anchor.x, &mut anchor.y, breaks]
            }
        }
    }
}
