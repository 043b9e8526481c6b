//! `[[texture]]`: the parts of the surface that do not touch the plane (Eqs. 15, 17 and 18).

use std::ops::Bound::{Excluded, Included};

use serde::{Deserialize, Serialize};
use slipfront::surface::Orientation;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::check::Check;
use super::choice::keys_with_choice;
use super::error::CaseError;
use super::height_map::HeightMap;
use super::key_table::{COORDINATE, SECTIONS};
use super::keys::{texture_header, unknown_shape};
use super::pattern::Pattern;
use super::probe::names_of;
use super::tables::Tables;
use super::values::{Pair, length, word};
use crate::number_format::count;
use crate::quantity::Length;

/// One `[[texture]]` of the file; a block is textured when its centre lies inside any of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Texture {
    /// `shape` and the keys that it has.
    #[serde(flatten)]
    pub shape: Shape,
    /// The keys that every shape has.
    #[serde(flatten)]
    pub pattern: Pattern,
}

/// The shape of a texture.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "shape", rename_all = "snake_case")]
pub enum Shape {
    /// A cavity with the outline of Eq. 17.
    Cavity(Cavity),
    /// A straight groove through the whole slider (Eq. 15).
    Groove(Groove),
    /// The inside of a closed polygon, by the even-odd rule.
    Polygon(Polygon),
    /// The dark pixels of an image, or the ones of an array.
    Mask(Mask),
    /// Measured topography.
    HeightMap(HeightMap),
}

/// A cavity with the outline of Eq. 17.
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
    /// The centre, or that of the pattern.
    pub center: Center,
    /// Rotation about the centre, degrees from x towards y, -360 to 360.
    pub rotate: f64,
}

/// The size of a cavity.
#[derive(Clone, Debug, PartialEq)]
pub enum CavitySize {
    /// `coverage`: percent of the whole area (Eq. 18), all cavities of the pattern together; more than 0, less than 100.
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
    pub threshold: f64,
}

/// Halfway to white.
pub const DEFAULT_THRESHOLD: f64 = 0.5;

impl Texture {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        self.shape.check(check)?;
        self.pattern.check(check)
    }
}

impl Shape {
    /// Its name in the file.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Cavity(_) => "cavity",
            Self::Groove(_) => "groove",
            Self::Polygon(_) => "polygon",
            Self::Mask(_) => "mask",
            Self::HeightMap(_) => "height_map",
        }
    }

    fn check(&self, check: &Check) -> Result<(), CaseError> {
        match self {
            Self::Cavity(cavity) => cavity.check(check),
            Self::Groove(groove) => {
                groove.size.check(check)?;
                check.value("offset", &groove.offset)
            }
            Self::Polygon(polygon) => {
                let corners = polygon.points.len();
                if corners < 3 {
                    return check.refuse("points", |key| {
                        format!(
                            "`{key}` has {}: a polygon needs at least 3",
                            count(corners, "point")
                        )
                    });
                }
                let mut lengths = polygon.points.iter().flatten();
                lengths.try_for_each(|length| check.value_of(&COORDINATE, "points", length))
            }
            Self::Mask(Mask { file, threshold }) => {
                check.value("file", file)?;
                check.value("threshold", threshold)
            }
            Self::HeightMap(map) => map.check(check),
        }
    }
}

impl Cavity {
    fn check(&self, check: &Check) -> Result<(), CaseError> {
        check.value("s", &u64::from(self.s))?;
        let (most, remark) = match self.s {
            1 => (Excluded(1.0), "at 1 the cavity is a line".to_owned()),
            s => (
                Included(1.0 / f64::from(s)),
                format!("beyond 1/s = 1/{s} the outline crosses itself"),
            ),
        };
        let least = most.map(|most: f64| -most);
        check.number_within("w", self.w, (least, most), &remark)?;
        self.size.check(check)?;
        if let Center::At(center) = &self.center {
            let mut lengths = center.iter();
            lengths.try_for_each(|length| check.value_of(&COORDINATE, "center", length))?;
        }
        check.value("rotate", &self.rotate)
    }
}

keys_with_choice! {
    Cavity: CavityKeys {
        s: u32,
        w: f64,
        (size: CavitySize {
            coverage: f64 => Coverage,
            lambda: Length => Lambda,
            _ => "a cavity needs a size: `coverage = 10` (percent of the area) or `lambda = \"8 um\"`"
        }),
        across: bool,
        center: Center,
        rotate: f64,
    }
}

keys_with_choice! {
    Groove: GrooveKeys {
        #[serde(deserialize_with = "word")]
        orientation: Orientation,
        (size: GrooveSize {
            coverage: f64 => Coverage,
            width: Length => Width,
            _ => "a groove needs a size: `coverage = 10` (percent of the area) or `width = \"5 um\"`"
        }),
        offset: Length,
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
            CenterKey::Word(_) => {
                Err("expected \"middle\" or a pair of lengths such as [\"25 um\", \"25 um\"]".to_owned())
            }
            CenterKey::At(Pair([x, y])) => Ok(Self::At([length(&x)?, length(&y)?])),
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

impl<'i> Tables<'_, 'i> {
    pub(super) fn read_textures(&mut self) -> Result<Vec<Texture>, CaseError> {
        let Some(value) = self.root.remove("texture") else {
            return Ok(Vec::new());
        };
        let span = value.span();
        let DeValue::Array(values) = value.into_inner() else {
            let sentence = "`texture` must be a list of tables: write [[texture]] above the keys of each";
            return Err(self.source.error_at(span, sentence));
        };
        values.into_iter().map(|value| self.read_texture(value)).collect()
    }

    /// Reads a texture by its `shape`. Serde's internally tagged enums would lose the places of all keys.
    fn read_texture(&self, value: Spanned<DeValue<'i>>) -> Result<Texture, CaseError> {
        let span = value.span();
        let DeValue::Table(mut table) = value.into_inner() else {
            let sentence = "a texture must be a table: write [[texture]] above its keys";
            return Err(self.source.error_at(span, sentence));
        };
        let shape = table.remove("shape");
        let shape_span = shape.as_ref().map_or(span.clone(), Spanned::span);
        let name = shape.as_ref().and_then(|shape| shape.get_ref().as_str());
        let section = SECTIONS
            .iter()
            .find(|section| section.is_shape && Some(section.name) == name);
        let Some(section) = section else {
            return Err(self.source.error_at(shape_span, unknown_shape(name)));
        };
        section.fill_in(&mut table);
        // The keys of the pattern, which all shapes have, are read apart.
        let mut pattern = DeTable::default();
        for key in names_of::<Pattern>() {
            if let Some((key, value)) = table.remove_entry(*key) {
                pattern.insert(key, value);
            }
        }
        let header = texture_header(section.name);
        let table = Spanned::new(span.clone(), DeValue::Table(table));
        let shape = match section.name {
            "cavity" => Shape::Cavity(self.read_keys(table, &header, Some(section))?),
            "groove" => Shape::Groove(self.read_keys(table, &header, Some(section))?),
            "polygon" => Shape::Polygon(self.read_keys(table, &header, Some(section))?),
            "height_map" => Shape::HeightMap(self.read_keys(table, &header, Some(section))?),
            _ => Shape::Mask(self.read_keys(table, &header, Some(section))?),
        };
        let pattern = Spanned::new(span, DeValue::Table(pattern));
        Ok(Texture {
            shape,
            pattern: self.read_keys(pattern, &header, Some(section))?,
        })
    }
}
