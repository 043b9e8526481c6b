//! The results that a case writes, and the steps at which it does.

use slipfront::observe::Field;

use super::time_plan::TimePlan;
use crate::case_file;
use crate::case_file::{Attached, AttachedEdge, AutoOr, CaseError, CaseFile};
use crate::field_info::field_info;

/// The results that are written.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// The instants at which fields are recorded.
    pub snapshots: Snapshots,
    /// The fields that are recorded.
    pub fields: Vec<Field>,
    /// Stride n: the file of fields has every n-th block of each axis.
    pub stride: usize,
    /// Steps between rows of the series.
    pub series_stride: u64,
    /// Whether a movie is drawn of the run.
    pub movie: bool,
    /// Whether the last state is written.
    pub final_state: bool,
}

/// The instants at which fields are recorded.
#[derive(Clone, Debug, PartialEq)]
pub enum Snapshots {
    /// The instants A-F.
    Instants,
    /// The given steps.
    At(Vec<u64>),
    /// Multiples of this number of steps, from 0, and the instants A-F.
    Every(u64),
}

/// Largest number of maps in the picture of the stress: of more snapshots, six spread over the run are shown.
pub const MAX_MAPS: usize = 6;

/// Largest number of pictures of a movie: drawing them takes a minute and more.
pub const MAX_PICTURES: usize = 1000;

/// The field in the drawn maps: the contact stress, or the traction if only some blocks have a drive spring,
/// because the contact stress of a stuck block is the pull of its own drive spring.
pub fn mapped_field(file: &CaseFile) -> Field {
    match file.drive.attached {
        Attached::At(AttachedEdge::All) => Field::ContactStress,
        Attached::At(_) | Attached::File(_) => Field::Traction,
    }
}

/// Number of the instants A-F.
const INSTANTS: u64 = 6;

/// Largest number of rows of the series, unless the case sets a spacing.
const SERIES_ROWS: u64 = 20_000;

impl Output {
    /// The output that a case file requests; an error when a spacing is shorter than a step.
    pub(super) fn new(file: &CaseFile, time_plan: &TimePlan) -> Result<Self, CaseError> {
        let dt_star = time_plan.dt_star;
        let spacing = |key: &str, time: f64| -> Result<u64, CaseError> {
            let steps = (time / dt_star).round();
            if steps >= 1.0 {
                return Ok(steps as u64);
            }
            let sentence =
                format!("a spacing of {time:?} in t* is less than one step of {dt_star}: increase it");
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
        let output = Output {
            snapshots,
            fields: file.output.fields.clone(),
            stride: file.output.stride as usize,
            series_stride,
            movie: file.output.movie,
            final_state: file.output.final_state,
        };
        output.check_movie(file, time_plan.last_step)?;
        Ok(output)
    }

    /// Largest number of snapshots of a run of `last_step` steps.
    pub fn max_snapshots(&self, last_step: u64) -> u64 {
        match &self.snapshots {
            Snapshots::Instants => INSTANTS,
            Snapshots::At(steps) => steps.len() as u64,
            Snapshots::Every(every) => last_step / every + 1 + INSTANTS,
        }
    }

    /// Refuses a movie that could not be drawn when the run has ended.
    fn check_movie(&self, file: &CaseFile, last_step: u64) -> Result<(), CaseError> {
        let (found, field) = (self.max_snapshots(last_step), mapped_field(file));
        let sentence = match found {
            _ if !self.movie => return Ok(()),
            0 => "a movie shows the snapshots of a run, but this run has none: add `output.snapshots`, such as { every = 5.0 }, \
                  or leave `movie` out"
                .to_owned(),
            _ if !self.fields.contains(&field) => format!(
                "a movie shows {0}, which this run does not write: add \"{0}\" to `output.fields`, or leave `movie` out and \
                 draw another field with `slipfront movie --field`",
                field_info(field).name
            ),
            _ if found > MAX_PICTURES as u64 => format!(
                "a movie has at most {MAX_PICTURES} pictures, but this run has up to {found} snapshots: increase `every` of \
                 `output.snapshots`, or list fewer"
            ),
            _ => return Ok(()),
        };
        Err(file.source.error("output.movie", sentence))
    }
}
