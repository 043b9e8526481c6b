//! A measured record from a page.

use std::path::Path;

use slipfront_calibrate::noise_share;
use slipfront_case::table::TableOptions;
use slipfront_run::measured::{
    Column, Measure, MeasuredError, MeasuredRecord, TableColumn, columns_of, is_displacement, suggested,
};

use crate::base64;
use crate::protocol::{RecordCurve, RecordFile, RecordReply};
use crate::sentence::sentence;

/// Largest number of values of a record that are sent to the page: more than the pixels of a screen.
const MOST_VALUES: usize = 4000;

/// Reads a record: its columns, and the curve of two of them or why there is none.
pub(super) fn read(file: &RecordFile) -> RecordReply {
    let mut reply = RecordReply {
        name: file.name.clone(),
        columns: Vec::new(),
        curve: None,
        problem: None,
        notes: Vec::new(),
    };
    if let Err(sentence) = read_into(&mut reply, file) {
        reply.problem = Some(sentence);
    }
    reply
}

/// Reads a record as far as it can be read.
///
/// # Errors
/// A sentence on why there is no curve.
fn read_into(reply: &mut RecordReply, file: &RecordFile) -> Result<(), String> {
    let bytes = base64::decode(&file.bytes)?;
    let path = Path::new(&file.name);
    reply.columns = columns_of(&bytes, path).map_err(sentence)?;
    let chosen = Chosen::find(file, &reply.columns)?;
    let record = chosen.read(&bytes, path)?;
    reply.notes = record.notes().collect();
    reply.curve = Some(curve(&record, chosen.places));
    Ok(())
}

/// The columns of a record: those that were requested, or else those that their units suggest.
pub(super) struct Chosen {
    places: [usize; 2],
    /// Names of the columns as numbers from 1, and the requested units.
    pub(super) columns: [Column; 2],
    pub(super) along: Measure,
}

impl Chosen {
    /// The columns that a page requests from a table with these columns.
    ///
    /// # Errors
    /// A sentence, if there is no such column.
    pub(super) fn find(file: &RecordFile, columns: &[TableColumn]) -> Result<Self, String> {
        let [x, y] = suggested(columns).ok_or("the table has one column, where a record has two")?;
        let place = |asked: &Option<String>, suggested: usize| {
            let Some(asked) = asked else { return Ok(suggested) };
            let number = asked
                .parse::<usize>()
                .ok()
                .filter(|number| (1..=columns.len()).contains(number));
            let named = || columns.iter().position(|column| column.name == *asked);
            let place = number.map(|number| number - 1).or_else(named);
            place.ok_or_else(|| {
                format!(
                    "the table has no column {asked:?}: its columns are 1 to {}",
                    columns.len()
                )
            })
        };
        let places = [place(&file.x, x)?, place(&file.y, y)?];
        let unit = |asked: &Option<String>| asked.clone().filter(|unit| !unit.trim().is_empty());
        let units = [unit(&file.x_unit), unit(&file.y_unit)];
        let unit_of_x = units[0].as_deref().or(columns[places[0]].unit.as_deref());
        let along = match unit_of_x.is_some_and(is_displacement) {
            true => Measure::Displacement,
            false => Measure::Time,
        };
        let [x_unit, mut y_unit] = units;
        let y_column = &columns[places[1]];
        if y_unit.is_none() && y_column.unit.is_none() && y_column.is_coefficient() {
            y_unit = Some("1".to_owned());
        }
        let column = |place: usize, unit| Column {
            name: (place + 1).to_string(),
            unit,
        };
        Ok(Self {
            columns: [column(places[0], x_unit), column(places[1], y_unit)],
            places,
            along,
        })
    }

    fn read(&self, bytes: &[u8], path: &Path) -> Result<MeasuredRecord, String> {
        let [x, y] = &self.columns;
        let read = MeasuredRecord::parse(bytes, path, [x, y], self.along, TableOptions::default());
        read.map_err(|error| match error {
            MeasuredError::NoUnit { column, example, .. } => {
                format!(
                    "the table does not give the unit of column {column}: write it here, such as {example}"
                )
            }
            MeasuredError::OtherUnit {
                column,
                unit,
                quantity,
                ..
            } => {
                format!(
                    "column {column} has the unit {unit}, which is none of a {quantity} that is known here: convert it, or write \
                     the unit that its numbers have"
                )
            }
            error => sentence(error),
        })
    }
}

/// The curve of a record, thinned out for a page.
fn curve(record: &MeasuredRecord, columns: [usize; 2]) -> RecordCurve {
    let step = record.x.len().div_ceil(MOST_VALUES);
    let thinned = |values: &[f64]| values.iter().copied().step_by(step).collect();
    RecordCurve {
        columns,
        along: record.along,
        of: record.quantity,
        values: record.x.len(),
        x: thinned(&record.x),
        y: thinned(&record.y),
        noise_percent: 100.0 * noise_share(record),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(table: &str) -> RecordFile {
        RecordFile {
            name: "record.csv".to_owned(),
            bytes: base64::encode(table.as_bytes()),
            x: None,
            y: None,
            x_unit: None,
            y_unit: None,
        }
    }

    #[test]
    fn a_table_is_read_by_its_units() {
        let read = read(&file("t (ms);Fz (N);Fx (mN)\n0;9;1\n1;9;2\n2;9;3\n"));
        let curve = read.curve.unwrap();
        assert_eq!((curve.columns, curve.values), ([0, 2], 3));
        assert_eq!((curve.along, curve.of), (Measure::Time, Measure::Force));
        assert_eq!((curve.x[2], curve.y[2]), (0.002, 0.003));
        assert_eq!(read.columns[2].unit.as_deref(), Some("mN"));
    }

    #[test]
    fn a_missing_unit_is_a_problem_that_the_page_can_mend() {
        let mut file = file("way,force\n0,1\n1,2\n2,3\n");
        let problem = read(&file).problem.unwrap();
        assert!(problem.contains("unit of column"), "{problem}");
        (file.x_unit, file.y_unit) = (Some("um".to_owned()), Some("N".to_owned()));
        let curve = read(&file).curve.unwrap();
        assert_eq!((curve.along, curve.x[2]), (Measure::Displacement, 2e-6));
    }

    #[test]
    fn what_is_no_table_says_so() {
        let picture = RecordFile {
            bytes: base64::encode(b"\x89PNG\r\n\x1a\n"),
            ..file("")
        };
        let problem = read(&picture).problem.unwrap();
        assert!(problem.starts_with("record.csv"), "{problem}");
        let one = read(&file("F\n1\n2\n3\n")).problem.unwrap();
        assert!(one.contains("has one column"), "{one}");
    }

    #[test]
    fn a_long_record_is_thinned_out() {
        let rows: String = (0..10_000).map(|k| format!("{k},1\n")).collect();
        let curve = read(&file(&format!("t (s),mu (1)\n{rows}"))).curve.unwrap();
        assert_eq!((curve.values, curve.x.len(), curve.x[1]), (10_000, 3334, 3.0));
    }
}
