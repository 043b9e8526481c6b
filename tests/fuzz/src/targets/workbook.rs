//! Parts of workbooks. The archive around them is made here, since a mutation inside of it would fail at its
//! checksum.

use std::io::Write;
use std::path::Path;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use slipfront_case::table::TableOptions;
use slipfront_run::measured::{Column, Measure, MeasuredRecord};

use crate::checks::readable;
use crate::long::{many, nested};
use crate::target::{Memory, Target, Time};

/// XML of the parts of an `.xlsx`, the first of which is also taken as the content of an `.ods`.
pub(crate) const WORKBOOK: Target = Target {
    name: "workbook",
    check: workbook,
    generated,
    files: &[],
    dictionary: Some("table.dict"),
    max_bytes: 4096,
    // The text of a workbook has 2^26 bytes at most, in memory twice as it grows. The longest piece of XML
    // has 2^20 bytes, and an attribute, `a=''`, takes 40 for its five.
    memory: Memory {
        bytes: 224 << 20,
        per_byte: 16,
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
        "<worksheet><sheetData><row><c t=\"s\"><v>1</v></c><c t=\"s\"><v>0</v></c></row><row><c><v>1</v></c><c s=\"1\"><v>0.05</v></c></row>\
         <row><c><v>2</v></c><c s=\"2\"><v>0.06</v></c></row></sheetData></worksheet>\x1c\
         <sst><si><r><t>mu</t></r><rPh><t>x</t></rPh></si><si><t>t</t></si></sst>\x1c\
         <styleSheet><numFmts><numFmt numFmtId=\"164\" formatCode=\"0.0%\"/></numFmts>\
         <cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"9\"/><xf numFmtId=\"164\"/></cellXfs></styleSheet>\x1c\
         <workbook><sheets><sheet name=\"S\" id=\"1\"/><sheet name=\"Z\" id=\"2\"/></sheets></workbook>",
        "<o><spreadsheet><table><table-header-rows><table-row><table-cell value-type=\"string\"><p>t<s/>1</p><annotation><p>a</p></annotation>\
         </table-cell></table-row></table-header-rows><table-row number-rows-repeated=\"3\"><table-cell value-type=\"time\" time-value=\"PT1S\"/>\
         <table-cell value-type=\"percentage\" value=\"0.1\"/></table-row></table></spreadsheet></o>",
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
        many(
            "<spreadsheet><table><table-row number-rows-repeated='1000000'><table-cell value-type='string'>",
            "<p/>",
            "</table-cell></table-row></table></spreadsheet>",
        ),
        many(
            "<spreadsheet><table><table-row number-rows-repeated='1000000'>",
            "<table-cell/>",
            "</table-row></table></spreadsheet>",
        ),
        many("<a>", "<b c='' d='' e='' f='' g='' h='' i='' j='' k=''/>", "</a>"),
        nested("\x1c<sst>", "<si>", "<t>x</t>", "</si>", "</sst>"),
        many("\x1c<sst>", "<si><t>#</t></si>", "</sst>"),
        many(
            "<worksheet><sheetData><row>",
            "<c t='s'><v>0</v></c>",
            &format!(
                "</row></sheetData></worksheet>\x1c<sst><si><t>{}</t></si></sst>",
                "x".repeat(100_000)
            ),
        ),
        many(
            "\x1c<sst/>\x1c<styleSheet><numFmts>",
            "<numFmt numFmtId='#' formatCode='0'/>",
            "</numFmts></styleSheet>",
        ),
        many(
            "\x1c<sst/>\x1c<styleSheet><cellXfs>",
            "<xf numFmtId='#'/>",
            "</cellXfs></styleSheet>",
        ),
        many(
            "<worksheet/>\x1c<sst/>\x1c<styleSheet/>\x1c<workbook><sheets>",
            "<sheet name='S' id='1'/>",
            "</sheets></workbook>",
        ),
        many(
            "<worksheet/>\x1c<sst/>\x1c<styleSheet/>\x1c<workbook/>\x1c<Relationships>",
            "<Relationship Id='#' Target='a'/>",
            "</Relationships>",
        ),
    ]
}

/// An archive of compressed files.
fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    for (name, content) in files {
        let file = archive
            .new_file(name)
            .compression_method(CompressionMethod::DEFLATE);
        let (mut entry, config) = file.start().expect("memory takes what is written");
        let mut writer = config.wrap(DeflateEncoder::new(&mut entry, Compression::fast()));
        writer.write_all(content).expect("memory takes what is written");
        let (deflate, descriptor) = writer.finish().expect("memory takes what is written");
        deflate.finish().expect("memory takes what is written");
        entry.finish(descriptor).expect("memory takes what is written");
    }
    archive.finish().expect("memory takes what is written");
    bytes
}

/// Sign between the parts of an input: a sheet, the shared texts, the styles, the list of sheets, the links
/// to their files, and a second sheet.
const SEPARATOR: char = '\u{1c}';
/// Names of the parts in an `.xlsx`, and what they have if the input ends before them.
const PARTS: [(&str, &str); 6] = [
    ("xl/worksheets/sheet1.xml", ""),
    ("xl/sharedStrings.xml", "<sst><si><t>t</t></si></sst>"),
    (
        "xl/styles.xml",
        "<styleSheet><cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"22\"/></cellXfs></styleSheet>",
    ),
    (
        "xl/workbook.xml",
        "<workbook xmlns:r=\"r\"><sheets><sheet name=\"S\" r:id=\"1\"/></sheets></workbook>",
    ),
    (
        "xl/_rels/workbook.xml.rels",
        "<Relationships><Relationship Id=\"1\" Target=\"worksheets/sheet1.xml\"/>\
         <Relationship Id=\"2\" Target=\"worksheets/sheet2.xml\"/></Relationships>",
    ),
    ("xl/worksheets/sheet2.xml", "<worksheet/>"),
];

/// A record that is read goes forwards, with a finite friction for each of its places.
fn workbook(input: &[u8]) {
    let mut pieces = input.split(|byte| *byte == SEPARATOR as u8);
    let parts = PARTS.map(|(name, without)| (name, pieces.next().unwrap_or(without.as_bytes())));
    let open_document = archive(&[("content.xml", parts[0].1)]);
    let [x, y] = [("1", "s"), ("2", "1")].map(|(name, unit)| Column {
        name: name.to_owned(),
        unit: Some(unit.to_owned()),
    });
    for book in [archive(&parts), open_document] {
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
