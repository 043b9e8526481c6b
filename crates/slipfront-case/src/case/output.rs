//! Which results a case writes, and at which steps.

use slipfront::observe::Field;

use super::time_plan::TimePlan;
use crate::case_file;
use crate::case_file::{Attached, AttachedEdge, AutoOr, CaseError, CaseFile};

/// Which results are written.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// The instants at which fields are recorded.
    pub snapshots: Snapshots,
    /// The fields that are recorded.
    pub fields: Vec<Field>,
    /// Every n-th block of each axis in the fields file.
    pub stride: usize,
    /// Steps between rows of the series.
    pub series_stride: u64,
    /// Whether a movie is drawn of the run.
    pub movie: bool,
}

/// The instants at which fields are recorded.
#[derive(Clone, Debug, PartialEq)]
pub enum Snapshots {
    /// At the instants A-F.
    Instants,
    /// At these steps.
    At(Vec<u64>),
    /// Every n-th step from 0, and at the instants A-F.
    Every(u64),
}

/// Most maps in the picture of the stress: of more snapshots, six spread over the run are shown.
pub const MAX_MAPS: usize = 6;

/// The field whose maps are drawn: the contact stress, and of a slider of which only some blocks have a drive spring the traction,
/// since the contact stress of a stuck block is the pull of its own drive spring.
pub fn mapped_field(file: &CaseFile) -> Field {
    match file.drive.attached {
        Attached::At(AttachedEdge::All) => Field::ContactStress,
        Attached::At(_) | Attached::File(_) => Field::Traction,
    }
}

/// Most rows of the series unless the case sets a spacing.
const SERIES_ROWS: u64 = 20_000;

impl Output {
    /// The output that a case file asks for, refused when a spacing is shorter than a step.
    pub(super) fn of(file: &CaseFile, time_plan: &TimePlan) -> Result<Self, CaseError> {
        let dt_star = time_plan.dt_star;
        let spacing = |key: &str, time: f64| -> Result<u64, CaseError> {
            let steps = (time / dt_star).round();
            if steps >= 1.0 {
                return Ok(steps as u64);
            }
            let sentence =
                format!("a spacing of {time:?} in t* is less than one step of {dt_star}: raise it");
            Err(file.source.error(key, sentence))
        };
        let snapshots = match &file.output.snapshots {
            case_file::Snapshots::Auto => Snapshots::Instants,
            case_file::Snapshots::Every(every) => Snapshots::Every(spacing("output.snapshots", *every)?),
            case_file::Snapshots::At(times) => {
                let mut steps: Vec<u64> = times.iter().map(|time| (time / dt_star).round() as u64).collect();
                steps.dedup();
                Snapshots::At(steps)
            }
        };
        let series_stride = match file.output.series {
            AutoOr::Auto => time_plan.last_step.div_ceil(SERIES_ROWS),
            AutoOr::Number(time) => spacing("output.series", time)?,
        };
        Ok(Output {
            snapshots,
            fields: file.output.fields.clone(),
            stride: file.output.stride as usize,
            series_stride,
            movie: file.output.movie,
        })
    }
}
