//! Data of a figure: numbers, pictures and tables.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::drawing::Drawing;
use crate::number::MeasuredNumber;

/// A table of the report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Name of the table's file.
    pub name: String,
    /// Caption of the table.
    pub caption: String,
    /// Names of the table's columns.
    pub header: Vec<String>,
    /// Rows of the table.
    pub rows: Vec<Vec<String>>,
}

/// A picture of a figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Name of the picture's files.
    pub name: String,
    /// Caption of the picture.
    pub caption: String,
    /// Contents of the picture.
    pub drawing: Drawing,
}

/// All data of a figure.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct FigureData {
    /// Measured numbers by their names within the figure; they decide on the claims.
    pub numbers: BTreeMap<String, MeasuredNumber>,
    /// Pictures.
    pub panels: Vec<Panel>,
    /// Tables.
    pub tables: Vec<Table>,
}

impl FigureData {
    /// The numbers, with names that begin with that of the figure: `fig12.largest_rise`.
    pub(super) fn named_numbers(&self, figure: &str) -> impl Iterator<Item = (String, MeasuredNumber)> {
        let numbers = self.numbers.iter();
        numbers.map(move |(name, number)| (format!("{figure}.{name}"), *number))
    }

    pub(super) fn number(&mut self, name: &str, number: MeasuredNumber) {
        self.numbers.insert(name.to_owned(), number);
    }

    pub(super) fn value(&mut self, name: &str, value: f64) {
        self.number(name, MeasuredNumber::exact(value));
    }

    /// Adds the mean of values, one for each surface.
    pub(super) fn values(&mut self, name: &str, values: &[f64]) {
        self.number(name, MeasuredNumber::from_values(values));
    }

    pub(super) fn panel(&mut self, name: &str, caption: &str, drawing: Drawing) {
        self.panels.push(Panel {
            name: name.to_owned(),
            caption: caption.to_owned(),
            drawing,
        });
    }

    pub(super) fn table<const COLUMNS: usize>(
        &mut self,
        name: &str,
        caption: &str,
        header: [&str; COLUMNS],
        rows: impl IntoIterator<Item = [String; COLUMNS]>,
    ) {
        self.tables.push(Table {
            name: name.to_owned(),
            caption: caption.to_owned(),
            header: header.map(str::to_owned).to_vec(),
            rows: rows.into_iter().map(|row| row.to_vec()).collect(),
        });
    }
}
