//! Slip fronts: when each block first slips.

use crate::snapshot::Snapshot;

/// First-slip time of every block in contact.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstSlip {
    /// t* of the first slip; NaN for a block that has not slipped, and over a texture.
    pub time_star: Vec<f64>,
    /// The earliest of them.
    pub earliest: Option<f64>,
}

impl FirstSlip {
    /// All first slips up to this instant.
    pub fn of(now: &Snapshot) -> Self {
        let time_star = now.first_slip_time_star();
        let earliest = time_star.iter().copied().filter(|t| !t.is_nan()).reduce(f64::min);
        Self { time_star, earliest }
    }
}
