//! What a case writes, and when.

use super::time_plan::TimePlan;
use crate::case_file;
use crate::case_file::{AutoOr, CaseError, CaseFile};
use slipfront::observe::Field;

/// What is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// When fields are kept.
    pub snapshots: Snapshots,
    /// Which fields.
    pub fields: Vec<Field>,
    /// Every n-th block of each axis in the fields file.
    pub stride: usize,
    /// Steps between rows of the series.
    pub series_stride: u64,
}

/// When fields are kept.
#[derive(Clone, Debug, PartialEq)]
pub enum Snapshots {
    /// At the instants A-F.
    Instants,
    /// At these steps.
    At(Vec<u64>),
    /// Every n-th step from 0.
    Every(u64),
}

/// Most maps in the picture of the stress: of more snapshots, six spread over the run are shown.
pub const MAX_MAPS: usize = 6;

/// The largest variable (or record of one) that every reader of 64-bit offset files takes.
pub const VARIABLE_MAX_BYTES: usize = i32::MAX as usize - 3;

/// Longest series that is written unless a spacing is asked for.
const SERIES_ROWS: u64 = 20_000;

impl Output {
    /// What a case file asks for.
    ///
    /// # Errors
    /// When the run has no such steps.
    pub(super) fn of(file: &CaseFile, time_plan: &TimePlan) -> Result<Self, CaseError> {
        let TimePlan {
            dt_star, last_step, ..
        } = *time_plan;
        let spacing = |key: &str, time: f64| -> Result<u64, CaseError> {
            let steps = (time / dt_star).round();
            if steps >= 1.0 {
                return Ok(steps as u64);
            }
            Err(file.source.error(
                key,
                format!("a spacing of {time:?} in t* is less than one step of {dt_star}: raise it"),
            ))
        };
        let snapshots = match &file.output.snapshots {
            case_file::Snapshots::Auto => Snapshots::Instants,
            case_file::Snapshots::Every(every) => Snapshots::Every(spacing("output.snapshots", *every)?),
            case_file::Snapshots::At(times) => {
                let mut steps: Vec<u64> = times.iter().map(|time| (time / dt_star).round() as u64).collect();
                if let Some((_, time)) = steps.iter().zip(times).find(|&(&step, _)| step > last_step) {
                    let sentence = format!(
                        "no snapshot can be taken at t* = {time}: the run ends at {:.4}",
                        time_plan.end_star()
                    );
                    return Err(file.source.error("output.snapshots", sentence));
                }
                steps.dedup();
                Snapshots::At(steps)
            }
        };
        let series_stride = match file.output.series {
            AutoOr::Auto => last_step.div_ceil(SERIES_ROWS),
            AutoOr::Number(time) => spacing("output.series", time)?,
        };
        let stride = file.output.stride as usize;
        Ok(Output {
            snapshots,
            fields: file.output.fields.clone(),
            stride,
            series_stride,
        })
    }
}

/// The smallest stride from `stride` on with which one variable holds a lattice of `nx` x `ny` blocks.
pub fn smallest_stride(nx: usize, ny: usize, stride: usize) -> usize {
    let enough = (stride..).find(|stride| fits(nx.div_ceil(*stride), ny.div_ceil(*stride)));
    enough.unwrap_or(usize::MAX)
}

fn fits(columns: usize, rows: usize) -> bool {
    columns.saturating_mul(rows).saturating_mul(size_of::<f64>()) <= VARIABLE_MAX_BYTES
}
