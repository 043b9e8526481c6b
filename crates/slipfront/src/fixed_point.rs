//! Sums that depend neither on the order of their terms nor on who adds which: each number is rounded to an integer multiple of
//! one quantum, and the integers are added.

/// A quantum, by which numbers up to a bound become integers of at most 51 bits and a sign.
///
/// The quantum is a power of two, 2^-50 or less of the bound: each number of a sum is rounded by half of it at the most, and
/// the sum not at all until it becomes a number again.
///
/// ```
/// use slipfront::fixed_point::FixedPoint;
///
/// let fixed = FixedPoint::of_bound(0.7);
/// let sum = |terms: [f64; 3]| fixed.value(fixed.sum(&terms));
/// assert_eq!(sum([0.1, 0.7, -0.3]), sum([-0.3, 0.7, 0.1]));
/// // Half a quantum for each term.
/// assert!((sum([0.1, 0.7, -0.3]) - 0.5).abs() <= 3.0 * 2f64.powi(-52));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedPoint {
    quantum: f64,
    per_quantum: f64,
}

/// A number of this size is a multiple of 1 and nothing finer, so that adding it rounds to an integer, which then stands in the
/// lowest bits. Unlike a conversion this is one addition on every processor.
const INTEGERS: f64 = 1.5 * (1u64 << 52) as f64;

/// Exponent of the smallest number whose inverse is finite.
const MIN_EXPONENT: i32 = -1022;

/// Integers of at most 2^51 whose sum fits into a word.
const PIECE: usize = 1 << 11;

/// Bits of a sum in the lower of its two words.
const LOW_BITS: u32 = 40;

impl FixedPoint {
    /// For numbers whose magnitude is `bound` at the most.
    pub fn of_bound(bound: f64) -> Self {
        let exponent = (bound.abs().to_bits() >> 52) as i32 - 1023;
        let exponent = (exponent - 50).max(MIN_EXPONENT);
        let power = |exponent: i32| f64::from_bits(((exponent + 1023) as u64) << 52);
        Self {
            quantum: power(exponent),
            per_quantum: power(-exponent),
        }
    }

    /// The multiple of the quantum nearest to `x`; that of a number beyond the bound, or of none, has no meaning.
    #[inline(always)]
    pub fn integer(&self, x: f64) -> i64 {
        let bits = (x * self.per_quantum + INTEGERS).to_bits();
        bits.wrapping_sub(INTEGERS.to_bits()).cast_signed()
    }

    /// The sum of the [integers](Self::integer) of all numbers.
    pub fn sum(&self, numbers: &[f64]) -> i128 {
        let integers = |piece: &[f64]| -> i64 { piece.iter().map(|x| self.integer(*x)).sum() };
        let sums = numbers.chunks(PIECE).map(|piece| i128::from(integers(piece)));
        sums.sum()
    }

    /// The number nearest to so many quanta.
    pub fn value(&self, sum: i128) -> f64 {
        sum as f64 * self.quantum
    }
}

/// A sum of integers as two words, each of which may be added over up to 2^23 ranks: [`join`] makes the sum of them.
///
/// The sum over all ranks has 2^102 as its bound, the integers of 2^51 numbers.
pub fn split(sum: i128) -> [i64; 2] {
    let low = sum & ((1 << LOW_BITS) - 1);
    [low as i64, (sum >> LOW_BITS) as i64]
}

/// The sum whose words, or sums of words, these are: see [`split`].
pub fn join([low, high]: [i64; 2]) -> i128 {
    (i128::from(high) << LOW_BITS) + i128::from(low)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn bound(terms: &[f64]) -> f64 {
        terms.iter().fold(0.0, |bound, term| term.abs().max(bound))
    }

    /// Numbers of very different size, and of the same.
    fn terms() -> impl Strategy<Value = Vec<f64>> {
        let number = prop_oneof![
            -1.0..1.0_f64,
            (-1.0..1.0_f64, -60..60_i32).prop_map(|(x, e)| x * 2f64.powi(e))
        ];
        prop::collection::vec(number, 1..200)
    }

    proptest! {
        /// Whoever adds what, in whatever order.
        #[test]
        fn any_order_and_any_partition_give_the_same_bits(
            (terms, shuffled) in terms().prop_flat_map(|terms| (Just(terms.clone()), Just(terms).prop_shuffle())),
            cuts in prop::collection::vec(0..200_usize, 0..8),
        ) {
            let fixed = FixedPoint::of_bound(bound(&terms));
            let mut words = [0; 2];
            let mut cuts: Vec<usize> = cuts.into_iter().map(|cut| cut.min(terms.len())).collect();
            cuts.extend([0, terms.len()]);
            cuts.sort_unstable();
            for pair in cuts.windows(2) {
                let part = split(fixed.sum(&shuffled[pair[0]..pair[1]]));
                words = [words[0] + part[0], words[1] + part[1]];
            }
            prop_assert_eq!(fixed.value(join(words)).to_bits(), fixed.value(fixed.sum(&terms)).to_bits());
        }

        /// Half a quantum, 2^-51 of the bound, for each term; the plain sum is rounded by as many times 2^-53 of the sum of
        /// magnitudes, which is at most n times the bound.
        #[test]
        fn a_sum_is_as_good_as_the_plain_one(terms in terms()) {
            let (n, bound) = (terms.len() as f64, bound(&terms));
            let fixed = FixedPoint::of_bound(bound);
            let plain: f64 = terms.iter().sum();
            let off = (fixed.value(fixed.sum(&terms)) - plain).abs();
            prop_assert!(off <= n * bound * (2f64.powi(-51) + n * 2f64.powi(-53)), "{off}");
        }

        #[test]
        fn the_parts_of_a_sum_make_it_again(sum in -(1i128 << 101)..(1i128 << 101)) {
            prop_assert_eq!(join(split(sum)), sum);
        }
    }

    /// The largest numbers of either sign, more than a word holds.
    #[test]
    fn long_sums_do_not_overflow() {
        let fixed = FixedPoint::of_bound(1.0);
        for x in [1.0, -1.0] {
            let numbers = vec![x; 3 * PIECE + 5];
            assert_eq!(fixed.value(fixed.sum(&numbers)), x * numbers.len() as f64);
        }
    }

    #[test]
    fn the_bound_itself_is_exact_at_any_size() {
        for exponent in [-1022, -972, -300, -1, 0, 1, 52, 300, 1022, 1023] {
            let power = 2f64.powi(exponent);
            // The largest number of this exponent that has 51 bits, so that it is a multiple of the quantum.
            for bound in [power, power * (2.0 - 2f64.powi(-50))] {
                let fixed = FixedPoint::of_bound(bound);
                // The smallest numbers are multiples of the smallest quantum.
                let rounded = if exponent < -972 {
                    power * (bound / power).round_ties_even()
                } else {
                    bound
                };
                for x in [bound, -bound] {
                    let value = fixed.value(i128::from(fixed.integer(x)));
                    assert_eq!(value, rounded.copysign(x), "{x:e}");
                }
            }
        }
        let nothing = FixedPoint::of_bound(0.0);
        assert_eq!(nothing.value(i128::from(nothing.integer(0.0))), 0.0);
    }
}
