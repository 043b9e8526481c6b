//! What comes of a figure: numbers, pictures and tables.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::drawing::Drawing;
use slipfront_run::study::Sample;

/// Confidence of all intervals.
const CONFIDENCE: f64 = 0.95;

/// A measured number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Number {
    /// The value, or the mean over random surfaces.
    pub value: f64,
    /// The 95 % confidence interval of that mean; none for a single value.
    pub interval: Option<[f64; 2]>,
}

impl Number {
    /// A single value.
    pub fn exact(value: f64) -> Self {
        Self {
            value,
            interval: None,
        }
    }

    /// The mean over random surfaces; not a number of none.
    pub fn of(values: &[f64]) -> Self {
        match Sample::of(values, CONFIDENCE) {
            Some(sample) => Self {
                value: sample.mean,
                interval: sample.interval(),
            },
            None => Self::exact(f64::NAN),
        }
    }

    /// Mean and interval, not a number where there is none: as pictures want them.
    pub(super) fn ends(&self) -> [f64; 3] {
        let [low, high] = self.interval.unwrap_or([f64::NAN; 2]);
        [self.value, low, high]
    }
}

/// A table of the report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Name of its file.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// Names of its columns.
    pub header: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
}

/// A picture of a figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Name of its files.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// What is drawn.
    pub drawing: Drawing,
}

/// Everything that a figure found.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Found {
    /// Numbers that claims are about, by name.
    pub numbers: BTreeMap<String, Number>,
    /// Pictures.
    pub panels: Vec<Panel>,
    /// Tables.
    pub tables: Vec<Table>,
}

impl Found {
    /// Notes a number.
    pub(super) fn number(&mut self, name: &str, number: Number) {
        self.numbers.insert(name.to_owned(), number);
    }

    /// Notes a single value.
    pub(super) fn value(&mut self, name: &str, value: f64) {
        self.number(name, Number::exact(value));
    }

    /// Notes one value for each surface.
    pub(super) fn values(&mut self, name: &str, values: &[f64]) {
        self.number(name, Number::of(values));
    }

    /// Adds a picture.
    pub(super) fn panel(&mut self, name: &str, caption: &str, drawing: Drawing) {
        self.panels.push(Panel {
            name: name.to_owned(),
            caption: caption.to_owned(),
            drawing,
        });
    }
}

/// The largest of some values.
pub(super) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// The smallest of some values.
pub(super) fn smallest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

/// The mean.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The standard deviation about the mean.
pub(super) fn deviation(values: &[f64]) -> f64 {
    let center = mean(values);
    (values.iter().map(|value| (value - center).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// The steps from each value to the next.
pub(super) fn rises(values: &[f64]) -> Vec<f64> {
    values.windows(2).map(|pair| pair[1] - pair[0]).collect()
}
