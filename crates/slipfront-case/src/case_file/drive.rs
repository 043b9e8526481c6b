//! The table `[drive]`: the pull on the slider.

use serde::{Deserialize, Serialize};
use slipfront::{Edge, Edges};

use super::check::{Check, Checked};
use super::error::CaseError;
use super::key::{
    DEGREES, Key, KeyKind, STIFFNESS_PER_AREA, StarUnit, TIME_STAR, above, key, number, quantity, within,
};
use super::serde_names::names_of;
use super::slider::Slider;
use super::words::{AttachedEdge, Body, Loading, Motion, Outline};
use crate::key_rows;
use crate::quantity::{QuantityError, Speed, Stiffness, StiffnessPerArea};

key_rows! {
    /// The table `[drive]`: the pull on the slider.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(try_from = "DriveKeys", into = "DriveKeys")]
    pub struct Drive from DriveKeys {
        [
            /// Speed of the drive: `v_star`, `speed` or `program`.
            pub speed: DriveSpeed or "the drive needs `v_star`, `speed` or `program`" {
                /// Speed of the drive.
                v_star: f64 => VStar = key("0.03", number(above(0.0, 10.0), "the paper's runs have 0.01 to 0.2"))
                    .star(StarUnit::Speed)
                    .paper("V* = sqrt(E rho) V h/(P mu_s l), Eq. 11 with h = l")
                    .title("drive speed", "V*", "")
                    .further_bounds("; V* not below 1e-9"),
                /// Speed of the drive with its unit, instead of `v_star`.
                speed: Speed => Speed = key("", quantity("m/s", within(1e-18, 1e6)))
                    .paper("V")
                    .title("drive speed", "V", "m/s"),
                /// Sequence of speeds, instead of `v_star`: each until its t*, rounded to a step, the last to
                /// the end of the run. At least one speed must be positive. The largest absolute value is
                /// used as V*.
                program: Vec<SpeedSegment> => Program = key("",
                    KeyKind::Table("[{ v_star = 0.03, until_star = 200 }, { v_star = 0 }]", SpeedSegment::KEYS))
                    .further_bounds(", rising"),
            }
        ]
        /// Direction of the drive, degrees from x towards y.
        pub direction: f64 = key("0", DEGREES).paper("theta")
            .title("direction of the drive", "\u{3b8}", "\u{b0}"),
        /// Motion of the drive: along the direction, or counterclockwise rotation about the centroid of all
        /// blocks, with the speed at the largest radius.
        pub motion: Motion = key("\"translation\"", KeyKind::Words(names_of::<Motion>)),
        /// Loading of the slider: the drive moves all the time, or stands while a block in contact slides.
        pub loading: Loading = key("\"constant\"", KeyKind::Words(names_of::<Loading>))
            .note("See [slow loading](#slow-loading)."),
        [
            /// Blocks that have a drive spring: `attach` or `attach_file`.
            pub attached: Attached or "the drive needs `attach` or `attach_file`" {
                /// Blocks that have a drive spring: all, or the blocks of a free edge.
                attach: AttachedEdge => At = key("\"all\"", KeyKind::Words(names_of::<AttachedEdge>)),
                /// An image or array of the blocks that have a drive spring, in place of `attach`: dark
                /// pixels, or ones.
                attach_file: String => File = key("", KeyKind::File(&["png", "npy"]))
                    .note("It is stretched as a [mask](#shape--mask) is."),
            }
        ]
        [
            /// Stiffness of the drive springs: `stiffness`, `stiffness_star`, `stiffness_per_area`,
            /// `total_stiffness` or `total_stiffness_star`.
            pub stiffness: DriveStiffness or "the drive needs a `stiffness`" {
                /// Stiffness of each drive spring; `"auto"` is k_2 = 0.375 E h, with the thickness h. In a
                /// graded slider it is multiplied by the relative modulus of each block.
                stiffness: AutoOrStiffness => Each = key("\"auto\"", KeyKind::Special("`\"auto\"`, or 1e-30 to 1e30 N/m")).paper("k_s"),
                /// Stiffness of each drive spring, relative to E h with the thickness h.
                stiffness_star: f64 => EachStar = key("", DRIVE_STIFFNESS).star(StarUnit::SpringOfBlock)
                    .title("drive stiffness", "k\u{209b}*", ""),
                /// Stiffness K per area of the mount, which the drive springs represent, independent of the
                /// block size: each spring has K l^2.
                stiffness_per_area: StiffnessPerArea => PerArea = key("", STIFFNESS_PER_AREA)
                    .title("stiffness of the mount", "K", "N/m\u{b3}"),
                /// Total stiffness of all drive springs, distributed in proportion to the modulus of each
                /// block.
                total_stiffness: Stiffness => Total = key("", STIFFNESS)
                    .title("total drive stiffness", "K\u{209b}", "N/m"),
                /// Total stiffness of all drive springs, relative to E h with the thickness h. A file has at
                /// most one of these five keys.
                total_stiffness_star: f64 => TotalStar = key("", DRIVE_STIFFNESS).star(StarUnit::Stiffness)
                    .title("total drive stiffness", "K\u{209b}*", ""),
            }
        ]
    }
}

key_rows! {
    /// A part of a program in which the speed is constant.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct SpeedSegment {
        /// Speed of the drive in the segment, V*.
        pub v_star: f64 = key("", PROGRAM_SPEED).star(StarUnit::Speed),
        /// End of the segment, t*; none for the last segment.
        pub until_star: Option<f64> = key("", TIME_STAR).star(StarUnit::Time),
    }
}

/// Kind of a stiffness with its unit.
const STIFFNESS: KeyKind = quantity("N/m", within(1e-30, 1e30));
const DRIVE_STIFFNESS: KeyKind = number(above(0.0, 1e6), "that of the paper is 0.375 on each block");
/// Kind of a speed of a program.
const PROGRAM_SPEED: KeyKind = number(within(-10.0, 10.0), "the paper's runs have 0.01 to 0.2");

/// Largest number of segments of a program.
const MAX_SEGMENTS: usize = 10_000;

impl Drive {
    /// The edge with the only blocks that have a drive spring, if there is one.
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
        if slider.body == Body::Bulk {
            self.check_for_bulk(check)?;
        }
        self.check_values(check)?;
        if let DriveSpeed::Program(segments) = &self.speed {
            check_program(segments, check)?;
        }
        if self.motion == Motion::Rotation && self.direction != 0.0 {
            return check.refuse("direction", |key| {
                format!("`{key}` does not apply to `motion` = \"rotation\", which drives every block in its own direction: leave it out")
            });
        }
        if self.motion == Motion::Rotation && slider.edges.contains(&Edges::Periodic) {
            return check.refuse("motion", |key| {
                format!(
                    "`{key}` = \"rotation\" needs an axis and free edges: it does not apply to periodic edges"
                )
            });
        }
        if self.edge().is_some() && slider.outline != Outline::Rectangle {
            return check.refuse("attach", |key| {
                format!("`{key}` gives an edge of the lattice, but a slider with an outline has none: give the driven blocks with `attach_file`")
            });
        }
        if let Some(edge) = self.edge()
            && slider.edges[edge.axis()] == Edges::Periodic
        {
            let axis = ["x", "y"][edge.axis()];
            return check.refuse("attach", |key| {
                format!("`{key}` gives an edge, but the slider is periodic along {axis}; use free edges, or `attach_file`")
            });
        }
        if slider.rigid && !matches!(self.stiffness, DriveStiffness::Total(_)) {
            return check.refuse(self.stiffness.key(), |_| {
                "a rigid slider (`slider.rigid`) is held by the spring `drive.total_stiffness`: give it in N/m".to_owned()
            });
        }
        Ok(())
    }
    /// Refuses drives that do not apply to a bulk body, which is driven over its whole back.
    fn check_for_bulk(&self, check: &Check) -> Result<(), CaseError> {
        let turns = self.motion == Motion::Rotation;
        let is_of_file = matches!(self.attached, Attached::File(_));
        let keys = [
            ("motion", turns, "its equations for rotation are not derived"),
            ("attach_file", is_of_file, "its whole back is driven"),
            ("attach", self.edge().is_some(), "its whole back is driven"),
        ];
        let given = keys.iter().find(|(_, is_given, _)| *is_given);
        given.map_or(Ok(()), |(key, _, why)| {
            check.refuse(key, |key| {
                format!("`{key}` does not apply to `slider.body` = \"bulk\": {why}; leave it out, or use \"sheet\"")
            })
        })
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
        segment.v_star.check(check, "program", &PROGRAM_SPEED)?;
        segment.until_star.check(check, "program", &TIME_STAR)?;
    }
    if let Some(number) = others.iter().position(|segment| segment.until_star.is_none()) {
        return refuse(format!(
            "lacks `until_star` of its speed {}: only the last speed has no end",
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
            "never moves forwards, so the slider has no static friction along the drive: give a positive speed; `direction` \
             reverses the drive"
                .to_owned(),
        );
    }
    Ok(())
}

/// Stiffness of a drive spring, or the word that leaves the choice to the program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum AutoOrStiffness {
    /// The value `"auto"`: k_2 for each spring.
    Auto,
    /// The user's stiffness, N/m.
    Stiffness(Stiffness),
}

impl Checked for AutoOrStiffness {
    fn complaint(&self, _: &KeyKind) -> Option<String> {
        match self {
            Self::Auto => None,
            Self::Stiffness(stiffness) => stiffness.complaint(&STIFFNESS),
        }
    }
}

/// The segments of a program are checked one by one.
impl Checked for Vec<SpeedSegment> {}

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
