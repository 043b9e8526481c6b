//! Friction after the first peak: the size and speed of its fall, and its recovery.
//!
//! With `z_i = s3_(p+i)` for 60 of 400 after the peak p, the smallest of them at j, and the largest within 50
//! of 400 after p + j at l:
//!
//! ```text
//! z_j/m                        the least friction
//! log (j + 1)/n                when it is reached
//! log (s5_p - z_j)             the drop
//! log (h + 1)/n                when half of it is done: first i with z_i < (s5_p + z_j)/2
//! log n max(z_i - z_(i+1))     the fastest fall
//! log n max(z_(i+1) - z_i)     the fastest rise
//! z_(j+l)/m, log (l + 1)/n     the second peak
//! quantiles of z/m             at 0.1, 0.25, 0.5, 0.75, 0.9
//! ```

use super::curve::{Curve, log, quantiles};

pub(super) fn features(curve: &Curve) -> Vec<f64> {
    let (n, m, height) = (curve.y.len() as f64, curve.level, curve.height());
    let s3 = &curve.s3;
    let behind = |from: usize, count: usize| &s3[from..(from + curve.of_400(count)).min(s3.len())];
    let z = behind(curve.peak, 60);
    let j = position_of_largest(z, |value| -value);
    let middle = 0.5 * (height + z[j]);
    let half = z.iter().position(|&value| value < middle).unwrap_or(0);
    let steps = z.windows(2).map(|pair| pair[1] - pair[0]);
    let (fall, rise) = steps.fold((0.0, 0.0), |(fall, rise): (f64, f64), step| {
        (fall.max(-step), rise.max(step))
    });
    let second = behind(curve.peak + j, 50);
    let l = position_of_largest(second, |value| value);
    let place = |i: usize| log((i as f64 + 1.0) / n);
    let mut found = vec![
        z[j] / m,
        place(j),
        log(height - z[j]),
        place(half),
        log(n * fall),
        log(n * rise),
        second[l] / m,
        place(l),
    ];
    found.extend(quantiles(z, [0.1, 0.25, 0.5, 0.75, 0.9]).map(|value| value / m));
    found
}

/// Position of the value for which `by` is largest, the first of several.
fn position_of_largest(values: &[f64], by: impl Fn(f64) -> f64) -> usize {
    let mut largest = 0;
    for (i, &value) in values.iter().enumerate() {
        if by(value) > by(values[largest]) {
            largest = i;
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::super::curve::tests::ramp_and_fall;
    use super::*;

    #[test]
    fn a_fall_has_its_depth_and_speed() {
        let y = ramp_and_fall();
        let found = features(&Curve::new(&y));
        let near = |k: usize, value: f64| assert!((found[k] - value).abs() < 1e-12, "{k} {found:?}");
        near(0, 1.0);
        // The mean of three values is 1/2 from value 121 on, one after the end of the fall and 22 after value
        // 99.
        near(1, (23.0_f64 / 400.0).ln());
        near(2, 0.483_f64.ln());
        // The middle, (0.983 + 0.5)/2, is 1 - 10.34/40.
        near(3, (13.0_f64 / 400.0).ln());
        near(4, 10.0_f64.ln());
        near(5, super::super::curve::LEAST.ln());
        near(6, 1.0);
        near(8, 1.0);
    }
}
