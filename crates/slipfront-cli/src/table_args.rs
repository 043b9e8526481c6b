//! Options on the format of the table of a measured record.

use clap::{Args, ValueEnum, value_parser};
use slipfront_case::table::{DecimalSign, FieldSeparator, TableOptions};

/// How a table is written, where it should not be found.
#[derive(Args)]
pub(crate) struct TableArgs {
    /// Line of the record with the column names, from 1; 0 if there is none [default: detected]
    #[arg(long, value_name = "LINE", requires = "data")]
    header_line: Option<u64>,
    /// Decimal sign of the record [default: detected]
    #[arg(long, value_name = "SIGN", requires = "data")]
    decimal: Option<Decimal>,
    /// Field separator of the record [default: detected]
    #[arg(long, value_name = "NAME", requires = "data")]
    separator: Option<Separator>,
    /// Part of the record, from 1, if it has several tables below each other, such as the steps of a test
    #[arg(long, value_name = "N", requires = "data", value_parser = value_parser!(u32).range(1..))]
    segment: Option<u32>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Decimal {
    Point,
    Comma,
}

#[derive(Clone, Copy, ValueEnum)]
enum Separator {
    Comma,
    Semicolon,
    Tab,
    Blank,
}

impl TableArgs {
    pub(crate) fn options(&self) -> TableOptions {
        let decimal = self.decimal.map(|decimal| match decimal {
            Decimal::Point => DecimalSign::Point,
            Decimal::Comma => DecimalSign::Comma,
        });
        let separator = self.separator.map(|separator| match separator {
            Separator::Comma => FieldSeparator::Comma,
            Separator::Semicolon => FieldSeparator::Semicolon,
            Separator::Tab => FieldSeparator::Tab,
            Separator::Blank => FieldSeparator::Blank,
        });
        TableOptions {
            segment: self.segment,
            ..TableOptions::stated(self.header_line, decimal, separator)
        }
    }
}
