//! The curve of a run as CSV.

use slipfront_run::series::{SeriesRow, read_csv, to_csv};

use crate::checks::readable;
use crate::{Memory, Target, scratch};

/// `series.csv`.
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
    mutations: 2000,
    repetitions: 60,
};

/// A series of so many rows.
pub(crate) fn csv(rows: u64) -> Vec<u8> {
    let row = |step: u64| {
        let time_star = step as f64 * 16.0;
        SeriesRow {
            step,
            time_star,
            time_s: 3e-10 * time_star,
            mu_star: 0.3 * step as f64,
            friction_coefficient: 0.3 * step as f64,
            mu_lateral_star: -0.0,
            sliding_percent: 12.5 * step as f64,
            work_j: 1e-20,
            kinetic_energy_j: 1e-300,
            lattice_energy_j: 5e-324,
            drive_spring_energy_j: 2.0,
            friction_loss_j: 0.1 + 0.2,
            damping_loss_j: f64::NAN,
            viscous_loss_j: (rows == 3).then_some(1e-9),
        }
    };
    to_csv((0..rows).map(row)).unwrap()
}

/// A series that is written and read again has the same bits.
fn series(input: &[u8]) {
    let rows = match read_csv(&scratch::file("run/series.csv", input)) {
        Ok(rows) => rows,
        Err(error) => return readable(&error),
    };
    let printed = to_csv(rows.iter().copied()).unwrap();
    let again = read_csv(&scratch::file("run/series.csv", &printed)).unwrap();
    assert_eq!(again.len(), rows.len());
    assert_eq!(to_csv(again.into_iter()).unwrap(), printed);
}
