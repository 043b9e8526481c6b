//! The friction coefficient mu* (Eq. 9), the share of sliding blocks N*, and the first peak of mu*.

use serde::{Deserialize, Serialize};

use super::Observer;
use super::energy::{Energies, Ledger};
use crate::kernel::Totals;
use crate::vector_field::dot;
use crate::{Model, RunError, Snapshot};

/// The whole slider at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// mu*, the pull of the drive springs along the drive over the load; can be negative.
    pub mu_star: f64,
    /// The same across the drive, a quarter turn to the left of it.
    pub mu_lateral_star: f64,
    /// Number of blocks that slide, textured ones included.
    pub n_sliding: usize,
    /// N*, the same in % of all blocks.
    pub sliding_percent: f64,
}

impl CurvePoint {
    /// Eq. 9 over mu_s, from the mean displacement:
    ///
    /// ```text
    /// mu* = (1/N) sum_i F_s,i . d = k_s (V* t* - mean(u . d))
    /// ```
    pub(crate) fn measure(model: &Model, totals: &Totals, time_star: f64) -> Self {
        let (drive, n) = (&model.drive, model.lattice.n_blocks() as f64);
        let mean = totals.displacement.map(|sum| sum / n);
        let position = drive.position(time_star);
        let pull = [
            drive.k_drive * (position[0] - mean[0]),
            drive.k_drive * (position[1] - mean[1]),
        ];
        let [dx, dy] = drive.direction;
        Self {
            mu_star: dot(pull, [dx, dy]),
            mu_lateral_star: dot(pull, [-dy, dx]),
            n_sliding: totals.n_sliding,
            sliding_percent: 100.0 * totals.n_sliding as f64 / n,
        }
    }
}

/// The first peak of mu* that is followed by a fall of at least half-way to the steady level L, found while the
/// run goes on: until such a fall is seen it is the largest mu* so far.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// mu* at the peak: mu_s* once `ended`.
    pub mu_star: f64,
    /// Step of the peak.
    pub step: u64,
    /// Time of the peak: t_s* once `ended`.
    pub time_star: f64,
    /// Whether the fall has been seen.
    pub ended: bool,
    /// Largest mu* of the whole run so far.
    pub mu_star_max: f64,
    steady_level: f64,
}

impl Peak {
    /// Nothing seen yet; `steady_level` is L, see [`Model::steady_level`].
    pub(crate) fn new(steady_level: f64) -> Self {
        let lowest = f64::NEG_INFINITY;
        Self {
            mu_star: lowest,
            step: 0,
            time_star: 0.0,
            ended: false,
            mu_star_max: lowest,
            steady_level,
        }
    }

    /// Whether a fall to `mu_star` would end the peak.
    pub(crate) fn ends_at(&self, mu_star: f64) -> bool {
        self.mu_star > self.steady_level && mu_star <= 0.5 * (self.mu_star + self.steady_level)
    }

    pub(crate) fn watch(&mut self, step: u64, time_star: f64, mu_star: f64) {
        self.mu_star_max = self.mu_star_max.max(mu_star);
        if self.ended {
            return;
        }
        if mu_star > self.mu_star {
            (self.mu_star, self.step, self.time_star) = (mu_star, step, time_star);
        } else {
            self.ended = self.ends_at(mu_star);
        }
    }
}

/// One row of the recorded curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurveRow {
    /// Step.
    pub step: u64,
    /// t*.
    pub time_star: f64,
    /// mu* and N*.
    pub point: CurvePoint,
    /// Energies held at this instant and spent up to it.
    pub energies: Energies,
}

/// Records the curve, and keeps the ledger of energies. To be shown every step.
#[derive(Debug, Serialize, Deserialize)]
pub struct Curve {
    /// Every `stride`-th step from 0, and the last one.
    pub rows: Vec<CurveRow>,
    stride: u64,
    ledger: Ledger,
}

impl Curve {
    /// Records every `stride`-th step.
    pub fn every(stride: u64) -> Self {
        Self {
            rows: Vec::new(),
            stride,
            ledger: Ledger::default(),
        }
    }

    /// Whether it can have come of this new one, shown every step up to `step`.
    pub fn is_consistent_with(&self, new: &Self, step: u64) -> bool {
        let steps = (0..=step).step_by(new.stride.max(1) as usize);
        self.stride == new.stride && self.rows.iter().map(|row| row.step).eq(steps)
    }
}

impl Observer for Curve {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.ledger.add(now);
        if now.last || now.step.is_multiple_of(self.stride) {
            let energies = self.ledger.energies(now.stored_energy());
            self.rows.push(CurveRow {
                step: now.step,
                time_star: now.time_star,
                point: now.point,
                energies,
            });
        }
        Ok(())
    }

    fn needs_energies(&self, step: u64) -> bool {
        step.is_multiple_of(self.stride)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watch(level: f64, curve: &[f64]) -> Peak {
        let mut peak = Peak::new(level);
        for (n, &mu) in curve.iter().enumerate() {
            peak.watch(n as u64, n as f64, mu);
        }
        peak
    }

    #[test]
    fn the_first_peak_counts_even_if_a_later_one_is_higher() {
        let peak = watch(0.5, &[0.0, 0.4, 0.8, 1.0, 0.9, 0.75, 0.2, 0.9, 1.1, 0.1]);
        assert_eq!(
            (peak.mu_star, peak.step, peak.ended, peak.mu_star_max),
            (1.0, 3, true, 1.1)
        );
    }

    #[test]
    fn a_dip_of_less_than_half_way_does_not_end_the_climb() {
        let peak = watch(0.5, &[0.0, 0.8, 0.7, 0.9, 0.6]);
        assert_eq!((peak.mu_star, peak.step, peak.ended), (0.9, 3, true));
    }

    #[test]
    fn of_equal_values_the_first_is_the_peak() {
        assert_eq!(watch(0.5, &[0.0, 1.0, 0.9, 1.0, 0.2]).step, 1);
    }

    #[test]
    fn without_a_fall_the_largest_value_is_taken() {
        let peak = watch(1.0, &[0.0, 0.5, 0.9, 0.95, 0.94]);
        assert_eq!((peak.mu_star, peak.ended), (0.95, false));
    }
}
