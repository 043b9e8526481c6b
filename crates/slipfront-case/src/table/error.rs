//! Reasons why a text is not a table of numbers.

use std::io;

use slipfront_base::text::truncated;

/// Reason why a table cannot be read: a sentence that continues after the name of the file.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum TableError {
    #[error("cannot be read: {0}")]
    Read(#[from] io::Error),
    #[error("is {0}, not a text table: save the table as text, such as .csv, and give that file")]
    Binary(&'static str),
    #[error("has {found} fields in line {line} and {names} names in line {header}: {remedy}")]
    TooManyFields {
        header: u64,
        names: usize,
        line: u64,
        found: usize,
        remedy: &'static str,
    },
    #[error(
        "has {names} names in line {header} and {found} fields in line {line}: {remedy}; mend the names, or use none \
         (`header_line` = 0) and give columns by their numbers"
    )]
    TooManyNames {
        header: u64,
        names: usize,
        line: u64,
        found: usize,
        remedy: &'static str,
    },
    #[error("can be read in two ways: {0}")]
    Ambiguous(String),
    #[error(
        "has a thousands separator in line {line}, {}: write the number without it",
        quoted(text)
    )]
    Thousands { line: u64, text: String },
    #[error(
        "has a field that begins in line {line} and spans several lines: remove the quotation mark at its start"
    )]
    OpenQuote { line: u64 },
    #[error("has more than {most} bytes in line {line}: write one row per line")]
    LongLine { line: u64, most: u64 },
    #[error("has {found} segments of rows, so there is no segment {wanted}")]
    NoSegment { wanted: u32, found: usize },
    #[error("has {lines} lines, so there is no line {wanted} with column names")]
    NoHeader { wanted: u64, lines: u64 },
}

fn quoted(text: &str) -> String {
    format!("{:?}", truncated(text))
}
