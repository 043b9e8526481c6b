//! The table `[drive]`: the pull on the slider.

use serde::{Deserialize, Deserializer, Serialize};
use slipfront::{Edge, Edges};

use super::check::Check;
use super::error::CaseError;
use super::key_table::{PROGRAM_SPEED, STIFFNESS, UNTIL};
use super::slider::Slider;
use super::values::word;
use super::words::{AttachedEdge, Loading, Motion, Outline};
use crate::quantity::{QuantityError, Speed, Stiffness, StiffnessPerArea};

/// The table `[drive]`: the pull on the slider.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "DriveKeys", into = "DriveKeys")]
pub struct Drive {
    /// Speed of the drive: `v_star`, `speed` or `program`.
    pub speed: DriveSpeed,
    /// Direction of the drive (theta), degrees from x towards y, -360 to 360.
    pub direction: f64,
    /// Motion of the far ends of the drive springs.
    pub motion: Motion,
    /// Whether the drive stands still while a block in contact slides.
    pub loading: Loading,
    /// Blocks that have a drive spring: `attach` or `attach_file`.
    pub attached: Attached,
    /// Stiffness of the drive springs: `stiffness`, `stiffness_star`, `stiffness_per_area`, `total_stiffness` or `total_stiffness_star`.
    pub stiffness: DriveStiffness,
}

/// The speed of the drive.
#[derive(Clone, Debug, PartialEq)]
pub enum DriveSpeed {
    /// `v_star`: V* = sqrt(E rho) V/(P `mu_static`) (Eq. 11), more than 0, at most 10.
    VStar(f64),
    /// `speed`: V, m/s.
    Speed(Speed),
    /// `program`: speeds that follow one another.
    Program(Vec<SpeedSegment>),
}

/// A part of a program in which the speed is constant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpeedSegment {
    /// V*, -10 to 10.
    pub v_star: f64,
    /// t* at which the segment ends; none for the last segment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until_star: Option<f64>,
}

/// The blocks that have a drive spring.
#[derive(Clone, Debug, PartialEq)]
pub enum Attached {
    /// The key `attach`: the blocks of an edge, or all.
    At(AttachedEdge),
    /// `attach_file`: a `.png` (dark pixels are driven) or a `.npy` of shape (ny, nx) of 0 and 1 (driven), relative to the case file.
    File(String),
}

/// The stiffness of the drive springs.
#[derive(Clone, Debug, PartialEq)]
pub enum DriveStiffness {
    /// The value `stiffness = "auto"`: k_2 for each spring.
    Auto,
    /// The key `stiffness`: of each spring, N/m.
    Each(Stiffness),
    /// The key `stiffness_star`: of each spring over E h, more than 0.
    EachStar(f64),
    /// The key `stiffness_per_area`: of each spring over the area of a block, N/m^3.
    PerArea(StiffnessPerArea),
    /// The key `total_stiffness`: of all springs together, N/m.
    Total(Stiffness),
    /// The key `total_stiffness_star`: of all springs together over E h, more than 0.
    TotalStar(f64),
}

/// Largest number of segments of a program.
const MAX_SEGMENTS: usize = 10_000;

impl Drive {
    /// The edge whose blocks alone have a drive spring.
    pub fn edge(&self) -> Option<Edge> {
        match self.attached {
            Attached::At(AttachedEdge::Left) => Some(Edge::Left),
            Attached::At(AttachedEdge::Right) => Some(Edge::Right),
            Attached::At(AttachedEdge::Bottom) => Some(Edge::Bottom),
            Attached::At(AttachedEdge::Top) => Some(Edge::Top),
            Attached::At(AttachedEdge::All) | Attached::File(_) => None,
        }
    }

    pub(super) fn check(&self, check: &Check, slider: &Slider) -> Result<(), CaseError> {
        match &self.speed {
            DriveSpeed::VStar(v_star) => check.value("v_star", v_star)?,
            DriveSpeed::Speed(speed) => check.value("speed", speed)?,
            DriveSpeed::Program(segments) => check_program(segments, check)?,
        }
        check.value("direction", &self.direction)?;
        if self.motion == Motion::Rotation && self.direction != 0.0 {
            return check.refuse("direction", |key| {
                format!("`{key}` has no meaning for `motion` = \"rotation\", which pulls every block another way: leave it out")
            });
        }
        if self.motion == Motion::Rotation && slider.edges.contains(&Edges::Periodic) {
            return check.refuse("motion", |key| {
                format!("`{key}` = \"rotation\" needs an axis and ends all around: it has no meaning with periodic edges")
            });
        }
        if self.edge().is_some() && slider.outline != Outline::Rectangle {
            return check.refuse("attach", |key| {
                format!("`{key}` names an edge of the lattice, which a slider with an outline does not have: say by `attach_file` which blocks are driven")
            });
        }
        if let Some(edge) = self.edge()
            && slider.edges[edge.axis()] == Edges::Periodic
        {
            let axis = ["x", "y"][edge.axis()];
            return check.refuse("attach", |key| {
                format!("`{key}` names an edge that is none: the slider is periodic along {axis}; take free edges, or `attach_file`")
            });
        }
        match &self.stiffness {
            DriveStiffness::Auto => {}
            DriveStiffness::Each(stiffness) => check.value_of(&STIFFNESS, "stiffness", stiffness)?,
            DriveStiffness::EachStar(stiffness) => check.value("stiffness_star", stiffness)?,
            DriveStiffness::PerArea(stiffness) => check.value("stiffness_per_area", stiffness)?,
            DriveStiffness::Total(stiffness) => check.value("total_stiffness", stiffness)?,
            DriveStiffness::TotalStar(stiffness) => check.value("total_stiffness_star", stiffness)?,
        }
        match &self.attached {
            Attached::At(_) => Ok(()),
            Attached::File(file) => check.value("attach_file", file),
        }
    }
}

fn check_program(segments: &[SpeedSegment], check: &Check) -> Result<(), CaseError> {
    let refuse = |sentence: String| check.refuse("program", |key| format!("`{key}` {sentence}"));
    let Some((last, others)) = segments.split_last() else {
        return refuse("is empty: give it a speed, such as { v_star = 0.03 }".to_owned());
    };
    if segments.len() > MAX_SEGMENTS {
        return refuse(format!("has {} speeds, more than {MAX_SEGMENTS}", segments.len()));
    }
    for segment in segments {
        check.value_of(&PROGRAM_SPEED, "program", &segment.v_star)?;
        if let Some(until) = segment.until_star {
            check.value_of(&UNTIL, "program", &until)?;
        }
    }
    if let Some(number) = others.iter().position(|segment| segment.until_star.is_none()) {
        return refuse(format!(
            "lacks `until_star` of its speed {}, which others follow: only the last has no end",
            number + 1
        ));
    }
    if let Some(until) = last.until_star {
        return refuse(format!(
            "has `until_star` = {until:?} of its last speed, which has no end: leave it out, or let a speed follow"
        ));
    }
    if !others
        .iter()
        .is_sorted_by(|one, next| one.until_star < next.until_star)
    {
        return refuse(
            "has times that do not rise: `until_star` counts from the beginning of the run".to_owned(),
        );
    }
    if segments.iter().all(|segment| segment.v_star == 0.0) {
        return refuse("never moves: give it a speed other than 0".to_owned());
    }
    if segments.iter().all(|segment| segment.v_star <= 0.0) {
        return refuse(
            "never moves forwards, so that the slider has no static friction along the drive: give it a speed above 0; \
             `direction` turns the drive round"
                .to_owned(),
        );
    }
    Ok(())
}

/// The table `[drive]` as it stands in the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DriveKeys {
    v_star: Option<f64>,
    speed: Option<Speed>,
    program: Option<Vec<SpeedSegment>>,
    direction: f64,
    #[serde(deserialize_with = "word")]
    motion: Motion,
    #[serde(deserialize_with = "word")]
    loading: Loading,
    #[serde(default, deserialize_with = "some_word")]
    attach: Option<AttachedEdge>,
    attach_file: Option<String>,
    stiffness: Option<AutoOrStiffness>,
    stiffness_star: Option<f64>,
    stiffness_per_area: Option<StiffnessPerArea>,
    total_stiffness: Option<Stiffness>,
    total_stiffness_star: Option<f64>,
}

/// The key `stiffness` as it stands in the file.
#[derive(Clone, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
enum AutoOrStiffness {
    Auto,
    Stiffness(Stiffness),
}

impl TryFrom<String> for AutoOrStiffness {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        match text.as_str() {
            "auto" => Ok(Self::Auto),
            text if text.starts_with(|c: char| c.is_ascii_alphabetic()) => Err(format!(
                "{text:?} is neither \"auto\" nor a stiffness such as \"2 N/m\""
            )),
            text => text
                .parse()
                .map(Self::Stiffness)
                .map_err(|error: QuantityError| error.to_string()),
        }
    }
}

impl From<AutoOrStiffness> for String {
    fn from(key: AutoOrStiffness) -> Self {
        match key {
            AutoOrStiffness::Auto => "auto".to_owned(),
            AutoOrStiffness::Stiffness(stiffness) => stiffness.to_string(),
        }
    }
}

fn some_word<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<AttachedEdge>, D::Error> {
    word(deserializer).map(Some)
}

impl TryFrom<DriveKeys> for Drive {
    type Error = &'static str;

    fn try_from(keys: DriveKeys) -> Result<Self, Self::Error> {
        let speed = match (keys.program, keys.speed, keys.v_star) {
            (Some(program), ..) => DriveSpeed::Program(program),
            (_, Some(speed), _) => DriveSpeed::Speed(speed),
            (.., Some(v_star)) => DriveSpeed::VStar(v_star),
            _ => return Err("the drive needs `v_star`, `speed` or `program`"),
        };
        let attached = match (keys.attach_file, keys.attach) {
            (Some(file), _) => Attached::File(file),
            (None, Some(edge)) => Attached::At(edge),
            (None, None) => return Err("the drive needs `attach` or `attach_file`"),
        };
        let stars = (keys.stiffness_star, keys.total_stiffness_star);
        let with_units = (keys.stiffness, keys.stiffness_per_area, keys.total_stiffness);
        let stiffness = match (with_units, stars) {
            ((Some(AutoOrStiffness::Auto), ..), _) => DriveStiffness::Auto,
            ((Some(AutoOrStiffness::Stiffness(each)), ..), _) => DriveStiffness::Each(each),
            ((_, Some(per_area), _), _) => DriveStiffness::PerArea(per_area),
            ((.., Some(total)), _) => DriveStiffness::Total(total),
            (_, (Some(each), _)) => DriveStiffness::EachStar(each),
            (_, (_, Some(total))) => DriveStiffness::TotalStar(total),
            _ => return Err("the drive needs a `stiffness`"),
        };
        Ok(Self {
            speed,
            direction: keys.direction,
            motion: keys.motion,
            loading: keys.loading,
            attached,
            stiffness,
        })
    }
}

impl From<Drive> for DriveKeys {
    fn from(drive: Drive) -> Self {
        let mut keys = Self {
            v_star: None,
            speed: None,
            program: None,
            direction: drive.direction,
            motion: drive.motion,
            loading: drive.loading,
            attach: None,
            attach_file: None,
            stiffness: None,
            stiffness_star: None,
            stiffness_per_area: None,
            total_stiffness: None,
            total_stiffness_star: None,
        };
        match drive.speed {
            DriveSpeed::VStar(v_star) => keys.v_star = Some(v_star),
            DriveSpeed::Speed(speed) => keys.speed = Some(speed),
            DriveSpeed::Program(program) => keys.program = Some(program),
        }
        match drive.attached {
            Attached::At(edge) => keys.attach = Some(edge),
            Attached::File(file) => keys.attach_file = Some(file),
        }
        match drive.stiffness {
            DriveStiffness::Auto => keys.stiffness = Some(AutoOrStiffness::Auto),
            DriveStiffness::Each(each) => keys.stiffness = Some(AutoOrStiffness::Stiffness(each)),
            DriveStiffness::EachStar(each) => keys.stiffness_star = Some(each),
            DriveStiffness::PerArea(per_area) => keys.stiffness_per_area = Some(per_area),
            DriveStiffness::Total(total) => keys.total_stiffness = Some(total),
            DriveStiffness::TotalStar(total) => keys.total_stiffness_star = Some(total),
        }
        keys
    }
}
