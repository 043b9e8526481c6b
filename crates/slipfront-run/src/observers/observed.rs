//! Properties of an observer that only some runs have.

use serde::Serialize;
use serde::de::DeserializeOwned;
use slipfront::Scales;
use slipfront::observe::Observer;
use slipfront_case::case::Case;
use slipfront_case::case_file::names_of;

use crate::run_files::RunFile;
use crate::series::{SeriesError, finish, read_rows};

/// An observer that only some runs have, with its numbers, its table and the words for them.
pub(crate) trait Observed: Observer + Sized {
    /// Numbers under the name of the observer in `summary.json`.
    type Numbers: 'static;

    /// Numbers that are quantities of studies, by name. The tables of a study have them only if one of its
    /// runs has them.
    const QUANTITIES: &'static [Quantity<Self::Numbers>] = &[];

    /// The table of the observer's records, if the run writes one.
    const TABLE: Option<Table> = None;

    /// The observer of a run of this case, at its start; none for a run that does not have it.
    fn of_run(case: &Case) -> Option<Self>;

    /// Whether the observer, at a checkpoint, can have begun as `new`.
    fn fits(&self, new: &Self, now: Times) -> bool;

    /// The numbers at the end of a run.
    fn numbers(&self) -> Self::Numbers;

    /// A sentence that a reader should know before trusting the numbers.
    fn warning(&self) -> Option<String> {
        None
    }

    /// The numbers as a line for a reader: its name and its text.
    fn line(numbers: &Self::Numbers, case: &Case) -> (&'static str, String);

    /// The content of the [table](Self::TABLE).
    ///
    /// # Errors
    /// When a row cannot be written as CSV.
    fn csv(&self, scales: &Scales) -> Result<Vec<u8>, csv::Error> {
        let _ = scales;
        Ok(Vec::new())
    }
}

/// The name of a number, and the function that finds it among others.
pub(crate) type Quantity<Numbers> = (&'static str, fn(&Numbers) -> Option<f64>);

/// Times at a checkpoint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times {
    /// t*.
    pub(crate) time_star: f64,
    /// t* of the drive.
    pub(crate) drive_time_star: f64,
}

/// Columns of a table: names and values, with NaN for missing numbers.
pub type TableColumns = Vec<(&'static str, Vec<f64>)>;

/// A file of a run with a row for each thing that an observer has recorded.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// Name of the file.
    pub file: &'static str,
    /// Content of the file, in a list of the files of a run.
    pub shows: &'static str,
    /// Content of the file, in the description for a data repository.
    pub description: &'static str,
    /// Reads the columns of the file.
    pub columns: fn(&RunFile<'_>) -> Result<TableColumns, SeriesError>,
}

impl Table {
    /// Name of the table: the name of its file without the ending.
    pub fn name(&self) -> &'static str {
        self.file.strip_suffix(".csv").unwrap_or(self.file)
    }
}

/// Rows as CSV, with the header even if there are no rows.
pub(super) fn csv_of<T: Serialize + DeserializeOwned>(
    rows: impl IntoIterator<Item = T>,
) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    writer.write_record(names_of::<T>())?;
    rows.into_iter().try_for_each(|row| writer.serialize(row))?;
    finish(writer)
}

/// Reads the columns of a table with rows of this type, called `name` in the folder of a run.
pub(super) fn columns<T: Serialize + DeserializeOwned>(
    file: &RunFile<'_>,
    name: &'static str,
) -> Result<TableColumns, SeriesError> {
    let names = names_of::<T>();
    // Row by row, because the JSON values of a long table take far more memory than its numbers.
    let numbers = |row: T| -> Vec<f64> {
        let row = serde_json::to_value(row).unwrap_or_default();
        let number = |name: &&str| row[*name].as_f64().unwrap_or(f64::NAN);
        names.iter().map(number).collect()
    };
    let rows = read_rows(file, name, numbers)?;
    let column = |(place, name): (usize, &&'static str)| (*name, rows.iter().map(|row| row[place]).collect());
    Ok(names.iter().enumerate().map(column).collect())
}
