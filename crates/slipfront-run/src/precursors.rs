//! The file `precursors.csv`: the events of slip of a slider that is driven at an edge, one row each.

use serde::{Deserialize, Serialize};
use slipfront::Scales;
use slipfront::observe::SlipEvent;
use slipfront_case::case_file::names_of;

use crate::names::PRECURSORS;
use crate::run_files::RunFile;
use crate::series::{SeriesError, columns_of, finish, read_rows};

/// One row of `precursors.csv`. The last columns are empty for an event that went on when the run ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrecursorRow {
    /// t* at which the first block in contact slides.
    pub time_star: f64,
    /// Time in s at which the first block in contact slides.
    pub time_s: f64,
    /// Largest distance from the driven edge at which a block in contact has slid, over the length of the slider: 1 for an
    /// event that crosses it.
    pub length: f64,
    /// mu* when the event begins.
    pub mu_star_before: f64,
    /// Friction coefficient when the event begins, F_T/F_N.
    pub friction_coefficient_before: f64,
    /// mu* when all blocks in contact are stuck again.
    pub mu_star_after: Option<f64>,
    /// Friction coefficient when all blocks in contact are stuck again, F_T/F_N.
    pub friction_coefficient_after: Option<f64>,
    /// t* at which all blocks in contact are stuck again.
    pub until_star: Option<f64>,
}

impl PrecursorRow {
    fn new(event: &SlipEvent, scales: &Scales) -> Self {
        let mean = scales.mu_static_mean;
        Self {
            time_star: event.from_star,
            time_s: event.from_star * scales.time(),
            length: event.length,
            mu_star_before: event.mu_star_before,
            friction_coefficient_before: event.mu_star_before * mean,
            mu_star_after: event.after.map(|(_, mu_star)| mu_star),
            friction_coefficient_after: event.after.map(|(_, mu_star)| mu_star * mean),
            until_star: event.after.map(|(time_star, _)| time_star),
        }
    }
}

/// The events with their units.
pub fn rows(events: &[SlipEvent], scales: &Scales) -> Vec<PrecursorRow> {
    events
        .iter()
        .map(|event| PrecursorRow::new(event, scales))
        .collect()
}

/// The columns of a table of events, with NaN for missing numbers.
pub fn columns(rows: &[PrecursorRow]) -> impl Iterator<Item = (&'static str, Vec<f64>)> {
    let all = columns_of! { PrecursorRow:
        time_star time_s length mu_star_before friction_coefficient_before mu_star_after friction_coefficient_after until_star
    };
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    all.into_iter()
        .map(move |(name, value)| (name, rows.iter().map(value).map(number).collect()))
}

/// The events as CSV, with the header also where there is none.
pub fn to_csv(events: &[SlipEvent], scales: &Scales) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    writer.write_record(names_of::<PrecursorRow>())?;
    for row in rows(events, scales) {
        writer.serialize(row)?;
    }
    finish(writer)
}

/// Reads the events back.
pub fn read_csv<'f>(file: impl Into<RunFile<'f>>) -> Result<Vec<PrecursorRow>, SeriesError> {
    read_rows(&file.into(), PRECURSORS, |row| row)
}
