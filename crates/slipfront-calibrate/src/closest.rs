//! The curve of the model that lies closest to records, where the unknowns determine it: without random
//! coefficients there is one whose difference from a good record is noise.

use serde::Serialize;
use slipfront_study::StudyError;
use slipfront_study::adaptation::Adaptation;
use slipfront_study::draws::Draws;
use slipfront_study::statistics::mean;

use crate::normals::{Stream, draws};
use crate::progress::CalibrationStage;
use crate::runs::{RunMaker, Runs};
use crate::set_up::{Curves, SetUp};
use crate::summaries::deviation;

/// Number of the surface of the first run; all surfaces are alike.
const FIRST_SURFACE: u64 = 1;

/// Largest ratio of the differences from the closest curve to the noise that the file states: intervals for
/// less noise are too narrow.
const MOST_NOISE: f64 = 1.2;

/// Standard errors by which differences of neighbouring values may be correlated. Noise is by more than half
/// of them, one time in 40, and a search that ends near the closest curve leaves the rest.
const MOST_CORRELATED: f64 = 4.0;

/// Ratio of differences to noise over a part of the records with which a search goes on to the next part.
const NEAR: f64 = 1.5;

/// Shares of the records, from their beginning, over which curves are compared one after the other: where the
/// phases of stick-slip agree over a part, they nearly agree over twice of it.
const PARTS: [f64; 4] = [0.125, 0.25, 0.5, 1.0];

/// Number of searches, and runs of a generation.
const SEARCHES: usize = 5;
const DRAFTS: usize = 24;

/// Generations without progress after which a search over a part ends, and the share of the distance that is
/// progress.
const PATIENCE: usize = 10;
const PROGRESS: f64 = 0.002;

/// Share by which the distances of two searches may differ that have found the same curve.
const SAME: f64 = 0.005;

/// Differences between records and the curve of the model that lies closest to them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Closest {
    /// Root of their mean square, over the standard deviation of the noise that the file states.
    pub noise_ratio: f64,
    /// Correlation of differences of neighbouring values: 0 of white noise.
    pub correlation: f64,
    /// Correlation above which the differences are not taken for noise.
    pub most_correlated: f64,
    /// Share of the records, from their beginning, over which they were compared.
    pub share: f64,
}

impl Closest {
    /// Whether the records differ from the model by more than the noise.
    pub fn is_refused(&self) -> bool {
        self.is_noisier() || self.is_correlated()
    }

    /// Whether the differences are larger than the noise.
    pub fn is_noisier(&self) -> bool {
        self.noise_ratio > MOST_NOISE
    }

    /// Whether the differences are no white noise.
    pub fn is_correlated(&self) -> bool {
        self.correlation > self.most_correlated
    }

    /// Differences of every record in units of the noise, over this share of the records.
    fn of(differences: &[Vec<f64>], share: f64) -> Self {
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
        }
    }

    /// Whether another search ended at the same distance over the same part, so that no further one is
    /// needed.
    fn agrees_with(&self, other: &Self) -> bool {
        let apart = (self.noise_ratio - other.noise_ratio).abs();
        self.share == other.share && apart < SAME * other.noise_ratio
    }

    /// Whether the curve lies closer than another one, or follows the records farther.
    fn is_closer_than(&self, other: &Self) -> bool {
        (self.share, -self.noise_ratio) > (other.share, -other.noise_ratio)
    }
}

/// Looks for the closest curve among those of the unknowns that an estimate has drawn; none where random
/// coefficients make curves of the same unknowns differ. A search ends where the differences are noise.
/// `noise` is that of a value of the records, as a share of their mean friction.
///
/// # Errors
/// When a run cannot be made or kept, and after a stop.
pub fn closest(
    maker: &mut RunMaker,
    set_up: &SetUp,
    drawn: &[Vec<f64>],
    records: &[Vec<f64>],
    noise: f64,
) -> Result<Option<Closest>, StudyError> {
    let middle = [set_up.middle(), set_up.middle()];
    let two_surfaces = maker.curves(
        CalibrationStage::Closest,
        &Runs::new(set_up, &middle, FIRST_SURFACE),
    )?;
    if two_surfaces[0] != two_surfaces[1] {
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
        maker,
        begin: (0..set_up.unknowns.len()).map(begin).collect(),
    };
    let mut found: Vec<Closest> = Vec::new();
    for number in 0..SEARCHES {
        let next = search.from(set_up, number)?;
        if !next.is_refused() {
            return Ok(Some(next));
        }
        let agrees = found.iter().any(|before| next.agrees_with(before));
        found.push(next);
        if agrees {
            break;
        }
    }
    let closer = |one: Closest, other: Closest| if other.is_closer_than(&one) { other } else { one };
    Ok(found.into_iter().reduce(closer))
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

impl Search<'_, '_> {
    /// The closest curve of the search of this number.
    fn from(&mut self, set_up: &SetUp, number: usize) -> Result<Closest, StudyError> {
        let mut adaptation = Adaptation::new(vec![0.0; self.begin.len()], 1.0);
        let mut draws = draws(Stream::Closest, number, 0);
        let [first, longer @ ..] = PARTS;
        let mut best = self.over(set_up, first, &mut adaptation, &mut draws)?;
        for share in longer {
            if best.noise_ratio > NEAR {
                break;
            }
            best = self.over(set_up, share, &mut adaptation, &mut draws)?;
        }
        Ok(best)
    }

    /// The closest curve over the first part of the records, from where a search stands.
    fn over(
        &mut self,
        set_up: &SetUp,
        share: f64,
        adaptation: &mut Adaptation,
        draws: &mut Draws,
    ) -> Result<Closest, StudyError> {
        let part = set_up.beginning(share);
        let is_done = |best: &Closest| match share {
            1.0 => !best.is_refused(),
            _ => best.noise_ratio < NEAR,
        };
        let mut best = self.generation(&part, share, adaptation, draws)?;
        let mut idle = 0;
        while idle < PATIENCE && !is_done(&best) {
            let next = self.generation(&part, share, adaptation, draws)?;
            idle += 1;
            if next.noise_ratio < (1.0 - PROGRESS) * best.noise_ratio {
                idle = 0;
            }
            if next.noise_ratio < best.noise_ratio {
                best = next;
            }
        }
        Ok(best)
    }

    /// The closest curve of the next generation over the first part of the records.
    fn generation(
        &mut self,
        part: &SetUp,
        share: f64,
        adaptation: &mut Adaptation,
        draws: &mut Draws,
    ) -> Result<Closest, StudyError> {
        let drafts: Vec<_> = (0..DRAFTS).map(|_| adaptation.draw(draws)).collect();
        let points: Vec<Vec<f64>> = drafts.iter().map(|(_, numbers)| self.point(numbers)).collect();
        let runs = Runs::new(part, &points, FIRST_SURFACE);
        let curves = self.maker.curves(CalibrationStage::Closest, &runs)?;
        let judged = curves.iter().zip(&drafts);
        let judged = judged.map(|(curves, (normal, _))| (self.judge(curves, share), normal.as_slice()));
        let mut ranked: Vec<(Closest, &[f64])> = judged.collect();
        ranked.sort_by(|one, other| one.0.noise_ratio.total_cmp(&other.0.noise_ratio));
        let normal: Vec<&[f64]> = ranked.iter().map(|(_, normal)| *normal).collect();
        adaptation.adapt(&normal);
        Ok(ranked[0].0)
    }

    /// The point of the ranges at numbers of a search.
    fn point(&self, numbers: &[f64]) -> Vec<f64> {
        let all = self.begin.iter().zip(numbers);
        all.map(|([mean, deviation], x)| (mean + deviation * x).clamp(0.0, 1.0))
            .collect()
    }

    /// Differences between the records and curves of a part.
    fn judge(&self, curves: &Curves, share: f64) -> Closest {
        let records = self.records.iter().zip(curves).zip(&self.deviations);
        let differences = records.map(|((record, curve), deviation)| {
            let pairs = record.iter().zip(curve);
            pairs.map(|(y, f)| (y - f) / deviation).collect()
        });
        Closest::of(&differences.collect::<Vec<_>>(), share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::normals::normals;

    #[test]
    fn noise_passes_and_a_wave_does_not() {
        let noise: Vec<f64> = normals(Stream::Noise, 1, 0).take(4000).collect();
        let plain = Closest::of(std::slice::from_ref(&noise), 1.0);
        assert!(
            !plain.is_refused() && (plain.noise_ratio - 1.0).abs() < 0.1,
            "{plain:?}"
        );
        let more: Vec<f64> = noise.iter().map(|e| 1.5 * e).collect();
        assert!(Closest::of(&[more], 1.0).is_noisier());
        // The mean square of the wave is 0.32, which makes the correlation 0.24, and the noise 1.15 times as
        // much.
        let wave = noise
            .iter()
            .enumerate()
            .map(|(i, e)| e + 0.8 * (0.05 * i as f64).sin());
        let waved = Closest::of(&[wave.collect()], 1.0);
        assert!(waved.is_correlated() && !waved.is_noisier(), "{waved:?}");
    }
}
