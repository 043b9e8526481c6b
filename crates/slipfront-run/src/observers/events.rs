//! The catalogue of the events of slip: its numbers, and the file `events.csv` with a row for each.

use serde::{Deserialize, Serialize};
use slipfront::Scales;
use slipfront::observe::{Event, Events};
use slipfront_base::number_format::{count, four_digits};
use slipfront_case::case::Case;

use super::observed::{Observed, Quantity, Table, Times, columns, csv_of};
use crate::run_files::RunFile;
use crate::series::{SeriesError, read_rows};

/// Name of the file in a run folder.
pub(crate) const FILE: &str = "events.csv";

/// Events of slip of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EventSummary {
    /// Number of events; each is a row of `events.csv`.
    pub count: usize,
    /// Number of events after the last row, at which the catalogue is full. The other numbers refer to the
    /// rows.
    pub not_listed: u64,
    /// Share of the events in which all blocks in contact slide.
    pub whole_share: Option<f64>,
    /// Largest number of blocks in contact that slide in an event.
    pub blocks_max: Option<usize>,
    /// Largest moment of an event, in units of displacement times blocks.
    pub moment_star_max: Option<f64>,
    /// Sum of the moments of all events.
    pub moment_star_sum: f64,
    /// Mean time from the beginning of an event to the beginning of the next, t* of the drive.
    pub waiting_time_star: Option<f64>,
    /// Standard deviation of these times over their mean: 0 for periodic events, 1 for random events.
    pub waiting_time_variation: Option<f64>,
}

/// One row of `events.csv`. Times and forces of the end are empty for an event that was in progress when the
/// run ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EventRow {
    /// t* at which the first block in contact slides.
    pub time_star: f64,
    /// Time in s at which the first block in contact slides.
    pub time_s: f64,
    /// t* of the drive at which the first block in contact slides.
    pub drive_time_star: f64,
    /// t* at which all blocks in contact are stuck again.
    pub until_star: Option<f64>,
    /// Time in s at which all blocks in contact are stuck again.
    pub until_s: Option<f64>,
    /// Column of the block in contact that slides first, from 0.
    pub nucleation_column: u32,
    /// Row of the block in contact that slides first, from 0.
    pub nucleation_row: u32,
    /// Number of blocks in contact that slide.
    pub blocks: usize,
    /// Sum of the slip of these blocks along the drive, in units of displacement.
    pub moment_star: f64,
    /// Sum over these blocks of slip times area, m^3.
    pub potency_m3: f64,
    /// Largest speed of a block in contact.
    pub slip_speed_star_max: f64,
    /// Largest speed of a block in contact, m/s.
    pub slip_speed_max_m_s: f64,
    /// mu* when the event begins.
    pub mu_star_before: f64,
    /// Friction coefficient when the event begins, F_T/F_N.
    pub friction_coefficient_before: f64,
    /// mu* when all blocks in contact are stuck again.
    pub mu_star_after: Option<f64>,
    /// Friction coefficient when all blocks in contact are stuck again, F_T/F_N.
    pub friction_coefficient_after: Option<f64>,
}

impl EventRow {
    /// The row of an event.
    pub fn new(event: &Event, scales: &Scales) -> Self {
        let (mean, time) = (scales.mu_static_mean, scales.time());
        let area = scales.block_size * scales.block_size;
        let [nucleation_column, nucleation_row] = event.nucleation;
        Self {
            time_star: event.from_star,
            time_s: event.from_star * time,
            drive_time_star: event.drive_from_star,
            until_star: event.after.map(|(until_star, _)| until_star),
            until_s: event.after.map(|(until_star, _)| until_star * time),
            nucleation_column,
            nucleation_row,
            blocks: event.blocks,
            moment_star: event.moment,
            potency_m3: event.moment * scales.displacement() * area,
            slip_speed_star_max: event.speed_max,
            slip_speed_max_m_s: event.speed_max * scales.speed(),
            mu_star_before: event.mu_star_before,
            friction_coefficient_before: event.mu_star_before * mean,
            mu_star_after: event.after.map(|(_, mu_star)| mu_star),
            friction_coefficient_after: event.after.map(|(_, mu_star)| mu_star * mean),
        }
    }
}

impl Observed for Events {
    type Numbers = EventSummary;

    const QUANTITIES: &'static [Quantity<EventSummary>] = &[
        ("event_count", |numbers| Some(numbers.count as f64)),
        ("event_whole_share", |numbers| numbers.whole_share),
        ("event_blocks_max", |numbers| {
            numbers.blocks_max.map(|blocks| blocks as f64)
        }),
        ("event_moment_star_max", |numbers| numbers.moment_star_max),
        ("event_moment_star_sum", |numbers| Some(numbers.moment_star_sum)),
        ("event_waiting_time_star", |numbers| numbers.waiting_time_star),
        ("event_waiting_time_variation", |numbers| {
            numbers.waiting_time_variation
        }),
    ];

    const TABLE: Option<Table> = Some(Table {
        file: FILE,
        shows: "the catalogue of slip events",
        description: "Events of slip: time, place of nucleation, number of blocks, moment and friction of each",
        columns: |file| columns::<EventRow>(file, FILE),
    });

    fn of_run(case: &Case) -> Option<Self> {
        case.file.output.events.then(|| Self::new(&case.model))
    }

    fn fits(&self, new: &Self, now: Times) -> bool {
        self.is_consistent_with(new, now.time_star)
    }

    fn numbers(&self) -> EventSummary {
        let events = self.events();
        let moments = events.iter().map(|event| event.moment);
        let begins: Vec<f64> = events.iter().map(|event| event.drive_from_star).collect();
        let [waiting_time_star, waiting_time_variation] = waiting_times(&begins);
        let share = self.n_whole() as f64 / events.len() as f64;
        EventSummary {
            count: events.len(),
            not_listed: self.unlisted(),
            whole_share: (!events.is_empty()).then_some(share),
            blocks_max: events.iter().map(|event| event.blocks).max(),
            moment_star_max: moments.clone().reduce(f64::max),
            moment_star_sum: moments.sum(),
            waiting_time_star,
            waiting_time_variation,
        }
    }

    fn warning(&self) -> Option<String> {
        let all = self.events().len() as u64 + self.unlisted();
        (self.unlisted() > 0).then(|| {
            format!(
                "the catalogue of events is full: events.csv and all event statistics contain only the first {} of {all}; \
                 reduce time.duration_star",
                Self::MAX
            )
        })
    }

    fn line(numbers: &EventSummary, _case: &Case) -> (&'static str, String) {
        let mut text = format!("{} of slip", count(numbers.count, "event"));
        if let (Some(share), Some(blocks)) = (numbers.whole_share, numbers.blocks_max) {
            text += &format!(
                ", {} % of them with all blocks in contact, the largest with {}",
                four_digits(100.0 * share),
                count(blocks, "block")
            );
        }
        if let Some(star) = numbers.waiting_time_star {
            text += &format!(", one in t* = {} of the drive", four_digits(star));
        }
        ("catalogue", text)
    }

    fn csv(&self, scales: &Scales) -> Result<Vec<u8>, csv::Error> {
        to_csv(self.events().iter().map(|event| EventRow::new(event, scales)))
    }
}

/// Mean and relative standard deviation of the times between these beginnings; none for fewer than two
/// beginnings, and no deviation for fewer than three.
fn waiting_times(begins: &[f64]) -> [Option<f64>; 2] {
    let (Some(first), Some(last)) = (begins.first(), begins.last()) else {
        return [None; 2];
    };
    let n = begins.len() - 1;
    let mean = (last - first) / n as f64;
    let squares = begins.windows(2).map(|pair| (pair[1] - pair[0] - mean).powi(2));
    let deviation = (squares.sum::<f64>() / n as f64).sqrt();
    [
        (n > 0).then_some(mean),
        (n > 1 && mean > 0.0).then_some(deviation / mean),
    ]
}

/// Rows as CSV, with the header even if there are no rows.
///
/// # Errors
/// When a row cannot be written.
pub fn to_csv(rows: impl IntoIterator<Item = EventRow>) -> Result<Vec<u8>, csv::Error> {
    csv_of(rows)
}

/// Reads the events back.
///
/// # Errors
/// When the file cannot be read, or a row of it is not an event.
pub fn read_csv<'f>(file: impl Into<RunFile<'f>>) -> Result<Vec<EventRow>, SeriesError> {
    read_rows(&file.into(), FILE, |row| row)
}
