//! Maxima over blocks, computed with eight running values at any register width of the processor.

const LANES: usize = 8;

/// Largest `term(k)` over `0..n`, at least 0.
#[inline(always)]
pub fn largest(n: usize, term: impl Fn(usize) -> f64) -> f64 {
    let larger = |one: f64, other: f64| if other > one { other } else { one };
    let mut lanes = [0.0; LANES];
    let whole = n - n % LANES;
    for first in (0..whole).step_by(LANES) {
        for (k, lane) in lanes.iter_mut().enumerate() {
            *lane = larger(*lane, term(first + k));
        }
    }
    (whole..n).map(term).chain(lanes).fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_counts() {
        for n in 0..40 {
            assert_eq!(
                largest(n, |k| (k * 7 % 13) as f64),
                (0..n).map(|k| k * 7 % 13).max().unwrap_or(0) as f64
            );
        }
    }
}
