//! Sums and maxima over blocks whose result does not depend on the SIMD width: eight running values, combined at the end in
//! a fixed order.

/// Number of running values, whatever the width of the processor's registers.
const LANES: usize = 8;

/// Lane k mod 8 takes term k of `0..n` to what it has.
#[inline(always)]
fn lanes(n: usize, term: impl Fn(usize) -> f64, take: impl Fn(f64, f64) -> f64) -> [f64; LANES] {
    let mut lanes = [0.0; LANES];
    let whole = n - n % LANES;
    for first in (0..whole).step_by(LANES) {
        for (k, lane) in lanes.iter_mut().enumerate() {
            *lane = take(*lane, term(first + k));
        }
    }
    for (k, lane) in lanes.iter_mut().enumerate().take(n - whole) {
        *lane = take(*lane, term(whole + k));
    }
    lanes
}

/// Sum of `term(k)` over `0..n`: lane k mod 8 takes term k, then the lanes are added in pairs.
///
/// ```text
/// ((s_0 + s_4) + (s_2 + s_6)) + ((s_1 + s_5) + (s_3 + s_7))
/// ```
#[inline(always)]
pub(crate) fn sum(n: usize, term: impl Fn(usize) -> f64) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes(n, term, |sum, term| sum + term);
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// Largest `term(k)` over `0..n`, at least 0.
#[inline(always)]
pub(crate) fn largest(n: usize, term: impl Fn(usize) -> f64) -> f64 {
    let larger = |one: f64, other: f64| if other > one { other } else { one };
    lanes(n, term, larger).into_iter().fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_counts_once() {
        for n in 0..40 {
            assert_eq!(sum(n, |k| k as f64), (n * n.saturating_sub(1) / 2) as f64, "{n}");
            assert_eq!(
                largest(n, |k| (k * 7 % 13) as f64),
                (0..n).map(|k| k * 7 % 13).max().unwrap_or(0) as f64
            );
        }
    }
}
