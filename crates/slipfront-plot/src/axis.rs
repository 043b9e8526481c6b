//! A linear or logarithmic axis: maps values to pixels and checks which values can be drawn.

#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnAxis {
    /// Ends of the axis: values, or their decimal logarithms if the axis is logarithmic.
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    /// Pixels of the ends.
    pub(crate) start: f64,
    pub(crate) end: f64,
    pub(crate) is_log: bool,
}

impl DrawnAxis {
    /// An axis around `values` with a margin of `pad` times its length at both ends, not yet placed.
    ///
    /// It is logarithmic if `log` is true and every drawable value is positive.
    pub(crate) fn around(values: &[f64], log: bool, pad: f64) -> Self {
        let log = log && values.iter().filter(|v| drawable(**v)).all(|&value| value > 0.0);
        let (lo, hi) = range(values.iter().map(|&value| measured(value, log)));
        let pad = pad * (hi - lo);
        Self::between(lo - pad, hi + pad, log)
    }

    /// An axis from `lo` to `hi`, not yet placed; both are decimal logarithms if `is_log`.
    pub(crate) fn between(lo: f64, hi: f64, is_log: bool) -> Self {
        Self {
            lo,
            hi,
            start: 0.0,
            end: 1.0,
            is_log,
        }
    }

    /// A linear axis from `lo` to `hi`, not yet placed.
    pub(crate) fn linear(lo: f64, hi: f64) -> Self {
        Self::between(lo, hi, false)
    }

    /// The axis placed from one pixel to another.
    pub(crate) fn placed(self, start: f64, end: f64) -> Self {
        Self { start, end, ..self }
    }

    /// Coordinate of a value along the axis: the value itself, or its decimal logarithm.
    pub(crate) fn measure(&self, value: f64) -> f64 {
        measured(value, self.is_log)
    }

    /// The pixel of a value.
    pub(crate) fn at(&self, value: f64) -> f64 {
        self.at_measured(self.measure(value))
    }

    /// The pixel of a value, clamped to the ends of the axis.
    pub(crate) fn clamped(&self, value: f64) -> f64 {
        self.at_measured(self.measure(value).clamp(self.lo, self.hi))
    }

    /// The pixel of a coordinate returned by [`measure`](Self::measure).
    pub(crate) fn at_measured(&self, measured: f64) -> f64 {
        self.start + (measured - self.lo) / (self.hi - self.lo) * (self.end - self.start)
    }

    /// True when `value` lies on the axis.
    pub(crate) fn contains(&self, value: f64) -> bool {
        (self.lo..=self.hi).contains(&self.measure(value))
    }
}

fn measured(value: f64, log: bool) -> f64 {
    if log { libm::log10(value) } else { value }
}

/// Magnitude from which values are treated as missing, because their differences could overflow.
const MAX_VALUE: f64 = 1e100;

/// Limit below which differences are treated as zero, because fractions of them could underflow.
const MIN_DIFFERENCE: f64 = 1e-290;

/// True when a value can be placed on an axis.
pub(crate) fn drawable(value: f64) -> bool {
    value.abs() < MAX_VALUE
}

/// The smallest and largest drawable value, [`widened`]; 0 and 1 when there is none.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let empty = (f64::INFINITY, f64::NEG_INFINITY);
    let values = values.filter(|&value| drawable(value));
    let (lo, hi) = values.fold(empty, |(lo, hi), value| (lo.min(value), hi.max(value)));
    widened(if lo <= hi { (lo, hi) } else { (0.0, 1.0) })
}

/// The range itself, or a wider one around it if it is too narrow for an axis.
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
    fn an_axis_through_zero_is_never_logarithmic() {
        assert!(!DrawnAxis::around(&[0.0, 1.0], true, 0.0).is_log);
        assert!(DrawnAxis::around(&[f64::NAN, 1.0], true, 0.0).is_log);
    }

    #[test]
    fn values_are_placed_by_their_logarithms() {
        let axis = DrawnAxis::around(&[1.0, 100.0], true, 0.0).placed(10.0, 30.0);
        assert_eq!([1.0, 10.0, 100.0].map(|value| axis.at(value)), [10.0, 20.0, 30.0]);
        assert!(axis.contains(50.0) && !axis.contains(101.0) && axis.clamped(1e9) == 30.0);
    }

    #[test]
    fn odd_ranges_still_make_an_axis() {
        assert_eq!(range([f64::NAN, f64::INFINITY].into_iter()), (0.0, 1.0));
        assert_eq!(widened((0.0, 0.0)), (-0.5, 0.5));
        let (lo, hi) = widened((1e16, 1e16));
        assert!(lo < 1e16 && hi > 1e16);
    }
}
