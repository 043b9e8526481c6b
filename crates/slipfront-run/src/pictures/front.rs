//! The picture of the slip front: the time at which each block has first slipped, and the share of sliding
//! blocks against position and time.

use std::ops::Range;

use slipfront_case::case_file::Motion;
use slipfront_plot::{self as plot, CellMeans, FrontMap, Picture, PictureSize, SpaceTime};

use super::error::{RunPictureError, drawn};
use super::maps::drawn_lattice;
use crate::fields::{self, KymographData};
use crate::names::{FIELDS, KYMOGRAPH, SUMMARY};
use crate::run_files::RunFiles;
use crate::summary::{Summary, summary_of};

/// Least number of rows of the kymograph that are shown, if the run has that many.
const MIN_INSTANTS: usize = 32;

/// Draws the spread of slip in a run with a transition.
pub(super) fn of_run(run: RunFiles, size: PictureSize) -> Result<Option<Picture>, RunPictureError> {
    let summary = summary_of(&run.file(SUMMARY)?)?;
    let kymograph = run.found(KYMOGRAPH)?.filter(|_| summary.transition);
    let Some(kymograph) = kymograph else {
        return Ok(None);
    };
    let kymograph = fields::read_kymograph(kymograph)?;
    let mut fields = fields::read_first_slips::<CellMeans>(&run.file(FIELDS)?)?;
    let first_slips = fields.frames.pop().and_then(|mut frame| frame.values.pop());
    let map = FrontMap {
        lattice: drawn_lattice(&fields),
        first_slips: first_slips.unwrap_or_default(),
        nucleations: summary
            .nucleations
            .iter()
            .map(|site| [site.x_m, site.y_m])
            .collect(),
    };
    let earliest = map
        .first_slips
        .iter()
        .copied()
        .fold(f64::INFINITY, |least, slip| least.min(slip.into()));
    let rows = rows_of_the_front(&kymograph.time_star, earliest, &summary);
    let space_time = space_time(&kymograph, rows, &summary);
    drawn("front", plot::front(&map, &space_time, size)).map(Some)
}

/// Draws the kymograph of a run from its first instant to its last.
///
/// # Errors
/// When the files cannot be read, or there is no kymograph.
pub fn draw_kymograph(run: RunFiles, size: PictureSize) -> Result<Picture, RunPictureError> {
    let summary = summary_of(&run.file(SUMMARY)?)?;
    let kymograph = fields::read_kymograph(run.file(KYMOGRAPH)?)?;
    let rows = 0..kymograph.time_star.len();
    let space_time = space_time(&kymograph, rows, &summary);
    drawn("the kymograph", plot::kymograph(&space_time, size))
}

/// Rows of a kymograph as they are drawn.
fn space_time(kymograph: &KymographData, rows: Range<usize>, summary: &Summary) -> SpaceTime {
    let columns = kymograph.columns();
    let times = &kymograph.time_star[rows.clone()];
    let [first, last] = [times.first(), times.last()].map(|time| time.copied().unwrap_or_default());
    // A row represents the time interval around it.
    let half = 0.5 * (last - first) / (times.len() as f64 - 1.0).max(1.0);
    SpaceTime {
        place: title_of_place(summary.motion).to_owned(),
        places: kymograph.places,
        times: [first - half, last + half],
        columns,
        shares: kymograph.sliding_share[rows.start * columns..rows.end * columns].to_vec(),
    }
}

/// Title of the places of a kymograph.
pub fn title_of_place(motion: Option<Motion>) -> &'static str {
    match motion {
        Some(Motion::Rotation) => "distance from the axis",
        _ => "position along drive",
    }
}

/// The rows of a kymograph while the front passes, with a quarter of that time before it and the same time
/// again after it. Under a held drive the summary has times of the drive, and the rows have those of the
/// blocks, which slid first at `earliest`.
fn rows_of_the_front(times: &[f64], earliest: f64, summary: &Summary) -> Range<usize> {
    let onset = summary.onset_time_star;
    let (from, rise) = match summary.drive_steps {
        None => summary
            .first_slip_time_star
            .map_or((onset, 0.0), |from| (from, onset - from)),
        Some(_) => (earliest, 0.0),
    };
    let passes = summary.front_duration_star.unwrap_or_default();
    let duration = (1.2 * passes).max(rise);
    let start = times.partition_point(|time| *time < from - 0.25 * duration);
    let end = times.partition_point(|time| *time <= from + 2.0 * duration);
    let more = MIN_INSTANTS.saturating_sub(end.saturating_sub(start)).div_ceil(2);
    start.saturating_sub(more)..(end.max(start) + more).min(times.len())
}
