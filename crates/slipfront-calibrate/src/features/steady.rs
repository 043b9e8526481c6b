//! Steady sliding: size, speed and regularity of the scatter of friction in the second half of the record.
//!
//! With `e_i = y_i - m` in the second half, d_L its differences over L of 400, and windows as in [the parent
//! module](super):
//!
//! ```text
//! log sd(e)/m                  and of its running means over 4, 8, 16, 32 of 400
//! log sd(d_L)/m                L = 1, 2, 4
//! mean d_L^3/sd(d_L)^3         L = 1, 2, 4: falls that are faster than rises
//! log max(-f)/m, log max(f)/m  f: differences of its running mean over 3 of 400
//! sum e_i e_(i+L)/sum e_i^2    autocorrelation, L = 1, 2, 3, 5, 8, 12, 16, 20, 25, 30, 40 of 400
//! mean e^3/sd^3, log mean e^4/sd^4
//! log of the mean of |E_k|^2/m^2   of bands of k; E_k: Fourier coefficients of e under a window of Hann
//! quantiles of s3/m            at 0.02, 0.1, 0.9, 0.98
//! ```

use super::curve::{Curve, deviation, log, log_power, quantiles, running_mean};
use slipfront_study::statistics::mean;

pub(super) fn features(curve: &Curve) -> Vec<f64> {
    let m = curve.level;
    let start = curve.y.len() / 2;
    let e: Vec<f64> = curve.y[start..].iter().map(|y| y - m).collect();
    let scatter = deviation(&e);
    let mut found = vec![log(scatter / m)];
    for width in [4, 8, 16, 32] {
        found.push(log(deviation(&running_mean(&e, curve.of_400(width))) / m));
    }
    for distance in [1, 2, 4] {
        let distance = curve.of_400(distance);
        let steps: Vec<f64> = e.iter().zip(&e[distance..]).map(|(a, b)| b - a).collect();
        let spread = deviation(&steps);
        found.extend([log(spread / m), moment(&steps, cube) / cube(spread)]);
    }
    let smooth = &curve.s3[start..];
    let steps = smooth.windows(2).map(|pair| pair[1] - pair[0]);
    let (fall, rise) = steps.fold((0.0, 0.0), |(fall, rise): (f64, f64), step| {
        (fall.max(-step), rise.max(step))
    });
    found.extend([log(fall / m), log(rise / m)]);
    for distance in [1, 2, 3, 5, 8, 12, 16, 20, 25, 30, 40] {
        found.push(autocorrelation(&e, curve.of_400(distance)));
    }
    found.extend([
        moment(&e, cube) / cube(scatter),
        log(moment(&e, |e| e * cube(e)) / (scatter * cube(scatter))),
    ]);
    found.extend(log_power(&e, m, BANDS.windows(2).map(|band| band[0]..band[1])));
    found.extend(quantiles(smooth, [0.02, 0.1, 0.9, 0.98]).map(|value| value / m));
    found
}

/// First frequencies of the bands of the spectrum, in periods over the half of the record.
const BANDS: [usize; 11] = [1, 3, 5, 7, 9, 12, 16, 22, 30, 45, 70];

fn cube(value: f64) -> f64 {
    value * value * value
}

/// Mean of a power of the values.
fn moment(values: &[f64], power: impl Fn(f64) -> f64) -> f64 {
    values.iter().map(|&value| power(value)).sum::<f64>() / values.len() as f64
}

/// Autocorrelation `sum e_i e_(i+L)/sum e_i^2` for values with a mean of 0.
fn autocorrelation(e: &[f64], distance: usize) -> f64 {
    let products: Vec<f64> = e.iter().zip(&e[distance..]).map(|(a, b)| a * b).collect();
    mean(&products) * products.len() as f64 / e.iter().map(|e| e * e).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Friction of 1 that jumps between 1.1 and 0.9 at every value.
    #[test]
    fn an_alternation_has_its_scatter() {
        let y: Vec<f64> = (0..400).map(|i| if i % 2 == 0 { 1.1 } else { 0.9 }).collect();
        let found = features(&Curve::new(&y));
        let near = |k: usize, value: f64| assert!((found[k] - value).abs() < 1e-9, "{k} {found:?}");
        near(0, 0.1_f64.ln());
        // Differences over 1 are 0.2 in size; those over 2 and 4 vanish. The sum of all 199 is one of them.
        let size = 0.2 * (1.0 - 1.0 / f64::from(199 * 199)).sqrt();
        near(5, size.ln());
        near(7, super::super::curve::LEAST.ln());
        // A mean over three values is a third of the way from 1; edges aside, differences are 0.2/3.
        near(11, (0.2_f64 / 3.0).ln());
        near(12, (0.2_f64 / 3.0).ln());
        near(13, -199.0 / 200.0);
        near(14, 198.0 / 200.0);
        near(24, 0.0);
        near(25, 0.0);
        // The Hann window leaks none of such a fast alternation into long periods.
        (26..36).for_each(|k| near(k, 2.0 * super::super::curve::LEAST.ln()));
    }

    /// A sinusoid of amplitude 0.1 with 8 periods over the half of the record has three Fourier coefficients:
    /// n/4 and twice n/8 of its amplitude.
    #[test]
    fn a_swing_is_in_its_band() {
        let y: Vec<f64> = (0..400)
            .map(|i| 1.0 + 0.1 * libm::sin(std::f64::consts::TAU * 8.0 * f64::from(i) / 200.0))
            .collect();
        let found = features(&Curve::new(&y));
        let n = 200.0_f64;
        let band = |squares: f64, width: f64| (0.01 * squares * n / width).ln();
        // The bands of 7 and 8 periods, and of 9 to 11.
        assert!((found[29] - band(1.0 / 64.0 + 1.0 / 16.0 * 1.0 / 4.0 * 4.0, 2.0)).abs() < 1.0);
        assert!(found[29] > found[28] + 5.0 && found[29] > found[31] + 5.0);
    }
}
