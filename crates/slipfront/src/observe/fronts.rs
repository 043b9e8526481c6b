//! Slip fronts: when each block first slips.

use super::Observer;
use crate::{Contact, RunError, Snapshot, Surface};

/// First-slip time of every block in contact. To be shown every step.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstSlip {
    /// t* of the first slip; not a number where there is none yet, and over a texture.
    pub time_star: Vec<f64>,
    /// The earliest of them.
    pub earliest: Option<f64>,
    /// Blocks in contact that have not slipped.
    left: usize,
}

impl FirstSlip {
    /// Nothing has slipped yet on this surface.
    pub fn none(surface: &Surface) -> Self {
        Self {
            time_star: vec![f64::NAN; surface.n_blocks()],
            earliest: None,
            left: surface.n_contact(),
        }
    }
}

impl Observer for FirstSlip {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        if now.point.n_sliding == 0 || self.left == 0 {
            return Ok(());
        }
        let textured = &now.model.surface.textured;
        let contacts = now.forces.contact_after.iter().zip(textured);
        for ((contact, textured), time) in contacts.zip(&mut self.time_star) {
            if *contact == Contact::Sliding && !textured && time.is_nan() {
                *time = now.time_star;
                self.left -= 1;
                self.earliest.get_or_insert(now.time_star);
            }
        }
        Ok(())
    }
}
