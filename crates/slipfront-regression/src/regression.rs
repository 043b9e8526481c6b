//! Regression of one unknown on the features of training runs, which determines the relevant features.
//!
//! Kernel ridge regression with a Gaussian kernel. Every feature has its own weight, determined in
//! `parameters.rs`:
//!
//! ```text
//! f(x) = f_0 + sum_i a_i k(x, x_i),   A a = u - f_0,   A = K + lambda diag(v)
//! k(x, x') = exp(-sum_f w_f (x_f - x'_f)^2/2)
//! ```
//!
//! The noise variances v are larger for outliers. The logarithm of the size of the residuals is another
//! function of the features, with its own regression of this form.
//!
//! Intervals use the leave-one-out prediction of each run, which needs no separate regression: `u_i -
//! f_without_i(x_i) = a_i/[A^-1]_ii`.

use crate::fit::{Fit, Noise, kernel, kernel_of_all, median, multiplied};
use crate::parameters::{MAX_SEARCHED, Parameters};

/// Size, relative to the median, that is added to residuals before their logarithm is taken: a residual near
/// 0 is due to chance.
const LEAST_SIZE: f64 = 0.1;

/// Regression of an unknown on the features of training runs, and of the size of its residuals.
#[derive(Clone, Debug)]
pub struct Regression {
    value: Function,
    /// Logarithm of the size of the residuals.
    log_scale: Function,
    /// Leave-one-out predictions of every run.
    pub predictions: Vec<f64>,
    /// Leave-one-out predictions of the size of every run's residual.
    scales: Vec<f64>,
}

/// A function of features, fitted to values at training runs.
#[derive(Clone, Debug)]
struct Function {
    /// Mean of the values.
    mean: f64,
    /// Multipliers of the features, the square roots of their weights; empty if no feature is relevant.
    multipliers: Vec<f64>,
    /// The features of the training runs, times their multipliers.
    points: Vec<f64>,
    coefficients: Vec<f64>,
}

/// Prediction for a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// The unknown.
    pub value: f64,
    /// Size of the residuals of runs with similar features: the exponential of the mean of their logarithms.
    pub scale: f64,
}

/// Widths within which training runs count as similar to a record: of its prediction (in units of the range),
/// and of the logarithm of its scale.
const LIKE_VALUE: f64 = 0.15;
const LIKE_SCALE: f64 = 0.5;

impl Prediction {
    /// The value, limited to the range.
    fn bounded(self) -> f64 {
        self.value.clamp(0.0, 1.0)
    }
}

impl Regression {
    /// Leave-one-out prediction of a training run.
    pub fn left_out(&self, run: usize) -> Prediction {
        Prediction {
            value: self.predictions[run],
            scale: self.scales[run],
        }
    }

    /// Squared distance between a training run and a record, `(f - f_i)^2/0.15^2 + log^2(s/s_i)/0.5^2`.
    pub fn distance(&self, run: usize, record: &Prediction) -> f64 {
        let other = self.left_out(run);
        let away = (record.bounded() - other.bounded()) / LIKE_VALUE;
        let wider = libm::log(record.scale / other.scale) / LIKE_SCALE;
        away * away + wider * wider
    }

    /// The residual of a training run with this truth, in units of its scale, applied to the prediction for a
    /// record: `f + s (u_i - f_i)/s_i`.
    pub fn moved(&self, run: usize, truth: f64, record: &Prediction) -> f64 {
        let other = self.left_out(run);
        let residual = (truth - other.bounded()) / other.scale;
        (record.bounded() + record.scale * residual).clamp(0.0, 1.0)
    }
}

impl Regression {
    /// Learns an unknown from `unknown.len()` rows of features.
    pub fn learn(features: &[f64], unknown: &[f64]) -> Self {
        let (value, residuals) = Function::learn(features, unknown, Noise::HeavyTailed);
        let sizes: Vec<f64> = residuals.iter().map(|e| e.abs()).collect();
        let least = LEAST_SIZE * median(&sizes);
        let logs: Vec<f64> = sizes
            .iter()
            // All residuals may be zero, for an unknown that is an exact function of the features.
            .map(|size| libm::log(size + least + f64::MIN_POSITIVE))
            .collect();
        let (log_scale, of_logs) = Function::learn(features, &logs, Noise::Normal);
        Self {
            value,
            log_scale,
            predictions: unknown.iter().zip(&residuals).map(|(u, e)| u - e).collect(),
            scales: logs
                .iter()
                .zip(&of_logs)
                .map(|(log, e)| libm::exp(log - e))
                .collect(),
        }
    }

    /// Similarity of every training run to a record in this regression and in another: the product of their
    /// kernels.
    pub fn likeness(&self, features: &[f64], other: &Self) -> Vec<f64> {
        let own = |of: &Self| {
            let kernel = of.value.kernel(features);
            kernel.unwrap_or_else(|| vec![1.0; of.predictions.len()])
        };
        own(self).iter().zip(own(other)).map(|(a, b)| a * b).collect()
    }

    /// The prediction for these features of a record.
    pub fn predict(&self, features: &[f64]) -> Prediction {
        Prediction {
            value: self.value.at(features),
            scale: libm::exp(self.log_scale.at(features)),
        }
    }
}

impl Function {
    /// Learns a function from its values at `values.len()` rows of features; returns it with the
    /// leave-one-out residual of every run.
    fn learn(features: &[f64], values: &[f64], noise: Noise) -> (Self, Vec<f64>) {
        let (n, d) = (values.len(), features.len() / values.len());
        let mean = mean(values);
        let targets: Vec<f64> = values.iter().map(|value| value - mean).collect();
        let nothing = Self {
            mean,
            multipliers: Vec::new(),
            points: Vec::new(),
            coefficients: Vec::new(),
        };
        // A few hundred runs suffice for weights, which need many factorizations; coefficients need all runs.
        let searched = n.min(MAX_SEARCHED);
        let Some(parameters) = Parameters::likeliest(&features[..searched * d], &targets[..searched], noise)
        else {
            return (nothing, targets);
        };
        let points = multiplied(features, &parameters.multipliers);
        let fit = |variances: Vec<f64>| {
            let noise = variances.into_iter().map(|variance| parameters.ridge * variance);
            Fit::new(kernel_of_all(&points, d), &targets, noise)
        };
        let Some(mut found) = fit(vec![1.0; n]) else {
            return (nothing, targets);
        };
        // A first regression identifies outliers; the second learns less from them.
        if let Some(better) = noise.variances(&found.residuals).and_then(fit) {
            found = better;
        }
        let function = Self {
            mean,
            multipliers: parameters.multipliers,
            points,
            coefficients: found.coefficients,
        };
        (function, found.residuals)
    }

    /// Kernels between features and those of the training runs; none if no feature is relevant.
    fn kernel(&self, features: &[f64]) -> Option<Vec<f64>> {
        let d = self.multipliers.len();
        (d > 0).then(|| kernel(&multiplied(features, &self.multipliers), &self.points, d))
    }

    /// The value at these features.
    fn at(&self, features: &[f64]) -> f64 {
        let kernel = self.kernel(features).unwrap_or_default();
        self.mean
            + kernel
                .iter()
                .zip(&self.coefficients)
                .map(|(k, a)| k * a)
                .sum::<f64>()
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::super::for_tests::{chance, cube, point};
    use super::*;

    #[test]
    fn a_linear_unknown_is_found() {
        let (n, d) = (150, 3);
        let unknown = |row: &[f64]| 0.3 + 0.2 * row[0] - 0.1 * row[1];
        let table = cube(n, d);
        let truths: Vec<f64> = table.chunks_exact(d).map(unknown).collect();
        let found = Regression::learn(&table, &truths);
        for run in n..n + 20 {
            let row = point(run, d);
            let Prediction { value, scale } = found.predict(&row);
            // A Gaussian kernel some units wide bends a line by the cube of the ratio.
            assert!(
                (value - unknown(&row)).abs() < 1e-3 && scale < 1e-3,
                "{value} {scale}"
            );
        }
    }

    #[test]
    fn single_runs_far_off_change_little() {
        let (n, d) = (150, 3);
        let unknown = |row: &[f64]| 0.3 + 0.2 * row[0] - 0.1 * row[1];
        let table = cube(n, d);
        let rows = table.chunks_exact(d).zip(chance(n)).enumerate();
        let truths: Vec<f64> = rows
            .map(|(run, (row, chance))| {
                let off = if run % 15 == 0 { 0.5 } else { 0.0 };
                unknown(row) + 0.01 * (chance - 0.5) + off
            })
            .collect();
        let found = Regression::learn(&table, &truths);
        let errors = (n..n + 100).map(|run| {
            let row = point(run, d);
            found.predict(&row).value - unknown(&row)
        });
        // One run in fifteen is off by 0.5: with equal noise, these runs would raise all predictions by their
        // mean, 0.033.
        let mean = errors.sum::<f64>() / 100.0;
        assert!(mean.abs() < 0.01, "{mean}");
    }

    #[test]
    fn features_that_tell_nothing_predict_the_mean() {
        let n = 150;
        let truths = chance(n);
        let found = Regression::learn(&cube(n, 3), &truths);
        assert!(found.value.multipliers.is_empty());
        assert_eq!(found.predict(&[0.1, 0.2, 0.3]).value, mean(&truths));
    }
}
