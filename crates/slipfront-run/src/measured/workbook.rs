//! Records in workbooks, `.xlsx` (ECMA-376) and `.ods` (OpenDocument): the one sheet with numbers, as a table
//! of text.
//!
//! A workbook is a zip archive of XML. No crate for workbooks is used, because such crates switch the whole
//! program to another compression library, which changes the bytes of all compressed results.

use std::io::Read;

use flate2::bufread::DeflateDecoder;
use jiff::SignedDuration;
use rawzip::{CompressionMethod, ZipArchive, ZipSliceArchive};
use roxmltree::{Document, Node};
use slipfront_case::xml;

/// Largest size of a workbook and of its XML, bytes.
pub(super) const MOST_BYTES: u64 = 1 << 28;
/// Largest size of a sheet as text, bytes: some five million numbers.
const SHEET_MAX_BYTES: u64 = 1 << 26;
/// Largest number of nodes of the XML of a sheet; a number takes three.
const NODES_MAX: u32 = 1 << 23;
/// Largest numbers of rows and columns of a sheet in both formats; an empty one takes a byte.
const PLACES_MAX: [usize; 2] = [1 << 20, 1 << 14];

/// Whether a file that begins with `head` may be a workbook: a zip archive.
pub(super) fn is_workbook(head: &[u8]) -> bool {
    head.starts_with(b"PK\x03\x04")
}

/// A sheet of a workbook as text.
#[derive(Default)]
pub(super) struct Sheet {
    /// Name of the sheet.
    pub(super) name: String,
    /// Rows of the sheet as lines, starting with row 1, with tabs between columns.
    pub(super) text: String,
    /// Number of complete rows, and numbers of columns and of numbers in the incomplete one.
    at: [usize; 2],
    n_numbers: usize,
    /// Number of rows with two numbers or more.
    n_rows: usize,
}

/// Contents of a cell.
enum Cell {
    Number(String),
    Text(String),
}

/// The sheet of a workbook that has numbers in two columns.
///
/// # Errors
/// A sentence that continues after the name of the file, if it is not a workbook, no sheet has such numbers,
/// or several have.
pub(super) fn sheet(bytes: &[u8]) -> Result<Sheet, String> {
    let unreadable = |why: String| {
        format!("is a workbook that cannot be read: {why}; save its sheet as .csv, and give that file")
    };
    let mut found = sheets(bytes).map_err(unreadable)?;
    found.retain(|sheet| sheet.n_rows > 1);
    let names = || Vec::from_iter(found.iter().map(|sheet| format!("{:?}", sheet.name))).join(", ");
    match found.len() {
        0 => Err("is a workbook without a sheet with two columns of numbers".to_owned()),
        1 => Ok(found.remove(0)),
        _ => Err(format!(
            "has numbers in several sheets, {}: save the right sheet as .csv, and give that file",
            names()
        )),
    }
}

fn sheets(bytes: &[u8]) -> Result<Vec<Sheet>, String> {
    if bytes.len() as u64 > MOST_BYTES {
        return Err(too_large("it", MOST_BYTES));
    }
    let archive = ZipArchive::from_slice(bytes).map_err(|error| format!("it is no zip archive ({error})"))?;
    match part(&archive, "content.xml")? {
        Some(content) => open_document(&content),
        None => office_open(&archive),
    }
}

fn too_large(what: &str, most: u64) -> String {
    format!("{what} has more than {} MiB", most >> 20)
}

/// The text of a file of an archive, if there is one of this name.
fn part(archive: &ZipSliceArchive<&[u8]>, name: &str) -> Result<Option<String>, String> {
    let said = |error: rawzip::Error| format!("`{name}` of its archive: {error}");
    let mut entries = archive.entries();
    while let Some(entry) = entries.next_entry().map_err(said)? {
        if entry.file_path().as_ref() != name.as_bytes() {
            continue;
        }
        let method = entry.compression_method();
        let entry = archive.get_entry(entry.wayfinder()).map_err(said)?;
        let stored: Box<dyn Read> = match method {
            CompressionMethod::STORE => Box::new(entry.verifying_reader(entry.data())),
            CompressionMethod::DEFLATE => Box::new(entry.verifying_reader(DeflateDecoder::new(entry.data()))),
            _ => return Err(format!("`{name}` is compressed otherwise than by deflate")),
        };
        let mut text = String::new();
        let read = stored.take(MOST_BYTES + 1).read_to_string(&mut text);
        read.map_err(|error| format!("`{name}` of its archive: {error}"))?;
        return match text.len() as u64 > MOST_BYTES {
            true => Err(too_large(&format!("`{name}`"), MOST_BYTES)),
            false => Ok(Some(text)),
        };
    }
    Ok(None)
}

/// The sheets of an `.xlsx`.
fn office_open(archive: &ZipSliceArchive<&[u8]>) -> Result<Vec<Sheet>, String> {
    let wanted = |name: &str| part(archive, name)?.ok_or(format!("its archive has no `{name}`"));
    let (book, links) = (wanted("xl/workbook.xml")?, wanted("xl/_rels/workbook.xml.rels")?);
    let (book, links) = (parse("workbook.xml", &book)?, parse("workbook.xml.rels", &links)?);
    let strings = match part(archive, "xl/sharedStrings.xml")? {
        Some(text) => {
            let document = parse("sharedStrings.xml", &text)?;
            elements(document.root_element(), "si").map(text_of).collect()
        }
        None => Vec::new(),
    };
    let styles = match part(archive, "xl/styles.xml")? {
        Some(text) => times(&parse("styles.xml", &text)?),
        None => Vec::new(),
    };
    let mut sheets = Vec::new();
    for of_book in elements(book.root_element(), "sheet") {
        let link = of_book.attributes().find(|attribute| attribute.name() == "id");
        let target = elements(links.root_element(), "Relationship")
            .find(|to| to.attribute("Id") == link.map(|link| link.value()))
            .and_then(|to| to.attribute("Target"))
            .unwrap_or_default();
        // A path from the folder of the workbook, or from the root of the archive.
        let path = match target.strip_prefix('/') {
            Some(path) => path.to_owned(),
            None => format!("xl/{target}"),
        };
        // Chart sheets have no cells.
        if !path.contains("worksheets/") {
            continue;
        }
        let text = wanted(&path)?;
        let document = parse(&path, &text)?;
        let mut sheet = Sheet {
            name: of_book.attribute("name").unwrap_or_default().to_owned(),
            ..Sheet::default()
        };
        // Rows and cells need not state their position: they then follow the previous ones.
        let mut row_at = 0;
        let data = elements(document.root_element(), "sheetData").next();
        for row in data.iter().flat_map(|data| children(*data, "row")) {
            let stated = row
                .attribute("r")
                .and_then(|row| row.parse::<usize>().ok()?.checked_sub(1));
            row_at = stated.unwrap_or(row_at);
            let mut at = [row_at, 0];
            for cell in children(row, "c") {
                at = cell.attribute("r").and_then(place).unwrap_or(at);
                sheet.add(at, office_cell(cell, &strings, &styles))?;
                at[1] += 1;
            }
            row_at += 1;
        }
        sheet.end_row();
        sheets.push(sheet);
    }
    Ok(sheets)
}

/// A cell of an `.xlsx`; `styles` says which styles are times.
fn office_cell(cell: Node<'_, '_>, strings: &[String], styles: &[bool]) -> Option<Cell> {
    let kind = cell.attribute("t").unwrap_or("n");
    if kind == "inlineStr" {
        return Some(Cell::Text(text_of(cell)));
    }
    let value = children(cell, "v").next().and_then(|value| value.text())?.trim();
    let is_time = || {
        let style = cell.attribute("s").and_then(|style| style.parse::<usize>().ok());
        styles.get(style.unwrap_or(0)).copied().unwrap_or(false)
    };
    match kind {
        "n" => Some(Cell::Number(match value.parse::<f64>() {
            Ok(days) if is_time() => clock_text(days),
            _ => value.to_owned(),
        })),
        "d" => Some(Cell::Number(value.to_owned())),
        "s" => Some(Cell::Text(strings.get(value.parse::<usize>().ok()?)?.clone())),
        "str" => Some(Cell::Text(value.to_owned())),
        _ => None,
    }
}

/// Whether cells of each style show a time or date.
fn times(styles: &Document<'_>) -> Vec<bool> {
    let root = styles.root_element();
    let format_of = |id: &str| {
        let of_id = elements(root, "numFmt").find(|format| format.attribute("numFmtId") == Some(id));
        of_id.and_then(|format| format.attribute("formatCode"))
    };
    let is_time = |style: Node<'_, '_>| {
        let id = style.attribute("numFmtId").unwrap_or_default();
        match id.parse::<u32>() {
            Ok(14..=22 | 45..=47) => true,
            _ => format_of(id).is_some_and(shows_time),
        }
    };
    let of_cells = elements(root, "cellXfs").next();
    of_cells.map_or(Vec::new(), |styles| elements(styles, "xf").map(is_time).collect())
}

/// Whether a number format shows a time or date: whether it has a letter of one outside of literal text.
fn shows_time(format: &str) -> bool {
    let mut signs = format.chars();
    while let Some(sign) = signs.next() {
        match sign.to_ascii_lowercase() {
            '"' => {
                signs.find(|sign| *sign == '"');
            }
            // A literal character follows, or one that only sets a width.
            '\\' | '_' | '*' => {
                signs.next();
            }
            // Elapsed hours, minutes or seconds, and not a colour, a currency or a condition.
            '[' => {
                let inside: String = signs.by_ref().take_while(|sign| *sign != ']').collect();
                if ["h", "hh", "m", "mm", "s", "ss"].contains(&inside.to_lowercase().as_str()) {
                    return true;
                }
            }
            'y' | 'd' | 'h' | 's' => return true,
            _ => {}
        }
    }
    false
}

/// The sheets of an `.ods`.
fn open_document(content: &str) -> Result<Vec<Sheet>, String> {
    let document = parse("content.xml", content)?;
    let mut sheets = Vec::new();
    let spreadsheet = elements(document.root_element(), "spreadsheet").next();
    for table in spreadsheet.iter().flat_map(|all| children(*all, "table")) {
        let mut sheet = Sheet {
            name: attribute(table, "name").unwrap_or_default().to_owned(),
            ..Sheet::default()
        };
        let (mut row_at, times_of) = (0, |node, name| {
            attribute(node, name)
                .and_then(|times| times.parse::<usize>().ok())
                .unwrap_or(1)
        });
        for row in rows_of(table) {
            let is_empty = children(row, "table-cell").all(|cell| open_cell(cell).is_none());
            let rows = times_of(row, "number-rows-repeated");
            // Empty rows and cells after all others are repeated up to the end of the sheet.
            for k in 0..if is_empty { 0 } else { rows } {
                let mut column = 0;
                for cell in row
                    .children()
                    .filter(|cell| cell.tag_name().name().ends_with("table-cell"))
                {
                    let columns = times_of(cell, "number-columns-repeated");
                    for repeated in 0..columns {
                        match open_cell(cell) {
                            Some(value) => sheet.add([row_at + k, column + repeated], Some(value))?,
                            None => break,
                        }
                    }
                    column = column.saturating_add(columns);
                }
            }
            row_at = row_at.saturating_add(rows);
        }
        sheet.end_row();
        sheets.push(sheet);
    }
    Ok(sheets)
}

/// The rows of a table of an `.ods`, also those in groups and headings, but not those of tables within a
/// cell.
fn rows_of<'a, 'x>(table: Node<'a, 'x>) -> Vec<Node<'a, 'x>> {
    let (mut rows, mut rest) = (Vec::new(), vec![table]);
    while let Some(node) = rest.pop() {
        match node.tag_name().name() {
            "table-row" => rows.push(node),
            "table" | "table-rows" | "table-row-group" | "table-header-rows" => {
                rest.extend(node.children().rev());
            }
            _ => {}
        }
    }
    rows
}

/// A cell of an `.ods`.
fn open_cell(cell: Node<'_, '_>) -> Option<Cell> {
    let value = |name| attribute(cell, name).map(str::to_owned);
    match attribute(cell, "value-type")? {
        "float" | "percentage" | "currency" => value("value").map(Cell::Number),
        "date" => value("date-value").map(Cell::Number),
        "time" => {
            let time = attribute(cell, "time-value")?.parse::<SignedDuration>().ok()?;
            Some(Cell::Number(clock_text(time.as_secs_f64() / 86_400.0)))
        }
        "string" => Some(Cell::Text(text_of(cell))),
        _ => None,
    }
}

impl Sheet {
    /// Adds a cell after all previous ones; its row and column count from 0.
    fn add(&mut self, [row, column]: [usize; 2], cell: Option<Cell>) -> Result<(), String> {
        if [row, column] < self.at || row >= PLACES_MAX[0] || column >= PLACES_MAX[1] {
            return Err(format!("sheet {:?} has its cells in disorder", self.name));
        }
        if self.text.len() as u64 + (row - self.at[0]) as u64 > SHEET_MAX_BYTES {
            return Err(too_large(&format!("sheet {:?}", self.name), SHEET_MAX_BYTES));
        }
        while self.at[0] < row {
            self.end_row();
        }
        self.text.extend(std::iter::repeat_n('\t', column - self.at[1]));
        self.at[1] = column;
        match cell {
            Some(Cell::Number(number)) => {
                self.n_numbers += 1;
                self.text.push_str(&number);
            }
            // Tabs and ends of lines separate fields here.
            Some(Cell::Text(text)) => self
                .text
                .extend(text.chars().map(|c| if c.is_control() { ' ' } else { c })),
            None => {}
        }
        Ok(())
    }

    fn end_row(&mut self) {
        self.text.push('\n');
        self.n_rows += usize::from(self.n_numbers > 1);
        (self.at, self.n_numbers) = ([self.at[0] + 1, 0], 0);
    }
}

fn parse<'x>(name: &str, text: &'x str) -> Result<Document<'x>, String> {
    xml::parse(name, text, NODES_MAX)
}

/// Elements of this name within a node, in any namespace: the namespaces of both formats depend on their
/// version.
fn elements<'a, 'x>(node: Node<'a, 'x>, name: &str) -> impl Iterator<Item = Node<'a, 'x>> {
    node.descendants()
        .filter(move |element| element.is_element() && element.tag_name().name() == name)
}

/// Elements of this name that are children of a node, in any namespace.
fn children<'a, 'x>(node: Node<'a, 'x>, name: &str) -> impl Iterator<Item = Node<'a, 'x>> {
    node.children()
        .filter(move |element| element.is_element() && element.tag_name().name() == name)
}

/// An attribute of this name, in any namespace.
fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let attribute = node.attributes().find(|attribute| attribute.name() == name);
    attribute.map(|attribute| attribute.value())
}

/// All text within a node.
fn text_of(node: Node<'_, '_>) -> String {
    node.descendants()
        .filter(Node::is_text)
        .filter_map(|text| text.text())
        .collect()
}

/// Row and column, from 0, of a cell with a name such as `B4`.
fn place(name: &str) -> Option<[usize; 2]> {
    let digits = name.find(|c: char| c.is_ascii_digit())?;
    let (letters, row) = name.split_at(digits);
    let column = letters.bytes().try_fold(0, |column: usize, letter| {
        let letter = letter.is_ascii_uppercase().then_some(letter - b'A')?;
        column.checked_mul(26)?.checked_add(usize::from(letter) + 1)
    });
    Some([
        row.parse::<usize>().ok()?.checked_sub(1)?,
        column?.checked_sub(1)?,
    ])
}

/// A number of days as hours, minutes and seconds, to a microsecond, which is the precision of days as a
/// double.
fn clock_text(days: f64) -> String {
    let microseconds = (days * 86_400e6).round().max(0.0) as u64;
    let (seconds, rest) = (microseconds / 1_000_000, microseconds % 1_000_000);
    format!(
        "{}:{:02}:{:02}.{rest:06}",
        seconds / 3600,
        seconds / 60 % 60,
        seconds % 60
    )
}

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::*;

    #[test]
    fn sheets_keep_their_rows_and_columns() {
        let sheet = sheet(include_bytes!("../../tests/workbooks/record.xlsx")).unwrap();
        assert_eq!(sheet.name, "Daten");
        let lines: Vec<&str> = sheet.text.lines().collect();
        assert_eq!(
            lines[..5],
            ["", "\tVersuch 7", "", "\tZeit\tUhr\tReibkraft", "\tms\t\tmN"]
        );
        // Days since 1900 as a double are rounded to a microsecond.
        assert!(lines[5].starts_with("\t0\t1088471:59:59.50000"), "{}", lines[5]);
        assert!(lines[8].starts_with("\t750\t1088472:00:00.2") && lines[8].ends_with("\t1251.5"));
    }

    #[test_case("General", false)]
    #[test_case("#,##0.00\\ \\s;[Red]-0.0_d", false)]
    #[test_case("0.0 \"s\"", false)]
    #[test_case("[$-407]dd/mm/yy\\ hh:mm", true)]
    #[test_case("[h]:mm:ss.000", true)]
    fn formats_show_times(format: &str, wanted: bool) {
        assert_eq!(shows_time(format), wanted);
    }

    #[test]
    fn several_sheets_with_numbers_and_other_archives_are_refused() {
        let error = sheet(include_bytes!("../../tests/workbooks/two_sheets.xlsx"))
            .err()
            .unwrap();
        assert!(
            error.contains("has numbers in several sheets, \"Daten\", \"More\""),
            "{error}"
        );
        let error = sheet(b"PK\x03\x04 no archive").err().unwrap();
        assert!(
            error.contains("is a workbook that cannot be read: it is no zip archive"),
            "{error}"
        );
    }
}
