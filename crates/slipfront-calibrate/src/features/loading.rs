//! The rise of friction up to the first peak, which shows the stiffness of the mount, and slip before the
//! slider as a whole slips.
//!
//! ```text
//! log s5_p                     the height of the first peak
//! log (p + 1)/n                its position
//! log (x_q + 1)/n              where s3 first exceeds q s5_p, q = 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.96
//! log n b_q                    b_q = sum i y_i/sum i^2 over i <= x_q: slope through 0, q = 0.25, 0.4, 0.6, 0.8
//! b_0.4 p/s5_p - 1             bend: how much higher the first slope would have led
//! ```

use super::curve::{Curve, log};

pub(super) fn features(curve: &Curve) -> Vec<f64> {
    let (n, height, peak) = (curve.y.len() as f64, curve.height(), curve.peak as f64);
    let mut found = vec![log(height), log((peak + 1.0) / n)];
    for share in [0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.96] {
        found.push(log((rises_above(&curve.s3, share * height) + 1.0) / n));
    }
    let slopes = [0.25, 0.4, 0.6, 0.8].map(|share| {
        let until = rises_above(&curve.s3, share * height).max(3.0);
        slope(&curve.y[..=until as usize])
    });
    found.extend(slopes.map(|slope| log(slope * n)));
    found.push(slopes[1] * peak / height - 1.0);
    found
}

/// Place at which values first rise above a level, interpolated between two of them; the last place if they
/// never do.
fn rises_above(s: &[f64], level: f64) -> f64 {
    let Some(i) = s.iter().position(|&value| value > level) else {
        return s.len() as f64 - 1.0;
    };
    if i == 0 {
        return 0.0;
    }
    i as f64 - 1.0 + (level - s[i - 1]) / (s[i] - s[i - 1])
}

/// Slope of the least-squares line through the origin.
fn slope(y: &[f64]) -> f64 {
    let sum =
        |f: &dyn Fn(f64, f64) -> f64| -> f64 { y.iter().enumerate().map(|(i, &y)| f(i as f64, y)).sum() };
    sum(&|i, y| i * y) / sum(&|i, _| i * i)
}

#[cfg(test)]
mod tests {
    use super::super::curve::tests::ramp_and_fall;
    use super::*;

    #[test]
    fn a_ramp_has_its_slope() {
        let y = ramp_and_fall();
        let found = features(&Curve::new(&y));
        // The mean over 5 values is largest one value before the peak: (0.97 + 0.98 + 0.99 + 1 + 0.975)/5.
        let height: f64 = 0.983;
        assert!((found[0] - height.ln()).abs() < 1e-12);
        assert!((found[1] - (100.0_f64 / 400.0).ln()).abs() < 1e-12);
        for (k, share) in [0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.96].into_iter().enumerate() {
            assert!((found[2 + k] - ((100.0 * share * height + 1.0) / 400.0).ln()).abs() < 1e-12);
        }
        for slope in &found[9..13] {
            assert!((slope - 4.0_f64.ln()).abs() < 1e-12);
        }
        assert!((found[13] - (0.99 / height - 1.0)).abs() < 1e-12);
    }

    #[test]
    fn a_level_that_is_never_reached_is_at_the_end() {
        assert_eq!(rises_above(&[0.0, 1.0], 2.0), 1.0);
        assert_eq!(rises_above(&[3.0, 1.0], 2.0), 0.0);
        assert_eq!(rises_above(&[0.0, 1.0, 3.0], 2.0), 1.5);
    }
}
