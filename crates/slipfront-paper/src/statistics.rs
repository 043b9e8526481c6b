//! Statistics of lists of values.

pub(super) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

pub(super) fn smallest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

/// Difference of the largest and the smallest value.
pub(super) fn range(values: &[f64]) -> f64 {
    largest(values.iter().copied()) - smallest(values.iter().copied())
}

/// The largest distance of a value from a center.
pub(super) fn farthest(values: &[f64], center: f64) -> f64 {
    largest(values.iter().map(|value| (value - center).abs()))
}

/// Distances between two lists, pair by pair.
pub(super) fn distances(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).collect()
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The standard deviation, with n in the denominator.
pub(super) fn deviation(values: &[f64]) -> f64 {
    let center = mean(values);
    (values.iter().map(|value| (value - center).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// The difference of each value from the one before it.
pub(super) fn rises(values: &[f64]) -> Vec<f64> {
    values.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// Ratios of two lists, pair by pair.
pub(super) fn ratios(numerators: &[f64], denominators: &[f64]) -> Vec<f64> {
    numerators.iter().zip(denominators).map(|(a, b)| a / b).collect()
}
