//! Text tables from instruments and programs: measured records, height maps, fields of coefficients.
//!
//! ```text
//! bytes -> text (encoding) -> lines -> fields (separator) -> numbers (decimal sign)
//! ```
//!
//! A [`TableLayout`] is detected from the beginning of a table: its encoding, its separator, its decimal
//! sign, the lines with names and units, and where the numbers begin. It reports what it has detected, and
//! refuses a table that can be read in two ways. A [`TableRows`] then reads line by line.

mod encoding;
mod error;
mod fields;
mod layout;
mod number;
mod rows;
mod segments;

pub use encoding::Encoding;
pub use error::TableError;
pub use layout::{DecimalSign, FieldSeparator, HEAD_BYTES, NamedLine, TableLayout, TableOptions};
pub use number::{clock_time, has_thousands, number};
pub use rows::TableRows;
pub use segments::segment;
