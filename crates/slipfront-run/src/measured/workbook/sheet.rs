//! A sheet of a workbook as a table of text.

use std::borrow::Cow;

use slipfront_base::text::truncated;

use super::archive::Budget;

/// Largest numbers of rows and columns of a sheet in both formats.
const PLACES_MAX: [usize; 2] = [1 << 20, 1 << 14];

/// A sheet of a workbook as text.
#[derive(Default)]
pub(in crate::measured) struct Sheet {
    /// Name of the sheet.
    pub(in crate::measured) name: String,
    /// Rows of the sheet as lines, starting with row 1, with tabs between columns.
    pub(in crate::measured) text: String,
    /// For each column, whether it has numbers that are not shown as percentages, and numbers that are: these
    /// are stored as shares of 1.
    pub(in crate::measured) shown: Vec<[bool; 2]>,
    /// Number of complete rows, and numbers of columns and of numbers in the incomplete one.
    at: [usize; 2],
    n_numbers: usize,
    /// Number of cells in the incomplete row.
    n_cells: usize,
    /// Where the incomplete row starts in the text.
    row_start: usize,
    /// Number of rows with two numbers or more.
    pub(super) n_rows: usize,
}

/// How a cell is shown.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Shown {
    Number,
    Percentage,
    Time,
    Text,
}

impl Sheet {
    /// A sheet without cells.
    pub(super) fn new(name: String) -> Self {
        Self {
            name,
            ..Self::default()
        }
    }

    /// Adds a cell after all previous ones; its row and column count from 0.
    pub(super) fn add(
        &mut self,
        budget: &mut Budget,
        [row, column]: [usize; 2],
        cell: Option<(&str, Shown)>,
    ) -> Result<(), String> {
        if [row, column] < self.at || row >= PLACES_MAX[0] || column >= PLACES_MAX[1] {
            let name = truncated(&self.name);
            return Err(format!("sheet {name:?} has its cells in disorder"));
        }
        let text = match cell {
            Some((days, Shown::Time)) => Cow::Owned(clock_text(days)?),
            // Tabs and ends of lines separate fields here.
            Some((text, Shown::Text)) => text.replace(|sign: char| sign.is_control(), " ").into(),
            cell => Cow::Borrowed(cell.map_or("", |(text, _)| text)),
        };
        let first = if row == self.at[0] { self.at[1] } else { 0 };
        budget.take(1, row - self.at[0] + column - first + text.len())?;
        while self.at[0] < row {
            self.end_row();
        }
        self.text.extend(std::iter::repeat_n('\t', column - self.at[1]));
        self.at[1] = column;
        self.n_cells += 1;
        self.text.push_str(&text);
        if let Some((_, shown)) = cell.filter(|(_, shown)| *shown != Shown::Text) {
            self.n_numbers += 1;
            if self.shown.len() <= column {
                self.shown.resize(column + 1, [false; 2]);
            }
            self.shown[column][usize::from(shown == Shown::Percentage)] = true;
        }
        Ok(())
    }

    /// Repeats the row with this number, counted from 0, so that it is there `times` times, if it has cells.
    pub(super) fn repeat_row(&mut self, budget: &mut Budget, row: usize, times: usize) -> Result<(), String> {
        if self.at[0] != row || self.n_cells == 0 {
            return Ok(());
        }
        let more = times.saturating_sub(1);
        if more >= PLACES_MAX[0] - row {
            let name = truncated(&self.name);
            return Err(format!("sheet {name:?} has more than {} rows", PLACES_MAX[0]));
        }
        let (line, counts) = (
            self.text[self.row_start..].to_owned(),
            (self.n_cells, self.n_numbers, self.at[1]),
        );
        budget.take(more * counts.0, more.saturating_mul(line.len() + 1))?;
        for _ in 0..more {
            self.end_row();
            self.text.push_str(&line);
            (self.n_cells, self.n_numbers, self.at[1]) = counts;
        }
        Ok(())
    }

    pub(super) fn end_row(&mut self) {
        self.text.push('\n');
        self.n_rows += usize::from(self.n_numbers > 1);
        (self.at, self.n_cells, self.n_numbers) = ([self.at[0] + 1, 0], 0, 0);
        self.row_start = self.text.len();
    }
}

/// A number of days as hours, minutes and seconds, to a microsecond, which is the precision of days as a
/// double.
fn clock_text(days: &str) -> Result<String, String> {
    let number = days
        .parse::<f64>()
        .ok()
        .filter(|days| (0.0..DAYS_MAX).contains(days));
    let number = number.ok_or_else(|| format!("a cell has the time {} in days", truncated(days)))?;
    let microseconds = (number * 86_400e6).round() as u64;
    let (seconds, rest) = (microseconds / 1_000_000, microseconds % 1_000_000);
    Ok(format!(
        "{}:{:02}:{:02}.{rest:06}",
        seconds / 3600,
        seconds / 60 % 60,
        seconds % 60
    ))
}

/// The day after the last one of both formats, 9999-12-31, counted from 1900.
const DAYS_MAX: f64 = 2_958_466.0;
