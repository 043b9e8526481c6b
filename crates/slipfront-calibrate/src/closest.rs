//! Search for the curve of the model that is closest to the records, if the unknowns determine the curve:
//! without random coefficients, the residuals between a good record and its closest curve are noise.

use serde::Serialize;
use slipfront_regression::least_squares;
use slipfront_study::StudyError;
use slipfront_study::adaptive_search::Adaptation;
use slipfront_study::draws::Draws;
use slipfront_study::statistics::mean;

use crate::features::deviation;
use crate::predicted::rms_difference;
use crate::progress::CalibrationStage;
use crate::runs::{RunMaker, Runs};
use crate::set_up::{Curves, MOST_HALVINGS, SetUp};
use crate::synthetic_noise::{Stream, draws};

/// Number of the surface of the first run; without random coefficients all surfaces are equal.
const FIRST_SURFACE: u64 = 1;

/// Largest accepted ratio of the residuals to the noise that the file states: if the noise is larger than
/// stated, the intervals are too narrow.
const MOST_NOISE: f64 = 1.2;

/// Largest accepted correlation of neighbouring residuals, in standard errors. The correlation of noise alone
/// exceeds half of that one time in 40; the rest allows for a search that ends near the closest curve.
const MOST_CORRELATED: f64 = 4.0;

/// Ratio of residuals to noise over a part of the records at which a search goes on to the next part.
const NEAR: f64 = 1.5;

/// Shares of the records, from their beginning, over which curves are compared one after the other: if the
/// phases of stick-slip agree over a part, they nearly agree over a part twice as long.
const PARTS: [f64; 4] = [0.125, 0.25, 0.5, 1.0];

/// Largest difference of a curve from that at the finest time step, in units of the noise, for a step that is
/// fine enough; and the number of points of the ranges at which it is tested. Slips begin at whole steps, so
/// a coarse step shifts their phases.
const STEP_ERROR: f64 = 0.25;
const STEP_POINTS: usize = 5;

/// Largest number of halvings of the time step for whole searches. At still finer steps, the search only
/// refines a curve that is already close.
const SEARCHED_HALVINGS: u32 = 5;

/// Number of searches, and runs of a generation.
const SEARCHES: usize = 5;
const DRAFTS: usize = 24;

/// Increment of a search variable for the finite difference of a derivative, in units of its initial standard
/// deviation.
const BESIDE: f64 = 0.02;

/// Damping factors of a Levenberg-Marquardt step, as shares of the squared derivatives.
const DAMPING: [f64; 3] = [1e-6, 0.1, 10.0];

/// Number of generations without progress after which a search over a part ends, and the least relative
/// decrease of the distance that counts as progress.
const PATIENCE: usize = 5;
const PROGRESS: f64 = 0.002;

/// Largest relative difference of the distances of two searches that have found the same curve.
const SAME: f64 = 0.005;

/// Residuals between the records and the curve of the model that is closest to them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Closest {
    /// Root mean square of the residuals, over the standard deviation of the noise that the file states.
    pub noise_ratio: f64,
    /// Correlation of neighbouring residuals: 0 for white noise.
    pub correlation: f64,
    /// Correlation above which the residuals are not accepted as noise.
    pub most_correlated: f64,
    /// Share of the records, from their beginning, that was compared.
    pub share: f64,
    /// Number of halvings of the time step of the case.
    pub halvings: u32,
}

impl Closest {
    /// Whether the records differ from the model by more than the noise.
    pub fn is_refused(&self) -> bool {
        self.is_noisier() || self.is_correlated()
    }

    /// Whether the residuals are larger than the noise.
    pub fn is_noisier(&self) -> bool {
        self.noise_ratio > MOST_NOISE
    }

    /// Whether the residuals are not white noise.
    pub fn is_correlated(&self) -> bool {
        self.correlation > self.most_correlated
    }

    /// Whether the residuals over the whole records are little more than the noise.
    fn is_nearly_passed(&self) -> bool {
        self.is_refused() && self.share == 1.0 && self.noise_ratio < NEAR
    }

    /// Summary of the residuals of every record, in units of the noise, over this share of the records.
    fn from_residuals(differences: &[Vec<f64>], share: f64, halvings: u32) -> Self {
        let all = differences.iter().flatten();
        let count = all.clone().count() as f64;
        let squares: f64 = all.map(|e| e * e).sum();
        let pairs = differences.iter().flat_map(|e| e.windows(2));
        let products: f64 = pairs.map(|pair| pair[0] * pair[1]).sum();
        Self {
            noise_ratio: (squares / count).sqrt(),
            correlation: products / squares,
            most_correlated: MOST_CORRELATED / count.sqrt(),
            share,
            halvings,
        }
    }

    /// Whether another search ended at the same distance over the same part; then no further one is needed.
    fn agrees_with(&self, other: &Self) -> bool {
        let apart = (self.noise_ratio - other.noise_ratio).abs();
        self.share == other.share && apart < SAME * other.noise_ratio
    }

    /// Whether the curve follows a longer part of the records than another one, or is closer over the same
    /// part.
    fn is_closer_than(&self, other: &Self) -> bool {
        (self.share, -self.noise_ratio) > (other.share, -other.noise_ratio)
    }
}

/// Searches for the closest curve, from points that were drawn from an estimate; none if random coefficients
/// make curves with the same unknowns differ. Returns the result with the set-up at its time step: the step
/// of the case for records that were computed at that step, and otherwise a finer one. `drawn` are points of
/// the ranges; `noise` is the standard deviation of a value of the records, as a share of their mean
/// friction.
///
/// # Errors
/// When a run cannot be made or kept, and after a stop.
pub fn closest(
    maker: &mut RunMaker,
    set_up: &SetUp,
    drawn: &[Vec<f64>],
    records: &[Vec<f64>],
    noise: f64,
) -> Result<Option<(SetUp, Closest)>, StudyError> {
    if set_up.is_random()? {
        return Ok(None);
    }
    let begin = |j: usize| {
        let values: Vec<f64> = drawn.iter().map(|point| point[j]).collect();
        [mean(&values), deviation(&values)]
    };
    let deviations = records.iter().zip(&set_up.conditions);
    let mut search = Search {
        records,
        deviations: deviations
            .map(|(record, conditions)| conditions.grid.deviation(record, noise))
            .collect(),
        begin: (0..set_up.unknowns.len()).map(begin).collect(),
        maker,
    };
    let (mut set_up, mut found) = (set_up.clone(), search.closest(set_up)?);
    if found.closest.is_refused() {
        let fine = fine_enough(search.maker, &set_up, drawn, noise)?;
        if fine.halvings == set_up.halvings {
            return Ok(Some((set_up, found.closest)));
        }
        (found, set_up) = (search.closest(&fine)?, fine);
    }
    // The phases of slips may still shift by the remaining error of the time step.
    while found.closest.is_nearly_passed() && set_up.halvings < MOST_HALVINGS {
        set_up = set_up.halved(1);
        let whole = Part::new(&set_up, 1.0);
        let begin = search.judge(&whole, vec![found.numbers])?;
        found = search.descend(&whole, begin)?;
    }
    Ok(Some((set_up, found.closest)))
}

/// The set-up with the largest time step at which curves differ from those at the finest step by less than
/// the noise.
fn fine_enough(
    maker: &mut RunMaker,
    set_up: &SetUp,
    drawn: &[Vec<f64>],
    noise: f64,
) -> Result<SetUp, StudyError> {
    let points = &drawn[..drawn.len().min(STEP_POINTS)];
    let mut curves = |set_up: &SetUp| {
        let runs = Runs::new(set_up, points, FIRST_SURFACE);
        maker.curves(CalibrationStage::Closest, &runs)
    };
    let finest = set_up.halved(SEARCHED_HALVINGS);
    let of_finest = curves(&finest)?;
    let is_same = |(one, other): (&Curves, &Curves)| {
        let mut records = one.iter().zip(other).zip(&set_up.conditions);
        records.all(|((one, other), conditions)| {
            rms_difference(one, other) < STEP_ERROR * conditions.grid.deviation(other, noise)
        })
    };
    for times in 0..SEARCHED_HALVINGS {
        let coarse = set_up.halved(times);
        if curves(&coarse)?.iter().zip(&of_finest).all(is_same) {
            return Ok(coarse);
        }
    }
    Ok(finest)
}

/// Search for the closest curve.
struct Search<'a, 'm> {
    records: &'a [Vec<f64>],
    /// Standard deviation of the noise of every record.
    deviations: Vec<f64>,
    maker: &'a mut RunMaker<'m>,
    /// Mean and standard deviation of every unknown from which a search begins.
    begin: Vec<[f64; 2]>,
}

/// A curve with the search variables that produce it.
#[derive(Clone)]
struct Found {
    numbers: Vec<f64>,
    /// Residuals of every record in units of the noise.
    differences: Vec<Vec<f64>>,
    closest: Closest,
}

impl Search<'_, '_> {
    /// The closest curve of a set-up. No further search begins once the residuals are noise.
    fn closest(&mut self, set_up: &SetUp) -> Result<Found, StudyError> {
        let mut best = self.from(set_up, 0)?;
        let mut before = vec![best.closest];
        for number in 1..SEARCHES {
            if !best.closest.is_refused() {
                break;
            }
            let next = self.from(set_up, number)?;
            let closest = next.closest;
            if closest.is_closer_than(&best.closest) || !closest.is_refused() {
                best = next;
            }
            if before.iter().any(|before| closest.agrees_with(before)) {
                break;
            }
            before.push(closest);
        }
        Ok(best)
    }

    /// The closest curve of the search of this number.
    fn from(&mut self, set_up: &SetUp, number: usize) -> Result<Found, StudyError> {
        let mut adaptation = Adaptation::new(vec![0.0; self.begin.len()], 1.0);
        let mut draws = draws(Stream::Closest, number, 0);
        let [first, longer @ ..] = PARTS;
        let part = Part::new(set_up, first);
        let begin = self.generation(&part, &mut adaptation, &mut draws)?;
        let mut best = self.over(&part, begin, &mut adaptation, &mut draws)?;
        for share in longer {
            if best.closest.noise_ratio > NEAR {
                break;
            }
            let part = Part::new(set_up, share);
            let begin = self.judge(&part, vec![best.numbers])?;
            best = self.over(&part, begin, &mut adaptation, &mut draws)?;
        }
        Ok(best)
    }

    /// The closest curve over a part of the records: by descent, and by further generations if descent alone
    /// does not reach it.
    fn over(
        &mut self,
        part: &Part,
        begin: Found,
        adaptation: &mut Adaptation,
        draws: &mut Draws,
    ) -> Result<Found, StudyError> {
        let mut best = self.descend(part, begin)?;
        let mut idle = 0;
        while idle < PATIENCE && !part.is_done(&best.closest) {
            let next = self.generation(part, adaptation, draws)?;
            idle += 1;
            if next.closest.noise_ratio < (1.0 - PROGRESS) * best.closest.noise_ratio {
                idle = 0;
            }
            if next.is_closer_than(&best) {
                best = self.descend(part, next)?;
            }
        }
        Ok(best)
    }

    /// The closest curve of the next generation.
    fn generation(
        &mut self,
        part: &Part,
        adaptation: &mut Adaptation,
        draws: &mut Draws,
    ) -> Result<Found, StudyError> {
        let drafts: Vec<_> = (0..DRAFTS).map(|_| adaptation.draw(draws)).collect();
        let judged = self.judge_all(part, drafts.iter().map(|(_, numbers)| numbers.clone()).collect())?;
        let mut ranked: Vec<(&Found, &[f64])> = judged
            .iter()
            .zip(&drafts)
            .map(|(found, (normal, _))| (found, normal.as_slice()))
            .collect();
        ranked.sort_by(|(one, _), (other, _)| one.closest.noise_ratio.total_cmp(&other.closest.noise_ratio));
        let normal: Vec<&[f64]> = ranked.iter().map(|(_, normal)| *normal).collect();
        adaptation.adapt(&normal);
        Ok(ranked[0].0.clone())
    }

    /// Improves a curve by the Levenberg-Marquardt method, with derivatives by finite differences, as long as
    /// that makes progress.
    fn descend(&mut self, part: &Part, mut best: Found) -> Result<Found, StudyError> {
        while !part.is_done(&best.closest) {
            let beside = (0..best.numbers.len()).map(|j| {
                let mut numbers = best.numbers.clone();
                numbers[j] += BESIDE;
                numbers
            });
            let beside = self.judge_all(part, beside.collect())?;
            let own = best.differences.concat();
            let slopes: Vec<Vec<f64>> = beside
                .iter()
                .map(|found| {
                    let theirs = found.differences.concat();
                    theirs
                        .iter()
                        .zip(&own)
                        .map(|(theirs, own)| (own - theirs) / BESIDE)
                        .collect()
                })
                .collect();
            let steps = DAMPING
                .iter()
                .filter_map(|damping| least_squares(&slopes, &own, *damping));
            let ahead = steps.map(|step| best.numbers.iter().zip(step).map(|(x, d)| x + d).collect());
            let ahead = self.judge_all(part, ahead.collect())?;
            let next = ahead.into_iter().chain(beside);
            let next =
                next.min_by(|one, other| one.closest.noise_ratio.total_cmp(&other.closest.noise_ratio));
            let Some(next) = next else { break };
            let is_progress = next.closest.noise_ratio < (1.0 - PROGRESS) * best.closest.noise_ratio;
            if next.is_closer_than(&best) {
                best = next;
            }
            if !is_progress {
                break;
            }
        }
        Ok(best)
    }

    /// Computes the curve of some search variables over a part of the records, and compares it with them.
    fn judge(&mut self, part: &Part, numbers: Vec<Vec<f64>>) -> Result<Found, StudyError> {
        let mut judged = self.judge_all(part, numbers)?;
        Ok(judged.remove(0))
    }

    /// Computes the curves of several sets of search variables over a part of the records, and compares them
    /// with it.
    fn judge_all(&mut self, part: &Part, numbers: Vec<Vec<f64>>) -> Result<Vec<Found>, StudyError> {
        let points: Vec<Vec<f64>> = numbers.iter().map(|numbers| self.point(numbers)).collect();
        let runs = Runs::new(&part.set_up, &points, FIRST_SURFACE);
        let curves = self.maker.curves(CalibrationStage::Closest, &runs)?;
        let judged = curves.iter().zip(numbers).map(|(curves, numbers)| {
            let differences = self.differences(curves);
            Found {
                closest: Closest::from_residuals(&differences, part.share, part.set_up.halvings),
                numbers,
                differences,
            }
        });
        Ok(judged.collect())
    }

    /// The point of the ranges for some search variables.
    fn point(&self, numbers: &[f64]) -> Vec<f64> {
        let all = self.begin.iter().zip(numbers);
        all.map(|([mean, deviation], x)| (mean + deviation * x).clamp(0.0, 1.0))
            .collect()
    }

    /// Residuals between the records and curves of a part, in units of the noise.
    fn differences(&self, curves: &Curves) -> Vec<Vec<f64>> {
        let records = self.records.iter().zip(curves).zip(&self.deviations);
        let differences = records.map(|((record, curve), deviation)| {
            let pairs = record.iter().zip(curve);
            pairs.map(|(y, f)| (y - f) / deviation).collect()
        });
        differences.collect()
    }
}

impl Found {
    fn is_closer_than(&self, other: &Self) -> bool {
        self.closest.noise_ratio < other.closest.noise_ratio
    }
}

/// The first part of the records.
struct Part {
    set_up: SetUp,
    share: f64,
}

impl Part {
    /// The first part of the records, with its own time step: the step shifts the phase at every slip, so a
    /// part with fewer slips can have coarser steps than the whole.
    fn new(set_up: &SetUp, share: f64) -> Self {
        let set_up = SetUp {
            halvings: set_up.halvings.saturating_sub(((1.0 / share) as u32).ilog2()),
            ..set_up.beginning(share)
        };
        Self { set_up, share }
    }

    /// Whether a curve is close enough.
    fn is_done(&self, closest: &Closest) -> bool {
        match self.share {
            1.0 => !closest.is_refused(),
            _ => closest.noise_ratio < NEAR,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic_noise::normals;

    #[test]
    fn noise_passes_and_a_wave_does_not() {
        let noise: Vec<f64> = normals(Stream::Noise, 1, 0).take(4000).collect();
        let plain = Closest::from_residuals(std::slice::from_ref(&noise), 1.0, 0);
        assert!(
            !plain.is_refused() && (plain.noise_ratio - 1.0).abs() < 0.1,
            "{plain:?}"
        );
        let more: Vec<f64> = noise.iter().map(|e| 1.5 * e).collect();
        assert!(Closest::from_residuals(&[more], 1.0, 0).is_noisier());
        // The wave has a mean square of 0.32, which raises the correlation to 0.24 and the residuals to 1.15
        // times the noise.
        let wave = noise
            .iter()
            .enumerate()
            .map(|(i, e)| e + 0.8 * (0.05 * i as f64).sin());
        let waved = Closest::from_residuals(&[wave.collect()], 1.0, 0);
        assert!(waved.is_correlated() && !waved.is_noisier(), "{waved:?}");
    }
}
