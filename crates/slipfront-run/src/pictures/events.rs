//! The picture of a catalogue of events of slip: the sizes of the events, and the times between them.

use slipfront_base::number_format::count;
use slipfront_plot::{self as plot, Distribution, Picture, PictureSize};

use super::error::{RunPictureError, drawn};
use crate::observers::events::{EventRow, FILE, read_csv};
use crate::run_files::RunFiles;

/// Draws the distributions of the moments of all events and of the times from the beginning of each to the
/// beginning of the next; none for a run with fewer than two events.
pub(super) fn of_run(run: RunFiles, size: PictureSize) -> Result<Option<Picture>, RunPictureError> {
    let Some(file) = run.found(FILE)? else {
        return Ok(None);
    };
    let rows = read_csv(file)?;
    if rows.len() < 2 {
        return Ok(None);
    }
    let wait = |pair: &[EventRow]| pair[1].drive_time_star - pair[0].drive_time_star;
    let distributions = [
        Distribution {
            x_title: "moment M* (displacement times blocks)".to_owned(),
            y_title: "events of at least M*".to_owned(),
            values: rows.iter().map(|row| row.moment_star).collect(),
        },
        Distribution {
            x_title: "waiting time t* of the drive".to_owned(),
            y_title: "waits of at least t*".to_owned(),
            values: rows.windows(2).map(wait).collect(),
        },
    ];
    let backwards = rows.iter().filter(|row| row.moment_star <= 0.0).count();
    let note = match backwards {
        0 => String::new(),
        _ => format!("without {} that slip backwards", count(backwards, "event")),
    };
    drawn("events", plot::distributions(&distributions, &note, size)).map(Some)
}
