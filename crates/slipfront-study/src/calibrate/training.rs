//! Training: runs of the model over the ranges of the unknowns, of which curves without noise are kept.

use rayon::prelude::*;
use slipfront::RunError;
use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::{CaseError, Override};
use slipfront_run::run_curve::run_curve_unless;

use super::grid::Grid;
use super::unknowns::{Unknown, design_point};
use crate::study_file::Base;

/// How one record was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Conditions {
    /// Keys in which the record differs from the case, such as its speed.
    pub overrides: Vec<Override>,
    /// Where friction is known.
    pub grid: Grid,
}

/// What a training is made of.
#[derive(Clone, Debug)]
pub struct SetUp {
    /// The case.
    pub base: Base,
    /// The keys that are looked for.
    pub unknowns: Vec<Unknown>,
    /// The records.
    pub conditions: Vec<Conditions>,
}

/// Why there is no training.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum TrainingError {
    #[error("the unknowns {point}: {source}")]
    Case { point: String, source: Box<CaseError> },
    #[error("the unknowns {point}: {source}; narrow the ranges")]
    Run { point: String, source: RunError },
    #[error(
        "the unknowns {point}: the run ends before record {record} does, or its friction is no force along the drive: \
         set `time.duration` to the length of the record"
    )]
    Short { point: String, record: usize },
}

/// Curves of runs over the ranges of the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Training {
    /// Shares of the ranges, for every run.
    pub(crate) points: Vec<Vec<f64>>,
    /// Friction without noise: for every run, that of every record.
    pub(crate) curves: Vec<Vec<Vec<f64>>>,
}

impl SetUp {
    /// The curves of all records at these shares of the ranges, over the surface that `friction.seed` draws; none if `ends` gave them up.
    ///
    /// # Errors
    /// When the case is none there, the run diverges, or it ends before a record.
    pub fn curves(
        &self,
        shares: &[f64],
        seed: u64,
        ends: &(dyn Fn() -> bool + Sync),
    ) -> Option<Result<Vec<Vec<f64>>, TrainingError>> {
        let point = || {
            let values = self.unknowns.iter().zip(shares);
            let values: Vec<String> = values
                .map(|(unknown, &share)| unknown.set_to(share).to_string())
                .collect();
            values.join(", ")
        };
        let mut changes: Vec<Override> = self
            .unknowns
            .iter()
            .zip(shares)
            .map(|(unknown, &share)| unknown.set_to(share))
            .collect();
        changes.push(Override::new("friction.seed", &toml::Value::from(seed as i64)));
        let mut curves = Vec::new();
        for (number, conditions) in self.conditions.iter().enumerate() {
            let all: Vec<&Override> = conditions.overrides.iter().chain(&changes).collect();
            let case = self.base.parse().and_then(|base| {
                let file = base.with(&all)?;
                Case::new(file, "training", &self.base.folder, &mut |_| true, Ranks::ALONE)
            });
            let case = match case {
                Ok(case) => case,
                Err(source) => {
                    return Some(Err(TrainingError::Case {
                        point: point(),
                        source: Box::new(source),
                    }));
                }
            };
            let curve = match run_curve_unless(&case, ends)? {
                Ok(curve) => curve,
                Err(source) => {
                    return Some(Err(TrainingError::Run {
                        point: point(),
                        source,
                    }));
                }
            };
            let Some(curve) = conditions.grid.curve(&curve) else {
                return Some(Err(TrainingError::Short {
                    point: point(),
                    record: number + 1,
                }));
            };
            curves.push(curve);
        }
        Some(Ok(curves))
    }
}

impl Training {
    /// Runs so many points of the ranges, each over a surface of its own, on rayon's threads; none if `ends` gave it up.
    ///
    /// # Errors
    /// Those of [`SetUp::curves`], of the first run that has one.
    pub fn run(
        set_up: &SetUp,
        runs: usize,
        ends: &(dyn Fn() -> bool + Sync),
    ) -> Option<Result<Self, TrainingError>> {
        let points: Vec<Vec<f64>> = (0..runs)
            .map(|run| design_point(run, set_up.unknowns.len()))
            .collect();
        let curves: Option<Vec<_>> = points
            .par_iter()
            .enumerate()
            .with_max_len(1)
            .map(|(run, point)| set_up.curves(point, 1 + run as u64, ends))
            .collect();
        let curves: Result<Vec<_>, _> = curves?.into_iter().collect();
        Some(curves.map(|curves| Self { points, curves }))
    }

    /// The training as bytes, to be kept.
    ///
    /// ```text
    /// runs, unknowns, records, values of every record: u64; then of every run its shares and its curves: f64; all little-endian
    /// ```
    pub fn to_bytes(&self) -> Vec<u8> {
        let lengths = self
            .curves
            .first()
            .map_or_else(Vec::new, |curves| curves.iter().map(Vec::len).collect());
        let unknowns = self.points.first().map_or(0, Vec::len);
        let head = [self.points.len(), unknowns, lengths.len()];
        let mut bytes: Vec<u8> = head
            .iter()
            .chain(&lengths)
            .flat_map(|&count| (count as u64).to_le_bytes())
            .collect();
        for (point, curves) in self.points.iter().zip(&self.curves) {
            let numbers = point.iter().chain(curves.iter().flatten());
            bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
        }
        bytes
    }

    /// A training that was kept; none if these are not the bytes of one.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (words, []) = bytes.as_chunks() else {
            return None;
        };
        let count = |k: usize| usize::try_from(u64::from_le_bytes(*words.get(k)?)).ok();
        let [runs, unknowns, records] = [count(0)?, count(1)?, count(2)?];
        let begin = records.checked_add(3).filter(|&begin| begin <= words.len())?;
        let lengths: Vec<usize> = (3..begin).map(count).collect::<Option<_>>()?;
        let row = lengths
            .iter()
            .try_fold(unknowns, |sum, &length| sum.checked_add(length))?;
        if row.checked_mul(runs)? != words.len() - begin || row == 0 {
            return None;
        }
        let mut training = Self {
            points: Vec::new(),
            curves: Vec::new(),
        };
        for words in words[begin..].chunks_exact(row) {
            let mut numbers = words.iter().map(|word| f64::from_le_bytes(*word));
            training.points.push(numbers.by_ref().take(unknowns).collect());
            let curves = lengths
                .iter()
                .map(|&length| numbers.by_ref().take(length).collect());
            training.curves.push(curves.collect());
        }
        Some(training)
    }
}
