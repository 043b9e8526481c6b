//! Alignment of a measured record with the curve of a run: the shift of its times or displacements.

use crate::interpolation::interpolate;

/// Non-decreasing times or displacements, and the friction at each.
pub(super) type Points<'p> = (&'p [f64], &'p [f64]);

/// A shift at which a record fits a curve better than at neighbouring shifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fitting {
    pub(super) shift: f64,
    pub(super) misfit: f64,
}

/// Distance between a shifted record and a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misfit {
    /// Root mean square of the differences.
    pub rms: f64,
    /// Number of points of the record that lie within the curve.
    pub points: usize,
}

/// Least overlap of record and curve for a misfit, over the length of the shorter of both, and least share of
/// the points of the record within the curve, unless nearly the whole curve lies within the record: a smaller
/// overlap is not meaningful.
const LEAST_COMMON: f64 = 0.1;

/// Share of a curve within the record that counts as the whole curve.
const NEARLY_WHOLE: f64 = 0.9;

/// Least number of points of the record within the curve.
const LEAST_POINTS: usize = 3;

/// Misfit relative to the least one, up to which another shift may also be the right one.
const AS_GOOD: f64 = 2.0;

/// Difference between two shifts, relative to the shorter of record and curve, up to which they look the same
/// in a picture.
const SAME_SHIFT: f64 = 0.05;

/// Largest number of shifts that are refined.
const MAX_FITTING: usize = 8;

/// Value at `x` of a curve by linear interpolation; none beyond its ends.
fn value_at((xs, ys): Points, x: f64) -> Option<f64> {
    let [from, to] = ends(xs);
    (!xs.is_empty() && (from..=to).contains(&x)).then(|| interpolate(xs, ys, x))
}

/// Distance between a record, shifted, and a curve, over the points of the record within the curve; none if
/// they overlap too little.
pub(super) fn misfit((xs, ys): Points, curve: Points, shift: f64) -> Option<Misfit> {
    let ([from, to], [start, end]) = (ends(xs).map(|x| x + shift), ends(curve.0));
    let common = to.min(end) - from.max(start);
    if common < LEAST_COMMON * (to - from).min(end - start) {
        return None;
    }
    let differences = xs
        .iter()
        .zip(ys)
        .filter_map(|(x, y)| Some(value_at(curve, x + shift)? - y));
    let (mut sum, mut points) = (0.0, 0);
    for difference in differences {
        (sum, points) = (sum + difference * difference, points + 1);
    }
    let are_enough =
        points as f64 >= LEAST_COMMON * xs.len() as f64 || common >= NEARLY_WHOLE * (end - start);
    (are_enough && points >= LEAST_POINTS.min(xs.len())).then(|| Misfit {
        rms: (sum / points as f64).sqrt(),
        points,
    })
}

/// First and last of values, 0 where there are none.
pub(super) fn ends(values: &[f64]) -> [f64; 2] {
    [values.first(), values.last()].map(|end| end.copied().unwrap_or_default())
}

/// The shifts with the least [`misfit`], the best first, among those at which record and curve overlap by at
/// least half of the shorter one. There is at least one.
pub(super) fn fitting_shifts(record: Points, curve: Points) -> Vec<Fitting> {
    const POINTS: usize = 2000;
    const SHIFTS: u32 = 400;
    // A part of the points gives the same result as all of them, in less time.
    let thin = |values: &[f64]| -> Vec<f64> {
        let step = values.len().div_ceil(POINTS);
        values.iter().step_by(step).copied().collect()
    };
    let (xs, ys) = (thin(record.0), thin(record.1));
    let ([from, to], [start, end]) = (ends(record.0), ends(curve.0));
    let common = 0.5 * (to - from).min(end - start);
    let (low, high) = (start - to + common, end - from - common);
    let badness = |shift: f64| misfit((&xs, &ys), curve, shift).map_or(f64::INFINITY, |misfit| misfit.rms);
    let step = (high - low) / f64::from(SHIFTS);
    let tried: Vec<Fitting> = (0..=SHIFTS)
        .map(|k| low + step * f64::from(k))
        .map(|shift| Fitting {
            shift,
            misfit: badness(shift),
        })
        .collect();
    let is_least = |k: usize| {
        let around = &tried[k.saturating_sub(1)..tried.len().min(k + 2)];
        around.iter().all(|other| tried[k].misfit <= other.misfit)
    };
    let mut least: Vec<Fitting> = (0..tried.len())
        .filter(|&k| is_least(k))
        .map(|k| tried[k])
        .collect();
    least.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    least.truncate(MAX_FITTING);
    for found in &mut least {
        found.shift = refined(found.shift - step, found.shift + step, [low, high], badness);
        found.misfit = badness(found.shift);
    }
    least.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    least
}

/// The shift with the least badness between two shifts, within bounds, by golden-section search.
fn refined(from: f64, to: f64, [low, high]: [f64; 2], badness: impl Fn(f64) -> f64) -> f64 {
    const ROUNDS: u32 = 40;
    let (mut low, mut high) = (from.max(low), to.min(high));
    let ratio = 0.5 * (5_f64.sqrt() - 1.0);
    for _ in 0..ROUNDS {
        let (inner, outer) = (high - ratio * (high - low), low + ratio * (high - low));
        if badness(inner) <= badness(outer) {
            high = outer;
        } else {
            low = inner;
        }
    }
    0.5 * (low + high)
}

/// The first of the `others` that fits about as well as the best shift, or better, and is not that shift;
/// `length` is the length of the shorter of record and curve.
pub(super) fn rival(best: Fitting, others: &[Fitting], length: f64) -> Option<Fitting> {
    let is_other = |other: &&Fitting| {
        (other.shift - best.shift).abs() > SAME_SHIFT * length && other.misfit <= AS_GOOD * best.misfit
    };
    others.iter().find(is_other).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curve that rises to a peak and falls to a plateau, over 0 to 1.
    fn curve() -> (Vec<f64>, Vec<f64>) {
        let xs: Vec<f64> = (0..=1000).map(|k| f64::from(k) / 1000.0).collect();
        let ys = xs.iter().map(|&x| level(x)).collect();
        (xs, ys)
    }

    fn level(x: f64) -> f64 {
        if x < 0.3 {
            x / 0.3
        } else {
            0.5 + 0.5 * (-(x - 0.3) / 0.02).exp()
        }
    }

    fn record(from: f64, to: f64, shift: f64) -> (Vec<f64>, Vec<f64>) {
        let xs: Vec<f64> = (0..=500)
            .map(|k| from + (to - from) * f64::from(k) / 500.0)
            .collect();
        let ys = xs.iter().map(|&x| level(x)).collect();
        (xs.iter().map(|x| x - shift).collect(), ys)
    }

    #[test]
    fn a_record_with_a_peak_has_one_place() {
        let (xs, ys) = curve();
        let (at, of) = record(0.1, 0.8, 0.37);
        let found = fitting_shifts((&at, &of), (&xs, &ys));
        // A tenth of the spacing of the points of the curve, which is linear between them.
        assert!((found[0].shift - 0.37).abs() < 1e-4, "{found:?}");
        assert_eq!(rival(found[0], &found, 0.7), None);
    }

    /// A plateau fits everywhere on a plateau.
    #[test]
    fn a_record_without_a_peak_has_many_places() {
        let (xs, ys) = curve();
        let at: Vec<f64> = (0..=100).map(|k| f64::from(k) / 500.0).collect();
        let of: Vec<f64> = at.iter().map(|x| 0.5 + 1e-3 * (200.0 * x).sin()).collect();
        let found = fitting_shifts((&at, &of), (&xs, &ys));
        assert!(rival(found[0], &found, 0.2).is_some(), "{found:?}");
    }

    /// There is no misfit beyond the ends of a curve, nor with too little overlap.
    #[test]
    fn a_record_beside_the_curve_has_no_misfit() {
        let (xs, ys) = curve();
        let (at, of) = record(0.1, 0.8, 0.0);
        let misfit = |shift| misfit((&at, &of), (&xs, &ys), shift);
        assert_eq!(misfit(5.0), None);
        // The curve ends at 1, so that 0.069 and 0.071 of the record, which is 0.7 long, are left on it.
        assert_eq!(misfit(0.831), None);
        assert_eq!(misfit(0.829).unwrap().points, 51);
        let all = misfit(0.0).unwrap();
        assert!(all.rms < 1e-2 && all.points == 501, "{all:?}");
    }

    /// A curve that is shorter than a tenth of the record may lie within it.
    #[test]
    fn a_long_record_may_go_beyond_the_curve() {
        let (xs, ys) = curve();
        let at: Vec<f64> = (0..=800).map(|k| 0.25 * f64::from(k)).collect();
        let found = misfit((&at, &at), (&xs, &ys), -100.0).unwrap();
        assert_eq!(found.points, 5);
        // Two points say nothing about a curve.
        let at: Vec<f64> = (0..=200).map(f64::from).collect();
        assert_eq!(misfit((&at, &at), (&xs, &ys), -100.0), None);
    }

    /// A record of which nearly all points lie far beyond the curve has the length of the curve and more in
    /// common with it, and no misfit.
    #[test]
    fn a_few_points_within_the_curve_are_no_overlap() {
        let (xs, ys) = curve();
        let at: Vec<f64> = (0..100)
            .map(|k| {
                if k < 5 {
                    0.2 * f64::from(k)
                } else {
                    1e6 + f64::from(k)
                }
            })
            .collect();
        assert_eq!(misfit((&at, &at), (&xs, &ys), 0.3), None);
    }
}
