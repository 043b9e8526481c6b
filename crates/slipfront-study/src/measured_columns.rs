//! The columns of a measured record, as the files of designs and calibrations name them.

use std::path::Path;

use slipfront_case::table::TableOptions;
use slipfront_run::measured::{Column, Measure, MeasuredError, MeasuredRecord};

/// Columns of a table, by their names or numbers, and their units if the header has none.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredColumns {
    /// Times, or displacements of the drive.
    pub x: Column,
    /// Forces, or coefficients if their unit is 1.
    pub y: Column,
    /// Format of the table, as far as it is not detected.
    pub options: TableOptions,
}

impl MeasuredColumns {
    /// Columns of these names or numbers, and their units.
    pub fn new([x, y]: [&str; 2], [x_unit, y_unit]: [&Option<String>; 2], options: TableOptions) -> Self {
        let column = |name: &str, unit: &Option<String>| Column {
            name: name.to_owned(),
            unit: unit.clone(),
        };
        Self {
            x: column(x, x_unit),
            y: column(y, y_unit),
            options,
        }
    }

    /// The record in a table.
    ///
    /// # Errors
    /// A sentence on why the table is not a record.
    pub fn read(&self, path: &Path, along: Measure) -> Result<MeasuredRecord, String> {
        let read = MeasuredRecord::read(path, [&self.x, &self.y], along, self.options);
        read.map_err(|error| Self::sentence(error, path))
    }

    /// The record in these bytes of a table; messages contain its path.
    ///
    /// # Errors
    /// A sentence on why the table is not a record.
    pub fn parse(&self, bytes: &[u8], path: &Path, along: Measure) -> Result<MeasuredRecord, String> {
        let read = MeasuredRecord::parse(bytes, path, [&self.x, &self.y], along, self.options);
        read.map_err(|error| Self::sentence(error, path))
    }

    /// The sentence of an error, with keys in place of options.
    fn sentence(error: MeasuredError, path: &Path) -> String {
        match error {
            MeasuredError::NoUnit {
                column,
                axis,
                example,
                ..
            } => format!(
                "column `{column}` of {} has no unit: give it as a key, such as {axis}_unit = \"{example}\"",
                path.display()
            ),
            MeasuredError::OtherUnit {
                column,
                unit,
                quantity,
                axis,
                example,
                ..
            } => format!(
                "column `{column}` of {} has the unit `{unit}`, which is none of a {quantity} that is known here: convert the column, \
                 or give the unit that its numbers have as a key, {axis}_unit{}",
                path.display(),
                example.map_or(String::new(), |unit| format!(" = \"{unit}\""))
            ),
            error => error.to_string(),
        }
    }
}
