//! A measured record: two columns of a table, such as force against time.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use csv::ByteRecord;
use slipfront_base::disk::open_limited;
use slipfront_base::number_format::count;
use slipfront_base::text::{display_path, truncated};
use slipfront_case::arrays::{separator, table_reader};
use slipfront_case::quantity::{Duration, Force, Length, QuantityError};
use thiserror::Error;

/// A column as a user names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the column in the header, with or without the unit there, or its number from 1.
    pub name: String,
    /// Unit of the column, if the header has none or another is meant.
    pub unit: Option<String>,
}

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Time, s.
    Time,
    /// Displacement, m.
    Displacement,
    /// Force, N.
    Force,
    /// Friction coefficient, 1.
    Coefficient,
}

/// Reason for which a table is no record.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum MeasuredError {
    #[error("cannot read {}: {source}", display_path(path))]
    Read { path: PathBuf, source: csv::Error },
    #[error("{} has no column `{name}`: {known}", display_path(path))]
    Column {
        path: PathBuf,
        name: String,
        known: String,
    },
    #[error(
        "nothing tells the unit of column `{column}` of {}: give it with --{axis}-unit, such as `--{axis}-unit {example}`",
        display_path(path)
    )]
    NoUnit {
        path: PathBuf,
        column: String,
        axis: &'static str,
        example: &'static str,
    },
    #[error("the unit of column `{column}` of {}: {why}", display_path(path))]
    Unit {
        path: PathBuf,
        column: String,
        why: String,
    },
    #[error(
        "line {line} of {}, {text:?}, has no number in column `{column}`: write one, remove the line, or begin it with #",
        display_path(path)
    )]
    NoNumber {
        path: PathBuf,
        line: u64,
        text: String,
        column: String,
    },
    #[error(
        "the field that ends in line {line} of {} goes over several lines: remove the quotation mark with which it begins",
        display_path(path)
    )]
    Lines { path: PathBuf, line: u64 },
    #[error(
        "line {line} of {}: the time or displacement falls, from {before} to {value} in SI units; a record goes forwards",
        display_path(path)
    )]
    Falls {
        path: PathBuf,
        line: u64,
        before: f64,
        value: f64,
    },
    #[error(
        "{} has {found} lines of numbers; a record has at least two",
        display_path(path)
    )]
    TooShort { path: PathBuf, found: usize },
}

/// Number of bytes at the beginning of a table in which the separator is looked for.
const HEAD_BYTES: u64 = 1 << 16;

/// Two columns in SI units, of which the first never falls.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRecord {
    /// Times or displacements.
    pub x: Vec<f64>,
    /// Forces or coefficients.
    pub y: Vec<f64>,
    /// Whether the abscissae are times or displacements.
    pub along: Measure,
    /// Whether the ordinates are forces or coefficients.
    pub of: Measure,
    /// Which lines at the end of the table have no numbers, if there are some: a sentence without its stop.
    pub footer: Option<String>,
}

/// A line without a number in one of the columns.
struct NoNumber {
    /// Number of bytes of the table up to the end of the line.
    end: u64,
    text: String,
    column: String,
}

impl Measure {
    /// SI unit of the quantity.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Displacement => "m",
            Self::Force => "N",
            Self::Coefficient => "1",
        }
    }

    /// The size of a unit in SI units.
    fn factor(self, unit: &str) -> Result<f64, QuantityError> {
        let one = format!("1 {unit}");
        match self {
            Self::Time => one.parse::<Duration>().map(|time| time.si()),
            Self::Displacement => one.parse::<Length>().map(|length| length.si()),
            Self::Force => one.parse::<Force>().map(|force| force.si()),
            Self::Coefficient if unit == "1" => Ok(1.0),
            Self::Coefficient => Err(QuantityError::Unit {
                text: unit.to_owned(),
                why: "a coefficient has the unit 1",
            }),
        }
    }
}

impl MeasuredRecord {
    /// Reads two columns of a table whose fields are separated by commas, semicolons, tabs or blanks; unless
    /// commas separate, numbers may have decimal commas. Empty lines, and those that begin with `#`, count as
    /// none; lines without numbers at the end are passed over, and named. The first column is along times or
    /// displacements; the second has forces, or coefficients if its unit is 1.
    ///
    /// # Errors
    /// When the table cannot be read, has not these columns, or lacks numbers in them before its end; when no
    /// unit is known.
    pub fn read(path: &Path, columns: [&Column; 2], along: Measure) -> Result<Self, MeasuredError> {
        Self::read_from(&|| open_limited(path, u64::MAX), path, columns, along)
    }

    /// Reads two columns of a table that is in memory, as [`read`](Self::read) does those of a file; messages
    /// name its path.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        columns: [&Column; 2],
        along: Measure,
    ) -> Result<Self, MeasuredError> {
        Self::read_from(&|| Ok(bytes), path, columns, along)
    }

    /// Reads two columns of the table that `open` opens from its beginning, each time that it is called.
    fn read_from<R: Read>(
        open: &impl Fn() -> std::io::Result<R>,
        path: &Path,
        columns: [&Column; 2],
        along: Measure,
    ) -> Result<Self, MeasuredError> {
        let failed = |source: csv::Error| MeasuredError::Read {
            path: path.to_owned(),
            source,
        };
        let mut head = Vec::new();
        let read = open().and_then(|table| table.take(HEAD_BYTES).read_to_end(&mut head));
        read.map_err(|source| failed(source.into()))?;
        let separator = separator(&head);
        let mut table = table_reader(open().map_err(|source| failed(source.into()))?, separator);
        let (mut places, mut factors) = ([0; 2], [1.0; 2]);
        let mut record = Self {
            x: Vec::new(),
            y: Vec::new(),
            along,
            of: Measure::Force,
            footer: None,
        };
        // The first line without numbers behind the last one that has some, and how many there are.
        let mut footer: Option<(NoNumber, usize)> = None;
        let mut row = ByteRecord::new();
        let mut is_first = true;
        while table.read_byte_record(&mut row).map_err(failed)? {
            let fields: Vec<String> = row
                .iter()
                .map(|field| {
                    String::from_utf8_lossy(field)
                        .trim_start_matches('\u{feff}')
                        .to_owned()
                })
                .filter(|field| separator != b' ' || !field.is_empty())
                .collect();
            let number = |field: &str| number(field, separator);
            if std::mem::take(&mut is_first) {
                let has_names = fields
                    .iter()
                    .any(|field| !field.is_empty() && number(field).is_none());
                let names = if has_names { &fields[..] } else { &[] };
                for (k, column) in columns.into_iter().enumerate() {
                    places[k] = place(path, column, names, fields.len())?;
                }
                let [x, y] = places.map(|place| names.get(place));
                if unit_of(columns[1], y) == Some("1") {
                    record.of = Measure::Coefficient;
                }
                factors = [
                    factor(path, columns[0], x, along, "x")?,
                    factor(path, columns[1], y, record.of, "y")?,
                ];
                if has_names {
                    continue;
                }
            }
            let end = table.position().byte();
            if row.as_slice().contains(&b'\n') {
                let (path, line) = (path.to_owned(), line_at(open, end).map_err(failed)?);
                return Err(MeasuredError::Lines { path, line });
            }
            if fields.iter().all(String::is_empty) {
                continue;
            }
            let values = [0, 1].map(|k| number(fields.get(places[k])?).map(|value| factors[k] * value));
            let [Some(x), Some(y)] = values else {
                let without = usize::from(values[0].is_some());
                let first = || NoNumber {
                    end,
                    text: truncated(&fields.join(&char::from(separator).to_string())),
                    column: columns[without].name.clone(),
                };
                footer.get_or_insert_with(|| (first(), 0)).1 += 1;
                continue;
            };
            if let Some((line, _)) = footer {
                return Err(line.error(open, path));
            }
            if let Some(&before) = record.x.last().filter(|before| x < **before) {
                return Err(MeasuredError::Falls {
                    path: path.to_owned(),
                    line: line_at(open, end).map_err(failed)?,
                    before,
                    value: x,
                });
            }
            record.x.push(x);
            record.y.push(y);
        }
        match (record.x.len(), footer) {
            (0..2, Some((line, _))) => return Err(line.error(open, path)),
            (found @ 0..2, None) => {
                let path = path.to_owned();
                return Err(MeasuredError::TooShort { path, found });
            }
            (_, None) => {}
            (_, Some((first, lines))) => {
                record.footer = Some(format!(
                    "{} ends with {} without numbers, from line {} on",
                    display_path(path),
                    count(lines, "line"),
                    line_at(open, first.end).map_err(failed)?
                ));
            }
        }
        Ok(record)
    }
}

impl NoNumber {
    /// The error about this line of a table.
    fn error<R: Read>(self, open: &impl Fn() -> std::io::Result<R>, path: &Path) -> MeasuredError {
        match line_at(open, self.end) {
            Ok(line) => MeasuredError::NoNumber {
                path: path.to_owned(),
                line,
                text: self.text,
                column: self.column,
            },
            Err(source) => MeasuredError::Read {
                path: path.to_owned(),
                source,
            },
        }
    }
}

/// Number of the line that ends, with its terminator if it has one, at the byte `end` of a table. The reader
/// of tables counts no lines that are empty, comments or end as those of Windows.
fn line_at<R: Read>(open: &impl Fn() -> std::io::Result<R>, end: u64) -> csv::Result<u64> {
    let mut before = BufReader::new(open()?.take(end.saturating_sub(1)));
    let mut line = 1;
    loop {
        let bytes = before.fill_buf()?;
        if bytes.is_empty() {
            return Ok(line);
        }
        line += bytes.iter().filter(|&&byte| byte == b'\n').count() as u64;
        let read = bytes.len();
        before.consume(read);
    }
}

/// A finite number, with a decimal point, or a decimal comma where commas separate nothing.
fn number(field: &str, separator: u8) -> Option<f64> {
    let value = match separator {
        b',' => field.parse(),
        _ => field.replace(',', ".").parse(),
    };
    value.ok().filter(|value: &f64| value.is_finite())
}

/// Position of a column among `n`, which have `names` if the list is not empty.
fn place(path: &Path, column: &Column, names: &[String], n: usize) -> Result<usize, MeasuredError> {
    let wanted = column.name.to_lowercase();
    let is_named = |name: &String| {
        let name = name.to_lowercase();
        name == wanted || split_unit(&name).0 == wanted
    };
    if let Some(place) = names.iter().position(is_named) {
        return Ok(place);
    }
    match column.name.parse::<usize>() {
        Ok(number) if (1..=n).contains(&number) => Ok(number - 1),
        _ => Err(MeasuredError::Column {
            path: path.to_owned(),
            name: truncated(&column.name),
            known: match names {
                [] => format!("it has no header; its columns are 1 to {n}"),
                names => format!("its columns are {}, or 1 to {n}", truncated(&names.join(", "))),
            },
        }),
    }
}

/// A column's name without its unit, and the unit: `Force (N)`, `force [N]`, `F / N`, `force_n`.
fn split_unit(name: &str) -> (&str, Option<&str>) {
    let in_brackets = [('(', ')'), ('[', ']')].into_iter().find_map(|(open, close)| {
        let (before, rest) = name.split_once(open)?;
        Some((before.trim(), rest.strip_suffix(close)?.trim()))
    });
    let behind = || {
        name.split_once(" / ")
            .map(|(before, unit)| (before.trim(), unit.trim()))
    };
    let suffix = || name.rsplit_once('_');
    match in_brackets.or_else(behind).or_else(suffix) {
        Some((before, unit)) => (before, Some(unit)),
        None => (name, None),
    }
}

/// The unit of a column: the given one, or the one in its header.
fn unit_of<'a>(column: &'a Column, header: Option<&'a String>) -> Option<&'a str> {
    let in_header = || split_unit(header?).1;
    column.unit.as_deref().or_else(in_header)
}

/// The size of the unit of a column in SI units.
fn factor(
    path: &Path,
    column: &Column,
    header: Option<&String>,
    measure: Measure,
    axis: &'static str,
) -> Result<f64, MeasuredError> {
    let shown = || truncated(header.unwrap_or(&column.name));
    if let Some(unit) = &column.unit {
        return measure.factor(unit).map_err(|error| MeasuredError::Unit {
            path: path.to_owned(),
            column: shown(),
            why: error.to_string(),
        });
    }
    let unit = unit_of(column, header);
    // Units of names are written small: force_n, time_ms. Where case decides, as between mN and MN, the unit
    // has to be given.
    let as_written = |unit: &str| measure.factor(unit).ok();
    let of_name = |unit: &str| match (measure, unit) {
        (Measure::Force, "n") => Some(1.0),
        (Measure::Force, "kn") => Some(1e3),
        _ => None,
    };
    let found = unit.and_then(|unit| as_written(unit).or_else(|| of_name(unit)));
    found.ok_or_else(|| MeasuredError::NoUnit {
        path: path.to_owned(),
        column: shown(),
        axis,
        example: match measure {
            Measure::Time => "ms",
            Measure::Displacement => "um",
            Measure::Force => "N",
            Measure::Coefficient => "1",
        },
    })
}

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::*;

    fn read(text: &str, names: [&str; 2], units: [Option<&str>; 2]) -> Result<MeasuredRecord, MeasuredError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("force.csv");
        std::fs::write(&path, text).unwrap();
        let [x, y] = [0, 1].map(|k| Column {
            name: names[k].to_owned(),
            unit: units[k].map(str::to_owned),
        });
        MeasuredRecord::read(&path, [&x, &y], Measure::Time)
    }

    #[test_case("time_ms,force_n\n0,0.5\n2,1\n", ["time_ms", "force"]; "names")]
    #[test_case("Zeit [ms];Kraft [N]\n0;0,5\n2;1,0\n", ["zeit", "2"]; "decimal commas")]
    #[test_case("\u{feff}# a comment\nt (ms),Force (kN),x\n0,0.0005,a\n2,0.001,b\n", ["t", "force"]; "brackets")]
    #[test_case("n\tt / ms\tF / mN\n1\t0\t500\n2\t2\t1000\n", ["t", "F"]; "tabs")]
    #[test_case("time_ms,force_n\n0,0.5\n\n# a comment\n,\n2,1\n", ["1", "2"]; "empty lines")]
    fn tables_of_many_kinds(text: &str, names: [&str; 2]) {
        let record = read(text, names, [None; 2]).unwrap();
        assert_eq!(record.x, [0.0, 0.002]);
        assert_eq!(record.y, [0.5, 1.0]);
    }

    #[test]
    fn units_may_be_given() {
        let record = read("0 500\n2 1000\n", ["1", "2"], [Some("ms"), Some("mN")]).unwrap();
        assert_eq!((record.x, record.y), (vec![0.0, 0.002], vec![0.5, 1.0]));
    }

    #[test_case("t (s),mu (1)\n0,0.5\n2,1\n", None; "header")]
    #[test_case("t (s),mu\n0,0.5\n2,1\n", Some("1"); "given")]
    fn the_unit_1_is_that_of_a_coefficient(text: &str, unit: Option<&str>) {
        let record = read(text, ["t", "mu"], [None, unit]).unwrap();
        assert_eq!((record.of, record.y), (Measure::Coefficient, vec![0.5, 1.0]));
    }

    #[test_case(
        "time_s,force_n\n0,1\n1,2\n", ["time", "load"],
        "has no column `load`: its columns are time_s, force_n, or 1 to 2"
        ; "column"
    )]
    #[test_case("time_s,force\n0,1\n1,2\n", ["time", "force"], "give it with --y-unit, such as `--y-unit N`"; "unit")]
    #[test_case(
        "time_s,force_mn\n0,1\n1,2\n", ["time", "force"], "nothing tells the unit of column `force_mn`"
        ; "ambiguous"
    )]
    #[test_case("time_s,force_n\n0,1\n1,two\n", ["time", "force"], "line 3 of"; "number")]
    #[test_case("time_s,force_n\n0,1\n1,\n2,1\n", ["time", "force"], ", \"1,\", has no number in column `force`"; "gap")]
    #[test_case("time_s,force_n\n0,1\n1\n2,1\n", ["time", "force"], "has no number in column `force`"; "few fields")]
    #[test_case("time_s,force_n\n0,1\n,0.5\n2,1\n", ["time", "force"], "has no number in column `time`"; "no time")]
    #[test_case("time_s,force_n\n0,1\nNaN\n2,1\n", ["time", "force"], ", \"NaN\", has no number"; "no finite number")]
    #[test_case(
        "time_s\tforce_n\r\n# a\r\n\r\n0\t1\r\n*** sensor overload ***\r\n2\t1\r\n", ["time", "force"],
        "line 5 of"
        ; "line of an instrument"
    )]
    #[test_case("time_s,force_n\n0,1\n1,1\n1,\"2\n2,2\n", ["time", "force"], "goes over several lines"; "quote")]
    #[test_case("time_s,force_n\n1,1\n0,2\n", ["time", "force"], "falls, from 1 to 0"; "order")]
    #[test_case("time_s,force_n\n1,1\n", ["time", "force"], "has 1 lines of numbers"; "short")]
    #[test_case("time_s,force_n\n", ["time", "force"], "has 0 lines of numbers"; "header alone")]
    fn what_is_wrong_is_said(text: &str, names: [&str; 2], sentence: &str) {
        let error = read(text, names, [None; 2]).unwrap_err().to_string();
        assert!(error.contains(sentence), "{error}");
    }

    /// The line is that of an editor, wherever it stands and however lines end.
    #[test_case("t_s,f_n\n0,1\n1,1\nEnd of test\n\n2024-01-01,\n", 4, 2; "two lines")]
    #[test_case("t_s,f_n\r\n\r\n0,1\r\n1,1\r\n\r\n1.5,", 6, 1; "a line that was cut")]
    fn lines_without_numbers_at_the_end_are_told(text: &str, from: u64, lines: usize) {
        let record = read(text, ["1", "2"], [None; 2]).unwrap();
        assert_eq!(record.x, [0.0, 1.0]);
        let footer = record.footer.unwrap();
        let told = format!(
            "ends with {} without numbers, from line {from} on",
            count(lines, "line")
        );
        assert!(footer.ends_with(&told), "{footer}");
    }
}
