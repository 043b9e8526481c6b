//! Bisection, for solutions without a closed form.

/// The first number between two ends, to the last bit, from which a condition holds that holds at the second
/// end.
pub(super) fn bisected([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
}
