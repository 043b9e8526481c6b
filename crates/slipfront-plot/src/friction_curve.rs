//! What a friction picture knows of a run.

use serde::{Deserialize, Serialize};

/// One run's curve; everything is dimensionless.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrictionCurve {
    /// What the legend calls it; shown only beside other curves.
    pub label: String,
    /// Whether mu* is a torque, of a drive that rotates.
    pub is_torque: bool,
    /// t*, never falling.
    pub time_star: Vec<f64>,
    /// mu* at these times; NaN leaves a gap.
    pub mu_star: Vec<f64>,
    /// N* at these times, in percent.
    pub sliding_percent: Vec<f64>,
    /// When the first block in contact slips.
    pub first_slip_time_star: Option<f64>,
    /// The peak: (`t_s*`, `mu_s*`).
    pub peak: Option<(f64, f64)>,
    /// The window of kinetic friction.
    pub kinetic: Option<Kinetic>,
    /// Instants to letter.
    pub instants: Vec<Instant>,
}

/// Kinetic friction: the mean of mu* over a window of t*.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kinetic {
    /// Where the window begins.
    pub from: f64,
    /// Where the window ends.
    pub to: f64,
    /// `mu_k*`.
    pub mean: f64,
    /// Its standard uncertainty, if known.
    pub uncertainty: Option<f64>,
}

/// A lettered instant of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instant {
    /// Its letter.
    pub letter: char,
    /// When it is.
    pub time_star: f64,
    /// mu* at that time.
    pub mu_star: f64,
}
