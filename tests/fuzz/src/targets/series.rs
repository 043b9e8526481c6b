//! The curve of a run, its events of slip, and those of a slider that is driven at an edge, as CSV.

use slipfront::Scales;
use slipfront::observe::{Event, SlipEvent};
use slipfront_run::observers::events::{self, EventRow};
use slipfront_run::observers::precursors;
use slipfront_run::series::{SeriesRow, read_csv, to_csv};

use crate::checks::readable;
use crate::long::many;
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// Target for `series.csv`.
pub(crate) const SERIES: Target = Target {
    name: "series",
    check: series,
    generated: || vec![csv(3), csv(1), csv(0)],
    files: &[],
    dictionary: Some("table.dict"),
    max_bytes: 4096,
    memory: Memory {
        bytes: 256 << 10,
        per_byte: 256,
    },
    time: Time::READING,
    mutations: 2000,
    repetitions: 20,
    long: || long(&csv(1), &csv(0)),
};

/// Target for `precursors.csv`.
pub(crate) const PRECURSORS: Target = Target {
    name: "precursors",
    check: precursor_rows,
    generated: || vec![precursors_csv(3), precursors_csv(1), precursors_csv(0)],
    long: || long(&precursors_csv(1), &precursors_csv(0)),
    ..SERIES
};

/// Target for `events.csv`.
pub(crate) const EVENTS: Target = Target {
    name: "events",
    check: event_rows,
    generated: || vec![events_csv(3), events_csv(1), events_csv(0)],
    long: || long(&events_csv(1), &events_csv(0)),
    ..SERIES
};

/// Tables with many rows, columns and comments, by one with a row and one with the header alone.
fn long(row: &[u8], header: &[u8]) -> Vec<Vec<u8>> {
    let (row, header) = (String::from_utf8_lossy(row), String::from_utf8_lossy(header));
    let row = &row[header.len()..];
    let (head, below) = (header.trim_end(), format!("\n{row}"));
    vec![
        many(&header, row, ""),
        many(&header, "#,", "\n"),
        many(&header, "#\n", ""),
        many(&header, "\n", row),
        many(&header, "# a comment\n", row),
        many(&header, ",\n", ""),
        many(head, ",a#", &below),
        many(head, ",step", &below),
        many("", "a#,", &format!("{header}{row}")),
        many("", "# a comment\n", &header),
        many(&header, "\"", row),
        many(&header, "0", row),
    ]
}

/// Units of events.
const SCALES: Scales = Scales {
    block_size: 1e-6,
    thickness: 1e-6,
    contact_width: 1e-6,
    young_modulus: 1e11,
    density: 1e4,
    pressure: 1e5,
    mu_static_mean: 0.7,
};

/// Events at an edge as CSV, `count` of them, the last of which goes on.
pub(crate) fn precursors_csv(count: u32) -> Vec<u8> {
    let event = |number: u32| SlipEvent {
        from_star: 16.5 * f64::from(number),
        length: 0.25 * f64::from(number + 1),
        mu_star_before: 0.1 * f64::from(number),
        after: (number + 1 < count).then_some((16.5 * f64::from(number) + 0.1, 1e-300)),
    };
    let events: Vec<SlipEvent> = (0..count).map(event).collect();
    precursors::to_csv(&events, &SCALES).unwrap()
}

/// Events that are read have the numbers that stand there: written as a row of the same columns they are read
/// again as equal.
fn precursor_rows(input: &[u8]) {
    let rows = match precursors::read_csv(scratch::file("run/precursors.csv", input)) {
        Ok(rows) => rows,
        Err(error) => return readable(&error),
    };
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:?}"));
    let mut printed = String::from_utf8(precursors_csv(0)).unwrap();
    for row in &rows {
        let numbers = [
            row.time_star,
            row.time_s,
            row.length,
            row.mu_star_before,
            row.friction_coefficient_before,
        ]
        .map(Some);
        let after = [row.mu_star_after, row.friction_coefficient_after, row.until_star];
        let cells: Vec<String> = numbers.into_iter().chain(after).map(number).collect();
        printed += &(cells.join(",") + "\n");
    }
    let again = precursors::read_csv(scratch::file("run/precursors.csv", printed.as_bytes())).unwrap();
    // Debug shows every bit but those of a NaN.
    assert_eq!(format!("{again:?}"), format!("{rows:?}"));
}

/// A catalogue of `count` events as CSV, the last of which goes on and the first of which slips backwards.
pub(crate) fn events_csv(count: u32) -> Vec<u8> {
    let row = |number: u32| {
        let event = Event {
            from_star: 16.5 * f64::from(number),
            drive_from_star: 8.0 * f64::from(number),
            nucleation: [number, 7],
            blocks: 1 << number,
            moment: 30.5 * f64::from(number) - 1.0,
            speed_max: 0.3,
            mu_star_before: 0.1 * f64::from(number),
            after: (number + 1 < count).then_some((16.5 * f64::from(number) + 0.1, 1e-300)),
        };
        EventRow::new(&event, &SCALES)
    };
    events::to_csv((0..count).map(row)).unwrap()
}

/// A catalogue that is written and read again has the same bits.
fn event_rows(input: &[u8]) {
    let rows = match events::read_csv(scratch::file("run/events.csv", input)) {
        Ok(rows) => rows,
        Err(error) => return readable(&error),
    };
    let printed = events::to_csv(rows.iter().copied()).unwrap();
    let again = events::read_csv(scratch::file("run/events.csv", &printed)).unwrap();
    // Debug shows every bit but those of a NaN.
    assert_eq!(format!("{again:?}"), format!("{rows:?}"));
}

/// A series of `rows` rows.
pub(crate) fn csv(rows: u64) -> Vec<u8> {
    let row = |step: u64| {
        let time_star = step as f64 * 16.0;
        SeriesRow {
            step,
            time_star,
            time_s: 3e-10 * time_star,
            drive_time_star: (rows == 3).then_some(0.5 * time_star),
            drive_displacement_m: (rows != 1).then_some(1e-12 * time_star),
            mu_star: 0.3 * step as f64,
            friction_coefficient: 0.3 * step as f64,
            mu_lateral_star: -0.0,
            friction_force_n: Some(1e-9 * step as f64),
            lateral_force_n: Some(-0.0),
            torque_n_m: None,
            sliding_percent: 12.5 * step as f64,
            work_j: 1e-20,
            kinetic_energy_j: 1e-300,
            lattice_energy_j: 5e-324,
            drive_spring_energy_j: 2.0,
            friction_loss_j: 0.1 + 0.2,
            damping_loss_j: f64::NAN,
            viscous_loss_j: (rows == 3).then_some(1e-9),
            contact_spring_energy_j: None,
            foundation_energy_j: None,
            broken_spring_loss_j: None,
            weakening_loss_j: None,
            mean_state_star: Some(16.0),
        }
    };
    to_csv((0..rows).map(row)).unwrap()
}

/// A series that is written and read again has the same bits.
fn series(input: &[u8]) {
    let rows = match read_csv(scratch::file("run/series.csv", input)) {
        Ok(rows) => rows,
        Err(error) => return readable(&error),
    };
    let printed = to_csv(rows.iter().copied()).unwrap();
    let again = read_csv(scratch::file("run/series.csv", &printed)).unwrap();
    assert_eq!(again.len(), rows.len());
    assert_eq!(to_csv(again.into_iter()).unwrap(), printed);
}
