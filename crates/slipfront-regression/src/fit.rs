//! Kernel regression with given parameters, and models of the noise of its values.

use crate::dense::{Factor, squared_distances};

/// A regression, and the leave-one-out residual of every run.
pub(crate) struct Fit {
    pub(crate) coefficients: Vec<f64>,
    /// `u_i - f_without_i(x_i) = a_i/[A^-1]_ii`.
    pub(crate) residuals: Vec<f64>,
}

impl Fit {
    /// The regression `A a = u` of values u with mean 0, `A = K + diag(noise)`; none if A is not positive
    /// definite.
    pub(crate) fn new(
        kernel: Vec<f64>,
        values: &[f64],
        noise: impl ExactSizeIterator<Item = f64>,
    ) -> Option<Self> {
        let factor = Factor::new(kernel, noise)?;
        let mut coefficients = values.to_vec();
        factor.solve(&mut coefficients);
        // Leave-one-out residuals from a single factor: `n` separate regressions would give the same.
        let inverse = factor.inverse_diagonal();
        let residuals = coefficients.iter().zip(inverse).map(|(a, d)| a / d).collect();
        Some(Self {
            coefficients,
            residuals,
        })
    }
}

/// Distribution of the noise of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Noise {
    /// All runs have the same noise.
    Normal,
    /// Some runs are outliers, such as those that stick and slip among others that slide. They get more
    /// noise, so that the regression does not learn to explain them.
    HeavyTailed,
}

/// Degrees of freedom of the noise with heavy tails.
const FREEDOM: f64 = 4.0;

/// Median of the absolute value of a standard normal number.
const MEDIAN_SIZE: f64 = 0.6745;

impl Noise {
    /// Noise variances of runs with these residuals, relative to that of a run with a residual of one
    /// standard deviation s. Here s is the median absolute residual over that of a standard normal number.
    /// None if all variances are the same.
    ///
    /// ```text
    /// (nu + e^2/s^2)/(nu + 1)
    /// ```
    ///
    /// Repeated regressions with normal noise, with these variances updated from the residuals each time,
    /// converge to the maximum-likelihood regression with noise of Student's distribution with nu degrees of
    /// freedom (Lange et al., Journal of the American Statistical Association 84 (1989) 881).
    pub(crate) fn variances(self, residuals: &[f64]) -> Option<Vec<f64>> {
        let sizes: Vec<f64> = residuals.iter().map(|e| e.abs()).collect();
        let deviation = median(&sizes) / MEDIAN_SIZE;
        let variance = |e: &f64| (FREEDOM + (e / deviation) * (e / deviation)) / (FREEDOM + 1.0);
        (self == Self::HeavyTailed && deviation > 0.0).then(|| residuals.iter().map(variance).collect())
    }
}

/// Rows of features, with each feature multiplied by its multiplier.
pub(crate) fn multiplied(features: &[f64], multipliers: &[f64]) -> Vec<f64> {
    let rows = features.chunks_exact(multipliers.len());
    rows.flat_map(|row| row.iter().zip(multipliers).map(|(x, by)| x * by))
        .collect()
}

/// The kernel `exp(-|x - x'|^2/2)` of every pair of points.
pub(crate) fn kernel_of_all(points: &[f64], d: usize) -> Vec<f64> {
    let n = points.len() / d;
    let mut kernel = squared_distances(points, points, d);
    for i in 0..n {
        kernel[i * n + i] = 1.0;
        // One half is copied to the other: this halves the number of exponentials, and makes the matrix
        // exactly symmetric.
        for j in 0..i {
            let value = libm::exp(-0.5 * kernel[i * n + j]);
            kernel[i * n + j] = value;
            kernel[j * n + i] = value;
        }
    }
    kernel
}

/// The kernel `exp(-|x - x'|^2/2)` between two sets of points.
pub(crate) fn kernel(points: &[f64], others: &[f64], d: usize) -> Vec<f64> {
    let mut kernel = squared_distances(points, others, d);
    for value in &mut kernel {
        *value = libm::exp(-0.5 * *value);
    }
    kernel
}

/// The median of numbers.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::super::for_tests::cube;
    use super::*;

    /// Leave-one-out residuals, compared with a regression without the run.
    #[test]
    fn residuals_are_those_of_runs_left_out() {
        let (n, d) = (12, 2);
        let table = cube(n, d);
        let targets: Vec<f64> = table
            .chunks_exact(d)
            .map(|row| row[0] * row[1] + row[0])
            .collect();
        let noise = |n: usize| (0..n).map(|i| 0.01 * (1.0 + i as f64));
        let all = Fit::new(kernel_of_all(&table, d), &targets, noise(n)).unwrap();
        let (points, last) = table.split_at((n - 1) * d);
        let rest = Fit::new(kernel_of_all(points, d), &targets[..n - 1], noise(n - 1)).unwrap();
        let near = kernel(last, points, d);
        let predicted: f64 = near.iter().zip(&rest.coefficients).map(|(k, a)| k * a).sum();
        // Rounding, times a condition number of at most n/0.01.
        assert!((all.residuals[n - 1] - (targets[n - 1] - predicted)).abs() < 1e3 * f64::EPSILON);
    }

    #[test]
    fn a_run_far_off_has_more_noise() {
        // Absolute residuals of 0.6745 correspond to a standard deviation of one.
        let residuals = [0.6745, -0.6745, 0.6745, -0.6745, 6.745];
        let found = Noise::HeavyTailed.variances(&residuals).unwrap();
        let exact = [(4.0 + 0.6745 * 0.6745) / 5.0, (4.0 + 6.745 * 6.745) / 5.0];
        assert!(
            (found[0] - exact[0]).abs() < 1e-12 && (found[4] - exact[1]).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(Noise::HeavyTailed.variances(&[0.0; 3]), None);
        assert_eq!(Noise::Normal.variances(&residuals), None);
    }
}
