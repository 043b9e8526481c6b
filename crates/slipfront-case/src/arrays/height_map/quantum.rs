//! The quantum in which heights are summed.

use super::roughness::HeightRange;

/// Quantum of heights. All heights, counted from the lowest, are rounded to whole multiples of a power of two
/// between 2^-53 and 2^-52 of their range: grey levels and integers stay exact, and other numbers lose no
/// more than when they were written.
#[derive(Clone, Copy)]
pub(super) struct Quantum {
    lowest: f64,
    size: f64,
}

impl Quantum {
    /// The quantum of heights in a finite range.
    pub(super) fn for_range(range: HeightRange) -> Self {
        const EXPONENT: u64 = 0x7ff << 52;
        const SMALLEST: f64 = f64::from_bits(1);
        let power = f64::from_bits((range.highest - range.lowest).to_bits() & EXPONENT);
        Self {
            lowest: range.lowest,
            size: (power * f64::EPSILON).max(SMALLEST),
        }
    }

    /// Number of quanta in a height, less than 2^53.
    pub(super) fn count(self, height: f64) -> i64 {
        ((height - self.lowest) / self.size).round() as i64
    }

    /// The height of a number of quanta.
    pub(super) fn height(self, quanta: f64) -> f64 {
        self.lowest + quanta * self.size
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_and_sums_of_few_bits_are_not_rounded() {
        for (lowest, highest) in [
            (0.0, 65535.0),
            (-3.0, 1e6),
            (1e9, 1e9 + 0.5),
            (0.1, 0.1),
            (0.0, 5e-324),
        ] {
            let quantum = Quantum::for_range(HeightRange { lowest, highest });
            assert!(quantum.count(highest) < 1 << 53);
            for height in [lowest, highest, lowest + 0.25 * (highest - lowest).trunc()] {
                assert_eq!(quantum.height(quantum.count(height) as f64), height);
            }
        }
    }
}
