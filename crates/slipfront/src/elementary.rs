//! Exponential and logarithm, computed by a fixed number of sums, products and quotients in a fixed order,
//! without branches. The compiler can vectorise them over several blocks, unlike those of `libm`, and they
//! have the same bits on every machine.

/// ln 2 as the sum of two parts. The first has so few digits that its products with small integers are exact.
const LN_2: [f64; 2] = [
    f64::from_bits(0x3fe6_2e42_fee0_0000),
    f64::from_bits(0x3dea_39ef_3579_3c76),
];

/// Constant for rounding: the sum of this and a number has the nearest integer in its lowest bits.
const TO_WHOLE: f64 = 1.5 * (1_u64 << 52) as f64;

/// Largest exponent: [`exp`] of a larger one returns the value at this one.
const MAX_EXPONENT: f64 = 700.0;

/// Inverse factorials `1/k!` from k = 0 on.
const INVERSE_FACTORIALS: [f64; 16] = {
    let mut inverse = [1.0; 16];
    let mut k = 1;
    while k < 16 {
        inverse[k] = inverse[k - 1] / k as f64;
        k += 1;
    }
    inverse
};

/// The polynomial `sum_k c_k x^k`, evaluated in pairs of terms so that few operations wait for each other.
#[inline(always)]
fn polynomial<const TERMS: usize>(c: [f64; TERMS], x: f64) -> f64 {
    let (mut sum, square) = (0.0, x * x);
    let mut k = TERMS;
    while k > 1 {
        k -= 2;
        sum = sum * square + (c[k] + c[k + 1] * x);
    }
    sum
}

/// The exponential `e^x` for x of -700 to 700, to four units in the last place.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    let x = x.clamp(-MAX_EXPONENT, MAX_EXPONENT);
    let shifted = x * std::f64::consts::LOG2_E + TO_WHOLE;
    let n = shifted - TO_WHOLE;
    let rest = (x - n * LN_2[0]) - n * LN_2[1];
    let mut c = [0.0; 14];
    c.copy_from_slice(&INVERSE_FACTORIALS[..14]);
    // 2^n: n is added to the exponent.
    f64::from_bits(
        polynomial(c, rest)
            .to_bits()
            .wrapping_add(shifted.to_bits() << 52),
    )
}

/// The logarithm `ln x` of a positive number that is not subnormal, to four units in the last place.
#[inline(always)]
pub(crate) fn ln(x: f64) -> f64 {
    /// Bits of 1, and of a number just below sqrt(1/2).
    const ONE: u64 = 0x3ff0_0000_0000_0000;
    const LEAST: u64 = 0x3fe6_a09e_0000_0000;
    const MANTISSA: u64 = (1 << 52) - 1;
    // x = 2^n m with m from sqrt(1/2) to sqrt(2).
    let bits = x.to_bits().wrapping_sub(LEAST).wrapping_add(ONE);
    let n = f64::from_bits((bits >> 52) | TO_WHOLE.to_bits()) - (TO_WHOLE + 1023.0);
    let m = f64::from_bits((bits & MANTISSA).wrapping_add(LEAST));
    let s = (m - 1.0) / (m + 1.0);
    const C: [f64; 10] = {
        let mut c = [0.0; 10];
        let mut k = 0;
        while k < 10 {
            c[k] = 2.0 / (2 * k + 1) as f64;
            k += 1;
        }
        c
    };
    n * LN_2[0] + (n * LN_2[1] + s * polynomial(C, s * s))
}

/// Bound on x below which [`small_mean_decay`] has enough terms to be exact to the last digit.
pub(crate) const SMALL_DECAY: f64 = 0.5;

/// Mean of `e^-x` over an interval, `(1 - e^-x)/x` for x >= 0; 1 at 0.
#[inline(always)]
pub(crate) fn mean_decay(x: f64) -> f64 {
    let series = small_mean_decay(x.min(SMALL_DECAY));
    let quotient = (1.0 - exp(-x)) / x;
    if x < SMALL_DECAY { series } else { quotient }
}

/// The mean `(1 - e^-x)/x` for x below [`SMALL_DECAY`], by a series.
#[inline(always)]
pub(crate) fn small_mean_decay(x: f64) -> f64 {
    let mut c = [0.0; 14];
    c.copy_from_slice(&INVERSE_FACTORIALS[1..15]);
    polynomial(c, -x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance: seven roundings by half a unit in the last place, 1.1e-16 each, of numbers no larger than
    /// the value.
    fn assert_close(found: f64, exact: f64, x: f64) {
        assert!(
            (found - exact).abs() <= 8e-16 * exact.abs(),
            "{x:e}: {found:e} {exact:e}"
        );
    }

    #[test]
    fn they_are_those_of_libm() {
        for k in -70_000..=70_000 {
            let x = f64::from(k) * 0.009_999;
            assert_close(exp(x), libm::exp(x), x);
            let y = libm::exp(x);
            // Near 1 the error of the logarithm is that of y - 1.
            let bound = 8e-16 * libm::log(y).abs() + 1e-17;
            assert!((ln(y) - libm::log(y)).abs() <= bound, "{y:e}");
            let near = 1.0 + 1e-6 * f64::from(k);
            assert_close(ln(near), libm::log(near), near);
            let positive = x.abs() * 1e-3;
            if positive > 0.0 {
                assert_close(mean_decay(positive), -libm::expm1(-positive) / positive, positive);
            }
        }
        assert_eq!((exp(0.0), ln(1.0), mean_decay(0.0)), (1.0, 0.0, 1.0));
        assert_eq!(exp(-1e9), exp(-700.0));
        assert_close(ln(1e-300), libm::log(1e-300), 1e-300);
        assert_close(mean_decay(1e-30), 1.0, 1e-30);
        assert_close(mean_decay(2000.0), 1.0 / 2000.0, 2000.0);
    }
}
