//! The friction tensor of values over directions: the test of whether friction has axes at all, and the axes.

use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::statistics::{Sample, mean};

/// Smallest number of replicates for the test: one more than the components of the second harmonic.
pub(crate) const MIN_REPLICATES: usize = 3;

/// Difference relative to the mean below which values differ only by rounding.
const ROUNDING: f64 = 1e-9;

/// The least-squares fit of the friction tensor M over the directions d:
///
/// ```text
/// mu(d) = d . M d = (mu_1 + mu_2)/2 + (mu_1 - mu_2)/2 cos 2(theta - theta_1)
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Principal {
    /// Direction theta_1 of the larger principal value, from 0 to 180 degrees; the other principal direction
    /// is perpendicular to it.
    pub direction: f64,
    /// Half width of the direction's confidence interval, degrees.
    pub half_width: Option<f64>,
    /// Principal values mu_1 and mu_2.
    pub values: [Sample; 2],
    /// Root mean square of the residuals over the directions, over the mean.
    pub misfit: f64,
}

/// Result of the tensors of all replicates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tensor {
    /// p-value: the probability of axes at least as pronounced if friction is isotropic.
    pub(crate) p_value: f64,
    /// The axes, if they are statistically significant at this confidence.
    pub(crate) principal: Option<Principal>,
}

impl Tensor {
    /// The tensor of the values of at least [`MIN_REPLICATES`] replicates, each in all directions; none if
    /// there are fewer than three directions within half a turn.
    pub(crate) fn fit(degrees: &[f64], values: &[Vec<f64>], confidence: f64) -> Option<Self> {
        let harmonics: Vec<[f64; 3]> = degrees
            .iter()
            .map(|degrees| {
                let (sine, cosine) = libm::sincos(2.0 * degrees.to_radians());
                [1.0, cosine, sine]
            })
            .collect();
        let fits: Vec<[f64; 3]> = values
            .iter()
            .map(|values| least_squares(&harmonics, values))
            .collect::<Option<_>>()?;
        let p_value = p_of_isotropy(&fits)?;
        let principal =
            (p_value < 1.0 - confidence).then(|| principal(&harmonics, values, &fits, confidence));
        Some(Self {
            p_value,
            principal: principal.flatten(),
        })
    }
}

/// p-value of Hotelling's test of whether the mean (c, s) of the two components of the second harmonic is
/// zero, with the covariance S over n replicates; none for fewer than [`MIN_REPLICATES`] replicates:
///
/// ```text
/// T^2 = n (c, s) . S^-1 (c, s),   (n - 2)/(2 (n - 1)) T^2 ~ F(2, n - 2)
/// ```
fn p_of_isotropy(fits: &[[f64; 3]]) -> Option<f64> {
    if fits.len() < MIN_REPLICATES {
        return None;
    }
    let n = fits.len() as f64;
    let mean = |of: &dyn Fn(&[f64; 3]) -> f64| fits.iter().map(of).sum::<f64>() / n;
    let [level, c, s] = [0, 1, 2].map(|part| mean(&|fit| fit[part]));
    let covariance = |of: &dyn Fn(&[f64; 3]) -> f64| mean(of) * n / (n - 1.0);
    // Avoids a division by zero for replicates that do not differ at all.
    let rounding = (ROUNDING * level) * (ROUNDING * level);
    let cc = covariance(&|fit| (fit[1] - c) * (fit[1] - c)) + rounding;
    let ss = covariance(&|fit| (fit[2] - s) * (fit[2] - s)) + rounding;
    let cs = covariance(&|fit| (fit[1] - c) * (fit[2] - s));
    let t_squared = n * (c * c * ss - 2.0 * c * s * cs + s * s * cc) / (cc * ss - cs * cs);
    let f = (n - 2.0) / (2.0 * (n - 1.0)) * t_squared;
    Some(FisherSnedecor::new(2.0, n - 2.0).ok()?.sf(f))
}

/// The axes of the tensor that fits the mean over replicates.
fn principal(
    harmonics: &[[f64; 3]],
    values: &[Vec<f64>],
    fits: &[[f64; 3]],
    confidence: f64,
) -> Option<Principal> {
    let means = over_replicates(values);
    let [level, cosine, sine] = least_squares(harmonics, &means)?;
    let amplitude = libm::hypot(cosine, sine);
    // Components of every replicate along the axes of the mean, and perpendicular to them.
    let [along_cosine, along_sine] = [cosine / amplitude, sine / amplitude];
    let part = |of: &dyn Fn([f64; 3]) -> f64| {
        let values: Vec<f64> = fits.iter().map(|fit| of(*fit)).collect();
        Sample::from_values(&values, confidence)
    };
    let along = |[_, cosine, sine]: [f64; 3]| cosine * along_cosine + sine * along_sine;
    let turned = part(&|[_, cosine, sine]| sine * along_cosine - cosine * along_sine)?;
    let half_width = turned
        .half_width
        .map(|half| 0.5 * libm::atan2(half, amplitude).to_degrees());
    let fitted = harmonics
        .iter()
        .map(|[one, c, s]| level * one + cosine * c + sine * s);
    let squares: Vec<f64> = fitted
        .zip(&means)
        .map(|(fit, value)| (value - fit) * (value - fit))
        .collect();
    Some(Principal {
        direction: (0.5 * libm::atan2(sine, cosine).to_degrees()).rem_euclid(180.0),
        half_width,
        values: [
            part(&|fit| fit[0] + along(fit))?,
            part(&|fit| fit[0] - along(fit))?,
        ],
        misfit: mean(&squares).sqrt() / level.abs(),
    })
}

/// The mean over replicates in each direction.
fn over_replicates(values: &[Vec<f64>]) -> Vec<f64> {
    let directions = values.first().map_or(0, Vec::len);
    let mean = |at: usize| values.iter().map(|values| values[at]).sum::<f64>() / values.len() as f64;
    (0..directions).map(mean).collect()
}

/// The coefficients of three functions in the least-squares fit to these values; none if the functions, given
/// by their values, are linearly dependent.
fn least_squares(functions: &[[f64; 3]], values: &[f64]) -> Option<[f64; 3]> {
    let product = |i: usize, j: usize| functions.iter().map(|f| f[i] * f[j]).sum::<f64>();
    let matrix: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)));
    let right: [f64; 3] =
        std::array::from_fn(|i| functions.iter().zip(values).map(|(f, value)| f[i] * value).sum());
    let determinant = determinant(&matrix);
    // For equally spaced directions, the determinant is a quarter of the third power of their number.
    if determinant <= 1e-9 * (functions.len() as f64).powi(3) {
        return None;
    }
    Some(std::array::from_fn(|column| {
        let mut replaced = matrix;
        for (row, right) in replaced.iter_mut().zip(right) {
            row[column] = right;
        }
        self::determinant(&replaced) / determinant
    }))
}

fn determinant([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use slipfront::surface::{Coefficients, Distribution};

    use super::*;

    /// Friction of a tensor with these principal values, the first at `direction`.
    fn of_tensor(degrees: &[f64], [one, two]: [f64; 2], direction: f64) -> Vec<f64> {
        let value = |degrees: &f64| {
            let cosine = libm::cos(2.0 * (degrees - direction).to_radians());
            0.5 * (one + two) + 0.5 * (one - two) * cosine
        };
        degrees.iter().map(value).collect()
    }

    const EIGHTH: [f64; 8] = [0.0, 22.5, 45.0, 67.5, 90.0, 112.5, 135.0, 157.5];

    /// If replicates do not differ, the axes are certain.
    #[test]
    fn the_axes_of_a_tensor_are_found() {
        for (degrees, direction) in [
            (&EIGHTH[..], 30.0),
            (&EIGHTH[..5], 170.0),
            (&[0.0, 60.0, 300.0], 90.0),
        ] {
            let values = vec![of_tensor(degrees, [0.9, 0.6], direction); 3];
            let tensor = Tensor::fit(degrees, &values, 0.95).unwrap();
            let found = tensor.principal.unwrap();
            // The bounds allow for rounding of sums of a few numbers of order 1.
            assert!((found.direction - direction).abs() < 1e-10, "{found:?}");
            assert!((found.values[0].mean - 0.9).abs() < 1e-13 && (found.values[1].mean - 0.6).abs() < 1e-13);
            assert!(
                found.half_width.unwrap() < 1e-10 && found.misfit < 1e-13,
                "{found:?}"
            );
            assert!(tensor.p_value < 1e-6, "{tensor:?}");
        }
    }

    #[test]
    fn axes_that_are_not_known_are_not_told() {
        // Two directions and their opposites determine no axes, and two replicates are too few for the test.
        let two = [0.0, 90.0, 180.0, 270.0];
        assert!(Tensor::fit(&two, &vec![of_tensor(&two, [0.9, 0.6], 0.0); 3], 0.95).is_none());
        assert!(Tensor::fit(&EIGHTH, &vec![of_tensor(&EIGHTH, [0.9, 0.6], 0.0); 2], 0.95).is_none());
        // Equal friction in all directions, and friction with fourfold symmetry.
        let fourfold = EIGHTH.map(|degrees| 0.8 + 0.1 * libm::cos(4.0 * degrees.to_radians()));
        for values in [[0.8; 8], fourfold] {
            let tensor = Tensor::fit(&EIGHTH, &vec![values.to_vec(); 3], 0.95).unwrap();
            assert!(tensor.principal.is_none() && tensor.p_value > 0.99, "{tensor:?}");
        }
        // Surfaces that differ by more than the principal values.
        let one = of_tensor(&EIGHTH, [0.9, 0.6], 0.0);
        let others = [80.0, 100.0].map(|direction| of_tensor(&EIGHTH, [0.9, 0.8], direction));
        let [two, three] = others;
        let tensor = Tensor::fit(&EIGHTH, &[one, two, three], 0.95).unwrap();
        assert!(tensor.principal.is_none(), "{tensor:?}");
        // A little scatter gives the direction a finite interval.
        let turned = [-1.0, 0.0, 1.0].map(|degrees| of_tensor(&EIGHTH, [0.9, 0.6], 20.0 + degrees));
        let found = Tensor::fit(&EIGHTH, &turned, 0.95).unwrap().principal.unwrap();
        assert!((found.direction - 20.0).abs() < 1e-10);
        // t(2, 97.5 %) = 4.3027 times sin(2 degrees)/sqrt(3), over the amplitude of the mean, (1 + 2 cos 2
        // degrees)/3.
        let turn = 2f64.to_radians();
        let ratio = 4.3027 * turn.sin() / 3f64.sqrt() / ((1.0 + 2.0 * turn.cos()) / 3.0);
        // The quantile has four decimals, a relative error of 1e-5 for 2.5 degrees.
        let expected = 0.5 * ratio.atan().to_degrees();
        assert!((found.half_width.unwrap() - expected).abs() < 1e-4, "{found:?}");
    }

    /// F(2, d) has a closed form, P(F > f) = (1 + 2 f/d)^(-d/2), so the p-value is
    /// `(1 + T^2/(n - 1))^(-(n - 2)/2)`.
    #[test]
    fn the_test_is_that_of_hotelling() {
        let fits = [
            [1.0, 0.3, 0.2],
            [1.0, 0.1, -0.1],
            [1.0, 0.2, 0.2],
            [1.0, 0.0, 0.1],
        ];
        // Means 0.15 and 0.1; S = [[5, 3], [3, 6]]/300, and S^-1 = [[6, -3], [-3, 5]] 300/21.
        let t_squared = 4.0 * 300.0 / 21.0 * (6.0 * 0.0225 - 6.0 * 0.015 + 5.0 * 0.01);
        let expected = (1.0_f64 + t_squared / 3.0).powf(-1.0);
        // The rounding that is added to S is 1e-18 of 1e-2.
        assert!((p_of_isotropy(&fits).unwrap() - expected).abs() < 1e-13);
    }

    /// Isotropic friction with normal scatter is called anisotropic as often as the significance level
    /// states, since the test is exact for such scatter.
    #[test]
    fn chance_passes_for_anisotropy_as_often_as_it_may() {
        let scatter = Distribution {
            mean: 0.8,
            deviation: 0.01,
        };
        for replicates in [3, 6, 12] {
            let trials = 2000;
            let alarms = (0..trials).filter(|&seed| {
                let drawn = Coefficients::draw(8 * replicates, scatter, scatter, seed).mu_static;
                let values: Vec<Vec<f64>> = drawn.chunks(8).map(<[f64]>::to_vec).collect();
                let tensor = Tensor::fit(&EIGHTH, &values, 0.95).unwrap();
                tensor.principal.is_some()
            });
            // 5 % of 2000 trials are 100 +- 9.7; the bound is five standard errors.
            let alarms = alarms.count();
            assert!(alarms.abs_diff(100) < 49, "{replicates}: {alarms}");
        }
    }
}
