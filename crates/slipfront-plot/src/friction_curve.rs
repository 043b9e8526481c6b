//! What a friction picture knows of a run.

use serde::{Deserialize, Serialize};

/// What the axes of a friction picture count, and what its labels call the marks: texts in which the character after an underscore
/// is a subscript.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionAxes {
    /// Title of the horizontal axis.
    pub x: String,
    /// Title of the vertical axis of friction.
    pub friction: String,
    /// Symbol of the peak.
    pub peak: String,
    /// Symbol of kinetic friction.
    pub kinetic: String,
    /// Unit of both, with the space before it; empty for none.
    pub unit: String,
}

impl Default for FrictionAxes {
    /// mu* against t*.
    fn default() -> Self {
        Self {
            x: "dimensionless time t*".to_owned(),
            friction: "friction \u{3bc}* = \u{3bc}/\u{27e8}\u{3bc}_s\u{27e9}".to_owned(),
            peak: "\u{3bc}_s*".to_owned(),
            kinetic: "\u{3bc}_k*".to_owned(),
            unit: String::new(),
        }
    }
}

/// One run's curve, in the units of the axes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrictionCurve {
    /// What the legend calls it; shown only beside other curves.
    pub label: String,
    /// Time, or path of the drive.
    pub x: Vec<f64>,
    /// Friction there; NaN leaves a gap.
    pub friction: Vec<f64>,
    /// N* there, in percent.
    pub sliding_percent: Vec<f64>,
    /// Where the first block in contact slips.
    pub first_slip: Option<f64>,
    /// Where the peak is, and friction there.
    pub peak: Option<(f64, f64)>,
    /// The window of kinetic friction.
    pub kinetic: Option<KineticLine>,
    /// Instants to letter.
    pub instants: Vec<Instant>,
}

/// Kinetic friction: its mean over a window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KineticLine {
    /// Where the window begins.
    pub from: f64,
    /// Where the window ends.
    pub to: f64,
    /// The mean.
    pub mean: f64,
    /// Its standard uncertainty, if known.
    pub uncertainty: Option<f64>,
}

/// A lettered instant of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instant {
    /// Its letter.
    pub letter: char,
    /// Where it is.
    pub x: f64,
    /// Friction there.
    pub friction: f64,
}
