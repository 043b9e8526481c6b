//! Content of a friction picture: the curves of runs and their marks.

use serde::{Deserialize, Serialize};

/// Titles of the axes of a friction picture, and names of the marks: texts in which the character after an
/// underscore is a subscript.
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
    /// Unit of both axes of friction and peak, with the space before it; empty for none.
    pub unit: String,
}

impl Default for FrictionAxes {
    /// Titles for mu* against t*.
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
    /// Name of the curve in the legend; shown only if there are other curves.
    pub label: String,
    /// Abscissae: time, or path of the drive.
    pub x: Vec<f64>,
    /// Friction at each abscissa; NaN leaves a gap.
    pub friction: Vec<f64>,
    /// N* at each abscissa, in percent.
    pub sliding_percent: Vec<f64>,
    /// Abscissa at which the first block in contact slips.
    pub first_slip: Option<f64>,
    /// Abscissa and friction of the peak.
    pub peak: Option<(f64, f64)>,
    /// The window of kinetic friction.
    pub kinetic: Option<KineticLine>,
    /// Instants with letters.
    pub instants: Vec<Instant>,
    /// Whether the curve is a measured record, which is drawn as points below the other curves.
    #[serde(default)]
    pub is_record: bool,
}

impl FrictionCurve {
    /// The points of friction.
    pub(crate) fn friction_points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.x.iter().copied().zip(self.friction.iter().copied())
    }

    /// The points of N*.
    pub(crate) fn sliding_points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.x.iter().copied().zip(self.sliding_percent.iter().copied())
    }
}

/// Kinetic friction: its mean over a window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KineticLine {
    /// Beginning of the window.
    pub from: f64,
    /// End of the window.
    pub to: f64,
    /// Mean over the window.
    pub mean: f64,
    /// Standard uncertainty of the mean, if known.
    pub uncertainty: Option<f64>,
}

/// A lettered instant of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instant {
    /// Letter of the instant.
    pub letter: char,
    /// Abscissa of the instant.
    pub x: f64,
    /// Friction at the instant.
    pub friction: f64,
}
