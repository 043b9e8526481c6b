//! The events of slip of a slider that is driven at an edge: their numbers, and the file `precursors.csv`
//! with a row for each.

use serde::{Deserialize, Serialize};
use slipfront::Scales;
use slipfront::observe::{Precursors, SlipEvent};
use slipfront_case::case::Case;

use super::observed::{Observed, Quantity, Table, Times, columns, csv_of};
use crate::run_files::RunFile;
use crate::series::{SeriesError, read_rows};
use crate::times::instant;

/// Name of the file in a run folder.
pub(crate) const FILE: &str = "precursors.csv";

/// Events of slip of a slider driven at an edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrecursorSummary {
    /// Number of events; each is a row of `precursors.csv`.
    pub events: usize,
    /// t* at the beginning of the first event that crosses the whole slider.
    pub crossing_time_star: Option<f64>,
    /// mu* at the beginning of the first event that crosses the whole slider.
    pub crossing_mu_star: Option<f64>,
    /// Number of precursors: events before the one that crosses the whole slider, or all events if none
    /// crosses.
    pub precursor_count: usize,
    /// Length of the longest precursor over the length of the slider.
    pub precursor_length_max: Option<f64>,
    /// mu* at the beginning of the first event over mu* at the beginning of the first event that crosses the
    /// whole slider: the load at nucleation over the load at the transition.
    pub nucleation_load_ratio: Option<f64>,
}

/// One row of `precursors.csv`. The last columns are empty for an event that was in progress when the run
/// ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrecursorRow {
    /// t* at which the first block in contact slides.
    pub time_star: f64,
    /// Time in s at which the first block in contact slides.
    pub time_s: f64,
    /// Largest distance from the driven edge at which a block in contact has slid, over the length of the
    /// slider: 1 for an event that crosses it.
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

impl Observed for Precursors {
    type Numbers = PrecursorSummary;

    const QUANTITIES: &'static [Quantity<PrecursorSummary>] = &[
        ("precursor_count", |numbers| Some(numbers.precursor_count as f64)),
        ("precursor_length_max", |numbers| numbers.precursor_length_max),
        ("nucleation_load_ratio", |numbers| numbers.nucleation_load_ratio),
    ];

    const TABLE: Option<Table> = Some(Table {
        file: FILE,
        shows: "the slip events, one per row",
        description: "Events of slip of a slider that is driven at an edge",
        columns: |file| columns::<PrecursorRow>(file, FILE),
    });

    fn of_run(case: &Case) -> Option<Self> {
        case.file.drive.edge().map(Self::new)
    }

    fn fits(&self, new: &Self, now: Times) -> bool {
        self.is_consistent_with(new, now.time_star)
    }

    fn numbers(&self) -> PrecursorSummary {
        let (events, crossing) = (self.events(), self.crossing());
        let is_precursor = |event: &&SlipEvent| event.length < 1.0;
        let before: Vec<f64> = events
            .iter()
            .take_while(is_precursor)
            .map(|event| event.length)
            .collect();
        let crossing_mu_star = crossing.map(|event| event.mu_star_before);
        let nucleation = events.first().map(|event| event.mu_star_before);
        PrecursorSummary {
            events: events.len(),
            crossing_time_star: crossing.map(|event| event.from_star),
            crossing_mu_star,
            precursor_count: before.len(),
            precursor_length_max: before.into_iter().reduce(f64::max),
            nucleation_load_ratio: nucleation
                .zip(crossing_mu_star)
                .map(|(first, crossing)| first / crossing),
        }
    }

    fn line(numbers: &PrecursorSummary, case: &Case) -> (&'static str, String) {
        let crossing = match numbers.crossing_time_star.zip(numbers.crossing_mu_star) {
            Some((time_star, mu_star)) => {
                let at = instant(time_star, &case.scales);
                format!("the first event across the whole slider at mu* = {mu_star:.4}, {at}")
            }
            None => "no event across the whole slider".to_owned(),
        };
        ("events of slip", format!("{}, {crossing}", numbers.events))
    }

    fn csv(&self, scales: &Scales) -> Result<Vec<u8>, csv::Error> {
        to_csv(self.events(), scales)
    }
}

/// The events as CSV.
///
/// # Errors
/// When a row cannot be written.
pub fn to_csv(events: &[SlipEvent], scales: &Scales) -> Result<Vec<u8>, csv::Error> {
    csv_of(events.iter().map(|event| PrecursorRow::new(event, scales)))
}

/// Reads the events back.
///
/// # Errors
/// When the file cannot be read, or a row of it is not an event.
pub fn read_csv<'f>(file: impl Into<RunFile<'f>>) -> Result<Vec<PrecursorRow>, SeriesError> {
    read_rows(&file.into(), FILE, |row| row)
}
