//! Maximum-likelihood weights of the features in the kernel of an unknown, and ridge.
//!
//! The values `u` at the training runs are modelled as normal numbers with the covariance `c A`, with c their
//! maximum-likelihood scale, and given variances v_i of the noise. The parameters minimize the negative
//! logarithm of the likelihood, without constants (Rasmussen and Williams, Gaussian Processes for Machine
//! Learning, 2006, section 5.4.1):
//!
//! ```text
//! l = n/2 log(u^T a/n) + 1/2 log det A,   A = K + lambda diag(v),   a = A^-1 u
//! dl = sum_ij g_ij dA_ij,   g = (A^-1 - n a a^T/(u^T a))/2
//! dl/dlog w_f = w_f sum_i x_if sum_j g_ij k_ij (x_jf - x_if),   dl/dlog lambda = lambda sum_i v_i g_ii
//! ```
//!
//! At first all features share one weight, then each gets its own. The single weights start from the mean
//! squared slopes of the first regression (Radhakrishnan et al., Science 383 (2024) 1461, with a diagonal
//! matrix), and a prior keeps them near this start: a hundred free weights would fit the noise of a few
//! hundred runs.

use crate::dense::{Factor, differences, squared_distances};
use crate::fit::{Fit, Noise, kernel_of_all, median, multiplied};

/// Largest number of runs from which weights and ridge are determined.
pub(crate) const MAX_SEARCHED: usize = 900;

/// Largest number of runs from which the common weight and the first slopes are determined.
const MAX_OF_COMMON_WEIGHT: usize = 450;

/// Number of optimization steps of the parameters: further steps change the regression by less than another
/// sample of runs does.
const STEPS: usize = 10;

/// Prior standard deviation of the logarithm of a weight around its start.
const PRIOR_DEVIATION: f64 = 1.0;

/// Initial ridge, and initial inverse of the common weight over the median squared distance, in the search
/// for the common weight.
const COMMON_RIDGE: f64 = 1e-3;
const COMMON_SPREAD: f64 = 4.0;

/// Initial ridge, and initial median of the weighted squared distances, in the search for the weights of all
/// features.
const RIDGE: f64 = 3e-3;
const SPREAD: f64 = 0.5;

/// Least initial weight of a feature, relative to the largest.
const LEAST_WEIGHT: f64 = 1e-6;

/// Least ridge: below it, rounding errors are as large as the differences between the kernels of neighbours.
const LEAST_RIDGE: f64 = 1e-8;

/// Largest residual, in standard deviations of the values, when residuals are compared with values: a few
/// outliers must not decide.
const MAX_RESIDUAL: f64 = 3.0;

/// Least share of the variance of an unknown that a regression must explain; with less it has learnt nothing.
const LEAST_EXPLAINED: f64 = 0.02;

/// Parameters of the kernel of an unknown.
pub(crate) struct Parameters {
    /// Multipliers of the features, the square roots of their weights.
    pub(crate) multipliers: Vec<f64>,
    /// Noise of a run, added to the diagonal of the kernel.
    pub(crate) ridge: f64,
}

impl Parameters {
    /// Maximum-likelihood parameters for values with mean 0 at rows of features; none if no feature depends
    /// on the unknown.
    pub(crate) fn likeliest(features: &[f64], values: &[f64], noise: Noise) -> Option<Self> {
        let (n, d) = (values.len(), features.len() / values.len());
        // The work grows with the cube of the number of runs, and a few runs suffice for two numbers.
        let some = n.min(MAX_OF_COMMON_WEIGHT);
        let mut first = Sample::new(&features[..some * d], &values[..some]);
        let spread = median(&squared_distances(first.features, first.features, d));
        if spread <= 0.0 {
            return None;
        }
        let start = [1.0 / (COMMON_SPREAD * spread), COMMON_RIDGE].map(libm::log);
        let mut common = first.common_weight(start.to_vec());
        if let Some(variances) =
            first.learnt_variances(noise, &first.equal_weights(&common), libm::exp(common[1]))
        {
            first.variances = variances;
            common = first.common_weight(common);
        }
        let weights = first.weights_of_slopes(&common)?;
        let mut all = Sample::new(features, values);
        if let Some(variances) = all.learnt_variances(noise, &weights, RIDGE) {
            all.variances = variances;
        }
        Some(all.weights_near(&weights))
    }
}

/// Values at rows of features.
struct Sample<'a> {
    features: &'a [f64],
    values: &'a [f64],
    /// Variances of the noise of the runs, in units of the ridge.
    variances: Vec<f64>,
}

impl<'a> Sample<'a> {
    fn new(features: &'a [f64], values: &'a [f64]) -> Self {
        Self {
            features,
            values,
            variances: vec![1.0; values.len()],
        }
    }

    /// Number of features.
    fn d(&self) -> usize {
        self.features.len() / self.values.len()
    }

    /// The features, each times the square root of its weight.
    fn points(&self, weights: &[f64]) -> Vec<f64> {
        let roots: Vec<f64> = weights.iter().map(|weight| weight.sqrt()).collect();
        multiplied(self.features, &roots)
    }

    /// The kernel with these weights.
    fn kernel(&self, weights: &[f64]) -> Vec<f64> {
        kernel_of_all(&self.points(weights), self.d())
    }

    /// The noise of the runs.
    fn noise(&self, ridge: f64) -> impl ExactSizeIterator<Item = f64> {
        self.variances.iter().map(move |variance| ridge * variance)
    }

    fn fit(&self, weights: &[f64], ridge: f64) -> Option<Fit> {
        Fit::new(self.kernel(weights), self.values, self.noise(ridge))
    }

    /// Noise variances from the residuals of a regression; none if all runs have the same noise, which needs
    /// no regression.
    fn learnt_variances(&self, noise: Noise, weights: &[f64], ridge: f64) -> Option<Vec<f64>> {
        if noise == Noise::Normal {
            return None;
        }
        noise.variances(&self.fit(weights, ridge)?.residuals)
    }

    /// Weights of all features, which are equal, from the logarithms of this weight and of the ridge.
    fn equal_weights(&self, common: &[f64]) -> Vec<f64> {
        vec![libm::exp(common[0]); self.d()]
    }

    /// Maximum-likelihood logarithms of the common weight of all features and of the ridge, starting from
    /// `start`.
    fn common_weight(&self, start: Vec<f64>) -> Vec<f64> {
        descend(start, &|logs| {
            let mut found = self.likelihood(&self.equal_weights(logs), libm::exp(logs[1]))?;
            let of_ridge = found.slopes.split_off(self.d());
            found.slopes = vec![found.slopes.iter().sum(), of_ridge[0]];
            Some(found)
        })
    }

    /// Most probable weight of every feature, with a log-normal prior around the given weights.
    fn weights_near(&self, weights: &[f64]) -> Parameters {
        let d = weights.len();
        let mut start: Vec<f64> = weights.iter().map(|&weight| libm::log(weight)).collect();
        start.push(libm::log(RIDGE));
        let found = descend(start.clone(), &|logs| {
            let weights: Vec<f64> = logs[..d].iter().map(|&log| libm::exp(log)).collect();
            let mut found = self.likelihood(&weights, libm::exp(logs[d]))?;
            for ((slope, log), first) in found.slopes.iter_mut().zip(logs).zip(&start).take(d) {
                let away = (log - first) / PRIOR_DEVIATION;
                found.value += 0.5 * away * away;
                *slope += away / PRIOR_DEVIATION;
            }
            Some(found)
        });
        Parameters {
            multipliers: found[..d].iter().map(|log| libm::exp(0.5 * log)).collect(),
            ridge: libm::exp(found[d]),
        }
    }

    /// Negative logarithm of the likelihood, and its derivatives with respect to the logarithms of weights
    /// and ridge.
    fn likelihood(&self, weights: &[f64], ridge: f64) -> Option<Slope> {
        let (n, d) = (self.values.len(), self.d());
        let kernel = self.kernel(weights);
        let factor = Factor::new(kernel.clone(), self.noise(ridge))?;
        let mut coefficients = self.values.to_vec();
        factor.solve(&mut coefficients);
        let product: f64 = self.values.iter().zip(&coefficients).map(|(u, a)| u * a).sum();
        let scale = product / n as f64;
        let value = 0.5 * n as f64 * libm::log(scale) + 0.5 * factor.log_determinant();
        // The elements replace those of the inverse, because matrices of all pairs of runs take most of the
        // memory.
        let mut g = factor.inverse();
        let mut of_ridge = 0.0;
        for (i, row) in g.chunks_exact_mut(n).enumerate() {
            for ((g, k), a) in row.iter_mut().zip(&kernel[i * n..]).zip(&coefficients) {
                *g = 0.5 * (*g - coefficients[i] * a / scale) * k;
            }
            // The kernel of a run with itself is 1.
            of_ridge += ridge * self.variances[i] * row[i];
        }
        let pulls = differences(&g, self.features, d);
        let mut of_weights = vec![0.0; d];
        for (pulls, row) in pulls.chunks_exact(d).zip(self.features.chunks_exact(d)) {
            for ((sum, pull), x) in of_weights.iter_mut().zip(pulls).zip(row) {
                *sum += pull * x;
            }
        }
        let of_weights = of_weights.iter().zip(weights).map(|(sum, weight)| sum * weight);
        Some(Slope {
            value,
            slopes: of_weights.chain([of_ridge]).collect(),
        })
    }

    /// Weights proportional to the mean squared slopes of a regression with the same weight for all
    /// features, given by the logarithms of the weight and of the ridge; none if this regression has learnt
    /// nothing. A run with more noise counts for less.
    ///
    /// ```text
    /// df/dx_f(x_i) = w sum_j a_j k_ij (x_jf - x_if)
    /// ```
    fn weights_of_slopes(&self, common: &[f64]) -> Option<Vec<f64>> {
        let (n, d) = (self.values.len(), self.d());
        let equal = self.equal_weights(common);
        let fit = self.fit(&equal, libm::exp(common[1]))?;
        let variance = self.values.iter().map(|u| u * u).sum::<f64>() / n as f64;
        let bound = MAX_RESIDUAL * variance.sqrt();
        let squares = fit.residuals.iter().map(|e| {
            let e = e.abs().min(bound);
            e * e
        });
        let has_learnt = squares.sum::<f64>() / (n as f64) < (1.0 - LEAST_EXPLAINED) * variance;
        if !has_learnt {
            return None;
        }
        let mut kernel = self.kernel(&equal);
        for row in kernel.chunks_exact_mut(n) {
            for (k, a) in row.iter_mut().zip(&fit.coefficients) {
                *k *= a;
            }
        }
        let mut squares = vec![0.0; d];
        let slopes = differences(&kernel, self.features, d);
        for (slopes, variance) in slopes.chunks_exact(d).zip(&self.variances) {
            for (sum, slope) in squares.iter_mut().zip(slopes) {
                *sum += slope * slope / variance;
            }
        }
        let largest = squares.iter().copied().fold(0.0, f64::max);
        let weights: Vec<f64> = squares
            .iter()
            .map(|square| (square / largest).max(LEAST_WEIGHT))
            .collect();
        let points = self.points(&weights);
        let median = median(&squared_distances(&points, &points, d));
        (median > 0.0).then(|| weights.iter().map(|weight| weight * SPREAD / median).collect())
    }
}

/// A function value and its derivatives with respect to the parameters.
struct Slope {
    value: f64,
    slopes: Vec<f64>,
}

/// Factors of the step of a parameter if its derivative keeps or changes its sign, the first step, and the
/// largest.
const LONGER: f64 = 1.3;
const SHORTER: f64 = 0.5;
const FIRST_STEP: f64 = 0.5;
const LONGEST: f64 = 2.0;

/// Parameters with the least value in [`STEPS`] steps of descent from `start`. The last parameter is the
/// logarithm of the ridge. Each parameter has its own step, and only the sign of its derivative counts
/// (Rprop; Riedmiller and Braun, IEEE International Conference on Neural Networks 1993, p. 586): the units of
/// parameters do not matter, and there is no line search.
fn descend(start: Vec<f64>, f: &dyn Fn(&[f64]) -> Option<Slope>) -> Vec<f64> {
    let mut place = start.clone();
    // Steps by sign alone may increase the value, so the best place is kept, not the last.
    let (mut least, mut best) = (f64::INFINITY, start);
    let mut steps = vec![FIRST_STEP; place.len()];
    let mut before = vec![0.0; place.len()];
    for _ in 0..STEPS {
        // If rounding makes the matrix not positive definite, no further step is possible.
        let Some(Slope { value, mut slopes }) = f(&place) else {
            break;
        };
        if value < least {
            least = value;
            best.clone_from(&place);
        }
        for (((x, step), slope), before) in place.iter_mut().zip(&mut steps).zip(&mut slopes).zip(&before) {
            let signs: f64 = *slope * before;
            if signs > 0.0 {
                *step = (LONGER * *step).min(LONGEST);
            } else if signs < 0.0 {
                *step *= SHORTER;
                // A step that went too far is not reversed immediately.
                *slope = 0.0;
            }
            if *slope != 0.0 {
                *x -= *step * slope.signum();
            }
        }
        if let Some(ridge) = place.last_mut() {
            *ridge = ridge.max(libm::log(LEAST_RIDGE));
        }
        before = slopes;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::super::for_tests::{chance, cube};
    use super::*;

    /// Values that depend on two of three features, with noise.
    fn sample(n: usize) -> (Vec<f64>, Vec<f64>) {
        let features = cube(n, 3);
        let rows = features.chunks_exact(3).zip(chance(n));
        let values: Vec<f64> = rows
            .map(|(row, chance)| libm::sin(3.0 * row[0]) - row[1] + 0.2 * (chance - 0.5))
            .collect();
        (features, values)
    }

    #[test]
    fn slopes_of_the_likelihood_are_its_derivatives() {
        let (features, values) = sample(40);
        let mut sample = Sample::new(&features, &values);
        sample.variances = (0..40).map(|run| 1.0 + f64::from(run % 3)).collect();
        let at = |logs: &[f64]| {
            let weights: Vec<f64> = logs[..3].iter().map(|&log| libm::exp(log)).collect();
            sample.likelihood(&weights, libm::exp(logs[3])).unwrap()
        };
        let logs = [1.0, 0.5, -2.0, -4.0];
        let found = at(&logs);
        for k in 0..4 {
            let step = 1e-4;
            let moved = |by: f64| {
                let mut logs = logs;
                logs[k] += by;
                at(&logs).value
            };
            let slope = (moved(step) - moved(-step)) / (2.0 * step);
            // The error of a central difference is a third derivative times step^2/6, plus rounding over the
            // step.
            let known = found.slopes[k];
            assert!((slope - known).abs() < 1e-5, "{k} {slope} {known}");
        }
    }

    #[test]
    fn what_never_differs_tells_nothing() {
        let (features, values) = sample(40);
        assert!(Parameters::likeliest(&features, &[0.0; 40], Noise::HeavyTailed).is_none());
        assert!(Parameters::likeliest(&[0.7; 120], &values, Noise::Normal).is_none());
        // Three of four runs have the same features.
        let some = features.chunks_exact(3).enumerate();
        let some: Vec<f64> = some
            .flat_map(|(i, row)| if i % 4 == 0 { row } else { &[0.7; 3] }.to_vec())
            .collect();
        assert!(Parameters::likeliest(&some, &values, Noise::Normal).is_none());
    }

    #[test]
    fn a_feature_without_influence_has_the_least_weight() {
        let (features, values) = sample(150);
        let found = Parameters::likeliest(&features, &values, Noise::Normal).unwrap();
        let [first, second, third] = found.multipliers[..] else {
            panic!("{:?}", found.multipliers);
        };
        assert!(first > second && second > 3.0 * third, "{:?}", found.multipliers);
    }

    #[test]
    fn steps_down_come_near_the_least_value_in_any_unit() {
        let found = |unit: f64| {
            descend(vec![0.0, 0.0], &|x| {
                let away = [x[0] - 1.0, x[1] + 2.0];
                Some(Slope {
                    value: unit * (50.0 * away[0] * away[0] + 0.01 * away[1] * away[1]),
                    slopes: vec![unit * 100.0 * away[0], unit * 0.02 * away[1]],
                })
            })
        };
        let [first, second] = found(1.0)[..] else {
            panic!("two parameters")
        };
        // A step that goes too far is halved. This happens to the first step; the second parameter's steps
        // are longer by then.
        assert!((first - 1.0).abs() < SHORTER * FIRST_STEP, "{first}");
        assert!((second + 2.0).abs() < SHORTER * LONGEST, "{second}");
        assert_eq!(found(1e6), [first, second]);
    }

    #[test]
    fn slopes_are_those_of_the_unknown() {
        let features = cube(150, 3);
        let values: Vec<f64> = features
            .chunks_exact(3)
            .map(|row| 0.2 * row[0] - 0.1 * row[1])
            .collect();
        let sample = Sample::new(&features, &values);
        let weights = sample.weights_of_slopes(&[0.25, 1e-6].map(libm::log)).unwrap();
        // As accurate as the regression of a line by a Gaussian kernel.
        assert!((weights[1] / weights[0] - 0.25).abs() < 0.01, "{weights:?}");
        assert!(weights[2] / weights[0] < 1e-4, "{weights:?}");
    }
}
