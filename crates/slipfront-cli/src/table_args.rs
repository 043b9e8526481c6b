//! Options on the format of the table of a measured record.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, value_parser};
use serde::de::DeserializeOwned;
use slipfront_case::table::{DecimalSign, FieldSeparator, TableOptions};

/// How a table is written, where it should not be found.
#[derive(Args)]
pub(crate) struct TableArgs {
    /// Line of the record with the column names, from 1; 0 if there is none [default: detected]
    #[arg(long, value_name = "LINE", requires = "data")]
    header_line: Option<u64>,
    /// Decimal sign of the record [default: detected]
    #[arg(long, value_name = "SIGN", requires = "data",
        value_parser = PossibleValuesParser::new(["point", "comma"]).try_map(named::<DecimalSign>))]
    decimal: Option<DecimalSign>,
    /// Field separator of the record [default: detected]
    #[arg(long, value_name = "NAME", requires = "data",
        value_parser = PossibleValuesParser::new(["comma", "semicolon", "tab", "blank"]).try_map(named::<FieldSeparator>))]
    separator: Option<FieldSeparator>,
    /// Part of the record, from 1, if it has several tables below each other, such as the steps of a test
    #[arg(long, value_name = "N", requires = "data", value_parser = value_parser!(u32).range(1..))]
    segment: Option<u32>,
}

/// The sign or separator with this name in files.
fn named<T: DeserializeOwned>(name: String) -> serde_json::Result<T> {
    serde_json::from_value(name.into())
}

impl TableArgs {
    pub(crate) fn options(&self) -> TableOptions {
        TableOptions {
            segment: self.segment,
            ..TableOptions::stated(self.header_line, self.decimal, self.separator)
        }
    }
}
