//! Sheets of workbooks. The archive around them is made here, since a mutation inside of it would fail at its
//! checksum.

use std::io::Write;
use std::path::Path;

use rawzip::{CompressionMethod, ZipArchiveWriter};
use slipfront_case::table::TableOptions;
use slipfront_run::measured::{Column, Measure, MeasuredRecord};

use crate::checks::readable;
use crate::long::{many, nested};
use crate::target::{Memory, Target, Time};

/// XML of a sheet in an `.xlsx`, and as the content of an `.ods`.
pub(crate) const WORKBOOK: Target = Target {
    name: "workbook",
    check: workbook,
    generated,
    files: &[],
    dictionary: Some("table.dict"),
    max_bytes: 4096,
    // A node of XML takes some 100 bytes, and `<a/>` has four; an empty row or column that a number skips
    // takes a byte, and a sheet has 2^26 at most, in memory twice as it grows.
    memory: Memory {
        bytes: 200 << 20,
        per_byte: 256,
    },
    time: Time::DRAWN,
    mutations: 700,
    repetitions: 20,
    long,
};

fn generated() -> Vec<Vec<u8>> {
    let texts = [
        "<worksheet><sheetData><row r=\"2\"><c r=\"A2\" t=\"s\"><v>0</v></c><c r=\"B2\" t=\"inlineStr\"><is><t>F</t></is></c></row>\
         <row r=\"3\"><c r=\"A3\" s=\"1\"><v>45352.5</v></c><c r=\"B3\"><v>1</v></c></row>\
         <row><c s=\"1\"><v>45352.6</v></c><c><v>2</v></c></row></sheetData></worksheet>",
        "<o xmlns:t=\"a\" xmlns:f=\"b\"><f:spreadsheet><t:table t:name=\"T\"><t:table-row><t:table-cell f:value-type=\"string\">t</t:table-cell></t:table-row>\
         <t:table-row t:number-rows-repeated=\"2\"><t:table-cell f:value-type=\"float\" f:value=\"1\" t:number-columns-repeated=\"2\"/></t:table-row>\
         <t:table-row t:number-rows-repeated=\"1048570\"><t:table-cell/></t:table-row></t:table></f:spreadsheet></o>",
    ];
    texts.iter().map(|text| text.as_bytes().to_vec()).collect()
}

fn long() -> Vec<Vec<u8>> {
    let cells = "<row><c><v>#</v></c><c><v>1</v></c></row>";
    vec![
        many("<sheetData>", cells, "</sheetData>"),
        many("<sheetData><row>", "<c><v>#</v></c>", "</row></sheetData>"),
        many(
            "<sheetData>",
            "<row r=\"#0000\"><c><v>1</v></c><c><v>2</v></c></row>",
            "</sheetData>",
        ),
        nested(
            "<sheetData>",
            "<row>",
            "<c><v>1</v></c>",
            "</row>",
            "</sheetData>",
        ),
        nested(
            "<spreadsheet>",
            "<table><table-row>",
            "<table-cell/>",
            "</table-row></table>",
            "</spreadsheet>",
        ),
        many(
            "<spreadsheet><table>",
            "<table-row number-rows-repeated='#'><table-cell value-type='float' value='1' number-columns-repeated='#'/></table-row>",
            "</table></spreadsheet>",
        ),
    ]
}

/// A stored archive of files.
fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    for (name, content) in files {
        let file = archive
            .new_file(name)
            .compression_method(CompressionMethod::STORE);
        let (mut entry, config) = file.start().expect("memory takes what is written");
        let mut writer = config.wrap(&mut entry);
        writer.write_all(content).expect("memory takes what is written");
        let (_, descriptor) = writer.finish().expect("memory takes what is written");
        entry.finish(descriptor).expect("memory takes what is written");
    }
    archive.finish().expect("memory takes what is written");
    bytes
}

const BOOK: &str = "<workbook xmlns:r=\"r\"><sheets><sheet name=\"S\" r:id=\"1\"/></sheets></workbook>";
const LINKS: &str =
    "<Relationships><Relationship Id=\"1\" Target=\"worksheets/sheet1.xml\"/></Relationships>";
const STRINGS: &str = "<sst><si><t>t</t></si></sst>";
const STYLES: &str = "<styleSheet><cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"22\"/></cellXfs></styleSheet>";

/// A record that is read goes forwards, with a finite friction for each of its places.
fn workbook(input: &[u8]) {
    let office_open = archive(&[
        ("xl/workbook.xml", BOOK.as_bytes()),
        ("xl/_rels/workbook.xml.rels", LINKS.as_bytes()),
        ("xl/sharedStrings.xml", STRINGS.as_bytes()),
        ("xl/styles.xml", STYLES.as_bytes()),
        ("xl/worksheets/sheet1.xml", input),
    ]);
    let open_document = archive(&[("content.xml", input)]);
    let [x, y] = [("1", "s"), ("2", "N")].map(|(name, unit)| Column {
        name: name.to_owned(),
        unit: Some(unit.to_owned()),
    });
    for book in [office_open, open_document] {
        let path = Path::new("record.xlsx");
        match MeasuredRecord::parse(&book, path, [&x, &y], Measure::Time, TableOptions::default()) {
            Err(error) => readable(&error),
            Ok(record) => {
                assert!(record.x.is_sorted() && record.x.len() == record.y.len());
                let mut values = record.x.iter().chain(&record.y);
                assert!(values.all(|value| value.is_finite()));
            }
        }
    }
}
