//! The keys of the table `[instrument]`.

use std::path::Path;

use serde::Deserialize;
use slipfront_case::case_file::{KeyKind, key, names_of, read_text};
use slipfront_case::key_rows;
use slipfront_case::quantity::{Duration, Mass, Rate, Stiffness};
use thiserror::Error;
use toml::Table;

use super::chain::{Filter, Instrument, MOVING_MEAN_CUTOFF};
use crate::measured::Measure;

/// Name of the table in a file.
const TABLE: &str = "instrument";

/// Orders of a Butterworth filter.
const ORDERS: [u32; 2] = [1, 10];

/// Default damping ratio of a load cell: steel with parts screwed to it.
const CELL_DAMPING: f64 = 0.02;

key_rows! {
    /// The table `[instrument]`.
    #[derive(Clone, Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct InstrumentKeys {
        /// Filter of the amplifier or of the program that wrote the record.
        filter: Option<FilterName> = key("", KeyKind::Words(names_of::<FilterName>)).without("none"),
        /// Order of a Butterworth filter.
        order: Option<u32> = key("", KeyKind::Special("1 to 10")).without("2"),
        /// Frequency at which the filter leaves 1/sqrt(2) of an amplitude (-3 dB).
        cutoff: Option<Rate> = key("", KeyKind::Special("1e-18 to 1e18 in SI units")),
        /// In place of `cutoff`: the time constant of a filter of first order, 1/(2 pi `cutoff`), or the
        /// width of a moving mean, 0.443/`cutoff`, which ends at the time of the value.
        time: Option<Duration> = key("", KeyKind::Special("1e-18 to 1e18 in SI units")),
        /// Mass between the slider and the load cell, with half of the cell's own: it swings on the
        /// `stiffness` of the cell.
        mass: Option<Mass> = key("", KeyKind::Special("1e-18 to 1e18 in SI units")).without("none"),
        /// Stiffness of the load cell, which the mount of the case, `drive.total_stiffness`, contains
        /// already.
        stiffness: Option<Stiffness> = key("", KeyKind::Special("1e-18 to 1e18 in SI units")).without("rigid"),
        /// Damping of the load cell over its critical damping.
        damping_ratio: Option<f64> = key("", KeyKind::Special("more than 0, less than 1")).without("0.02"),
        /// Rate at which values were taken, where the table has more rows than that: each value is held until
        /// the next one.
        sampling: Option<Rate> = key("", KeyKind::Special("1e-18 to 1e18 in SI units")).without("that of the rows"),
        /// Factor of the record: its friction over the true one.
        gain: Option<f64> = key("", KeyKind::Special("not 0; its size 1e-18 to 1e18")).without("1"),
        /// Friction of the record without load: a number in N or 1, or a text such as `"20 mN"`.
        offset: Option<Amount> = key("", KeyKind::Special("")).without("0"),
        /// Least and largest value that the instrument writes, such as `["-5 N", "5 N"]`.
        range: Option<[Amount; 2]> = key("", KeyKind::Special("")).without("without bounds"),
    }
}

/// Kind of a filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FilterName {
    FirstOrder,
    Butterworth,
    MovingMean,
}

/// A friction: a number in N or 1, or a text with a unit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number in N or 1, or a string with a unit, such as \"20 mN\""
)]
enum Amount {
    Si(f64),
    WithUnit(String),
}

impl Amount {
    fn value(&self, friction: Measure) -> Result<f64, String> {
        match self {
            Self::Si(value) => Ok(*value),
            Self::WithUnit(text) => friction.parse(text),
        }
    }
}

/// Reason why an instrument is not valid.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum InstrumentError {
    #[error("`instrument`: {0}")]
    Table(String),
    #[error("`{key}` of the instrument: {why}")]
    Key { key: &'static str, why: String },
    #[error("{0}")]
    File(String),
}

fn refuse<T>(key: &'static str, why: impl Into<String>) -> Result<T, InstrumentError> {
    let why = why.into();
    Err(InstrumentError::Key { key, why })
}

/// Bounds of numbers in SI units: far beyond any instrument, and near enough to 1 for a filter of the tenth
/// order over any time to stay finite.
const BOUNDS: std::ops::RangeInclusive<f64> = 1e-18..=1e18;

/// A number within the bounds.
fn positive(key: &'static str, value: f64) -> Result<f64, InstrumentError> {
    if BOUNDS.contains(&value) {
        return Ok(value);
    }
    let [least, most] = [BOUNDS.start(), BOUNDS.end()];
    refuse(
        key,
        format!("{value:e} in SI units must lie between {least:e} and {most:e}"),
    )
}

/// A number within the bounds, if there is one.
fn optional(key: &'static str, value: Option<f64>) -> Result<Option<f64>, InstrumentError> {
    value.map(|value| positive(key, value)).transpose()
}

impl InstrumentKeys {
    /// Keys of a table.
    ///
    /// # Errors
    /// When a key is unknown, or its value has another type.
    pub fn from_table(table: &Table) -> Result<Self, InstrumentError> {
        let read = table.clone().try_into();
        read.map_err(|error: toml::de::Error| InstrumentError::Table(error.message().to_owned()))
    }

    /// The table `[instrument]` of a file of any kind, such as a calibration file.
    ///
    /// # Errors
    /// When the file cannot be read or has no such table.
    pub fn load(path: &Path) -> Result<Self, InstrumentError> {
        let text = read_text(path).map_err(|error| InstrumentError::File(error.to_string()))?;
        let file = |why: String| InstrumentError::File(format!("{}: {why}", path.display()));
        let table = text.parse::<Table>().map_err(|error| file(error.to_string()))?;
        match table.get(TABLE).and_then(toml::Value::as_table) {
            Some(table) => Self::from_table(table).map_err(|error| file(error.to_string())),
            None => Err(file(format!("there is no table [{TABLE}]"))),
        }
    }

    /// The instrument, for records of this quantity of friction.
    ///
    /// # Errors
    /// When a value is out of bounds, or keys cannot be combined.
    pub fn instrument(&self, friction: Measure) -> Result<Instrument, InstrumentError> {
        let sampling = optional("sampling", self.sampling.as_ref().map(Rate::si))?;
        let gain = self.gain.unwrap_or(1.0);
        if gain == 0.0 {
            return refuse("gain", "0 removes the whole friction signal");
        }
        positive("gain", gain.abs())?;
        let amount = |key: &'static str, amount: &Amount| {
            let value = amount.value(friction).or_else(|why| refuse(key, why))?;
            if value != 0.0 {
                positive(key, value.abs())?;
            }
            Ok(value)
        };
        let offset = self
            .offset
            .as_ref()
            .map_or(Ok(0.0), |offset| amount("offset", offset))?;
        let range = match &self.range {
            Some([low, high]) => Some([amount("range", low)?, amount("range", high)?]),
            None => None,
        };
        if let Some([low, high]) = range
            && low >= high
        {
            return refuse(
                "range",
                format!("it goes from {low} to {high}: give the smaller one first"),
            );
        }
        Ok(Instrument {
            cell: self.cell()?,
            filter: self.filter()?,
            sampling,
            gain,
            offset,
            range,
        })
    }

    /// Undamped frequency and damping ratio of the load cell.
    fn cell(&self) -> Result<Option<[f64; 2]>, InstrumentError> {
        let (mass, stiffness) = match (&self.mass, &self.stiffness) {
            (Some(mass), Some(stiffness)) => (mass.si(), stiffness.si()),
            (Some(_), None) => {
                return refuse(
                    "mass",
                    "it oscillates on the load cell: also give the `stiffness` of the load cell",
                );
            }
            (None, Some(_)) => return refuse("stiffness", "a stiffness needs a `mass`: give it as well"),
            (None, None) if self.damping_ratio.is_some() => {
                return refuse(
                    "damping_ratio",
                    "it belongs to the load cell: also give its `mass` and `stiffness`",
                );
            }
            (None, None) => return Ok(None),
        };
        let (mass, stiffness) = (positive("mass", mass)?, positive("stiffness", stiffness)?);
        let damping = self.damping_ratio.unwrap_or(CELL_DAMPING);
        if !(damping > 0.0 && damping < 1.0) {
            return refuse(
                "damping_ratio",
                format!("{damping} must be more than 0 and less than 1"),
            );
        }
        Ok(Some([(stiffness / mass).sqrt() / std::f64::consts::TAU, damping]))
    }

    fn filter(&self) -> Result<Option<Filter>, InstrumentError> {
        let cutoff = optional("cutoff", self.cutoff.as_ref().map(Rate::si))?;
        let time = optional("time", self.time.as_ref().map(Duration::si))?;
        let Some(filter) = self.filter else {
            let given = [
                ("cutoff", cutoff.is_some()),
                ("time", time.is_some()),
                ("order", self.order.is_some()),
            ];
            return match given.into_iter().find(|(_, is_given)| *is_given) {
                Some((key, _)) => refuse(
                    key,
                    "it belongs to a `filter`: give one, such as `filter = \"first_order\"`",
                ),
                None => Ok(None),
            };
        };
        if self.order.is_some() && filter != FilterName::Butterworth {
            return refuse("order", "only a Butterworth filter has an order");
        }
        let [least, most] = ORDERS;
        let order = self.order.unwrap_or(2);
        if !(least..=most).contains(&order) {
            return refuse("order", format!("{order} must lie between {least} and {most}"));
        }
        let by_frequency = |cutoff: f64| match filter {
            FilterName::FirstOrder => Filter::FirstOrder(1.0 / (std::f64::consts::TAU * cutoff)),
            FilterName::Butterworth => Filter::Butterworth(order, cutoff),
            FilterName::MovingMean => Filter::MovingMean(MOVING_MEAN_CUTOFF / cutoff),
        };
        match (cutoff, time, filter) {
            (Some(_), Some(_), _) => refuse("time", "`cutoff` sets the same quantity: give one of them"),
            (Some(cutoff), None, _) => Ok(Some(by_frequency(cutoff))),
            (None, Some(_), FilterName::Butterworth) => refuse("time", "a Butterworth filter has a `cutoff`"),
            (None, Some(time), FilterName::FirstOrder) => Ok(Some(Filter::FirstOrder(time))),
            (None, Some(time), FilterName::MovingMean) => Ok(Some(Filter::MovingMean(time))),
            (None, None, _) => refuse("filter", "give its `cutoff`, such as `cutoff = \"20 Hz\"`"),
        }
    }
}
