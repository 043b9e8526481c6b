//! `[[texture]]`: the parts of the surface that do not touch the plane (Eqs. 15, 17 and 18).

use serde::{Deserialize, Serialize};

use slipfront::surface::Orientation;

use super::values::{Pair, pair, word};
use crate::quantity::{Length, QuantityError};

/// One `[[texture]]` of the file; a block is textured when its centre lies inside any of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "shape", rename_all = "snake_case")]
pub enum Texture {
    /// A cavity with the outline of Eq. 17.
    Cavity(Cavity),
    /// A straight groove through the whole slider (Eq. 15).
    Groove(Groove),
    /// The inside of a closed polygon, by the even-odd rule.
    Polygon(Polygon),
    /// The dark pixels of an image, or the ones of an array.
    Mask(Mask),
}

/// A cavity, or a grid of equal ones, with the outline of Eq. 17.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "CavityKeys", into = "CavityKeys")]
pub struct Cavity {
    /// Kind of outline (s), 1 to 64: an ellipse for 1, else a polygon of s + 1 curved edges.
    pub s: u32,
    /// How far the outline is from a circle (w): |w| < 1 for s = 1, |w| <= 1/s, where vertices are sharp, otherwise.
    pub w: f64,
    /// The size: `coverage` or `lambda`.
    pub size: CavitySize,
    /// Whether x and y of the outline are swapped: an ellipse of w > 0 is then elongated along y, not x.
    pub across: bool,
    /// The centre, or the centre of the grid.
    pub center: Center,
    /// Rotation about the centre, degrees from x towards y, -360 to 360.
    pub rotate: f64,
    /// How many cavities along x and along y, 1 to 1000 each.
    pub array: [u32; 2],
}

/// The size of a cavity.
#[derive(Clone, Debug, PartialEq)]
pub enum CavitySize {
    /// `coverage`: percent of the whole area (Eq. 18), all cavities of the grid together; more than 0, less than 100.
    Coverage(f64),
    /// `lambda`: the length of Eq. 17, the radius of the circle that w = 0 gives, m.
    Lambda(Length),
}

/// Where a cavity lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "CenterKey", into = "CenterKey")]
pub enum Center {
    /// `"middle"`: the middle of the slider.
    Middle,
    /// `[x, y]` from the slider's lower left corner, m.
    At([Length; 2]),
}

/// A straight groove through the whole slider, half-open: its lower edge in, its upper edge out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "GrooveKeys", into = "GrooveKeys")]
pub struct Groove {
    /// Whether the groove runs across or along the x axis of the lattice, whatever the direction of the drive.
    pub orientation: Orientation,
    /// The size: `coverage` or `width`.
    pub size: GrooveSize,
    /// Distance of the groove's middle line from the slider's, m.
    pub offset: Length,
}

/// The size of a groove.
#[derive(Clone, Debug, PartialEq)]
pub enum GrooveSize {
    /// `coverage`: percent of the whole area, more than 0, less than 100.
    Coverage(f64),
    /// `width`: m.
    Width(Length),
}

/// The inside of a closed polygon.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    /// The corners [x, y], at least 3, from the slider's lower left corner, m.
    #[serde(deserialize_with = "read_points")]
    pub points: Vec<[Length; 2]>,
}

/// An image or array stretched over the slider.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mask {
    /// A `.png` (dark pixels are textured) or a `.npy` of shape (ny, nx) of 0 and 1 (textured), relative to the case file.
    pub file: String,
    /// A pixel of an image is dark below this share of white, more than 0, less than 1.
    #[serde(default = "default_threshold")]
    pub threshold: f64,
}

/// Halfway to white.
pub const DEFAULT_THRESHOLD: f64 = 0.5;

fn default_threshold() -> f64 {
    DEFAULT_THRESHOLD
}

/// The keys of a cavity as they stand in the file.
#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct CavityKeys {
    s: u32,
    w: f64,
    coverage: Option<f64>,
    lambda: Option<Length>,
    across: bool,
    center: Center,
    rotate: f64,
    #[serde(deserialize_with = "pair")]
    array: [u32; 2],
}

impl Default for CavityKeys {
    fn default() -> Self {
        Self {
            s: 1,
            w: 0.0,
            coverage: None,
            lambda: None,
            across: false,
            center: Center::Middle,
            rotate: 0.0,
            array: [1, 1],
        }
    }
}

impl TryFrom<CavityKeys> for Cavity {
    type Error = &'static str;

    fn try_from(keys: CavityKeys) -> Result<Self, Self::Error> {
        let size = match (keys.lambda, keys.coverage) {
            (Some(lambda), _) => CavitySize::Lambda(lambda),
            (None, Some(coverage)) => CavitySize::Coverage(coverage),
            (None, None) => {
                return Err(
                    "a cavity needs a size: `coverage = 10` (percent of the area) or `lambda = \"8 um\"`",
                );
            }
        };
        Ok(Self {
            s: keys.s,
            w: keys.w,
            size,
            across: keys.across,
            center: keys.center,
            rotate: keys.rotate,
            array: keys.array,
        })
    }
}

impl From<Cavity> for CavityKeys {
    fn from(cavity: Cavity) -> Self {
        let (coverage, lambda) = match cavity.size {
            CavitySize::Coverage(coverage) => (Some(coverage), None),
            CavitySize::Lambda(lambda) => (None, Some(lambda)),
        };
        Self {
            s: cavity.s,
            w: cavity.w,
            coverage,
            lambda,
            across: cavity.across,
            center: cavity.center,
            rotate: cavity.rotate,
            array: cavity.array,
        }
    }
}

/// The keys of a groove as they stand in the file.
#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct GrooveKeys {
    #[serde(deserialize_with = "word")]
    orientation: Orientation,
    coverage: Option<f64>,
    width: Option<Length>,
    offset: Length,
}

impl Default for GrooveKeys {
    fn default() -> Self {
        Self {
            orientation: Orientation::Across,
            coverage: None,
            width: None,
            offset: Length::from_text("0 um", 0.0),
        }
    }
}

impl TryFrom<GrooveKeys> for Groove {
    type Error = &'static str;

    fn try_from(keys: GrooveKeys) -> Result<Self, Self::Error> {
        let size = match (keys.width, keys.coverage) {
            (Some(width), _) => GrooveSize::Width(width),
            (None, Some(coverage)) => GrooveSize::Coverage(coverage),
            (None, None) => {
                return Err(
                    "a groove needs a size: `coverage = 10` (percent of the area) or `width = \"5 um\"`",
                );
            }
        };
        Ok(Self {
            orientation: keys.orientation,
            size,
            offset: keys.offset,
        })
    }
}

impl From<Groove> for GrooveKeys {
    fn from(groove: Groove) -> Self {
        let (coverage, width) = match groove.size {
            GrooveSize::Coverage(coverage) => (Some(coverage), None),
            GrooveSize::Width(width) => (None, Some(width)),
        };
        Self {
            orientation: groove.orientation,
            coverage,
            width,
            offset: groove.offset,
        }
    }
}

/// `center` as it stands in the file.
#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"middle\" or a pair of lengths such as [\"25 um\", \"25 um\"]"
)]
enum CenterKey {
    Word(String),
    /// Texts, so that a length that cannot be read keeps its own message.
    At(Pair<String>),
}

impl TryFrom<CenterKey> for Center {
    type Error = String;

    fn try_from(key: CenterKey) -> Result<Self, String> {
        match key {
            CenterKey::Word(word) if word == "middle" => Ok(Self::Middle),
            CenterKey::Word(word) => Err(format!(
                "{word:?} is given, \"middle\" or a pair of lengths is wanted"
            )),
            CenterKey::At(Pair([x, y])) => {
                let length = |text: String| text.parse().map_err(|error: QuantityError| error.to_string());
                Ok(Self::At([length(x)?, length(y)?]))
            }
        }
    }
}

impl From<Center> for CenterKey {
    fn from(center: Center) -> Self {
        match center {
            Center::Middle => Self::Word("middle".to_owned()),
            Center::At(center) => Self::At(Pair(center.map(|length| length.to_string()))),
        }
    }
}

fn read_points<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Vec<[Length; 2]>, D::Error> {
    let points: Vec<Pair<Length>> = Vec::deserialize(deserializer)?;
    Ok(points.into_iter().map(|Pair(point)| point).collect())
}
