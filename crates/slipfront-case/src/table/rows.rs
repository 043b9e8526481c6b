//! Reader of the rows of a table.

use std::borrow::Cow;
use std::io::{BufRead, BufReader, Read};

use super::encoding::DecodedText;
use super::error::TableError;
use super::fields::fields;
use super::layout::TableLayout;

/// The rows of numbers of a table, after its lines of names and units, without comments and blank lines.
pub struct TableRows<'l, R: Read> {
    layout: &'l TableLayout,
    text: BufReader<DecodedText<R>>,
    /// Largest length of a line in bytes.
    line_max: u64,
    line: Vec<u8>,
    number: u64,
}

impl<'l, R: Read> TableRows<'l, R> {
    /// The rows of a source at its beginning, with lines of at most `line_max` bytes.
    pub fn new(source: R, layout: &'l TableLayout, line_max: u64) -> Self {
        Self {
            layout,
            text: BufReader::new(layout.encoding.decoded(source)),
            line_max,
            line: Vec::new(),
            number: 0,
        }
    }

    /// The fields of the next row and the number of its line, from 1; none at the end.
    ///
    /// # Errors
    /// When the source fails, a line is too long, a field spans several lines, or a row has more fields than
    /// there are names.
    #[expect(clippy::type_complexity, reason = "a row is a number and its fields")]
    pub fn next_row(&mut self) -> Result<Option<(u64, Vec<Cow<'_, str>>)>, TableError> {
        loop {
            self.line.clear();
            let read = (&mut self.text)
                .take(self.line_max + 1)
                .read_until(b'\n', &mut self.line)?;
            if read == 0 {
                return Ok(None);
            }
            self.number += 1;
            let (line, most) = (self.number, self.line_max);
            if read as u64 > most {
                return Err(TableError::LongLine { line, most });
            }
            let text = self.line.trim_ascii();
            let is_above = line < self.layout.first_line;
            if !is_above && !text.is_empty() && !text.starts_with(b"#") {
                break;
            }
        }
        let line = self.number;
        // Decoded text is UTF-8.
        let text = str::from_utf8(&self.line).unwrap_or_default();
        let text = text.trim_end_matches(['\r', '\n']);
        let mut fields = fields(text, self.layout.separator).map_err(|_| TableError::OpenQuote { line })?;
        self.layout.fit(line, &mut fields)?;
        Ok(Some((line, fields)))
    }
}
