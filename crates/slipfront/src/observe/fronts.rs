//! Slip fronts: when each block first slips.

use crate::Simulation;

/// First-slip time of every block in contact.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstSlip {
    /// t* of the first slip; not a number where there is none yet, and over a texture.
    pub time_star: Vec<f64>,
    /// The earliest of them.
    pub earliest: Option<f64>,
}

impl FirstSlip {
    /// As far as a run has come.
    pub fn of(simulation: &Simulation) -> Self {
        let time_star = simulation.first_slip_time_star();
        let earliest = time_star.iter().copied().filter(|t| !t.is_nan()).reduce(f64::min);
        Self { time_star, earliest }
    }
}
