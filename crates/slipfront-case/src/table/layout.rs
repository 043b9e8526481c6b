//! Layout of a table: the lines with its names, units and numbers, and their format.

use std::borrow::Cow;
use std::cmp::Reverse;

use serde::{Deserialize, Serialize};
use slipfront_base::number_format::count;
use slipfront_base::text::truncated;

use super::encoding::Encoding;
use super::error::TableError;
use super::fields::fields;
use super::number::{clock_time, has_groups, number};

/// Number of bytes at the beginning of a table that determine its layout.
pub const HEAD_BYTES: u64 = 1 << 20;

/// Separators to try; among equally good ones, the first is taken.
const SEPARATORS: [char; 4] = [';', '\t', ',', ' '];

/// Decimal sign of numbers, by its name in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DecimalSign {
    /// `0.5`.
    Point,
    /// `0,5`.
    Comma,
}

/// Separator of fields, by its name in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldSeparator {
    /// `1,2`.
    Comma,
    /// `1;2`.
    Semicolon,
    /// Tab characters.
    Tab,
    /// One or several blanks.
    Blank,
}

impl DecimalSign {
    /// The sign itself.
    fn sign(self) -> char {
        match self {
            Self::Point => '.',
            Self::Comma => ',',
        }
    }
}

impl FieldSeparator {
    /// The separator itself.
    fn sign(self) -> char {
        match self {
            Self::Comma => ',',
            Self::Semicolon => ';',
            Self::Tab => '\t',
            Self::Blank => ' ',
        }
    }
}

/// Properties of a table that the user states, instead of those that would be detected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableOptions {
    /// Line of the names, from 1; 0 if there are none.
    pub header_line: Option<u64>,
    /// Decimal sign, a point or a comma.
    pub decimal: Option<char>,
    /// Separator of fields: a comma, a semicolon, a tab or blanks.
    pub separator: Option<char>,
    /// One of several tables below each other, from 1.
    pub segment: Option<u32>,
}

impl TableOptions {
    /// The options from their names in files and commands.
    pub fn stated(
        header_line: Option<u64>,
        decimal: Option<DecimalSign>,
        separator: Option<FieldSeparator>,
    ) -> Self {
        Self {
            header_line,
            decimal: decimal.map(DecimalSign::sign),
            separator: separator.map(FieldSeparator::sign),
            segment: None,
        }
    }
}

/// A line with a text for each column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedLine {
    /// Number of the line, from 1.
    pub line: u64,
    /// Texts of the columns.
    pub texts: Vec<String>,
}

/// Layout of a table: the lines with its names, units and numbers, and their format.
#[derive(Clone, Debug, PartialEq)]
pub struct TableLayout {
    /// Encoding of the text.
    pub encoding: Encoding,
    /// Separator of fields.
    pub separator: char,
    /// Decimal sign, a point or a comma.
    pub decimal: char,
    /// Names of the columns.
    pub names: Option<NamedLine>,
    /// Units of the columns, in a line below their names.
    pub units: Option<NamedLine>,
    /// Number of the line with which the rows begin, from 1.
    pub first_line: u64,
    /// Number of columns.
    pub columns: usize,
    /// Lines above the names that are neither blank nor comments: their number, and the text of the first.
    above: Option<(usize, String)>,
    /// Whether the names stand in a comment.
    in_comment: bool,
    /// Line and number of fields of the widest row, which counts empty fields at its end.
    widest: Option<(u64, usize)>,
    /// First line of the matrix, which has mostly numbers; the number of lines above it that are neither
    /// blank nor comments; and the text of the first of these.
    above_numbers: Option<(u64, usize, String)>,
}

/// A line of the head. Line breaks within quotation marks, as spreadsheets write them in names, are blanks.
struct Line<'t> {
    /// Number of the line where it begins, from 1.
    number: u64,
    /// Number of the line where it ends.
    last: u64,
    text: Cow<'t, str>,
    /// Fields without the empty ones at the end.
    fields: Vec<String>,
    /// Number of fields with the empty ones at the end.
    width: usize,
    /// Number of fields that are numbers.
    numbers: usize,
}

impl<'t> Line<'t> {
    /// All lines of a text that are not blank.
    fn all(text: &'t str, separator: char, is_number: &dyn Fn(&str) -> bool) -> Vec<Self> {
        let mut physical = text.lines().zip(1..).peekable();
        let mut lines = Vec::new();
        while let Some((first, number)) = physical.next() {
            let (mut text, mut last) = (Cow::Borrowed(first), number);
            // A quotation mark that is never closed is one of its line alone.
            let mut rest = physical.clone();
            while fields(&text, separator).is_err() && last < number + MAX_BREAKS {
                let Some((next, at)) = rest.next() else { break };
                (text, last) = (Cow::Owned(format!("{text} {next}")), at);
            }
            if fields(&text, separator).is_ok() {
                physical = rest;
            } else {
                (text, last) = (Cow::Borrowed(first), number);
            }
            if text.trim().is_empty() || number == 1 && sep_line(&text).is_some() {
                continue;
            }
            let all = fields(without_mark(&text), separator).unwrap_or_default();
            let width = all.len();
            let fields: Vec<String> = trimmed(all).iter().map(ToString::to_string).collect();
            let numbers = fields.iter().filter(|field| is_number(field)).count();
            lines.push(Self {
                number,
                last,
                fields,
                width,
                numbers,
                text,
            });
        }
        lines
    }

    fn is_comment(&self) -> bool {
        without_mark(&self.text).len() < self.text.len()
    }

    /// Number of fields that are neither numbers nor empty.
    fn texts(&self) -> usize {
        self.fields.iter().filter(|field| !field.is_empty()).count() - self.numbers
    }

    /// Whether at least half of the fields that are not empty are numbers.
    fn is_row(&self) -> bool {
        self.numbers > 0 && self.numbers >= self.texts()
    }

    /// The fields of a line of names. With blanks between fields, names of several words are told apart by
    /// two blanks, if that gives a name for each column.
    fn names(&self, separator: char, columns: usize) -> Vec<String> {
        if separator == ' ' && self.fields.len() > columns {
            let parts = without_mark(&self.text).split("  ").map(str::trim);
            let wide: Vec<&str> = parts.filter(|name| !name.is_empty()).collect();
            if wide.len() == columns {
                return wide.into_iter().map(str::to_owned).collect();
            }
        }
        self.fields.clone()
    }
}

/// The text of a comment without its mark; any other line as it is.
fn without_mark(line: &str) -> &str {
    let comment = line.trim_start().strip_prefix('#');
    comment.map_or(line, |rest| rest.trim_start_matches('#'))
}

/// Largest number of line breaks within the quotation marks of one line of names.
const MAX_BREAKS: u64 = 8;

/// A possible reading of a table.
struct Reading {
    layout: TableLayout,
    /// Number of numeric fields in rows, minus the number of other fields.
    score: i64,
}

impl TableLayout {
    /// Finds the layout of the table that begins with `head`, which is the whole table if it is short.
    ///
    /// ```
    /// use slipfront_case::table::{TableLayout, TableOptions};
    ///
    /// let head = "Operator;none\n\nt;F\ns;mN\n0;0,5\n2;1,25\n";
    /// let layout = TableLayout::find(head.as_bytes(), TableOptions::default())?;
    /// assert_eq!((layout.separator, layout.decimal, layout.first_line), (';', ',', 5));
    /// let took = "line 3 names 2 columns; units in line 4: s; mN; decimal commas; 1 line above ignored, \"Operator;none\"";
    /// assert_eq!(layout.took().as_deref(), Some(took));
    /// # Ok::<_, slipfront_case::table::TableError>(())
    /// ```
    ///
    /// # Errors
    /// When the head is not text, can be read in two ways, or does not have the properties in `options`.
    pub fn find(head: &[u8], options: TableOptions) -> Result<Self, TableError> {
        binary(head).map_or(Ok(()), |kind| Err(TableError::Binary(kind)))?;
        let encoding = Encoding::detect(head);
        let text = encoding.text(head);
        let text = looked_at(&text, head.len() as u64 >= HEAD_BYTES);
        let stated = sep_line(text);
        let separators: Vec<char> = match options.separator.or(stated) {
            Some(separator) => vec![separator],
            // All separators that are not in the text give the same reading, so one of them is enough.
            None => {
                let absent = SEPARATORS.into_iter().find(|sign| !text.contains(*sign));
                let is_tried = |sign: &char| text.contains(*sign) || absent == Some(*sign);
                SEPARATORS.into_iter().filter(is_tried).collect()
            }
        };
        let mut readings = Vec::new();
        for separator in separators {
            let decimals: &[char] = match options.decimal {
                Some(decimal) => &[decimal],
                None if separator == ',' => &['.'],
                None => &['.', ','],
            };
            for &decimal in decimals {
                readings.push(Reading::read(text, encoding, [separator, decimal], options)?);
            }
        }
        best(readings, text, options)
    }

    /// Properties of the table that differ from names in the first line, commas between fields and decimal
    /// points, in a sentence without a full stop.
    pub fn took(&self) -> Option<String> {
        let mut took = Vec::new();
        match &self.names {
            Some(names) if self.above.is_some() && !self.in_comment => {
                took.push(format!(
                    "line {} names {}",
                    names.line,
                    count(self.columns, "column")
                ));
            }
            None if self.above.is_some() => {
                took.push(format!("rows of numbers begin in line {}", self.first_line));
            }
            _ => {}
        }
        if let Some(names) = self.names.as_ref().filter(|_| self.in_comment) {
            took.push(format!("names from the comment in line {}", names.line));
        }
        if let Some(units) = &self.units {
            took.push(format!(
                "units in line {}: {}",
                units.line,
                truncated(&units.texts.join("; "))
            ));
        }
        if self.decimal == ',' {
            took.push("decimal commas".to_owned());
        }
        if let Some(encoding) = self.encoding.unusual() {
            took.push(format!("{encoding} text"));
        }
        if let Some((lines, first)) = &self.above {
            took.push(format!("{} above ignored, {first:?}", count(*lines, "line")));
        }
        (!took.is_empty()).then(|| took.join("; "))
    }

    /// The layout of a table with numbers in every line.
    pub(crate) fn of_numbers_alone(self) -> Self {
        Self {
            names: None,
            units: None,
            first_line: 1,
            above: None,
            ..self
        }
    }

    /// The layout of a table with rows that begin at the first line of numbers, whatever is above.
    pub(crate) fn without_names(self) -> Self {
        let (first_line, above) = match self.above_numbers.clone() {
            Some((line, lines, first)) => (line, Some((lines, first))),
            None => (1, None),
        };
        Self {
            names: None,
            units: None,
            first_line,
            above,
            ..self
        }
    }

    /// Refuses a line with more names than any row has fields: the columns behind a name that was taken for
    /// two would have the names of others. The name `Comment` of LabVIEW needs no field.
    ///
    /// # Errors
    /// When there are more names than fields.
    pub fn check_names(&self) -> Result<(), TableError> {
        let (Some(names), Some((line, found))) = (&self.names, self.widest) else {
            return Ok(());
        };
        let count = names.texts.len();
        let is_comment = |name: &String| name.eq_ignore_ascii_case("comment");
        if count <= found || count == found + 1 && names.texts.last().is_some_and(is_comment) {
            return Ok(());
        }
        Err(TableError::TooManyNames {
            header: names.line,
            names: count,
            line,
            found,
            remedy: match self.separator {
                ' ' => "a name of several words was taken for several names",
                _ => "a name with a separator in it was taken for several names, or a name has no column",
            },
        })
    }

    /// Drops empty fields at the end of a row, and refuses a row with more fields than there are names.
    pub(super) fn fit(&self, line: u64, fields: &mut Vec<Cow<'_, str>>) -> Result<(), TableError> {
        let Some(names) = &self.names else { return Ok(()) };
        while fields.len() > names.texts.len() && fields.last().is_some_and(|field| field.is_empty()) {
            fields.pop();
        }
        if fields.len() <= names.texts.len() {
            return Ok(());
        }
        Err(TableError::TooManyFields {
            header: names.line,
            names: names.texts.len(),
            line,
            found: fields.len(),
            remedy: match self.separator {
                ',' => {
                    "a comma that separates cannot be a decimal sign too; write decimal points, or separate fields by semicolons"
                }
                _ => "write as many names as fields",
            },
        })
    }
}

impl Reading {
    /// Reads the text with this separator and decimal sign.
    fn read(
        text: &str,
        encoding: Encoding,
        [separator, decimal]: [char; 2],
        options: TableOptions,
    ) -> Result<Self, TableError> {
        let is_number = |field: &str| number(field, decimal).is_some() || clock_time(field).is_some();
        let lines = Line::all(text, separator, &is_number).into_iter();
        let lines = lines.filter(|line| !line.fields.is_empty());
        let (comments, lines): (Vec<Line>, Vec<Line>) = lines.partition(Line::is_comment);
        // Rows are the longest sequence of lines with equal numbers of fields, at least half of them numeric.
        let sequences = lines.chunk_by(|a, b| a.is_row() && b.is_row() && a.fields.len() == b.fields.len());
        let rows = sequences.filter(|lines| lines[0].is_row()).rev();
        let longest = rows.max_by_key(|lines| lines.len()).unwrap_or_default();
        let columns = longest.first().map_or(0, |line| line.fields.len());
        // Numeric columns are those with a number in most of these rows.
        let in_most = |column: &usize| {
            2 * longest
                .iter()
                .filter(|line| is_number(&line.fields[*column]))
                .count()
                > longest.len()
        };
        let of_numbers: Vec<usize> = (0..columns).filter(in_most).collect();
        // In a column that is empty in the rows, an instrument may have written a word.
        let is_empty = |column: &usize| longest.iter().all(|line| line.fields[*column].is_empty());
        let of_nothing: Vec<usize> = (0..columns).filter(is_empty).collect();
        let has_all = |line: &&Line| {
            line.fields.len() == columns
                && of_numbers.iter().all(|&column| is_number(&line.fields[column]))
                && of_nothing.iter().all(|&column| line.fields[column].is_empty())
        };
        let first = lines
            .iter()
            .position(|line| has_all(&line))
            .unwrap_or(lines.len());
        let score = lines[first..]
            .iter()
            .filter(|line| line.fields.len() == columns)
            .map(|line| line.numbers as i64 - line.texts() as i64)
            .sum();

        let n_lines = text.lines().count() as u64;
        let names = match options.header_line {
            Some(0) => None,
            Some(wanted) if comments.iter().any(|line| line.number == wanted) => None,
            Some(wanted) => Some(lines.iter().position(|line| line.number == wanted).ok_or({
                TableError::NoHeader {
                    wanted,
                    lines: n_lines,
                }
            })?),
            // Names are a line of texts, at least as many as there are columns.
            None => (0..first)
                .rev()
                .find(|&at| lines[at].fields.len() >= columns && lines[at].numbers == 0)
                // If there are fewer names than columns, the rows are wrong: the line is not one of an
                // instrument.
                .or_else(|| {
                    let at = first.checked_sub(1)?;
                    let are_names = separator != ' ' && lines[at].fields.len() > 1 && lines[at].numbers == 0;
                    are_names.then_some(at)
                }),
        };
        let has_units = |at: usize| {
            let line = lines.get(at)?;
            // Quantities of an instrument may have units that are not known here, such as those of
            // temperatures.
            let is_short = |field: &String| field.chars().take(UNIT_MAX_CHARS + 1).count() <= UNIT_MAX_CHARS;
            let are_units = line.numbers == 0
                && line.fields.len() <= columns.max(1)
                && line.fields.iter().all(is_short)
                && 2 * line.fields.iter().filter(|field| is_unit(field)).count() > line.fields.len();
            are_units.then_some(at)
        };
        let (names, units) = match names {
            // The nearest line of texts may contain the units.
            Some(at) if options.header_line.is_none() && at > 0 && has_units(at).is_some() => {
                let above = &lines[at - 1];
                match above.fields.len() >= columns && above.numbers == 0 {
                    true => (Some(at - 1), Some(at)),
                    false => (Some(at), None),
                }
            }
            Some(at) => (Some(at), has_units(at + 1)),
            None => (None, None),
        };
        let named = |line: &Line| NamedLine {
            line: line.number,
            texts: line.names(separator, columns),
        };
        let last = units.or(names);
        let first_line = match last {
            Some(at) => lines[at].last + 1,
            None => lines.get(first).map_or(1, |line| line.number),
        };
        let above = &lines[..names.unwrap_or(first)];
        // Programs write names in the last comment above the numbers.
        let in_comment = || match options.header_line {
            Some(wanted) => comments.iter().find(|line| line.number == wanted),
            None => {
                let line = comments.iter().rfind(|line| line.number < first_line)?;
                let names = line.names(separator, columns);
                (columns > 1 && names.len() == columns && line.numbers == 0).then_some(line)
            }
        };
        let commented = if names.is_none() { in_comment() } else { None };
        let names = names.map(|at| named(&lines[at])).or(commented.map(named));
        // Lines of an instrument above a matrix have fewer fields, or fewer numbers.
        let is_of_matrix =
            |line: &Line| 2 * line.numbers > line.fields.len() && 2 * line.fields.len() >= columns;
        let first_of_matrix = lines.iter().position(is_of_matrix).unwrap_or(0);
        let layout = TableLayout {
            encoding,
            separator,
            decimal,
            columns: names.as_ref().map_or(columns, |names| names.texts.len()),
            names,
            units: units.map(|at| NamedLine {
                line: lines[at].number,
                texts: lines[at].fields.clone(),
            }),
            first_line,
            above: above.first().map(|line| (above.len(), truncated(&line.text))),
            in_comment: commented.is_some(),
            widest: { longest.iter().map(|line| (line.number, line.width)) }
                .max_by_key(|(line, width)| (*width, Reverse(*line))),
            above_numbers: (first_of_matrix > 0).then(|| {
                let line = lines[first_of_matrix].number;
                (line, first_of_matrix, truncated(&lines[0].text))
            }),
        };
        Ok(Self { layout, score })
    }
}

/// The reading with the most numeric fields.
fn best(readings: Vec<Reading>, text: &str, options: TableOptions) -> Result<TableLayout, TableError> {
    // Among equally good readings, the first is taken; `max_by_key` alone would take the last.
    let found = readings
        .into_iter()
        .rev()
        .max_by_key(|reading| (reading.score, reading.layout.columns));
    let Some(Reading { layout, .. }) = found else {
        // At least one separator and one decimal sign are always tried.
        return Err(TableError::Ambiguous("it is empty".to_owned()));
    };
    let rows = text.lines().zip(1..).skip(layout.first_line as usize - 1);
    let rows = rows.filter(|(line, _)| !line.trim_start().starts_with('#'));
    let mut grouped = None;
    let (mut is_decimal, mut doubled, mut n_rows) = (options.decimal.is_some(), 0, 0_usize);
    for (line, at) in rows {
        let fields = trimmed(fields(line, layout.separator).unwrap_or_default());
        for field in &fields {
            let has_sign = field.contains(layout.decimal);
            is_decimal |= has_sign && !has_groups(field, layout.decimal);
            if layout.decimal == ',' && has_groups(field, ',') {
                grouped.get_or_insert_with(|| (at, field.to_string()));
            }
        }
        n_rows += usize::from(!fields.is_empty());
        doubled += usize::from(is_doubled(&fields));
    }
    if let Some((line, field)) = grouped.filter(|_| !is_decimal)
        && options.decimal.is_none()
    {
        let plain = field.replace(',', "");
        let decimal = field.replace(',', ".");
        return Err(TableError::Ambiguous(format!(
            "{field:?} in line {line} is {plain} with a comma between thousands and {decimal} with a decimal comma; \
             say which, as `decimal` = \"comma\" does, or write the numbers without it"
        )));
    }
    // Without names, `0,500,0,0175` may be two numbers or four.
    if layout.separator == ','
        && layout.names.is_none()
        && options.separator.is_none()
        && n_rows > 1
        && doubled == n_rows
    {
        return Err(TableError::Ambiguous(
            "its commas can separate whole numbers, or be decimal commas too, since numbers begin with 0; write decimal points, \
             or separate fields by semicolons"
                .to_owned(),
        ));
    }
    Ok(layout)
}

/// The beginning of a text that determines the layout: comments, and lines of [`LOOKED_AT`] bytes. If the
/// text `is_cut`, its last line is left out, unless it is the only one.
fn looked_at(text: &str, is_cut: bool) -> &str {
    let (mut end, mut counted) = (0, 0);
    for line in text.split_inclusive('\n') {
        let is_whole = line.ends_with('\n') || !is_cut;
        if end > 0 && (counted > LOOKED_AT || !is_whole) {
            break;
        }
        end += line.len();
        if !line.trim_start().starts_with('#') {
            counted += line.len();
        }
    }
    &text[..end]
}

/// Number of bytes of lines without comments that determine a layout.
const LOOKED_AT: usize = 1 << 14;

/// Whether fields are pairs of whole numbers, with the form of decimals in the second of each.
fn is_doubled(fields: &[Cow<'_, str>]) -> bool {
    let is_whole = |field: &Cow<'_, str>| field.parse::<i64>().is_ok();
    let is_padded = |field: &Cow<'_, str>| field.len() > 1 && field.starts_with('0');
    !fields.is_empty()
        && fields.len().is_multiple_of(2)
        && fields.iter().all(is_whole)
        && fields.iter().skip(1).step_by(2).all(|field| field.len() > 1)
        && fields.iter().skip(1).step_by(2).any(is_padded)
}

/// Fields without the empty ones at the end.
fn trimmed(mut fields: Vec<Cow<'_, str>>) -> Vec<Cow<'_, str>> {
    while fields.last().is_some_and(|field| field.is_empty()) {
        fields.pop();
    }
    fields
}

/// Largest number of characters of a unit.
const UNIT_MAX_CHARS: usize = 10;

/// Whether a text can be the unit of a column, such as `N`, `(mm)`, `[-]`, `m/s^2` or an empty text.
fn is_unit(text: &str) -> bool {
    const WORDS: [&str; 39] = [
        "s", "sec", "ms", "us", "min", "h", "m", "mm", "um", "nm", "cm", "n", "mn", "kn", "gf", "kgf", "g",
        "kg", "in", "inch", "ft", "lbf", "lb", "psi", "v", "mv", "%", "1", "-", "rpm", "c", "k", "hz", "bar",
        "pa", "kpa", "mpa", "deg", "rad",
    ];
    let bare = text.trim_matches(['(', ')', '[', ']']).trim();
    let is_bracketed = bare.len() + 2 <= text.len();
    let small = bare.to_lowercase().replace(['\u{b5}', '\u{3bc}'], "u");
    let small = small.trim_start_matches('\u{b0}');
    text.is_empty()
        || (is_bracketed && bare.len() <= 8)
        || WORDS.contains(&small)
        || (small.contains('/') && small.split('/').all(|part| WORDS.contains(&part)))
}

/// The separator in a first line `sep=;` of Excel.
fn sep_line(text: &str) -> Option<char> {
    let first = text.lines().next()?.trim_matches('"');
    let mut stated = first.strip_prefix("sep=")?.chars();
    stated.next().filter(|separator| SEPARATORS.contains(separator))
}

/// The kind of a file that is not text, from its first bytes.
fn binary(head: &[u8]) -> Option<&'static str> {
    match head {
        [b'P', b'K', 3, 4, ..] => Some("a workbook or an archive"),
        [0xd0, 0xcf, 0x11, 0xe0, ..] => Some("a workbook or a document of an old format"),
        [0x1f, 0x8b, ..] => Some("a compressed file"),
        [b'%', b'P', b'D', b'F', ..] => Some("a PDF document"),
        [0x89, b'P', b'N', b'G', ..] => Some("an image"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::*;

    fn find(text: &str) -> Result<TableLayout, String> {
        TableLayout::find(text.as_bytes(), TableOptions::default()).map_err(|error| error.to_string())
    }

    /// The separator, the decimal sign, the lines of names and units, and the first line of rows.
    fn found(text: &str) -> (char, char, [Option<u64>; 2], u64) {
        let layout = find(text).unwrap();
        let lines = [&layout.names, &layout.units].map(|line| line.as_ref().map(|line| line.line));
        (layout.separator, layout.decimal, lines, layout.first_line)
    }

    #[test_case("t,F\n0,1\n1,2\n", (',', '.', [Some(1), None], 2); "plain")]
    #[test_case("0 500\n2 1000\n", (' ', '.', [None, None], 1); "blanks without names")]
    #[test_case("0,5 1,5\n2,5 1,0\n", (' ', ',', [None, None], 1); "decimal commas and blanks")]
    #[test_case("0, 500\n2, 1000\n", (',', '.', [None, None], 1); "commas and blanks")]
    #[test_case("n\tt / ms\tF / mN\n1\t0\t500\n2\t2\t1000\n", ('\t', '.', [Some(1), None], 2); "tabs")]
    #[test_case("\"Time, s\",\"Force, N\"\n0,1\n1,2\n", (',', '.', [Some(1), None], 2); "quotes")]
    #[test_case("t,F,x\n0,0.5,a\n2,1,b\n", (',', '.', [Some(1), None], 2); "a column of texts")]
    #[test_case("sep=;\nt;F\n0;1\n1;2\n", (';', '.', [Some(2), None], 3); "separator stated")]
    #[test_case("t;F\n(s);[N]\n0;1,5\n1;2,5\n", (';', ',', [Some(1), Some(2)], 3); "units")]
    #[test_case("Speed;5\nDate;2024-01-01\n\nt;F\ns;N\n\n0;1,5\n1;2,5\n", (';', ',', [Some(4), Some(5)], 6); "instrument")]
    #[test_case("t;F;n\n0,5;997;1\n1,0;1,050;2\n", (';', ',', [Some(1), None], 2); "a decimal comma that is none between thousands")]
    #[test_case("u\tF\nin\tlbf\n0.5\t1\n1.0\t2\n", ('\t', '.', [Some(1), Some(2)], 3); "units of inches")]
    #[test_case("A: x\nB\n0 1\n1 2\n", (' ', '.', [Some(1), None], 2); "names in two words are names")]
    #[test_case("X\tY\tComment\n0\t1\n1\t2\n", ('\t', '.', [Some(1), None], 2); "more names than fields")]
    #[test_case("t,F\n0,1\n", (',', '.', [Some(1), None], 2); "one row")]
    #[test_case("t,F\n", (',', '.', [Some(1), None], 2); "names alone")]
    #[test_case("X0\t0,5\t0,5\n***End***\nX_Value\tF\tu\tComment\n\t0,5\t0,1\n\t0,6\t0,2\n", ('\t', ',', [Some(3), None], 4); "an empty column")]
    #[test_case("t;F\n12:00:01;0,5\n12:00:02;0,6\n", (';', ',', [Some(1), None], 2); "time of the day")]
    fn layouts_are_found(text: &str, wanted: (char, char, [Option<u64>; 2], u64)) {
        assert_eq!(found(text), wanted);
    }

    #[test_case("# written by hand\n# t  F\n0 1\n1 2\n", &["t", "F"], 3; "a comment as numpy.savetxt writes it")]
    #[test_case("# t = 3 s\n0 1\n1 2\n", &[], 2; "a comment that is none")]
    #[test_case("\"t\n(s)\",\"F\nin\nN\"\n0,1\n1,2\n", &["t (s)", "F in N"], 5; "line breaks in quotation marks")]
    #[test_case("Time (s)  F\n0  1\n1  2\n", &["Time (s)", "F"], 2; "two blanks between names")]
    #[test_case("Steps:\t1\na\tb\tc\td\te\tf\tg\n1\t2\t\t\t\t\t3\n2\t2\t\t\t\t\t3\n", &["a", "b", "c", "d", "e", "f", "g"], 3; "more gaps than numbers")]
    fn names_are_found(text: &str, names: &[&str], first_line: u64) {
        let layout = find(text).unwrap();
        assert_eq!(layout.names.as_ref().map_or(&[][..], |line| &line.texts), names);
        assert_eq!(layout.first_line, first_line);
        layout.check_names().unwrap();
    }

    #[test_case("Time (s) F\n0 1\n1 2\n", "has 3 names in line 1 and 2 fields in line 2: a name of several words"; "blanks")]
    #[test_case("t,Force, x,F\n0,1,2\n1,2,3\n", "has 4 names in line 1 and 3 fields in line 2: a name with a separator"; "commas")]
    #[test_case("t\tT\tF\n0\t1\n1\t2\n", "or a name has no column"; "tabs")]
    fn more_names_than_fields_are_refused(text: &str, sentence: &str) {
        let error = find(text).unwrap().check_names().unwrap_err().to_string();
        assert!(error.contains(sentence), "{error}");
    }

    #[test_case("t,F,x\n0,1,\n1,2,\n"; "empty fields at the end")]
    #[test_case("X\tF\tComment\n0\t1\n1\t2\n"; "comments of LabVIEW have no field")]
    fn names_without_values_are_names(text: &str) {
        assert_eq!(find(text).unwrap().check_names().ok(), Some(()));
    }

    #[test_case("t;F\n1;997\n2;1,050\n", "\"1,050\" in line 3 is 1050 with a comma between thousands and 1.050 with a decimal comma"; "thousands")]
    #[test_case("0,000,0,0000\n0,500,0,0175\n", "its commas can separate whole numbers"; "no names")]
    #[test_case("PK\u{3}\u{4}xl/", "is a workbook or an archive"; "workbook")]
    fn what_can_be_read_in_two_ways_is_refused(text: &str, sentence: &str) {
        let error = find(text).unwrap_err();
        assert!(error.contains(sentence), "{error}");
    }

    #[test]
    fn options_decide() {
        let text = "t;F\n1;997\n2;1,050\n";
        let options = TableOptions {
            decimal: Some(','),
            ..TableOptions::default()
        };
        assert_eq!(TableLayout::find(text.as_bytes(), options).unwrap().decimal, ',');
        let header = |header_line| {
            let options = TableOptions {
                header_line: Some(header_line),
                ..TableOptions::default()
            };
            TableLayout::find(b"a,b\nc,d\n0,1\n1,2\n", options)
        };
        assert_eq!(header(1).unwrap().names.unwrap().texts, ["a", "b"]);
        assert_eq!(header(0).unwrap().names, None);
        assert!(header(9).unwrap_err().to_string().contains("no line 9"));
    }

    #[test_case(Encoding::Utf16Le; "low byte first")]
    #[test_case(Encoding::Utf16Be; "high byte first")]
    fn utf_16_is_read_with_its_mark_and_without(encoding: Encoding) {
        for mark in ["", "\u{feff}"] {
            let units = format!("{mark}t (\u{b5}s);F\n0;1\n1;2\n")
                .encode_utf16()
                .collect::<Vec<u16>>();
            let bytes = units.iter().flat_map(|unit| match encoding {
                Encoding::Utf16Le => unit.to_le_bytes(),
                _ => unit.to_be_bytes(),
            });
            let bytes: Vec<u8> = bytes.collect();
            let layout = TableLayout::find(&bytes, TableOptions::default()).unwrap();
            assert_eq!(layout.encoding, encoding);
            assert_eq!(layout.names.unwrap().texts, ["t (\u{b5}s)", "F"]);
        }
    }
}
