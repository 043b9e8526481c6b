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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use slipfront_run::measured::{Measure, MeasuredRecord};

    use super::*;
    use crate::study_file::StudyFile;

    /// Two speeds of a small slider, along the path of the drive, of so many units of length.
    fn set_up(range: [f64; 2], path: f64) -> SetUp {
        let text = "base.slider.blocks = [6, 6]\nbase.time.duration_star = 60\nbase.drive.v_star = 0.1";
        let base = StudyFile::parse(text, "base", "base", Path::new(""))
            .unwrap()
            .base;
        let unknowns = vec![Unknown::new("friction.r_star", range[0], range[1], false).unwrap()];
        let case = base.parse().unwrap().with(&[]).unwrap();
        let unit = Case::new(case, "", Path::new(""), &mut |_| true, Ranks::ALONE)
            .unwrap()
            .scales
            .displacement();
        let conditions = [0.1, 0.2].map(|speed| {
            let x: Vec<f64> = (0..50).map(|k| path * unit * f64::from(k) / 49.0).collect();
            let record = MeasuredRecord {
                y: x.clone(),
                x,
                along: Measure::Displacement,
                of: Measure::Force,
            };
            Conditions {
                overrides: vec![Override::new("drive.v_star", &toml::Value::from(speed))],
                grid: Grid::of(&record).unwrap(),
            }
        });
        SetUp {
            base,
            unknowns,
            conditions: conditions.into(),
        }
    }

    fn trained(set_up: &SetUp, threads: usize) -> Result<Training, TrainingError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| Training::run(set_up, 6, &|| false)).unwrap()
    }

    #[test]
    fn threads_and_keeping_do_not_change_a_bit() {
        let set_up = set_up([0.4, 0.8], 5.0);
        let one = trained(&set_up, 1).unwrap();
        assert_eq!(one, trained(&set_up, 3).unwrap());
        assert_eq!(one.curves[0].len(), 2);
        assert!(one.curves[0] != one.curves[1] && one.curves[0][0] != one.curves[0][1]);
        let bytes = one.to_bytes();
        assert_eq!(Training::from_bytes(&bytes), Some(one));
        assert_eq!(Training::from_bytes(&bytes[8..]), None);
        assert_eq!(Training::from_bytes(&bytes[..bytes.len() - 1]), None);
        assert_eq!(Training::from_bytes(&[]), None);
    }

    #[test]
    fn what_cannot_be_run_is_told_with_its_unknowns() {
        let told = |range, path| trained(&set_up(range, path), 1).unwrap_err().to_string();
        assert!(told([0.5, 1.0], 50.0).contains("the run ends before record 1 does"));
        let out_of_bounds = told([-3.0, -2.0], 5.0);
        assert!(
            out_of_bounds.starts_with("the unknowns friction.r_star=-2."),
            "{out_of_bounds}"
        );
    }

    #[test]
    fn a_training_is_given_up_when_it_is_told_so() {
        assert!(Training::run(&set_up([0.4, 0.8], 5.0), 6, &|| true).is_none());
    }
}
