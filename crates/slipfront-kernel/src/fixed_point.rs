//! Sums that do not depend on the order of their terms.
//!
//! Numbers with a known bound become integers, multiples of a quantum. Integers add up exactly: in any order,
//! over any number of lanes, tiles, threads and ranks the sum has the same bits. Each term is rounded to the
//! nearest multiple of the quantum, with an error of at most `2^-51` of the bound.

use serde::{Deserialize, Serialize};

use crate::communicator::{Alone, Communicator};
use crate::reductions;

/// Numbers with a given bound on their size, as multiples of a quantum, which is a power of two.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FixedPoint {
    /// Power of two above the bound; NaN if there is no bound, so that all sums are NaN.
    limit: f64,
}

/// Largest bound: quanta and their sums with numbers must stay finite.
const MAX_BOUND: f64 = 1e300;

/// Least bound: a smaller one is replaced by it, so that quanta do not underflow.
const MIN_BOUND: f64 = 1e-270;

/// Number of quanta in the largest number.
const QUANTA: f64 = (1_u64 << 51) as f64;

/// Most integers that can be added without overflow of 64 bits.
const MAX_TERMS: usize = 1 << 11;

impl FixedPoint {
    /// Multiples of a quantum for numbers of at most `bound` in size.
    pub fn new(bound: f64) -> Self {
        let exponent = bound.max(MIN_BOUND).to_bits() & f64::INFINITY.to_bits();
        Self {
            limit: if bound <= MAX_BOUND {
                2.0 * f64::from_bits(exponent)
            } else {
                f64::NAN
            },
        }
    }

    /// The power of two above the bound.
    pub fn limit(self) -> f64 {
        self.limit
    }

    /// Multiples of the quantum that belongs to this [limit](Self::limit).
    pub fn with_limit(limit: f64) -> Self {
        Self { limit }
    }

    /// Shift by `1.5 2^52` quanta. Adding it to a number rounds the number to a multiple of the quantum, and
    /// the bits of the sum are the bits of the shift plus the multiple.
    pub fn shift(self) -> f64 {
        3.0 * self.limit
    }

    /// The multiple of the quantum nearest to `x`.
    #[inline(always)]
    pub fn integer(self, x: f64) -> i64 {
        let shift = self.shift();
        (x + shift).to_bits().wrapping_sub(shift.to_bits()) as i64
    }

    /// Sum of the integers of `term(k)` over `0..n`. The integer of a term that is NaN or exceeds the bound
    /// is arbitrary, so that sums with such terms may wrap around. Without a bound, [`value`](Self::value)
    /// returns NaN for any sum.
    #[inline(always)]
    pub fn sum(self, n: usize, term: impl Fn(usize) -> f64) -> i128 {
        let mut sum = 0;
        for first in (0..n).step_by(MAX_TERMS) {
            let terms = first..n.min(first + MAX_TERMS);
            let integers = terms.map(|k| self.integer(term(k)));
            sum += i128::from(integers.fold(0, i64::wrapping_add));
        }
        sum
    }

    /// Number that a sum of integers represents, rounded to the nearest double.
    pub fn value(self, sum: i128) -> f64 {
        sum as f64 * (self.limit / QUANTA)
    }
}

/// Numbers of a range that may lie far from zero, as differences from its centre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Window {
    centre: f64,
    differences: FixedPoint,
}

impl Window {
    /// Least difference between the ends of the range of a window: displacements differ by more as soon as
    /// blocks slide.
    const MIN_RANGE: f64 = 1e-9;

    /// A window of at least twice the range from `low` to `high`, with this range in its middle.
    pub fn around(low: f64, high: f64) -> Self {
        let differences = FixedPoint::new((high - low).max(Self::MIN_RANGE));
        let grid = differences.limit() / 8.0;
        Self {
            centre: ((low + high) / 2.0 / grid).round() * grid,
            differences,
        }
    }

    /// The window with this [centre](Self::centre) and the limit of its [differences](Self::differences).
    pub fn new([centre, limit]: [f64; 2]) -> Self {
        Self {
            centre,
            differences: FixedPoint::with_limit(limit),
        }
    }

    /// Whether all numbers from `low` to `high` can be converted.
    pub fn contains(&self, low: f64, high: f64) -> bool {
        let [first, last] = [-1.0, 1.0].map(|side| self.centre + side * self.differences.limit());
        first <= low && high <= last
    }

    /// Middle of the window.
    pub fn centre(&self) -> f64 {
        self.centre
    }

    /// Multiples of a quantum for differences from the centre.
    pub fn differences(&self) -> FixedPoint {
        self.differences
    }

    /// Constant for rounding: its sum with a number has, in its bits, the nearest multiple for the difference
    /// of the number from the centre. See [`FixedPoint::shift`].
    pub fn shift(&self) -> f64 {
        self.differences.shift() - self.centre
    }
}

/// Sum of `term(k)` over `0..n`, with the same bits for any order of the terms.
#[inline(always)]
pub fn sum(n: usize, term: impl Fn(usize) -> f64) -> f64 {
    sum_over(&Alone, n, term)
}

/// Sum of `term(k)` over the blocks of all `ranks`, with the same bits for any order. All ranks must call
/// this together, each with its own `n` terms.
#[inline(always)]
pub fn sum_over(ranks: &dyn Communicator, n: usize, term: impl Fn(usize) -> f64) -> f64 {
    // A NaN term makes the bound infinite.
    let size = |term: f64| if term.is_nan() { f64::INFINITY } else { term.abs() };
    let largest = ranks.largest_of(reductions::largest(n, |k| size(term(k))));
    let fixed_point = FixedPoint::new(largest);
    let mut words = split(fixed_point.sum(n, term));
    ranks.sum(&mut words);
    fixed_point.value(join(words))
}

/// A sum over blocks that is computed at every step, part by part. Its largest term rarely passes the power
/// of two that bounds the terms, or falls below half of it. The terms are added with the bound of the step
/// before, while the largest is found, and are added once more if the bound has changed. So the sum equals
/// [`sum`] of the terms, whatever came before.
#[derive(Clone, Copy, Debug)]
pub struct RunningSum {
    bound: FixedPoint,
    /// Bits of the largest size of a term so far. As integers, bits have the order of the sizes, and NaN is
    /// larger than all of them.
    largest: i64,
    sum: i128,
}

impl RunningSum {
    /// Adds terms to the sum.
    #[inline(always)]
    pub fn add(&mut self, terms: &[f64]) {
        const SIZE: u64 = i64::MAX as u64;
        let shift = self.bound.shift();
        for terms in terms.chunks(MAX_TERMS) {
            let (mut largest, mut sum) = (self.largest, 0_u64);
            for term in terms {
                largest = largest.max((term.to_bits() & SIZE) as i64);
                sum = sum.wrapping_add((term + shift).to_bits());
            }
            self.largest = largest;
            let shifts = shift.to_bits().wrapping_mul(terms.len() as u64);
            self.sum += i128::from(sum.wrapping_sub(shifts) as i64);
        }
    }

    /// Size of the largest term so far; infinite if one is NaN.
    fn largest(&self) -> f64 {
        let size = f64::from_bits(self.largest as u64);
        if size.is_nan() { f64::INFINITY } else { size }
    }

    /// Adds the terms of other sums with the same bounds.
    pub fn join<const N: usize>(sums: &mut [Self; N], others: &[Self; N]) {
        for (sum, other) in sums.iter_mut().zip(others) {
            sum.largest = sum.largest.max(other.largest);
            sum.sum += other.sum;
        }
    }

    /// Empties the sum and sets the bound of the next terms from the `largest` of the terms before. Returns
    /// whether those were added with this bound.
    fn restart(&mut self, largest: f64) -> bool {
        let bound = FixedPoint::new(largest);
        let was_bound = bound.limit.to_bits() == self.bound.limit.to_bits();
        *self = Self {
            bound,
            ..Self::default()
        };
        was_bound
    }

    /// Sums of all terms that all `ranks` have added; none if a bound has changed, so that all terms have to
    /// be added once more.
    pub fn finish<const N: usize>(ranks: &dyn Communicator, sums: &mut [Self; N]) -> Option<[f64; N]> {
        let mut largest = sums.each_ref().map(Self::largest);
        ranks.largest(&mut largest);
        let mut words = sums.each_ref().map(|sum| split(sum.sum));
        ranks.sum(words.as_flattened_mut());
        let (mut found, mut were_bounds) = ([0.0; N], true);
        for (k, sum) in sums.iter_mut().enumerate() {
            found[k] = sum.bound.value(join(words[k]));
            were_bounds &= sum.restart(largest[k]);
        }
        were_bounds.then_some(found)
    }
}

/// Number of blocks whose terms [`sums_by_parts`] adds at once: so few that they are on the stack.
pub const PART: usize = 1 << 10;

/// Sums over `n` blocks, each with the same bits for any order: `read` receives the number of a sum and the
/// first of some blocks, and writes the terms of these blocks. Without memory for all blocks. All ranks must
/// call this together.
pub fn sums_by_parts<const N: usize>(
    ranks: &dyn Communicator,
    n: usize,
    mut read: impl FnMut(usize, usize, &mut [f64]),
) -> [f64; N] {
    let mut terms = [0.0; PART];
    let mut sums = [RunningSum::default(); N];
    loop {
        for (number, sum) in sums.iter_mut().enumerate() {
            for first in (0..n).step_by(PART) {
                let terms = &mut terms[..PART.min(n - first)];
                read(number, first, terms);
                sum.add(terms);
            }
        }
        if let Some(found) = RunningSum::finish(ranks, &mut sums) {
            return found;
        }
    }
}

impl Default for RunningSum {
    fn default() -> Self {
        Self {
            bound: FixedPoint::new(0.0),
            largest: 0,
            sum: 0,
        }
    }
}

/// Number of bits of a sum in the lower of its two words.
const LOW_BITS: u32 = 40;

/// A sum of integers as two words, each of which may be added over up to 2^23 ranks. [`join`] restores the
/// sum.
///
/// The sum over all ranks is below 2^102, the integers of 2^51 numbers.
pub fn split(sum: i128) -> [i64; 2] {
    let low = sum & ((1 << LOW_BITS) - 1);
    [low as i64, (sum >> LOW_BITS) as i64]
}

/// Sum with the words, or sums of words, `low` and `high`: see [`split`].
pub fn join([low, high]: [i64; 2]) -> i128 {
    (i128::from(high) << LOW_BITS) + i128::from(low)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn small_integers_are_added_exactly() {
        for n in 0..40 {
            assert_eq!(sum(n, |k| k as f64), (n * n.saturating_sub(1) / 2) as f64, "{n}");
        }
        assert_eq!(sum(10_000, |_| -0.25), -2500.0);
        assert_eq!(sum(3, |k| [1e300, 1.0, -1e300][k]), 0.0);
    }

    /// The sum exceeds what one word holds.
    #[test]
    fn long_sums_do_not_overflow() {
        for x in [1.0, -1.0] {
            let n = 3 * MAX_TERMS + 5;
            assert_eq!(sum(n, |_| x), x * n as f64);
        }
    }

    /// A sum depends only on its own terms, whatever came before: larger terms, smaller ones, none, or NaN.
    #[test]
    fn a_running_sum_is_the_sum_of_its_step() {
        let scales = [1.0, 1e-3, 1.5e-3, 1e9, 0.0, f64::NAN, 2.0, f64::INFINITY, 1e-12];
        let mut sums = [RunningSum::default(); 2];
        for (step, scale) in scales.into_iter().enumerate() {
            let terms: Vec<f64> = (0..3 * MAX_TERMS + 5)
                .map(|k| scale * ((k * 7919 + step) % 1000) as f64 - 0.3)
                .collect();
            let found = loop {
                for part in terms.chunks(600) {
                    sums[0].add(part);
                }
                sums[1].add(&[scale]);
                if let Some(found) = RunningSum::finish(&Alone, &mut sums) {
                    break found;
                }
            };
            let exact = [sum(terms.len(), |k| terms[k]), sum(1, |_| scale)];
            assert_eq!(found.map(f64::to_bits), exact.map(f64::to_bits), "{scale}");
        }
    }

    #[test]
    fn without_a_bound_there_is_no_sum() {
        for bad in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e305] {
            assert!(sum(5, |k| if k == 3 { bad } else { 1.0 }).is_nan(), "{bad}");
            assert!(sum(3 * MAX_TERMS, |_| bad).is_nan(), "{bad}");
        }
        assert!(FixedPoint::new(f64::NAN).value(1).is_nan());
    }

    #[test]
    fn windows_far_from_zero_keep_every_bit() {
        let (low, high) = (1000.0, 1001.5);
        let window = Window::around(low, high);
        assert!(
            window.contains(low, high) && window.contains(999.5, 1002.0) && !window.contains(998.0, 1001.0)
        );
        for k in 0..1000 {
            let u = low + (high - low) * f64::from(k) / 1000.0;
            let bits = (u + window.shift()).to_bits();
            let integer = bits.wrapping_sub(window.differences().shift().to_bits()) as i64;
            let difference = window.differences().value(i128::from(integer));
            assert_eq!(window.centre() + difference, u);
        }
    }

    proptest! {
        /// Numbers of all sizes up to the bound, the bound included: any order and any partition gives the
        /// same bits, with an error of at most half a quantum per term.
        #[test]
        fn any_partition_gives_the_same_bits(
            terms in prop::collection::vec((-1.0..=1.0_f64, -60..=0_i32), 1..200),
            bound in prop_oneof![Just(1.0), 1e-250..1e250_f64],
            cut in 0..200_usize,
            stride in 1..7_usize,
        ) {
            let terms: Vec<f64> = terms.into_iter().map(|(x, e)| x * 2_f64.powi(e) * bound).chain([bound, -bound]).collect();
            let n = terms.len();
            let fixed_point = FixedPoint::new(bound);
            let integer = |k: usize| i128::from(fixed_point.integer(terms[k]));
            let whole: i128 = (0..n).map(integer).sum();
            let cut = cut.min(n);
            let [one, other] = [(cut..n).map(integer).sum(), (0..cut).rev().map(integer).sum()].map(split);
            prop_assert_eq!(whole, join([one[0] + other[0], one[1] + other[1]]));
            let strided: i128 = (0..stride).map(|from| (from..n).step_by(stride).map(integer).sum::<i128>()).sum();
            prop_assert_eq!(whole, strided);
            prop_assert_eq!(fixed_point.value(whole).to_bits(), sum(n, |k| terms[n - 1 - k]).to_bits());
            for (k, &term) in terms.iter().enumerate() {
                prop_assert!((fixed_point.value(integer(k)) - term).abs() <= fixed_point.limit() / QUANTA / 2.0);
            }
        }
    }
}
