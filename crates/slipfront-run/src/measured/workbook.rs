//! Records in workbooks, `.xlsx` (ECMA-376) and `.ods` (OpenDocument): the one sheet with numbers, as a table
//! of text.
//!
//! A workbook is a zip archive of XML, of which a kilobyte can stand for a gigabyte. It is therefore read
//! piece by piece, each file of the archive once, and what is read and kept is counted for the workbook as a
//! whole. No crate for workbooks is used, because such crates switch the whole program to another compression
//! library, which changes the bytes of all compressed results.

mod archive;
mod office_open;
mod open_document;
mod sheet;

use std::path::Path;

use slipfront_base::text::{display_path, truncated};

pub(super) use self::archive::MOST_BYTES;
use self::archive::{Budget, Parts};
use self::sheet::Sheet;
use super::error::MeasuredError;

/// Whether a file that begins with `head` may be a workbook: a zip archive.
pub(super) fn is_workbook(head: &[u8]) -> bool {
    head.starts_with(b"PK\x03\x04")
}

/// The sheet of a workbook that has numbers in two columns.
///
/// # Errors
/// If the file is not a workbook, no sheet has such numbers, or several have.
pub(super) fn sheet(bytes: &[u8], path: &Path) -> Result<Sheet, MeasuredError> {
    let refuse = |why: String| MeasuredError::refuse(format!("{} {why}", display_path(path)));
    let mut found = match sheets(bytes) {
        Ok(sheets) => sheets,
        Err(why) => {
            return refuse(format!(
                "is a workbook that cannot be read: {why}; save its sheet as .csv, and give that file"
            ));
        }
    };
    found.retain(|sheet| sheet.n_rows > 1);
    let names = || Vec::from_iter(found.iter().map(|sheet| format!("{:?}", sheet.name))).join(", ");
    match found.len() {
        0 => refuse("is a workbook without a sheet with two columns of numbers".to_owned()),
        1 => Ok(found.remove(0)),
        _ => refuse(format!(
            "has numbers in several sheets, {}: save the right sheet as .csv, and give that file",
            truncated(&names())
        )),
    }
}

fn sheets(bytes: &[u8]) -> Result<Vec<Sheet>, String> {
    let (mut parts, mut budget) = (Parts::open(bytes)?, Budget::new());
    match parts.has("content.xml") {
        true => open_document::sheets(&mut parts, &mut budget),
        false => office_open::sheets(&mut parts, &mut budget),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::path::Path;

    use rawzip::ZipArchiveWriter;
    use slipfront_case::table::TableOptions;

    use super::*;

    fn sheet(bytes: &[u8]) -> Result<Sheet, String> {
        super::sheet(bytes, Path::new("book")).map_err(|error| error.to_string())
    }
    use crate::measured::{Column, Measure, MeasuredRecord};

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

    /// A stored archive of files.
    fn archive(files: &[(&str, &str)]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut archive = ZipArchiveWriter::new(&mut bytes);
        for (name, content) in files {
            let (mut entry, config) = archive.new_file(name).start().unwrap();
            let mut writer = config.wrap(&mut entry);
            writer.write_all(content.as_bytes()).unwrap();
            let (_, descriptor) = writer.finish().unwrap();
            entry.finish(descriptor).unwrap();
        }
        archive.finish().unwrap();
        bytes
    }

    /// An `.xlsx` of one sheet with these rows, and of sheets with the links of `links`.
    fn office(rows: &str, links: &[&str]) -> Vec<u8> {
        let sheets =
            Vec::from_iter(links.iter().map(|link| format!("<sheet name='S' id='{link}'/>"))).concat();
        archive(&[
            (
                "xl/workbook.xml",
                &format!("<workbook><sheets>{sheets}</sheets></workbook>"),
            ),
            (
                "xl/_rels/workbook.xml.rels",
                "<Relationships><Relationship Id='1' Target='worksheets/sheet1.xml'/></Relationships>",
            ),
            (
                "xl/styles.xml",
                "<styleSheet><cellXfs><xf numFmtId='0'/><xf numFmtId='9'/></cellXfs></styleSheet>",
            ),
            (
                "xl/worksheets/sheet1.xml",
                &format!("<worksheet><sheetData>{rows}</sheetData></worksheet>"),
            ),
        ])
    }

    fn document(rows: &str) -> Vec<u8> {
        archive(&[(
            "content.xml",
            &format!("<o><spreadsheet><table name='S'>{rows}</table></spreadsheet></o>"),
        )])
    }

    /// Two rows of times and of a friction of 0.05 and 0.06, stored so, below a name; `styles` say which
    /// values are shown as percentages.
    fn shares(name: &str, styles: [u8; 2], is_office: bool) -> Vec<u8> {
        let [first, second] = styles;
        if is_office {
            let rows = format!(
                "<row><c t='str'><v>t (s)</v></c><c t='str'><v>{name}</v></c></row>\
                 <row><c><v>0</v></c><c s='{first}'><v>0.05</v></c></row><row><c><v>1</v></c><c s='{second}'><v>0.06</v></c></row>"
            );
            return office(&rows, &["1"]);
        }
        let cell = |style: u8, value: &str| {
            let kind = ["float", "percentage"][usize::from(style)];
            format!("<table-cell value-type='{kind}' value='{value}'/>")
        };
        let text = |text: &str| format!("<table-cell value-type='string'><p>{text}</p></table-cell>");
        let rows = [
            [text("t (s)"), text(name)],
            [cell(0, "0"), cell(first, "0.05")],
            [cell(0, "1"), cell(second, "0.06")],
        ];
        document(
            &rows
                .map(|cells| format!("<table-row>{}</table-row>", cells.concat()))
                .concat(),
        )
    }

    fn read(book: &[u8], unit: Option<&str>) -> Result<Vec<f64>, String> {
        let [x, y] = [("1", None), ("2", unit)].map(|(name, unit)| Column {
            name: name.to_owned(),
            unit: unit.map(str::to_owned),
        });
        let (path, options) = (Path::new("book"), TableOptions::default());
        let record = MeasuredRecord::parse(book, path, [&x, &y], Measure::Time, options);
        record.map(|record| record.y).map_err(|error| error.to_string())
    }

    /// A percentage is stored as a share of 1 and shown as a hundred times that: 5 % is 0.05 below any header
    /// that may be one of a coefficient.
    #[test]
    fn percentages_are_shares_of_1() {
        for is_office in [true, false] {
            for (name, styles, unit, wanted) in [
                ("strain (%)", [1, 1], None, [0.05, 0.06]),
                ("strain", [1, 1], None, [0.05, 0.06]),
                ("strain (-)", [1, 1], None, [0.05, 0.06]),
                ("strain", [1, 1], Some("%"), [0.05, 0.06]),
                ("strain (%)", [0, 0], None, [0.01 * 0.05, 0.01 * 0.06]),
            ] {
                let found = read(&shares(name, styles, is_office), unit);
                assert_eq!(found.unwrap(), wanted, "{name} {styles:?} {unit:?}");
            }
            for (name, styles, sentence) in [
                (
                    "F (N)",
                    [1, 1],
                    "shows its numbers as percentages, and is no coefficient",
                ),
                (
                    "strain (%)",
                    [1, 0],
                    "shows some of its numbers as percentages and others not",
                ),
            ] {
                let error = read(&shares(name, styles, is_office), None).unwrap_err();
                assert!(error.contains(sentence), "{error}");
            }
        }
    }

    #[test]
    fn budgets_hold_for_a_workbook_as_a_whole() {
        let number = "<table-cell value-type='float' value='1'/>";
        let repeated = |rows: usize, columns: usize, cell: &str| {
            let cell = cell.replace("/>", &format!(" number-columns-repeated='{columns}'/>"));
            document(&format!(
                "<table-row number-rows-repeated='{rows}'>{cell}</table-row>"
            ))
        };
        let text = format!(
            "<table-cell value-type='string'><p>{}</p></table-cell>",
            "x".repeat(100)
        );
        for (book, sentence) in [
            (
                office("", &["1", "1"]),
                "several of its sheets are `xl/worksheets/sheet1.xml`",
            ),
            (office("", &["2"]), "its sheet S has no file"),
            (
                office("<row><c t='s'><v>0</v></c></row>", &["1"]),
                "has the text 0, and there are 0",
            ),
            (archive(&[("a", ""), ("a", "")]), "two files `a`"),
            (repeated(1 << 20, 30, number), "more than 4194304 cells"),
            (repeated(1 << 21, 2, number), "more than 1048576 rows"),
            (repeated(2, 1 << 15, number), "cells in disorder"),
            (repeated(1 << 20, 1, &text), "more than 64 MiB of text"),
        ] {
            let error = sheet(&book).err().unwrap();
            assert!(
                error.contains(sentence) && error.contains("save its sheet as .csv"),
                "{error}"
            );
        }
    }

    /// Remarks on a cell are not its text.
    #[test]
    fn texts_of_cells_have_blanks_between_their_lines() {
        let book = document(
            "<table-row><table-cell value-type='string'><annotation><p>why</p></annotation><p>a<s/>b</p><p>c</p>\
             </table-cell></table-row><table-row number-rows-repeated='2'>\
             <table-cell value-type='float' value='1' number-columns-repeated='2'/></table-row>",
        );
        assert_eq!(sheet(&book).unwrap().text, "a b c\n1\t1\n1\t1\n");
    }
}
