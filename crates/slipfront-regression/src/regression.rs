//! Regression of one unknown on the summaries of training runs, which finds the summaries that matter.
//!
//! Kernel ridge regression with a Gaussian kernel, whose lengths come from the mean squared slopes of the regression itself: first with the
//! same length for every summary, then with weights (Radhakrishnan et al., Science 383 (2024) 1461, with a diagonal matrix):
//!
//! ```text
//! f(x) = f_0 + sum_i a_i k(x, x_i),   (K + lambda) a = u - f_0
//! k(x, x') = exp(-sum_f w_f (x_f - x'_f)^2/(2 h^2)),   w_f ~ mean_i (df/dx_f(x_i))^2
//! ```
//!
//! The logarithm of the size of the residuals is a function of the summaries too, found likewise.
//!
//! The prediction of a run by all others, from which intervals are made, needs no regression of its own: `u_i -
//! f_without_i(x_i) = a_i/[(K + lambda)^-1]_ii`.

use crate::dense::{Factor, squared_distances};

/// Largest number of runs from which weights and lengths are found.
const MAX_SEARCHED: usize = 800;

/// Number of times that the weights are found anew.
const ROUNDS: usize = 2;

/// Largest residual that counts when lengths are compared, in standard deviations of the unknown: few runs far off decide nothing.
const MAX_RESIDUAL: f64 = 3.0;

/// Least share of the variance of an unknown that a regression must explain; otherwise it has learnt nothing.
const LEAST_EXPLAINED: f64 = 0.02;

/// Size that is added to residuals before their logarithm is taken, over their median: a residual near 0 is chance.
const LEAST_SIZE: f64 = 0.1;

/// Multiples of a trial: `h^2 = 2^spread` medians of the squared distances, `lambda = 10^(ridge/2)`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Trial {
    spread: i32,
    ridge: i32,
}

/// Steps between trials, in spread and ridge: a kernel of twice the spread needs less of a ridge for the same regression.
const STEPS: [(i32, i32); 8] = [
    (1, -1),
    (-1, 1),
    (0, 2),
    (0, -2),
    (1, 0),
    (-1, 0),
    (0, 1),
    (0, -1),
];

/// Bounds of the trials.
const SPREADS: std::ops::RangeInclusive<i32> = -2..=7;
const RIDGES: std::ops::RangeInclusive<i32> = -14..=0;

/// Regression of an unknown on the summaries of training runs, and of the size of its residuals.
#[derive(Clone, Debug)]
pub struct Regression {
    value: Function,
    /// Logarithm of the size of the residuals.
    log_scale: Function,
    /// Predictions of every run by all others.
    pub predictions: Vec<f64>,
    /// Size of the residual of every run as all others predict it.
    scales: Vec<f64>,
}

/// A function of summaries that was found from values at training runs.
#[derive(Clone, Debug)]
struct Function {
    /// Mean of the values.
    mean: f64,
    /// Factors of the summaries; empty if the summaries tell nothing.
    lengths: Vec<f64>,
    /// The summaries of the training runs, times their factors.
    points: Vec<f64>,
    coefficients: Vec<f64>,
}

/// Prediction from a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// The unknown.
    pub value: f64,
    /// Size of the residuals of runs with such summaries: the exponential of the mean of their logarithms.
    pub scale: f64,
}

/// Widths over which training runs count as like a record, in its prediction (of the range) and in the logarithm of its scale.
const LIKE_VALUE: f64 = 0.15;
const LIKE_SCALE: f64 = 0.5;

impl Prediction {
    /// The value, within the range.
    fn bounded(self) -> f64 {
        self.value.clamp(0.0, 1.0)
    }
}

/// Numbers that a regression keeps of every run beside its summaries, which both functions keep: two coefficients, prediction and scale.
const NUMBERS_OF_A_RUN: usize = 4;

/// Matrices of as many rows and columns as there are runs: while lengths are looked for, distances, and the kernels of the best trial, of
/// the present one, and of its factor; in the end the kernel, which becomes its factor.
const MATRICES_OF_SEARCH: usize = 4;
const MATRICES: usize = 1;

impl Regression {
    /// Memory of a regression of `runs` runs with `summaries` summaries each, in bytes.
    pub fn bytes(runs: usize, summaries: usize) -> f64 {
        (size_of::<f64>() * runs * (2 * summaries + NUMBERS_OF_A_RUN)) as f64
    }

    /// Memory of [`learn`](Self::learn) beside its result, in bytes.
    pub fn bytes_to_learn(runs: usize) -> f64 {
        let searched = runs.min(MAX_SEARCHED);
        let matrices = (MATRICES_OF_SEARCH * searched * searched).max(MATRICES * runs * runs);
        (size_of::<f64>() * matrices) as f64
    }

    /// Prediction of a training run by all others.
    pub fn left_out(&self, run: usize) -> Prediction {
        Prediction {
            value: self.predictions[run],
            scale: self.scales[run],
        }
    }

    /// Squared distance of a training run from a record, `(f - f_i)^2/0.15^2 + log^2(s/s_i)/0.5^2`.
    pub fn distance(&self, run: usize, record: &Prediction) -> f64 {
        let other = self.left_out(run);
        let away = (record.bounded() - other.bounded()) / LIKE_VALUE;
        let wider = libm::log(record.scale / other.scale) / LIKE_SCALE;
        away * away + wider * wider
    }

    /// The residual of a training run with this truth, in units of its scale, around the prediction from a record: `f + s
    /// (u_i - f_i)/s_i`.
    pub fn moved(&self, run: usize, truth: f64, record: &Prediction) -> f64 {
        let other = self.left_out(run);
        let residual = (truth - other.bounded()) / other.scale;
        (record.bounded() + record.scale * residual).clamp(0.0, 1.0)
    }
}

impl Regression {
    /// Learns an unknown from `unknown.len()` rows of summaries.
    pub fn learn(summaries: &[f64], unknown: &[f64]) -> Self {
        let (value, residuals) = Function::learn(summaries, unknown);
        let sizes: Vec<f64> = residuals.iter().map(|e| e.abs()).collect();
        let least = LEAST_SIZE * median(&sizes);
        let logs: Vec<f64> = sizes
            .iter()
            .map(|size| libm::log(size + least + f64::MIN_POSITIVE))
            .collect();
        let (log_scale, of_logs) = Function::learn(summaries, &logs);
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

    /// Likeness of every training run to a record in this regression and in another: the product of their kernels.
    pub fn likeness(&self, summaries: &[f64], other: &Self) -> Vec<f64> {
        let own = |of: &Self| {
            let kernel = of.value.kernel(summaries);
            kernel.unwrap_or_else(|| vec![1.0; of.predictions.len()])
        };
        own(self).iter().zip(own(other)).map(|(a, b)| a * b).collect()
    }

    /// The prediction for these summaries of a record.
    pub fn predict(&self, summaries: &[f64]) -> Prediction {
        Prediction {
            value: self.value.at(summaries),
            scale: libm::exp(self.log_scale.at(summaries)),
        }
    }
}

impl Function {
    /// Learns a function from its values at `values.len()` rows of summaries; returns it with the residual of every run by all others.
    fn learn(summaries: &[f64], values: &[f64]) -> (Self, Vec<f64>) {
        let (n, d) = (values.len(), summaries.len() / values.len());
        let mean = mean(values);
        let targets: Vec<f64> = values.iter().map(|value| value - mean).collect();
        let nothing = Self {
            mean,
            lengths: Vec::new(),
            points: Vec::new(),
            coefficients: Vec::new(),
        };
        let searched = n.min(MAX_SEARCHED);
        let Some(lengths) = lengths(&summaries[..searched * d], &targets[..searched], d) else {
            return (nothing, targets);
        };
        let points = multiplied(summaries, &lengths.multipliers);
        let Some(fit) = Fit::of(kernel_of_all(&points, d), &targets, lengths.ridge) else {
            return (nothing, targets);
        };
        let found = Self {
            mean,
            lengths: lengths.multipliers,
            points,
            coefficients: fit.coefficients,
        };
        (found, fit.residuals)
    }

    /// Kernels between summaries and those of the training runs; none if the summaries tell nothing.
    fn kernel(&self, summaries: &[f64]) -> Option<Vec<f64>> {
        let d = self.lengths.len();
        (d > 0).then(|| kernel(&multiplied(summaries, &self.lengths), &self.points, d))
    }

    /// The value at these summaries.
    fn at(&self, summaries: &[f64]) -> f64 {
        let kernel = self.kernel(summaries).unwrap_or_default();
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

/// Rows of summaries, each summary times its factor.
fn multiplied(summaries: &[f64], lengths: &[f64]) -> Vec<f64> {
    let rows = summaries.chunks_exact(lengths.len());
    rows.flat_map(|row| row.iter().zip(lengths).map(|(x, length)| x * length))
        .collect()
}

/// The kernel `exp(-|x - x'|^2/2)`.
fn kernel(points: &[f64], others: &[f64], d: usize) -> Vec<f64> {
    let mut kernel = squared_distances(points, others, d);
    for value in &mut kernel {
        *value = libm::exp(-0.5 * *value);
    }
    kernel
}

/// The kernel of every pair of points.
fn kernel_of_all(points: &[f64], d: usize) -> Vec<f64> {
    let distances = squared_distances(points, points, d);
    exponentials(distances, points.len() / d, 1.0)
}

/// Exponentials `exp(-unit square/2)` of the elements of a symmetric matrix of n rows.
fn exponentials(mut squares: Vec<f64>, n: usize, unit: f64) -> Vec<f64> {
    for i in 0..n {
        for j in 0..=i {
            let value = libm::exp(-0.5 * unit * squares[i * n + j]);
            squares[i * n + j] = value;
            squares[j * n + i] = value;
        }
    }
    squares
}

/// A regression, and the residuals of every run by the others.
struct Fit {
    coefficients: Vec<f64>,
    residuals: Vec<f64>,
}

impl Fit {
    fn of(mut kernel: Vec<f64>, targets: &[f64], ridge: f64) -> Option<Self> {
        let n = targets.len();
        for i in 0..n {
            kernel[i * n + i] += ridge;
        }
        let factor = Factor::of(kernel, n)?;
        let mut coefficients = targets.to_vec();
        factor.solve(&mut coefficients);
        let inverse = factor.inverse_diagonal();
        let residuals = coefficients.iter().zip(inverse).map(|(a, d)| a / d).collect();
        Some(Self {
            coefficients,
            residuals,
        })
    }

    /// Mean square of the residuals, each of at most `bound`.
    fn error(&self, bound: f64) -> f64 {
        let squares = self.residuals.iter().map(|e| {
            let e = e.abs().min(bound);
            e * e
        });
        squares.sum::<f64>() / self.residuals.len() as f64
    }
}

/// Parameters of the kernel of an unknown.
struct Lengths {
    multipliers: Vec<f64>,
    ridge: f64,
}

/// Finds weights, lengths and ridge from some runs; none if no summaries depend on the unknown.
fn lengths(summaries: &[f64], targets: &[f64], d: usize) -> Option<Lengths> {
    let n = targets.len();
    let variance = targets.iter().map(|target| target * target).sum::<f64>() / n as f64;
    let bound = MAX_RESIDUAL * variance.sqrt();
    let mut weights = vec![1.0; d];
    let mut trial = Trial { spread: 2, ridge: -4 };
    let mut found: Option<(f64, Lengths)> = None;
    for round in 0..=ROUNDS {
        let points = multiplied(summaries, &weights);
        let distances = squared_distances(&points, &points, d);
        let median = median(&distances);
        if median <= 0.0 {
            return None;
        }
        let fit = |trial: Trial| {
            let unit = 1.0 / (libm::exp2(f64::from(trial.spread)) * median);
            let kernel = exponentials(distances.clone(), n, unit);
            let fit = Fit::of(kernel.clone(), targets, ridge(trial));
            fit.map(|fit| Tried {
                trial,
                error: fit.error(bound),
                coefficients: fit.coefficients,
                kernel,
                unit,
            })
        };
        let best = search(trial, &fit)?;
        trial = best.trial;
        let multipliers: Vec<f64> = weights.iter().map(|weight| weight * best.unit.sqrt()).collect();
        // Slopes of what was not learnt would be noise.
        if round == 0 && best.error > (1.0 - LEAST_EXPLAINED) * variance {
            return None;
        }
        if round < ROUNDS {
            weights = slopes(&best.kernel, &best.coefficients, summaries, &multipliers);
        }
        // Slopes are found with errors of their own, so that a round may be worse than the one before.
        if found.as_ref().is_none_or(|(least, _)| best.error < *least) {
            let ridge = ridge(trial);
            found = Some((best.error, Lengths { multipliers, ridge }));
        }
    }
    found.map(|(_, lengths)| lengths)
}

fn ridge(trial: Trial) -> f64 {
    libm::pow(10.0, 0.5 * f64::from(trial.ridge))
}

/// A trial and its regression.
struct Tried {
    trial: Trial,
    /// Mean square of the trial's residuals.
    error: f64,
    coefficients: Vec<f64>,
    kernel: Vec<f64>,
    /// Unit 1/h^2.
    unit: f64,
}

/// The trial with the least error of its neighbourhood, from `start` on; none if `start` has no regression.
fn search(start: Trial, fit: &dyn Fn(Trial) -> Option<Tried>) -> Option<Tried> {
    let mut tried = vec![start];
    let mut best = fit(start)?;
    loop {
        let around = best.trial;
        for (spread, ridge) in STEPS {
            let next = Trial {
                spread: around.spread + spread,
                ridge: around.ridge + ridge,
            };
            if tried.contains(&next) || !SPREADS.contains(&next.spread) || !RIDGES.contains(&next.ridge) {
                continue;
            }
            tried.push(next);
            // A smaller gain is not worth further trials.
            if let Some(found) = fit(next).filter(|found| found.error < 0.997 * best.error) {
                best = found;
                break;
            }
        }
        if best.trial == around {
            return Some(best);
        }
    }
}

/// Root mean square of the slope of the regression along every summary over the runs; the largest is scaled to 1.
///
/// ```text
/// df/dx_f(x_i) = sum_j a_j k_ij (x_jf - x_if) w_f/h^2
/// ```
fn slopes(kernel: &[f64], coefficients: &[f64], summaries: &[f64], multipliers: &[f64]) -> Vec<f64> {
    let (n, d) = (coefficients.len(), multipliers.len());
    let mut sums = vec![0.0; d];
    for i in 0..n {
        let mut slope = vec![0.0; d];
        let mut total = 0.0;
        for j in 0..n {
            let share = coefficients[j] * kernel[i * n + j];
            total += share;
            for (slope, x) in slope.iter_mut().zip(&summaries[j * d..(j + 1) * d]) {
                *slope += share * x;
            }
        }
        for (f, sum) in sums.iter_mut().enumerate() {
            let slope = (slope[f] - total * summaries[i * d + f]) * multipliers[f] * multipliers[f];
            *sum += slope * slope;
        }
    }
    let largest = sums.iter().copied().fold(0.0, f64::max);
    sums.iter().map(|sum| (sum / largest).sqrt()).collect()
}

/// The median of numbers.
fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Point `run` of the unit cube, less its mean: multiples of the roots of 2, 3 and 5, which fill it.
    fn point(run: usize, d: usize) -> Vec<f64> {
        let roots = [2.0_f64, 3.0, 5.0].into_iter().take(d);
        roots
            .map(|root| (root.sqrt() * (run as f64 + 1.0)).fract() - 0.5)
            .collect()
    }

    fn cube(n: usize, d: usize) -> Vec<f64> {
        (0..n).flat_map(|run| point(run, d)).collect()
    }

    /// Pseudorandom numbers from 0 to 1 (SplitMix64).
    fn chance(n: usize) -> Vec<f64> {
        let mut state = 0_u64;
        let mut next = || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..n).map(|_| next()).collect()
    }

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
            // A Gaussian kernel of some units of length bends a line by the cube of their ratio.
            assert!(
                (value - unknown(&row)).abs() < 1e-3 && scale < 1e-3,
                "{value} {scale}"
            );
        }
    }

    #[test]
    fn slopes_are_those_of_the_unknown() {
        let (n, d) = (150, 3);
        let table = cube(n, d);
        let targets: Vec<f64> = table
            .chunks_exact(d)
            .map(|row| 0.2 * row[0] - 0.1 * row[1])
            .collect();
        let multipliers = [0.5; 3];
        let kernel = kernel_of_all(&multiplied(&table, &multipliers), d);
        let fit = Fit::of(kernel.clone(), &targets, 1e-6).unwrap();
        let slopes = slopes(&kernel, &fit.coefficients, &table, &multipliers);
        // As exact as the regression of a line by a Gaussian kernel.
        assert!(
            slopes[0] == 1.0 && (slopes[1] - 0.5).abs() < 0.01 && slopes[2] < 0.01,
            "{slopes:?}"
        );
    }

    #[test]
    fn summaries_that_tell_nothing_predict_the_mean() {
        let n = 150;
        let truths = chance(n);
        let found = Regression::learn(&cube(n, 3), &truths);
        assert!(found.value.lengths.is_empty());
        assert_eq!(found.predict(&[0.1, 0.2, 0.3]).value, mean(&truths));
    }

    /// Residuals are those of runs left out, compared with a regression that has not seen them.
    #[test]
    fn residuals_are_those_of_runs_left_out() {
        let (n, d, ridge) = (12, 2, 0.01);
        let table = cube(n, d);
        let targets: Vec<f64> = table
            .chunks_exact(d)
            .map(|row| row[0] * row[1] + row[0])
            .collect();
        let all = Fit::of(kernel_of_all(&table, d), &targets, ridge).unwrap();
        let (points, last) = table.split_at((n - 1) * d);
        let rest = Fit::of(kernel_of_all(points, d), &targets[..n - 1], ridge).unwrap();
        let near = kernel(last, points, d);
        let predicted: f64 = near.iter().zip(&rest.coefficients).map(|(k, a)| k * a).sum();
        // Rounding, times a condition number of at most n/ridge.
        assert!((all.residuals[n - 1] - (targets[n - 1] - predicted)).abs() < 1e3 * f64::EPSILON);
    }
}
