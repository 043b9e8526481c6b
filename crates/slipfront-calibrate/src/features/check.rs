//! Numbers for the check of a record, which the estimate does not use.
//!
//! `d_i` are second differences `y_(i-1) - 2 y_i + y_(i+1)`, a slip is a fall of s3 by more than a quarter of
//! its range in the second half, and windows are shares of the record as in [the whole](super):
//!
//! ```text
//! noise             log of the quantiles of |d_i|/m at 0.5, 0.9 and 0.99
//! spectrum          log of the mean power in bands up to the highest frequency, of the second half
//! range             share of the values within a hundredth of the range of y at its largest, and at its least
//! first release     y behind the steepest fall after the first peak and before it, over its height
//! slips             their number; mean and scatter of the distances, depths and durations; correlation of a
//!                   distance with the depth after it; asymmetry, the share of rising steps of s3
//! shape of a slip   y around the steepest step of a slip, mean of all, over m
//! ```

use super::curve::{Curve, LEAST, deviation, log, log_power, quantiles};
use slipfront_study::statistics::mean;

/// Names of the groups of numbers, in words.
pub(crate) const GROUPS: [&str; 6] = [
    "noise",
    "spectrum",
    "range of the values",
    "shape of the first release",
    "distances and depths of slips",
    "shape of a slip",
];

/// The numbers of every group, in the order of [`GROUPS`].
pub(super) fn groups(curve: &Curve) -> [Vec<f64>; 6] {
    let slips = slips(curve);
    [
        noise(curve),
        spectrum(curve),
        range(curve.y),
        first_release(curve),
        regularity(curve, &slips),
        shape(curve, &slips),
    ]
}

fn noise(curve: &Curve) -> Vec<f64> {
    let m = curve.level.abs();
    let second = curve.y.windows(3).map(|y| (y[0] - 2.0 * y[1] + y[2]).abs() / m);
    quantiles(&second.collect::<Vec<_>>(), [0.5, 0.9, 0.99])
        .map(log)
        .to_vec()
}

/// First frequencies of the bands, as shares of the highest one.
const BANDS: [f64; 9] = [0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.55, 0.75, 1.0];

fn spectrum(curve: &Curve) -> Vec<f64> {
    let half = &curve.y[curve.y.len() / 2..];
    let e: Vec<f64> = half.iter().map(|y| y - curve.level).collect();
    let ends = BANDS.map(|share| (0.5 * share * e.len() as f64) as usize);
    let bands = ends.windows(2).map(|band| band[0]..band[1].max(band[0] + 1));
    log_power(&e, curve.level, bands)
}

fn range(y: &[f64]) -> Vec<f64> {
    let [low, high] = y
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &y| {
            [low.min(y), high.max(y)]
        });
    let near = 0.01 * (high - low);
    let share = |is: &dyn Fn(f64) -> bool| y.iter().filter(|y| is(**y)).count() as f64 / y.len() as f64;
    vec![share(&|y| y > high - near), share(&|y| y < low + near)]
}

/// Offsets in values at which the shape of a fall is taken.
const OFFSETS: [isize; 13] = [-8, -5, -3, -2, -1, 0, 1, 2, 3, 4, 6, 9, 14];

/// Values at the offsets from a place; beyond the ends, the nearest value.
fn around(y: &[f64], place: usize) -> impl Iterator<Item = f64> {
    let last = y.len() as isize - 1;
    OFFSETS
        .into_iter()
        .map(move |offset| y[(place as isize + offset).clamp(0, last) as usize])
}

fn first_release(curve: &Curve) -> Vec<f64> {
    let behind = curve.peak..(curve.peak + curve.of_400(60)).min(curve.y.len() - 1);
    let height = curve.height();
    around(curve.y, steepest(curve.y, behind))
        .map(|y| y / height)
        .collect()
}

/// Place of the steepest fall within a range, the first of several.
fn steepest(y: &[f64], places: std::ops::Range<usize>) -> usize {
    let fall = |i: usize| y[i] - y[i + 1];
    let start = places.start.min(y.len() - 2);
    places.fold(start, |best, i| if fall(i) > fall(best) { i } else { best })
}

/// First and last place of every slip in the second half.
fn slips(curve: &Curve) -> Vec<[usize; 2]> {
    let (s, start) = (&curve.s3, curve.y.len() / 2);
    let [low, high] = quantiles(&s[start..], [0.02, 0.98]);
    let least = (0.25 * (high - low)).max(LEAST * curve.level.abs());
    let mut slips = Vec::new();
    let (mut peak, mut trough) = (start, start);
    let mut is_falling = false;
    for i in start..s.len() {
        if is_falling {
            if s[i] < s[trough] {
                trough = i;
            }
            if s[i] - s[trough] > least {
                slips.push([peak, trough]);
                (is_falling, peak) = (false, i);
            }
        } else {
            if s[i] > s[peak] {
                peak = i;
            }
            if s[peak] - s[i] > least {
                (is_falling, trough) = (true, i);
            }
        }
    }
    slips
}

fn regularity(curve: &Curve, slips: &[[usize; 2]]) -> Vec<f64> {
    let (s, n) = (&curve.s3, curve.y.len() as f64);
    let depths: Vec<f64> = slips
        .iter()
        .map(|[from, to]| (s[*from] - s[*to]) / curve.level)
        .collect();
    let durations: Vec<f64> = slips.iter().map(|[from, to]| (to - from) as f64 / n).collect();
    let distances: Vec<f64> = slips
        .windows(2)
        .map(|pair| (pair[1][0] - pair[0][0]) as f64 / n)
        .collect();
    let half = &s[s.len() / 2..];
    let rising = half.windows(2).filter(|pair| pair[1] > pair[0]).count();
    let after = depths.get(1..).unwrap_or_default();
    let mut found = vec![
        libm::log(1.0 + slips.len() as f64),
        rising as f64 / half.len() as f64,
    ];
    for values in [&depths, &durations, &distances] {
        found.extend([log(mean(values)), log(deviation(values) / mean(values))]);
    }
    found.push(correlation(&distances, after));
    found
}

/// Correlation of two lists of the same length; 0 for fewer than three pairs, or for values that are equal
/// except for rounding.
fn correlation(one: &[f64], other: &[f64]) -> f64 {
    let is_the_same = |values: &[f64]| deviation(values) < 1e-9 * mean(values).abs();
    if one.len() < 3 || is_the_same(one) || is_the_same(other) {
        return 0.0;
    }
    let (a, b) = (mean(one), mean(other));
    let products: Vec<f64> = one.iter().zip(other).map(|(x, y)| (x - a) * (y - b)).collect();
    mean(&products) / (deviation(one) * deviation(other))
}

fn shape(curve: &Curve, slips: &[[usize; 2]]) -> Vec<f64> {
    let mut sums = vec![0.0; OFFSETS.len()];
    for [from, to] in slips {
        let place = steepest(curve.y, *from..*to);
        for (sum, y) in sums.iter_mut().zip(around(curve.y, place)) {
            *sum += y / (curve.level * slips.len() as f64);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten sawteeth in the second half of 400 values: rises over 16, falls over 4.
    fn sawteeth() -> Vec<f64> {
        let tooth = |i: usize| match i % 20 {
            k if k < 16 => k as f64 / 16.0,
            k => (20 - k) as f64 / 4.0,
        };
        (0..400).map(|i| 1.0 + 0.2 * tooth(i)).collect()
    }

    #[test]
    fn sawteeth_have_their_slips() {
        let y = sawteeth();
        let curve = Curve::new(&y);
        let slips = slips(&curve);
        // The last one ends with the record, before friction rises again.
        assert_eq!(slips.len(), 9, "{slips:?}");
        assert!(slips.windows(2).all(|pair| pair[1][0] - pair[0][0] == 20));
        let found = regularity(&curve, &slips);
        assert!((found[0] - 10.0_f64.ln()).abs() < 1e-12);
        // 16 of 20 steps rise; the running mean keeps all but the two next to a turning point.
        assert!((found[1] - 0.7).abs() < 0.01, "{found:?}");
        // Distances are all 20 of 400: they do not scatter.
        assert!((found[6] - 0.05_f64.ln()).abs() < 1e-12 && found[7] == LEAST.ln());
    }

    #[test]
    fn clipped_values_are_counted() {
        let y: Vec<f64> = sawteeth().iter().map(|y| y.min(1.1)).collect();
        // Of the 20 values of each tooth 8 to 18 are 1.1 or more.
        assert_eq!(range(&y)[0], 0.55);
    }

    #[test]
    fn noise_is_that_of_second_differences() {
        let y: Vec<f64> = (0..400).map(|i| 1.0 + 0.01 * f64::from(i % 2)).collect();
        let m = Curve::new(&y).level;
        assert!(
            noise(&Curve::new(&y))
                .iter()
                .all(|value| (value - (0.02 / m).ln()).abs() < 1e-9)
        );
    }
}
