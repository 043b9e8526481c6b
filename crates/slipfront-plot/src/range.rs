//! Ranges of values that an axis can show.

/// Larger values are taken as blank: their differences might not be finite.
const MAX_VALUE: f64 = 1e100;

/// Smaller differences are taken as none: their parts might be zero.
const MIN_DIFFERENCE: f64 = 1e-290;

/// True when a value can be placed on an axis.
pub(crate) fn drawable(value: f64) -> bool {
    value.abs() < MAX_VALUE
}

/// The smallest and largest drawable value; 0 and 1 when there is none.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (lo, hi) = values
        .filter(|&value| drawable(value))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), value| {
            (lo.min(value), hi.max(value))
        });
    if lo <= hi { (lo, hi) } else { (0.0, 1.0) }
}

/// A range, or one around it when it is too narrow to be an axis.
pub(crate) fn widened((lo, hi): (f64, f64)) -> (f64, f64) {
    let size = lo.abs().max(hi.abs());
    if hi - lo > 1e-9 * size && hi - lo > MIN_DIFFERENCE {
        return (lo, hi);
    }
    let margin = if size > MIN_DIFFERENCE { 0.1 * size } else { 0.5 };
    (lo - margin, hi + margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_ranges_still_make_an_axis() {
        assert_eq!(range([f64::NAN, f64::INFINITY].into_iter()), (0.0, 1.0));
        assert_eq!(widened((0.0, 0.0)), (-0.5, 0.5));
        let (lo, hi) = widened((1e16, 1e16));
        assert!(lo < 1e16 && hi > 1e16);
    }
}
