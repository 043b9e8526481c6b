//! The file `series.csv`: the curve of a run, one row per recorded step, names with units in the header.

use std::io::Read;
use std::path::PathBuf;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize};
use slipfront::observe::CurveRow;
use slipfront::{Model, Scales};
use thiserror::Error;

use crate::friction_unit::FrictionUnit;
use crate::names::SERIES;
use crate::run_files::RunFile;
use slipfront_base::text;

/// One row of `series.csv`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SeriesRow {
    /// Number of the step.
    pub step: u64,
    /// Time t*.
    pub time_star: f64,
    /// Time, s.
    pub time_s: f64,
    /// t* of a drive that is held: its path over V* at a constant speed.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub drive_time_star: Option<f64>,
    /// Displacement of the drive, m; for a rotation at its largest radius.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub drive_displacement_m: Option<f64>,
    /// Friction coefficient mu* (Eq. 9 over mu_s).
    pub mu_star: f64,
    /// Friction coefficient mu (Eq. 9).
    pub friction_coefficient: f64,
    /// The component of mu* across the drive.
    pub mu_lateral_star: f64,
    /// Friction along the drive, N; none for a drive that rotates.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub friction_force_n: Option<f64>,
    /// Friction across the drive, N.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub lateral_force_n: Option<f64>,
    /// Torque of friction, N m, for a drive that rotates.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub torque_n_m: Option<f64>,
    /// Share of sliding blocks N*, %.
    pub sliding_percent: f64,
    /// Work of the drive and of a dead load since the start, J.
    pub work_j: f64,
    /// Kinetic energy, J.
    pub kinetic_energy_j: f64,
    /// Energy of the springs between blocks, J.
    pub lattice_energy_j: f64,
    /// Energy of the drive springs, J.
    pub drive_spring_energy_j: f64,
    /// Energy lost to friction since the start, J.
    pub friction_loss_j: f64,
    /// Energy lost to damping since the start, J.
    pub damping_loss_j: f64,
    /// Energy lost to the dampers between blocks since the start, J, if there are any.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub viscous_loss_j: Option<f64>,
    /// Energy of the springs in contact, J; none if contacts are not springs.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub contact_spring_energy_j: Option<f64>,
    /// Energy of the foundation under an upright sheet, J; none without a foundation.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub foundation_energy_j: Option<f64>,
    /// Energy lost with springs in contact that broke since the start, J.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub broken_spring_loss_j: Option<f64>,
    /// Part of the loss to friction since the start that is the energy that falling strength takes, J; none
    /// where strength does not fall.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub weakening_loss_j: Option<f64>,
    /// Mean state of the contacts, t*; none for contacts without a state.
    #[serde(default, deserialize_with = "number", skip_serializing_if = "Option::is_none")]
    pub mean_state_star: Option<f64>,
}

/// Reads a number of an optional column, which a series may lack because it belongs to an option or is newer
/// than the file; a series that has the column has a number in every row.
fn number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    f64::deserialize(deserializer).map(Some)
}

/// A series that cannot be read.
#[derive(Debug, Error)]
#[error(
    "cannot read {path}: {}; it should be the {name} of a slipfront run",
    text::single_line(&source.to_string())
)]
pub struct SeriesError {
    path: PathBuf,
    name: &'static str,
    source: csv::Error,
}

impl SeriesRow {
    /// A recorded row of a run of this model with its units.
    pub fn new(row: &CurveRow, scales: &Scales, model: &Model) -> Self {
        let energy = scales.energy();
        let law = model.friction.needs();
        let viscous_loss = row.energies.viscous_loss * energy;
        let unit = FrictionUnit::new(scales, model);
        Self {
            step: row.step,
            time_star: row.time_star,
            time_s: row.time_star * scales.time(),
            drive_time_star: model.drive.is_held().then_some(row.drive_time_star),
            drive_displacement_m: Some(model.drive.path(row.drive_time_star) * scales.displacement()),
            mu_star: row.point.mu_star,
            friction_coefficient: row.point.mu_star * scales.mu_static_mean,
            mu_lateral_star: row.point.mu_lateral_star,
            friction_force_n: unit.force(row.point.mu_star),
            lateral_force_n: unit.force(row.point.mu_lateral_star),
            torque_n_m: unit.torque(row.point.mu_star),
            sliding_percent: row.point.sliding_percent,
            work_j: row.energies.work * energy,
            kinetic_energy_j: row.energies.stored.kinetic * energy,
            lattice_energy_j: row.energies.stored.lattice * energy,
            drive_spring_energy_j: row.energies.stored.drive_springs * energy,
            friction_loss_j: row.energies.friction_loss * energy,
            damping_loss_j: row.energies.damping_loss * energy,
            viscous_loss_j: model.slider().is_viscous().then_some(viscous_loss),
            contact_spring_energy_j: law.stores_energy.then_some(row.energies.contact_springs * energy),
            foundation_energy_j: model
                .friction
                .interface()
                .filter(|interface| interface.foundation > 0.0)
                .map(|_| row.energies.foundation * energy),
            broken_spring_loss_j: law
                .stores_energy
                .then_some(row.energies.broken_springs_loss * energy),
            weakening_loss_j: law
                .weakens_with_slip
                .then_some(row.energies.weakening_loss * energy),
            mean_state_star: law.has_state.then_some(row.mean_state),
        }
    }
}

/// A column of a series: its name, and its value in a row; none if the column belongs to another option.
type Column = (&'static str, fn(&SeriesRow) -> Option<f64>);

/// Names the fields of a row, each with the function that returns its number in the row, if there is one.
macro_rules! columns_of {
    ($($name:ident)*) => {
        &[$((stringify!($name), |row| row.$name.into())),*]
    };
}

/// Every column that a series may have, except the number of the step.
const COLUMNS: &[Column] = columns_of! {
    time_star time_s drive_time_star drive_displacement_m mu_star friction_coefficient mu_lateral_star friction_force_n lateral_force_n
    torque_n_m sliding_percent work_j kinetic_energy_j lattice_energy_j drive_spring_energy_j friction_loss_j damping_loss_j
    viscous_loss_j contact_spring_energy_j foundation_energy_j broken_spring_loss_j weakening_loss_j mean_state_star
};

/// Columns that count from the start of a run; the next leg continues their count.
const COUNTS: [&str; 10] = [
    "time_star",
    "time_s",
    "drive_time_star",
    "drive_displacement_m",
    "work_j",
    "friction_loss_j",
    "damping_loss_j",
    "viscous_loss_j",
    "broken_spring_loss_j",
    "weakening_loss_j",
];

/// The numbers of a row that count from the start of a run of this model, by the names of their columns,
/// except the number of the step; 0 for a column that the run lacks.
pub fn counts(row: &CurveRow, scales: &Scales, model: &Model) -> Vec<(&'static str, f64)> {
    let row = SeriesRow {
        drive_time_star: Some(row.drive_time_star),
        ..SeriesRow::new(row, scales, model)
    };
    let counted = COLUMNS.iter().filter(|(name, _)| COUNTS.contains(name));
    counted
        .map(|(name, value)| (*name, value(&row).unwrap_or_default()))
        .collect()
}

/// The columns of a series: names and values, without columns that it lacks, and without the numbers of the
/// steps.
pub fn columns(rows: &[SeriesRow]) -> Vec<(&'static str, Vec<f64>)> {
    let all = COLUMNS.iter();
    all.filter_map(|(name, value)| Some((*name, rows.iter().map(value).collect::<Option<_>>()?)))
        .collect()
}

/// Largest number of bytes of a column of a row as CSV: 24 characters, and the separator.
const COLUMN_BYTES: usize = 25;

/// The rows as CSV. Numbers have the fewest digits that read back as the same bits.
pub fn to_csv(rows: impl Iterator<Item = SeriesRow>) -> Result<Vec<u8>, csv::Error> {
    let mut rows = rows;
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.next().map_or(Ok(()), |row| writer.serialize(row))?;
    let mut text = finish(writer)?;
    let header = text.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let columns = 1 + header.iter().filter(|&&byte| byte == b',').count();
    // Reserved in advance: a growing text would temporarily take twice as much memory.
    text.reserve_exact(rows.size_hint().0 * columns * COLUMN_BYTES);
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(text);
    rows.try_for_each(|row| writer.serialize(row))?;
    finish(writer)
}

/// The bytes of a table.
pub(crate) fn finish(table: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, csv::Error> {
    table.into_inner().map_err(|error| error.into_error().into())
}

/// Reads a series back.
pub fn read_csv<'f>(file: impl Into<RunFile<'f>>) -> Result<Vec<SeriesRow>, SeriesError> {
    read_rows(&file.into(), SERIES, |row| row)
}

/// Reads the rows of a table of a run, called `name` in its folder, and keeps `part` of each.
pub(crate) fn read_rows<T: DeserializeOwned, U>(
    file: &RunFile<'_>,
    name: &'static str,
    part: impl Fn(T) -> U,
) -> Result<Vec<U>, SeriesError> {
    let read = || rows_of(file.open()?.0, part);
    read().map_err(|source| SeriesError {
        path: file.path().to_owned(),
        name,
        source,
    })
}

fn rows_of<T: DeserializeOwned, U>(file: impl Read, part: impl Fn(T) -> U) -> Result<Vec<U>, csv::Error> {
    let mut reader = csv::Reader::from_reader(BoundedLines { file, line_bytes: 0 });
    // The iterator of the csv crate would treat an unreadable header as missing, and continue with the rows
    // after it.
    let names = reader.headers()?.clone();
    let rows = reader
        .records()
        .map(|row| Ok(part(row?.deserialize(Some(&names))?)));
    rows.collect()
}

/// Largest length of a line of a series: more than its header and sixteen numbers take.
const LINE_MAX_BYTES: usize = 4096;

/// A file reader that limits the length of lines: the csv crate would keep a line of any length in memory.
struct BoundedLines<R> {
    file: R,
    /// Bytes since the last line break.
    line_bytes: usize,
}

impl<R: Read> Read for BoundedLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        // In a larger buffer, a line that is too long could go unnoticed within one piece.
        let most = buffer.len().min(LINE_MAX_BYTES);
        let bytes = self.file.read(&mut buffer[..most])?;
        self.line_bytes = match buffer[..bytes].iter().rposition(|&byte| byte == b'\n') {
            Some(end) => bytes - end - 1,
            None => self.line_bytes + bytes,
        };
        if self.line_bytes > LINE_MAX_BYTES {
            let sentence = format!("a line of it has more than {LINE_MAX_BYTES} bytes");
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidData, sentence));
        }
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk that fails to read the n-th piece, and reads all others.
    struct Failing<'a> {
        file: &'a [u8],
        reads: usize,
        failing: usize,
    }

    impl Read for Failing<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            self.reads += 1;
            if self.reads == self.failing {
                return Err(std::io::Error::other("it fails"));
            }
            let most = buffer.len().min(300);
            self.file.read(&mut buffer[..most])
        }
    }

    #[test]
    fn a_read_that_fails_is_never_taken_for_the_end() {
        let rows = vec![SeriesRow::default(); 20];
        let text = to_csv(rows.iter().copied()).unwrap();
        let pieces = text.len().div_ceil(300);
        for failing in 1..=pieces {
            let (file, reads) = (text.as_slice(), 0);
            assert!(
                rows_of(Failing { file, reads, failing }, |row: SeriesRow| row).is_err(),
                "piece {failing} of {pieces}"
            );
        }
        assert_eq!(rows_of(text.as_slice(), |row: SeriesRow| row).unwrap(), rows);
    }

    /// Columns have the order of the file, each with its own numbers.
    #[test]
    fn columns_are_those_of_the_file() {
        let row = SeriesRow {
            time_star: 1.5,
            mu_star: 0.25,
            torque_n_m: Some(3.0),
            mean_state_star: Some(7.0),
            ..SeriesRow::default()
        };
        let text = to_csv([row; 2].into_iter()).unwrap();
        let mut lines = std::str::from_utf8(&text).unwrap().lines();
        let header: Vec<&str> = lines.next().unwrap().split(',').collect();
        let numbers: Vec<f64> = lines
            .next()
            .unwrap()
            .split(',')
            .map(|cell| cell.parse().unwrap())
            .collect();
        let columns = columns(&[row; 2]);
        assert_eq!(
            columns.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
            header[1..]
        );
        for ((name, values), number) in columns.iter().zip(&numbers[1..]) {
            assert_eq!(values, &[*number; 2], "{name}");
        }
        let all = slipfront_case::case_file::names_of::<SeriesRow>();
        let whole = SeriesRow {
            drive_time_star: Some(0.0),
            drive_displacement_m: Some(0.0),
            friction_force_n: Some(0.0),
            lateral_force_n: Some(0.0),
            viscous_loss_j: Some(0.0),
            contact_spring_energy_j: Some(0.0),
            foundation_energy_j: Some(0.0),
            broken_spring_loss_j: Some(0.0),
            weakening_loss_j: Some(0.0),
            ..row
        };
        let names: Vec<&str> = super::columns(&[whole]).iter().map(|(name, _)| *name).collect();
        assert_eq!(names, all[1..]);
    }

    #[test]
    fn what_counts_from_the_start_is_a_column() {
        for name in COUNTS {
            assert!(COLUMNS.iter().any(|(column, _)| *column == name), "{name}");
        }
    }

    #[test]
    fn a_series_has_a_column_in_all_rows_or_in_none() {
        let row = |viscous_loss_j| SeriesRow {
            viscous_loss_j,
            ..SeriesRow::default()
        };
        for rows in [[row(None); 2], [row(Some(0.5)), row(Some(f64::MIN_POSITIVE))]] {
            let text = to_csv(rows.into_iter()).unwrap();
            assert_eq!(rows_of(text.as_slice(), |row: SeriesRow| row).unwrap(), rows);
        }
        let text = to_csv([row(Some(0.5)); 2].into_iter()).unwrap();
        let text = String::from_utf8(text).unwrap();
        let cut = text.strip_suffix("0.5\n").unwrap().to_owned() + "\n";
        assert!(rows_of(cut.as_bytes(), |row: SeriesRow| row).is_err());
    }

    #[test]
    fn a_line_without_end_is_refused() {
        let text = |line: usize| ["a".repeat(line), "b".repeat(line)].join("\n").into_bytes();
        let read = |bytes: &[u8]| {
            std::io::read_to_string(BoundedLines {
                file: bytes,
                line_bytes: 0,
            })
        };
        let longest = text(LINE_MAX_BYTES);
        assert_eq!(read(&longest).unwrap().into_bytes(), longest);
        let error = read(&text(2 * LINE_MAX_BYTES + 1)).unwrap_err();
        assert!(error.to_string().contains("more than 4096 bytes"), "{error}");
    }
}
