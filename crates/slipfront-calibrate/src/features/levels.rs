//! Levels of friction over the record.
//!
//! ```text
//! log m                        mean of the second half
//! s3_(p+a)/m                   a = -20 to 50 behind the first peak, in 400ths of the record
//! mean of y_(p+a-5..p+a+5)/m   a = 60, 90, 130
//! mean of an eighth/m          the third to the eighth eighth of the record
//! ```

use super::curve::{Curve, log};
use slipfront_study::statistics::mean;

pub(super) fn features(curve: &Curve) -> Vec<f64> {
    let (y, m) = (curve.y, curve.level);
    let (n, half) = (y.len(), curve.of_400(5));
    let mut found = vec![log(m)];
    for before in [20, 10, 5, 2] {
        found.push(curve.s3[curve.peak.saturating_sub(curve.of_400(before))] / m);
    }
    for behind in [2, 4, 6, 8, 10, 13, 16, 20, 25, 30, 40, 50] {
        found.push(curve.s3[(curve.peak + curve.of_400(behind)).min(n - 1)] / m);
    }
    for behind in [60, 90, 130] {
        let middle = (curve.peak + curve.of_400(behind)).min(n - 1);
        let near = &y[middle.saturating_sub(half)..(middle + half + 1).min(n)];
        found.push(mean(near) / m);
    }
    found.extend((2..8).map(|k| mean(&y[k * n / 8..(k + 1) * n / 8]) / m));
    found
}

#[cfg(test)]
mod tests {
    use super::super::curve::tests::ramp_and_fall;
    use super::*;

    #[test]
    fn a_fall_to_rest_has_levels() {
        let y = ramp_and_fall();
        let found = features(&Curve::new(&y));
        assert!((found[0] - 0.5_f64.ln()).abs() < 1e-12);
        let near = |k: usize, value: f64| assert!((found[k] - value / 0.5).abs() < 1e-12, "{k} {found:?}");
        // On the ramp, 20, 10, 5 and 2 before value 99.
        for (k, value) in [0.79, 0.89, 0.94, 0.97].into_iter().enumerate() {
            near(1 + k, value);
        }
        // After value 100, friction falls by 1/40 per value, to 1/2 at value 120.
        for (k, behind) in [2.0, 4.0, 6.0, 8.0, 10.0, 13.0, 16.0].into_iter().enumerate() {
            near(5 + k, 1.0 - (behind - 1.0) / 40.0);
        }
        near(12, (0.55 + 0.525 + 0.5) / 3.0);
        (13..20).for_each(|k| near(k, 0.5));
        // The third eighth, 100 to 149.
        near(20, 0.5 + 210.0 / 40.0 / 50.0);
        (21..26).for_each(|k| near(k, 0.5));
    }
}
