//! A measured record: two columns of a table, such as force against time.

mod column_names;
mod columns;
mod correction;
mod error;
mod measure;
mod workbook;

use std::io::Read;
use std::path::Path;

use slipfront_base::disk::open_limited;
use slipfront_base::number_format::{count, with_si_prefix};
use slipfront_base::text::{display_path, truncated};
use slipfront_case::extremes::Extremes;
use slipfront_case::table::{
    HEAD_BYTES, TableError, TableLayout, TableOptions, TableRows, clock_time, has_thousands, number, segment,
};

use self::column_names::{ColumnName, is_coefficient, units_of};
use self::columns::layout_of;
pub use self::columns::{TableColumn, columns_of, is_displacement, suggested};
pub use self::correction::Correction;
pub use self::error::MeasuredError;
pub use self::measure::Measure;

/// A column as a user names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the column in the header, with or without the unit there, or its number from 1.
    pub name: String,
    /// Unit of the column, if the header has none or another is meant.
    pub unit: Option<String>,
}

/// Largest distances by which displacements may go back and still count as sensor noise, as shares of the
/// whole path: anywhere, and if every third of the record goes back somewhere, unlike for a drive that
/// reverses.
const MOST_NOISE: [f64; 2] = [0.01, 0.05];

/// Largest size of a number of a record, in any unit: meters write 9.9e37 or more for a reading beyond their
/// range.
const MAX_READING: f64 = 1e30;

/// Length of a day, s.
const DAY: f64 = 86_400.0;

/// Number of bytes of a record from which on no segment of it is selected.
const SEGMENTS_MAX_BYTES: u64 = 1 << 28;

/// Largest number of bytes of a line of a record.
const LINE_MAX_BYTES: u64 = 1 << 20;

/// Two columns in SI units; the first is non-decreasing.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRecord {
    /// Times or displacements.
    pub x: Vec<f64>,
    /// Forces or coefficients.
    pub y: Vec<f64>,
    /// Whether the abscissae are times or displacements.
    pub along: Measure,
    /// Whether the ordinates are forces or coefficients.
    pub quantity: Measure,
    /// How the table was read, if it is not a plain one: a sentence without its full stop.
    pub took: Option<String>,
    /// Which lines at the end of the table have no numbers, if there are some: a sentence without its full
    /// stop.
    pub footer: Option<String>,
    /// How displacements with the noise of a sensor were averaged, if they were: a sentence without its full
    /// stop.
    pub averaged: Option<String>,
    /// Which ordinates are far from all others, as readings of an overloaded meter are: a sentence without
    /// its full stop.
    pub far_off: Option<String>,
}

/// Positions of two columns, and factors that convert their numbers to SI units.
struct Found {
    places: [usize; 2],
    /// Factor of abscissae, or the reason why their unit is unknown, which does not matter for times of day.
    x_factor: Result<f64, MeasuredError>,
    y_factor: f64,
}

impl MeasuredRecord {
    /// A record of these numbers, read from no table.
    pub fn new(x: Vec<f64>, y: Vec<f64>, along: Measure, quantity: Measure) -> Self {
        Self {
            x,
            y,
            along,
            quantity,
            took: None,
            footer: None,
            averaged: None,
            far_off: None,
        }
    }

    /// Reads two columns of a table of text; the parts of its layout that `options` do not state are
    /// [found](TableLayout::find). Empty lines and lines that begin with `#` are ignored; lines without
    /// numbers at the end are skipped and reported. The first column has times or displacements; times of day
    /// are converted to seconds since the first one. The second has forces, or coefficients if its unit is 1.
    ///
    /// # Errors
    /// When the table cannot be read, does not have these columns, or lacks numbers in them before its end;
    /// when a unit is unknown.
    pub fn read(
        path: &Path,
        columns: [&Column; 2],
        along: Measure,
        options: TableOptions,
    ) -> Result<Self, MeasuredError> {
        let open = || Ok(Box::new(open_limited(path, u64::MAX)?) as Box<dyn Read>);
        Self::read_from((&open, HEAD_BYTES), path, columns, along, options, &[])
    }

    /// Reads two columns of a table in memory, as [`read`](Self::read) does for a file; messages name its
    /// path.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        columns: [&Column; 2],
        along: Measure,
        options: TableOptions,
    ) -> Result<Self, MeasuredError> {
        let open = || Ok(Box::new(bytes) as Box<dyn Read>);
        Self::read_from((&open, HEAD_BYTES), path, columns, along, options, &[])
    }

    /// Reads two columns of the table that `open` opens from its beginning, each time that it is called, and
    /// whose layout shows in its first `head_bytes`. `shown` says how a workbook
    /// [shows](workbook::Sheet::shown) its columns.
    fn read_from<'t>(
        (open, head_bytes): (&dyn Fn() -> std::io::Result<Box<dyn Read + 't>>, u64),
        path: &Path,
        columns: [&Column; 2],
        along: Measure,
        options: TableOptions,
        shown: &[[bool; 2]],
    ) -> Result<Self, MeasuredError> {
        let failed = MeasuredError::of_table(path);
        let read = |most: u64| {
            let mut bytes = Vec::new();
            let read = open().and_then(|table| table.take(most).read_to_end(&mut bytes));
            read.map_err(MeasuredError::unreadable(path)).map(|_| bytes)
        };
        let head = read(head_bytes)?;
        if workbook::is_workbook(&head) {
            let sheet = workbook::sheet(&read(workbook::MOST_BYTES + 1)?, path)?;
            let open = || Ok(Box::new(sheet.text.as_bytes()) as Box<dyn Read>);
            let mut record =
                Self::read_from((&open, HEAD_BYTES), path, columns, along, options, &sheet.shown)?;
            let took = record.took.take();
            let took = took.unwrap_or_else(|| display_path(path).to_string());
            record.took = Some(format!("{took}; sheet {:?} of the workbook", sheet.name));
            return Ok(record);
        }
        if let Some(number) = options.segment {
            let table = read(SEGMENTS_MAX_BYTES)?;
            if table.len() as u64 == SEGMENTS_MAX_BYTES {
                let most = SEGMENTS_MAX_BYTES >> 20;
                let why = format!(
                    "has {most} MiB or more, too much to select a segment: write the segment to a file"
                );
                return Err(failed(std::io::Error::other(why).into()));
            }
            let text = segment(&table, number).map_err(&failed)?;
            let open = || Ok(Box::new(text.as_bytes()) as Box<dyn Read>);
            let options = TableOptions {
                segment: None,
                ..options
            };
            // Names and rows follow all segments before.
            let source = (&open as &dyn Fn() -> _, text.len() as u64);
            return Self::read_from(source, path, columns, along, options, shown);
        }
        let layout = layout_of(&head, path, options)?;
        let mut record = Self {
            took: layout
                .took()
                .map(|took| format!("{}: {took}", display_path(path))),
            ..Self::new(Vec::new(), Vec::new(), along, Measure::Force)
        };
        let Found {
            places,
            x_factor,
            y_factor,
        } = record.columns(&layout, path, columns, shown)?;
        let source = open().map_err(|source| failed(source.into()))?;
        let mut rows = TableRows::new(source, &layout, LINE_MAX_BYTES);
        let decimal = layout.decimal;
        let (mut clocks, mut midnights) = (None, 0.0);
        let mut has_numbers = false;
        // Ordinates as the table has them.
        let mut extremes = Extremes::default();
        let mut first_fall = None;
        // The first line without numbers after the last one with numbers, the error about it, and the number
        // of such lines.
        let mut footer: Option<(u64, MeasuredError, usize)> = None;
        while let Some((line, fields)) = rows.next_row().map_err(&failed)? {
            if fields.iter().all(|field| field.is_empty()) {
                continue;
            }
            let mut value = |k: usize| {
                let Some(field) = fields.get(places[k]) else {
                    return Ok(None);
                };
                let clock = clock_time(field).filter(|_| k == 0 && along == Measure::Time);
                if let Some(clock) = clock {
                    let (first, last) = clocks.get_or_insert((clock, clock));
                    // A clock without a date that goes back by more than half a day has passed midnight.
                    if last.max(clock) < DAY && clock < *last - 0.5 * DAY {
                        midnights += DAY;
                    }
                    *last = clock;
                    return Ok(Some(clock + midnights - *first));
                }
                let Some(value) = number(field, decimal).filter(|value| value.is_finite()) else {
                    return Ok(None);
                };
                if value.abs() > MAX_READING {
                    return MeasuredError::refuse(format!(
                        "line {line} of {} has {value:e} in column `{}`, as meters write where their range is exceeded: remove such \
                         lines, or begin them with #",
                        display_path(path),
                        columns[k].name
                    ));
                }
                if k == 1 {
                    extremes.add(&[value]);
                }
                has_numbers |= k == 0;
                let factors = [*x_factor.as_ref().unwrap_or(&1.0), y_factor];
                Ok(Some(factors[k] * value))
            };
            let read = (value(0)?, value(1)?);
            let (Some(x), Some(y)) = read else {
                let without = usize::from(read.0.is_some());
                // Numbers with thousands separators often occur only at the end, where they must not be
                // skipped.
                let wanted = places.iter().filter_map(|place| fields.get(*place));
                if let Some(field) = { wanted }.find(|field| has_thousands(field, decimal)) {
                    let text = field.to_string();
                    return Err(failed(TableError::Thousands { line, text }));
                }
                let no_number = || {
                    MeasuredError::Refused(format!(
                        "line {line} of {}, {:?}, has no number in column `{}`: write one, remove the line, begin it with #, or \
                         choose one of several segments by `segment`",
                        display_path(path),
                        truncated(&fields.join(&layout.separator.to_string())),
                        columns[without].name
                    ))
                };
                footer.get_or_insert_with(|| (line, no_number(), 0)).2 += 1;
                continue;
            };
            if let Some((_, no_number, _)) = footer {
                return Err(no_number);
            }
            if let Some(&before) = record.x.last().filter(|before| x < **before) {
                first_fall.get_or_insert((line, before, x));
            }
            record.x.push(x);
            record.y.push(y);
        }
        if has_numbers {
            x_factor?;
        }
        match (record.x.len(), footer) {
            (0..2, Some((_, no_number, _))) => return Err(no_number),
            (found @ 0..2, None) => {
                return MeasuredError::refuse(format!(
                    "{} has {found} lines of numbers; a record needs at least two",
                    display_path(path)
                ));
            }
            (_, None) => {}
            (_, Some((first, _, lines))) => {
                record.footer = Some(format!(
                    "{} ends with {} without numbers, starting at line {first}",
                    display_path(path),
                    count(lines, "line")
                ));
            }
        }
        record.far_off = far_off(&extremes, record.y.len(), path, &columns[1].name);
        if let [first, .., last] = record.x[..]
            && first == last
            && first_fall.is_none()
        {
            return MeasuredError::refuse(format!(
                "{} has the same time or displacement, {first} in SI units, in all lines: choose another column",
                display_path(path)
            ));
        }
        if let Some((line, before, value)) = first_fall
            && record.average_over_noise().is_none()
        {
            return MeasuredError::refuse(format!(
                "line {line} of {}: the time or displacement decreases from {before} to {value} in SI units; keep the lines of a \
                 single step of the test, such as by `segment`",
                display_path(path)
            ));
        }
        Ok(record)
    }

    /// Replaces displacements that go back because of sensor noise, and the friction there, by means over
    /// bins. The bins are as wide as the largest distance by which displacements go back. None if the
    /// abscissae are not displacements, or go back by more than noise would.
    fn average_over_noise(&mut self) -> Option<()> {
        let first = *self.x.first()?;
        let (mut largest, mut back) = (first, 0.0_f64);
        for &x in &self.x {
            largest = largest.max(x);
            back = back.max(largest - x);
        }
        let goes_back = |part: &[f64]| !part.is_sorted();
        let is_everywhere = self.x.chunks(self.x.len().div_ceil(3)).all(goes_back);
        let most = MOST_NOISE[usize::from(is_everywhere)] * (largest - first);
        if self.along != Measure::Displacement || back > most {
            return None;
        }
        let least = self.x.iter().copied().fold(first, f64::min);
        // Sums of displacements and friction, and the number of points, of every bin that is not empty.
        let mut bins = std::collections::BTreeMap::<u64, [f64; 3]>::new();
        for (&x, &y) in self.x.iter().zip(&self.y) {
            let bin = bins.entry(((x - least) / back) as u64).or_default();
            *bin = [bin[0] + x, bin[1] + y, bin[2] + 1.0];
        }
        let points = self.x.len();
        self.x = bins.values().map(|[x, _, n]| x / n).collect();
        self.y = bins.values().map(|[_, y, n]| y / n).collect();
        self.averaged = Some(format!(
            "displacements decrease by up to {}, like sensor noise: {} are averaged over bins of this width to {}",
            with_si_prefix(back, "m"),
            count(points, "point"),
            self.x.len()
        ));
        Some(())
    }

    /// Corrects the record:
    ///
    /// ```text
    /// x' = x + shift,   y' = y_factor y + y_offset,   where x' lies in the part
    /// ```
    pub fn correct(&mut self, correction: &Correction) {
        let Correction {
            y_factor,
            y_offset,
            shift,
            part: [from, to],
        } = *correction;
        let points = self.x.iter().map(|x| x + shift).zip(&self.y);
        let counting = points.filter(|(x, _)| (from..=to).contains(x));
        (self.x, self.y) = counting.map(|(x, y)| (x, y_factor * y + y_offset)).unzip();
    }

    /// Sentences for a reader of the record: how the table was read, which lines were skipped, and which
    /// ordinates are doubtful.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        let footer = self
            .footer
            .as_ref()
            .map(|footer| format!("{footer}: passed over"));
        [
            self.took.clone(),
            footer,
            self.averaged.clone(),
            self.far_off.clone(),
        ]
        .into_iter()
        .flatten()
    }

    /// Finds two columns of a table, and the quantity of the second one.
    fn columns(
        &mut self,
        layout: &TableLayout,
        path: &Path,
        columns: [&Column; 2],
        shown: &[[bool; 2]],
    ) -> Result<Found, MeasuredError> {
        let names = ColumnName::all(layout);
        let mut places = [0; 2];
        for (place, column) in places.iter_mut().zip(columns) {
            *place = place_of(path, column, &names, layout.columns)?;
        }
        let mut of_columns = units_of(layout, &names);
        of_columns.resize(layout.columns, None);
        let units = places.map(|place| of_columns[place].clone());
        let mut given = columns.map(|column| column.unit.as_deref());
        for k in 0..2 {
            // Cells that are shown as percentages are stored as shares of 1, whatever the header says.
            let Some([has_plain, true]) = shown.get(places[k]) else {
                continue;
            };
            let unit = given[k].or(units[k].as_deref());
            let is_share = unit.is_none_or(|unit| Measure::Coefficient.has_unit(unit));
            if *has_plain || !is_share || k == 0 {
                let why = match *has_plain {
                    true => "shows some of its numbers as percentages and others not",
                    false => "shows its numbers as percentages, and is no coefficient",
                };
                return MeasuredError::refuse(format!(
                    "column `{}` of {} {why}: give its cells the number format General, and the column the unit that they then have",
                    columns[k].name,
                    display_path(path)
                ));
            }
            given[k] = Some("1");
        }
        let [_, given_y] = given;
        if Measure::Coefficient.has_unit(given_y.or(units[1].as_deref()).unwrap_or("N")) {
            self.quantity = Measure::Coefficient;
        }
        let name_of = |k: usize| {
            let named = names.get(places[k]).filter(|name| !name.whole.is_empty());
            named.map_or(columns[k].name.as_str(), |name| name.whole)
        };
        let factor = |k: usize, measure, axis| {
            let column = Column {
                name: columns[k].name.clone(),
                unit: given[k].map(str::to_owned),
            };
            factor(path, &column, name_of(k), units[k].as_deref(), measure, axis)
        };
        Ok(Found {
            places,
            x_factor: factor(0, self.along, "x"),
            y_factor: factor(1, self.quantity, "y")?,
        })
    }
}

/// A sentence on readings that are far from all others, and larger: a record that begins at rest has its
/// zeros far from the friction of sliding, and a peak of static friction may be far from it too.
fn far_off(extremes: &Extremes, points: usize, path: &Path, column: &str) -> Option<String> {
    let marks = extremes.marks();
    let (value, n) = marks.iter().find(|(value, _)| extremes.exceeds_all(*value))?;
    Some(format!(
        "{} has {value} in column `{}` at {n} of {}, far from all others: if it is the reading of an overloaded meter, remove \
         these lines, or begin them with #",
        display_path(path),
        truncated(column),
        count(points, "point")
    ))
}

/// Position of a column among `n`: the one with exactly this name, else the one with this name apart from the
/// unit, else apart from case, else the one with this number.
fn place_of(
    path: &Path,
    column: &Column,
    names: &[ColumnName<'_>],
    n: usize,
) -> Result<usize, MeasuredError> {
    let wanted = column.name.trim();
    let small = wanted.to_lowercase();
    let is_named: [&dyn Fn(&ColumnName) -> bool; 4] = [
        &|name| name.whole == wanted,
        &|name| name.bare == wanted,
        &|name| name.whole.to_lowercase() == small,
        &|name| name.bare.to_lowercase() == small,
    ];
    for is_named in is_named {
        let places: Vec<usize> = (0..names.len())
            .filter(|&place| is_named(&names[place]))
            .collect();
        match places.as_slice() {
            [] => {}
            [place] => return Ok(*place),
            places => {
                let numbers: Vec<String> = places.iter().map(|place| (place + 1).to_string()).collect();
                return MeasuredError::refuse(format!(
                    "{} has `{}` in several columns, {}: give the number of a column, such as {}",
                    display_path(path),
                    truncated(wanted),
                    numbers.join(", "),
                    numbers[0]
                ));
            }
        }
    }
    match wanted.parse::<usize>() {
        Ok(number) if (1..=n).contains(&number) => Ok(number - 1),
        _ => {
            let known = match names {
                [] => format!("it has no header; its columns are 1 to {n}"),
                names => {
                    let names: Vec<&str> = names.iter().map(|name| name.whole).collect();
                    format!("its columns are {}, or 1 to {n}", truncated(&names.join(", ")))
                }
            };
            MeasuredError::refuse(format!(
                "{} has no column `{}`: {known}",
                display_path(path),
                truncated(wanted)
            ))
        }
    }
}

/// Factor of the unit of a column to SI units: of the given unit, else of the unit in the table.
fn factor(
    path: &Path,
    column: &Column,
    shown: &str,
    in_table: Option<&str>,
    measure: Measure,
    axis: &'static str,
) -> Result<f64, MeasuredError> {
    let shown = || truncated(shown);
    if let Some(unit) = &column.unit {
        return measure.factor(unit).or_else(|why| {
            MeasuredError::refuse(format!(
                "the unit of column `{}` of {}: {why}",
                shown(),
                display_path(path)
            ))
        });
    }
    // Units in names are in lower case: force_n, time_ms. If case matters, as for mN and MN, the unit must be
    // given.
    let of_name = |unit: &str| match (measure, unit) {
        (Measure::Force, "n") => Some(1.0),
        (Measure::Force, "kn") => Some(1e3),
        _ => None,
    };
    let found = in_table.and_then(|unit| measure.factor(unit).ok().or_else(|| of_name(unit)));
    found.ok_or_else(|| match in_table {
        Some(unit) if !unit.is_empty() => MeasuredError::OtherUnit {
            path: path.to_owned(),
            column: shown(),
            unit: truncated(unit),
            quantity: measure.name(),
            axis,
            example: match (measure, unit) {
                // Gram-force, as written by instruments, and not a mass.
                (Measure::Force, "g") => Some("gf"),
                (Measure::Force, "kg") => Some("kgf"),
                _ => None,
            },
        },
        _ => MeasuredError::NoUnit {
            path: path.to_owned(),
            column: shown(),
            axis,
            example: match measure {
                Measure::Time => "ms",
                Measure::Displacement => "um",
                Measure::Force if is_coefficient(&column.name) || is_coefficient(&shown()) => "1",
                Measure::Force => "N",
                Measure::Coefficient => "1",
            },
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
        MeasuredRecord::read(&path, [&x, &y], Measure::Time, TableOptions::default())
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

    #[test_case("Instrument: X\nOperator: none\n\nt (ms),F (N)\n0,0.5\n2,1\n", ["t", "F"], "line 4 names 2 columns; 2 lines above ignored, \"Instrument: X\""; "instrument")]
    #[test_case("t;F\nms;mN\n0;500,0\n2;1000,0\n", ["t", "F"], "units in line 2: ms; mN; decimal commas"; "units")]
    #[test_case("Zeit in msec\tKraft, N\n0\t0.5\n2\t1\n", ["Zeit", "kraft"], ""; "units in words")]
    #[test_case("mu_raw,mu (-),t/ms\n9,0.5,0\n9,1,2\n", ["t", "mu"], ""; "exact names first")]
    #[test_case("t (ms),COF ()\n0,0.5\n2,1\n", ["t", "COF"], ""; "no unit")]
    #[test_case("Time [ms],COF [%]\n0,50\n2,100\n", ["Time", "COF"], ""; "percent")]
    #[test_case("time;F (N)\n23:00:01,000;0,5\n23:00:01,002;1,0\n", ["time", "F"], "decimal commas"; "time of the day")]
    fn what_was_taken_is_said(text: &str, names: [&str; 2], took: &str) {
        let record = read(text, names, [None; 2]).unwrap();
        assert!(
            (record.x[1] - 0.002).abs() < 1e-9,
            "a time of the day is rounded to 2^-37 s: {:?}",
            record.x
        );
        assert_eq!(record.y, [0.5, 1.0]);
        let said = record.notes().collect::<String>();
        assert!(
            said.ends_with(took) && said.is_empty() == took.is_empty(),
            "{said}"
        );
    }

    /// The steps of a test in one file, each with its own header, or with names above the first alone. The
    /// first is longer than what is looked at to find the layout of a table.
    #[test]
    fn one_of_several_segments_is_read() {
        let rows: String = (0..40_000).map(|k| format!("{k},0.1,7\n")).collect();
        let header = "Data Count = 6\nT,Ff,COF\nsec,N,\n\n";
        let of_umt = |between: &str| {
            format!("CETR Data Viewer\nStep No. 1\n{header}{rows}\n{between}0,0.2,7\n2,0.4,7\n3,0.5,7\n")
        };
        let of_labview = "LabVIEW\nSamples\t2\nX_Value\tForce\tComment\n0,0\t9,0\n1,0\t9,0\tslip\n\nChannels\t1\n\
                          ***End_of_Header***\nX_Value\tForce\tComment\n0,0\t0,2\n2,0\t0,4\n3,0\t0,5\nend\n";
        let second = |text: &str, names: [&str; 2]| {
            let [x, y] = [(0, "s"), (1, "N")].map(|(k, unit)| Column {
                name: names[k].to_owned(),
                unit: Some(unit.to_owned()),
            });
            let options = |segment| TableOptions {
                segment: Some(segment),
                ..TableOptions::default()
            };
            let of = |number| {
                MeasuredRecord::parse(
                    text.as_bytes(),
                    Path::new("rig"),
                    [&x, &y],
                    Measure::Time,
                    options(number),
                )
            };
            let missing = of(3).unwrap_err().to_string();
            assert!(
                missing.contains("has 2 segments of rows, so there is no segment 3"),
                "{missing}"
            );
            of(2).unwrap()
        };
        for (text, names) in [
            (of_umt(&format!("Step No. 2\n{header}")), ["T", "Ff"]),
            (of_umt("Step No. 2\n"), ["T", "Ff"]),
            (of_labview.to_owned(), ["X_Value", "Force"]),
        ] {
            let record = second(&text, names);
            assert_eq!(record.x, [0.0, 2.0, 3.0], "{names:?}");
            assert_eq!(record.y, [0.2, 0.4, 0.5], "{names:?}");
        }
    }

    /// Displacements alternate forwards and back. Means over bins keep the friction, which is a function of
    /// displacement. A drive that reverses at the end is not noise.
    #[test]
    fn displacements_with_noise_are_averaged_and_others_refused() {
        let of = |displacement: &dyn Fn(f64, bool) -> f64| {
            let line = |k: usize| {
                let x = displacement(k as f64, k.is_multiple_of(2));
                format!("{x},{}\n", 0.5 + 1e-3 * x)
            };
            let text = "u (um),mu (1)\n".to_owned() + &(0..1000).map(line).collect::<String>();
            let [x, y] = ["u", "mu"].map(|name| Column {
                name: name.to_owned(),
                unit: None,
            });
            let along = Measure::Displacement;
            MeasuredRecord::parse(
                text.as_bytes(),
                Path::new("u.csv"),
                [&x, &y],
                along,
                TableOptions::default(),
            )
        };
        let with_noise = |noise: f64| of(&|x, is_even| if is_even { x } else { x - noise });
        assert!(with_noise(30.0).unwrap().x.is_sorted());
        let record = with_noise(1.5).unwrap();
        assert!(record.x.is_sorted() && record.x.len() < 1000);
        for (x, y) in record.x.iter().zip(&record.y) {
            // Friction is linear in displacement, and so are its means, apart from rounding.
            assert!((y - 0.5 - 1e3 * x).abs() < 1e-12, "{x} {y}");
        }
        let note = record.notes().last().unwrap();
        assert!(
            note.starts_with("displacements decrease by up to 500 nm"),
            "{note}"
        );
        let refused = [with_noise(60.0), of(&|x, _| 970.0 - (x - 970.0).abs())];
        for refused in refused {
            assert!(refused.unwrap_err().to_string().contains("decreases from"));
        }
    }

    #[test_case(include_bytes!("../tests/workbooks/record.xlsx"), "Zeit"; "xlsx")]
    #[test_case(include_bytes!("../tests/workbooks/record.xlsx"), "Uhr"; "xlsx with dates")]
    #[test_case(include_bytes!("../tests/workbooks/record.ods"), "Zeit"; "ods")]
    #[test_case(include_bytes!("../tests/workbooks/record.ods"), "Uhr"; "ods with times")]
    fn workbooks_are_read(book: &[u8], time: &str) {
        let [x, y] = [time, "Reibkraft"].map(|name| Column {
            name: name.to_owned(),
            unit: None,
        });
        let path = Path::new("book");
        let record =
            MeasuredRecord::parse(book, path, [&x, &y], Measure::Time, TableOptions::default()).unwrap();
        assert_eq!(record.y, [500.0, 750.5, 1001.0, 1251.5].map(|force| 1e-3 * force));
        for (k, x) in record.x.iter().enumerate() {
            // Seconds since 1900 have a resolution of 5e-7 s as a double.
            assert!((x - 0.25 * k as f64).abs() < 1e-6, "{x}");
        }
        let took = record.took.unwrap();
        assert!(took.ends_with("; sheet \"Daten\" of the workbook"), "{took}");
    }

    /// Zeros before the drive begins lie as far from the friction of sliding as readings of an overloaded
    /// meter do, on the other side.
    #[test_case(&[(7, 32767.0)], Some("32767 in column `F` at 1 of 100 points"); "one")]
    #[test_case(&[(7, 32767.0), (50, 32767.0), (51, 32767.0)], Some("32767 in column `F` at 3 of 100 points"); "equal ones")]
    #[test_case(&[(7, 32767.0), (8, -32768.0)], Some("-32768 in column `F` at 1 of 100 points"); "both signs")]
    #[test_case(&[(0, 0.0), (1, 0.0)], None; "zeros before the drive begins")]
    #[test_case(&[(7, 900.0)], None; "a peak")]
    fn readings_far_from_all_others_are_told(readings: &[(usize, f64)], wanted: Option<&str>) {
        let mut forces = Vec::from_iter((0..100).map(|k| 500.0 + 0.1 * f64::from(k % 3)));
        readings.iter().for_each(|&(at, reading)| forces[at] = reading);
        let lines = forces
            .iter()
            .enumerate()
            .map(|(k, force)| format!("{k},{force}\n"));
        let record = read(
            &format!("t (s),F (mN)\n{}", lines.collect::<String>()),
            ["t", "F"],
            [None; 2],
        );
        let notes = record.unwrap().notes().collect::<String>();
        assert!(
            notes.contains(wanted.unwrap_or("")) && notes.is_empty() == wanted.is_none(),
            "{notes}"
        );
    }

    /// Dates give the day, so times that go back are out of order, and do not belong to the next day.
    #[test]
    fn times_with_a_date_do_not_pass_midnight_backwards() {
        let text = "t,F (N)\n2024-01-03 10:00:00,1\n2024-01-01 10:00:00,2\n";
        let error = read(text, ["t", "F"], [None; 2]).unwrap_err().to_string();
        assert!(
            error.contains("decreases from 0 to -172800 in SI units"),
            "{error}"
        );
    }

    #[test]
    fn a_clock_passes_midnight() {
        let record = read("t,F (N)\n23:59:59,1\n00:00:01,2\n", ["t", "F"], [None; 2]).unwrap();
        assert_eq!(record.x, [0.0, 2.0]);
    }

    #[test]
    fn units_may_be_given() {
        let record = read("0 500\n2 1000\n", ["1", "2"], [Some("ms"), Some("mN")]).unwrap();
        assert_eq!((record.x, record.y), (vec![0.0, 0.002], vec![0.5, 1.0]));
    }

    #[test]
    fn units_that_are_not_known_are_named() {
        for (unit, sentence) in [
            (
                "N*m",
                "has the unit `N*m`, which is none of a force that is known here",
            ),
            ("kg", "with --y-unit, such as `--y-unit kgf`"),
            ("s", "has the unit `s`"),
        ] {
            let text = format!("t (s),F ({unit})\n0,1\n1,2\n");
            let error = read(&text, ["t", "F"], [None; 2]).unwrap_err().to_string();
            assert!(error.contains(sentence), "{error}");
        }
        // Standard gravity and the pound of 0.45359237 kg; rounding of the product.
        let record = read("t (hours),F (lb)\n0,1\n1,2\n", ["t", "F"], [None; 2]).unwrap();
        assert_eq!(record.x, [0.0, 3600.0]);
        assert!((record.y[0] / (0.453_592_37 * 9.806_65) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn times_that_are_all_equal_are_refused() {
        let error = read("t (s),F (N)\n3,1\n3,2\n3,2\n", ["t", "F"], [None; 2]);
        let error = error.unwrap_err().to_string();
        assert!(
            error.contains("the same time or displacement, 3 in SI units"),
            "{error}"
        );
    }

    #[test_case("t (s),mu (1)\n0,0.5\n2,1\n", None; "header")]
    #[test_case("t (s),mu\n0,0.5\n2,1\n", Some("1"); "given")]
    fn the_unit_1_is_that_of_a_coefficient(text: &str, unit: Option<&str>) {
        let record = read(text, ["t", "mu"], [None, unit]).unwrap();
        assert_eq!(
            (record.quantity, record.y),
            (Measure::Coefficient, vec![0.5, 1.0])
        );
    }

    #[test_case(
        "time_s,force_n\n0,1\n1,2\n", ["time", "load"],
        "has no column `load`: its columns are time_s, force_n, or 1 to 2"
        ; "column"
    )]
    #[test_case("time_s,force\n0,1\n1,2\n", ["time", "force"], "give it with --y-unit, such as `--y-unit N`"; "unit")]
    #[test_case(
        "time_s,force_mn\n0,1\n1,2\n", ["time", "force"], "column `force_mn` of"
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
    #[test_case("time_s,force_n\n0,1\n1,1\n1,\"2\n2,2\n", ["time", "force"], "spans several lines"; "quote")]
    #[test_case("time_s,force_n\n1,1\n0,2\n", ["time", "force"], "decreases from 1 to 0"; "order")]
    #[test_case("t (s),mu (1)\n0,000,0,0000\n0,500,0,0175\n", ["t", "mu"], "has 4 fields in line 2 and 2 names in line 1: a comma that separates cannot be a decimal sign too"; "decimal commas between commas")]
    #[test_case("t (s),mu (1),t (s),mu (1)\n0,100,0,0.5\n1,101,1,0.5\n", ["1", "mu"], "has `mu` in several columns, 2, 4: give the number"; "a name twice")]
    #[test_case("t (s),COF\n0,0.5\n1,0.5\n", ["t", "COF"], "such as `--y-unit 1`"; "coefficient without unit")]
    #[test_case("t (s);F_max (N)\n0;1\n1;2\n", ["t", "F"], "has no column `F`"; "the beginning of a name")]
    #[test_case("t (s);F (N)\n1;997\n2;1,050\n", ["t", "F"], "can be read in two ways: \"1,050\" in line 3"; "thousands")]
    #[test_case("time_s,force_n\n0,998.5\n1,999.5\n2,\"1,000.5\"\n3,\"1,001.5\"\n", ["time", "force"], "has a thousands separator in line 4, \"1,000.5\""; "thousands at the end")]
    #[test_case("time_s,force_n\n0,1\n1,9.91E+37\n2,1\n", ["time", "force"], "line 3 of"; "a meter beyond its range")]
    #[test_case("time_s,force_n\n0,-1e38\n1,-1e38\n2,-1e38\n", ["time", "force"], "has -1e38 in column `force`, as meters write"; "a meter that is always beyond it")]
    #[test_case("time_s,force_n\n1,1\n", ["time", "force"], "has 1 lines of numbers"; "short")]
    #[test_case("time_s,force_n\n", ["time", "force"], "has 0 lines of numbers"; "header alone")]
    fn what_is_wrong_is_said(text: &str, names: [&str; 2], sentence: &str) {
        let error = read(text, names, [None; 2]).unwrap_err().to_string();
        assert!(error.contains(sentence), "{error}");
    }

    /// The number of the line is that of an editor, for any position and any line ending.
    #[test_case("t_s,f_n\n0,1\n1,1\nEnd of test\n\n2024-01-01,\n", 4, 2; "two lines")]
    #[test_case("t_s,f_n\r\n\r\n0,1\r\n1,1\r\n\r\n1.5,", 6, 1; "a line that was cut")]
    fn lines_without_numbers_at_the_end_are_told(text: &str, from: u64, lines: usize) {
        let record = read(text, ["1", "2"], [None; 2]).unwrap();
        assert_eq!(record.x, [0.0, 1.0]);
        let footer = record.footer.unwrap();
        let ending = format!(
            "ends with {} without numbers, starting at line {from}",
            count(lines, "line")
        );
        assert!(footer.ends_with(&ending), "{footer}");
    }
}
