//! Results of a calibration, as numbers.

use serde::Serialize;
use slipfront_base::number_format::four_digits;

use crate::calibration::Estimate;
use crate::distribution::Distribution;
use crate::record_check::RecordCheck;
use slipfront_study::Unknown;
use slipfront_study::unknown::with_unit;

/// Probability of the intervals.
pub(crate) const CONFIDENCE: f64 = 0.9;

/// Content of `calibration.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Findings {
    /// Runs of the training.
    pub(crate) runs: usize,
    /// Standard deviation of the noise for which records were estimated, as a share of their mean friction.
    pub(crate) noise: f64,
    /// The unknown keys.
    pub(crate) unknowns: Vec<UnknownEstimate>,
    /// Pairs of unknowns that are determined only together.
    pub(crate) pairs: Vec<CoupledUnknowns>,
    /// Tests of whether the model can have made the records.
    #[serde(flatten)]
    pub(crate) check: RecordCheck,
    /// The instrument and the records.
    pub(crate) instrument: InstrumentFindings,
    /// Whether the model cannot have made the records.
    pub(crate) is_refused: bool,
    /// Share of the values of each record that lie within the band of the calibrated model, %.
    pub(crate) within_band_percent: Vec<f64>,
    /// Divisor of the time step for the finer one.
    pub(crate) finer_step: u32,
    /// Results on blocks of half the size.
    pub(crate) finer: OnFinerBlocks,
    /// Reduction of the intervals by further experiments.
    pub(crate) next: Vec<Further>,
    pub(crate) version: &'static str,
}

/// Bandwidth of the instrument, and frequencies and noise of the records.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct InstrumentFindings {
    /// Frequency up to which the instrument passes friction; none without filter, load cell and sampling.
    pub(crate) bandwidth_hz: Option<f64>,
    /// Frequency of a sinusoid with the range and the fastest rate of change of the record; none for records
    /// over displacement, or of noise alone.
    pub(crate) fastest_swing_hz: Option<f64>,
    /// Noise of every record, estimated from the scatter of neighbouring values, % of mean friction.
    pub(crate) noise_percent: Vec<f64>,
}

/// An unknown, as estimated from the records, in its own unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct UnknownEstimate {
    pub(crate) key: String,
    /// Range of the unknown.
    pub(crate) range: [f64; 2],
    pub(crate) unit: Option<String>,
    pub(crate) median: f64,
    /// Interval that contains the unknown with a probability of 90 %.
    pub(crate) interval: [f64; 2],
    /// Whether the records determine the unknown: the interval is less than 0.8 of the range.
    pub(crate) is_determined: bool,
    /// Median and interval on blocks of half the size.
    pub(crate) on_finer_blocks: Option<(f64, [f64; 2])>,
    /// Whether the median on blocks of half the size lies beyond the interval.
    pub(crate) belongs_to_block: bool,
    /// Median at the finer time step.
    pub(crate) at_finer_step: f64,
    /// Whether the median at the finer time step lies beyond the interval.
    pub(crate) depends_on_step: bool,
}

/// Two unknowns that are determined only together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct CoupledUnknowns {
    pub(crate) keys: [String; 2],
    pub(crate) correlation: f64,
}

/// Runs on blocks of half the size.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum OnFinerBlocks {
    /// Number of training runs.
    Runs(usize),
    /// No runs, because the file asks for none.
    NotAskedFor,
    /// No runs, for the given reason.
    Impossible(String),
}

/// An experiment that may be made next.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Further {
    /// The keys in which the experiment differs from the case.
    pub(crate) set: String,
    /// Ratio of the width of the interval with this experiment to the width without, for every unknown.
    pub(crate) narrowed_to: Vec<f64>,
}

impl UnknownEstimate {
    pub(crate) fn new(unknown: &Unknown, estimate: &Estimate, number: usize) -> Self {
        let (median, interval) = in_its_unit(unknown, &estimate.distributions[number]);
        Self {
            key: unknown.key().to_owned(),
            range: [0.0, 1.0].map(|share| unknown.at(share)),
            unit: unknown.unit().map(str::to_owned),
            median,
            interval,
            is_determined: !estimate.undetermined.contains(&number),
            on_finer_blocks: None,
            belongs_to_block: false,
            at_finer_step: median,
            depends_on_step: false,
        }
    }

    /// Adds the median at the finer time step: records at that step shift the estimate by `moved`, a share of
    /// the range.
    pub(crate) fn hold_against_finer_step(&mut self, unknown: &Unknown, moved: f64) {
        let [low, high] = self.interval;
        self.at_finer_step = unknown.at(unknown.share_of(self.median) - moved);
        self.depends_on_step = self.is_determined && !(low..=high).contains(&self.at_finer_step);
    }

    /// Adds the results on blocks of half the size.
    pub(crate) fn hold_against(&mut self, unknown: &Unknown, finer: &Distribution) {
        let (median, interval) = in_its_unit(unknown, finer);
        let [low, high] = self.interval;
        self.belongs_to_block = self.is_determined && !(low..=high).contains(&median);
        self.on_finer_blocks = Some((median, interval));
    }

    /// A value of the unknown with its unit, as a string.
    pub(crate) fn text(&self, value: f64) -> String {
        with_unit(four_digits(value), self.unit.as_deref())
    }
}

/// Median and interval of an unknown.
fn in_its_unit(unknown: &Unknown, distribution: &Distribution) -> (f64, [f64; 2]) {
    let interval = distribution.interval(CONFIDENCE);
    (
        unknown.at(distribution.quantile(0.5)),
        interval.map(|share| unknown.at(share)),
    )
}
