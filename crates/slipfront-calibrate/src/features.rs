//! Features of a curve of friction, its summary statistics: numbers from which a calibration learns.
//!
//! `y_i`, i from 0 to n - 1, is friction at n instants or places in equal steps. Widths of windows are shares
//! of the record: "w of 400" is w n/400 values. `s3` and `s5` are running means over 3 and 5 of 400; `m` is
//! the mean of the second half, in which the slider is assumed to slide steadily. Each file of this folder
//! has the formulas of its numbers. They are ratios and logarithms, so that the regression can be nearly
//! linear.

mod check;
mod curve;
mod levels;
mod loading;
mod release;
mod steady;

use self::check::GROUPS as CHECKED;
use self::curve::Curve;
pub(crate) use self::curve::{deviation, level, quantiles};

/// Smallest number of values of a curve that has features.
pub(crate) const MIN_VALUES: usize = 40;

/// The features of a curve of at least [`MIN_VALUES`] values, in a fixed order.
///
/// # Panics
/// If there are fewer values.
pub(crate) fn features(y: &[f64]) -> Vec<f64> {
    assert!(y.len() >= MIN_VALUES);
    estimated_from(&Curve::new(y)).concat()
}

/// Names of the groups of numbers for the check of a record, in words.
pub(crate) fn checked_groups() -> impl Iterator<Item = &'static str> {
    ESTIMATED.into_iter().chain(CHECKED)
}

/// The numbers for the check of a curve, in the groups of [`checked_groups`]: its features, and others that
/// the estimate does not use.
pub(crate) fn checked(y: &[f64]) -> Vec<Vec<f64>> {
    let curve = Curve::new(y);
    let mut groups = estimated_from(&curve).to_vec();
    groups.extend(check::groups(&curve).map(finite));
    groups
}

/// Names of the groups of features, in words.
const ESTIMATED: [&str; 4] = ["loading", "first fall", "levels of friction", "steady sliding"];

/// The groups of features, in the order of [`ESTIMATED`].
fn estimated_from(curve: &Curve) -> [Vec<f64>; 4] {
    let groups = [
        loading::features(curve),
        release::features(curve),
        levels::features(curve),
        steady::features(curve),
    ];
    groups.map(finite)
}

/// The numbers, with NaN and infinity replaced by 0: ratios of a curve without friction or without noise are
/// not finite.
fn finite(numbers: Vec<f64>) -> Vec<f64> {
    let or_zero = |number: f64| if number.is_finite() { number } else { 0.0 };
    numbers.into_iter().map(or_zero).collect()
}

/// Number of the features of a curve.
pub(crate) fn n_features() -> usize {
    features(&[0.0; MIN_VALUES]).len()
}

#[cfg(test)]
mod tests {
    use super::curve::tests::ramp_and_fall;
    use super::*;

    #[test]
    fn every_curve_has_finite_features() {
        for y in [vec![0.0; 40], vec![0.3; 1000], ramp_and_fall()] {
            let found = features(&y);
            assert!(found.iter().all(|value| value.is_finite()), "{found:?}");
        }
        assert_eq!(features(&[0.0; 40]).len(), features(&ramp_and_fall()).len());
    }
}
