//! Friction against the direction of the drive: how much it differs, the principal axes of the friction tensor, and friction across the
//! drive.

use std::collections::HashMap;

use super::levels::{Levels, combinations, direction_axis};
use super::plan::Plan;
use super::statistics::Sample;
use super::study_results::StudyResults;
use super::summary_values::Quantity;

/// Friction and what is across the drive with it.
pub(super) const FRICTION: [(&str, &str); 2] = [
    ("static_friction_star", "static_lateral_friction_star"),
    ("kinetic_friction_star", "kinetic_lateral_friction_star"),
];

/// Two directions are one if they differ by less, degrees.
const SAME: f64 = 1e-9;

/// A tensor whose principal values differ by less, relative to their mean, has no axes: it is that of rounding.
const ISOTROPIC: f64 = 1e-9;

/// Friction of one quantity over the directions, at the same levels of all other axes. All statistics are over replicates that have a
/// value in every direction.
#[derive(Clone, Debug)]
pub struct Anisotropy {
    /// The name of the quantity.
    pub quantity: &'static str,
    /// Columns of the other axes, and their cells.
    pub levels: Vec<(String, String)>,
    /// How many directions there are.
    pub directions: usize,
    /// The mean over the directions.
    pub mean: Sample,
    /// The direction in which the mean over replicates is largest, degrees from x towards y; the first if there are several.
    pub largest_direction: f64,
    /// The direction in which it is smallest.
    pub smallest_direction: f64,
    /// Friction in the one less that in the other, over the mean over the directions:
    ///
    /// ```text
    /// (mu(largest direction) - mu(smallest direction))/mean(mu)
    /// ```
    pub anisotropy: Sample,
    /// The axes of the friction tensor; none if they are not known.
    pub principal: Option<Principal>,
    /// Friction across the drive, positive to its left, where its mean is largest in size, and that direction.
    pub lateral: Option<(f64, Sample)>,
}

/// The friction tensor M that fits best, by least squares over the directions d:
///
/// ```text
/// mu(d) = d . M d = (mu_1 + mu_2)/2 + (mu_1 - mu_2)/2 cos 2(theta - theta_1)
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Principal {
    /// theta_1, the direction of the larger principal value, from 0 to 180 degrees; the other one is across it.
    pub direction: f64,
    /// Half width of its confidence interval, degrees; none of one run.
    pub half_width: Option<f64>,
    /// mu_1 and mu_2.
    pub values: [Sample; 2],
    /// Root mean square of what is left over the directions, over the mean.
    pub misfit: f64,
}

/// The anisotropy of static and kinetic friction at all levels of the other axes; empty if no axis is one of directions. Levels without
/// two directions that have values are left out.
pub fn anisotropies(plan: &Plan, results: &StudyResults) -> Vec<Anisotropy> {
    let Some(over) = direction_axis(&plan.axes) else {
        return Vec::new();
    };
    let positions = plan.points.iter().enumerate();
    let positions = positions.map(|(position, point)| (plan.levels(point), position));
    let points = Points {
        plan,
        results,
        over,
        positions: positions.collect(),
    };
    let others: Vec<usize> = (0..plan.axes.len()).filter(|&axis| axis != over).collect();
    let fixed = combinations(&plan.axes, &others);
    let all = fixed
        .iter()
        .flat_map(|fixed| FRICTION.map(|names| points.anisotropy(fixed, names)));
    all.flatten().collect()
}

/// The points of a study with directions.
struct Points<'a> {
    plan: &'a Plan,
    results: &'a StudyResults,
    /// The axis of the directions.
    over: usize,
    /// Positions by levels.
    positions: HashMap<Vec<usize>, usize>,
}

impl Points<'_> {
    fn anisotropy(&self, fixed: &Levels, (quantity, across): (&'static str, &str)) -> Option<Anisotropy> {
        let directions = self.directions(fixed);
        let degrees: Vec<f64> = directions.iter().map(|(degrees, _)| *degrees).collect();
        let values = self.replicates(&directions, quantity);
        if degrees.len() < 2 || values.is_empty() {
            return None;
        }
        let confidence = self.plan.settings.confidence();
        let sample = |of: &dyn Fn(&Vec<f64>) -> f64| {
            let values: Vec<f64> = values.iter().map(of).collect();
            Sample::of(&values, confidence)
        };
        let means = over_replicates(&values);
        let [largest, smallest] = extremes(&means);
        let lateral = self.replicates(&directions, across);
        let lateral = (!lateral.is_empty()).then(|| {
            let sizes: Vec<f64> = over_replicates(&lateral).into_iter().map(f64::abs).collect();
            let [at, _] = extremes(&sizes);
            let values: Vec<f64> = lateral.iter().map(|values| values[at]).collect();
            Some((degrees[at], Sample::of(&values, confidence)?))
        });
        let axes = self.plan.axes.iter().enumerate();
        let axes = axes.filter_map(|(axis, columns)| {
            let &(_, level) = fixed.iter().find(|(other, _)| *other == axis)?;
            Some(
                columns
                    .columns
                    .iter()
                    .cloned()
                    .zip(columns.levels[level].labels.clone()),
            )
        });
        Some(Anisotropy {
            quantity,
            levels: axes.flatten().collect(),
            directions: degrees.len(),
            mean: sample(&|values| mean(values))?,
            largest_direction: degrees[largest],
            smallest_direction: degrees[smallest],
            anisotropy: sample(&|values| (values[largest] - values[smallest]) / mean(values))?,
            principal: principal(&degrees, &values, confidence),
            lateral: lateral.flatten(),
        })
    }

    /// The directions that have a point at these levels of the other axes, each once, with the positions of the points.
    fn directions(&self, fixed: &Levels) -> Vec<(f64, usize)> {
        let mut levels = vec![0; self.plan.axes.len()];
        for &(axis, level) in fixed {
            levels[axis] = level;
        }
        let mut found: Vec<(f64, usize)> = Vec::new();
        for (level, at) in self.plan.axes[self.over].levels.iter().enumerate() {
            levels[self.over] = level;
            let Some((degrees, &position)) = at.number.zip(self.positions.get(&levels)) else {
                continue;
            };
            let is_same = |other: f64| {
                let apart = (degrees - other).rem_euclid(360.0);
                apart.min(360.0 - apart) < SAME
            };
            if !found.iter().any(|(other, _)| is_same(*other)) {
                found.push((degrees, position));
            }
        }
        found
    }

    /// The values of each replicate in all directions; of those that have them all.
    fn replicates(&self, directions: &[(f64, usize)], name: &str) -> Vec<Vec<f64>> {
        let Some(quantity) = Quantity::named(name) else {
            return Vec::new();
        };
        let counts = directions.iter();
        let counts = counts.map(|(_, position)| self.results.points[*position].replicates);
        let values = |replicate: usize| {
            let value = |(_, position): &(f64, usize)| self.results.value(*position, replicate, quantity);
            directions.iter().map(value).collect::<Option<Vec<f64>>>()
        };
        (0..counts.min().unwrap_or(0)).filter_map(values).collect()
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The mean over replicates in each direction.
fn over_replicates(values: &[Vec<f64>]) -> Vec<f64> {
    let directions = values.first().map_or(0, Vec::len);
    let mean = |at: usize| values.iter().map(|values| values[at]).sum::<f64>() / values.len() as f64;
    (0..directions).map(mean).collect()
}

/// Where the largest and the smallest value are, the first of equal ones.
fn extremes(values: &[f64]) -> [usize; 2] {
    let (mut largest, mut smallest) = (0, 0);
    for (at, value) in values.iter().enumerate() {
        if *value > values[largest] {
            largest = at;
        }
        if *value < values[smallest] {
            smallest = at;
        }
    }
    [largest, smallest]
}

/// The axes of the tensor that fits the mean over replicates; none if there are less than three directions in half a turn, if it is
/// isotropic, or if its principal values do not differ by more than their interval.
fn principal(degrees: &[f64], values: &[Vec<f64>], confidence: f64) -> Option<Principal> {
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
    let means = over_replicates(values);
    let [level, cosine, sine] = least_squares(&harmonics, &means)?;
    let amplitude = libm::hypot(cosine, sine);
    if amplitude <= ISOTROPIC * level.abs() {
        return None;
    }
    // Every replicate along the axes of the mean, and across.
    let [along_cosine, along_sine] = [cosine / amplitude, sine / amplitude];
    let part = |of: &dyn Fn([f64; 3]) -> f64| {
        let values: Vec<f64> = fits.iter().map(|fit| of(*fit)).collect();
        Sample::of(&values, confidence)
    };
    let along = |[_, cosine, sine]: [f64; 3]| cosine * along_cosine + sine * along_sine;
    let half_amplitude = part(&|fit| along(fit))?.half_width;
    if half_amplitude.is_some_and(|half| half >= amplitude) {
        return None;
    }
    let turned = part(&|[_, cosine, sine]| sine * along_cosine - cosine * along_sine)?;
    let half_width = turned
        .half_width
        .map(|half| 0.5 * libm::atan2(half, amplitude).to_degrees());
    let fitted = harmonics
        .iter()
        .map(|[one, c, s]| level * one + cosine * c + sine * s);
    let squares = fitted
        .zip(&means)
        .map(|(fit, value)| (value - fit) * (value - fit));
    Some(Principal {
        direction: (0.5 * libm::atan2(sine, cosine).to_degrees()).rem_euclid(180.0),
        half_width,
        values: [
            part(&|fit| fit[0] + along(fit))?,
            part(&|fit| fit[0] - along(fit))?,
        ],
        misfit: (squares.sum::<f64>() / means.len() as f64).sqrt() / level.abs(),
    })
}

/// The factors of three functions, given by their values, whose sum is nearest to these values; none if the functions do not differ there.
fn least_squares(functions: &[[f64; 3]], values: &[f64]) -> Option<[f64; 3]> {
    let product = |i: usize, j: usize| functions.iter().map(|f| f[i] * f[j]).sum::<f64>();
    let matrix: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)));
    let right: [f64; 3] =
        std::array::from_fn(|i| functions.iter().zip(values).map(|(f, value)| f[i] * value).sum());
    let determinant = determinant(&matrix);
    // That of equally spaced directions is a quarter of the third power of their number.
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
    use super::*;

    /// Friction of a tensor of these principal values, the first at `direction`.
    fn of_tensor(degrees: &[f64], [one, two]: [f64; 2], direction: f64) -> Vec<f64> {
        let value = |degrees: &f64| {
            let cosine = libm::cos(2.0 * (degrees - direction).to_radians());
            0.5 * (one + two) + 0.5 * (one - two) * cosine
        };
        degrees.iter().map(value).collect()
    }

    const EIGHTH: [f64; 8] = [0.0, 22.5, 45.0, 67.5, 90.0, 112.5, 135.0, 157.5];

    #[test]
    fn the_axes_of_a_tensor_are_found() {
        for (degrees, direction) in [
            (&EIGHTH[..], 30.0),
            (&EIGHTH[..5], 170.0),
            (&[0.0, 60.0, 300.0], 90.0),
        ] {
            let values = vec![of_tensor(degrees, [0.9, 0.6], direction)];
            let found = principal(degrees, &values, 0.95).unwrap();
            // Roundings of sums of a few numbers of order 1.
            assert!((found.direction - direction).abs() < 1e-10, "{found:?}");
            assert!((found.values[0].mean - 0.9).abs() < 1e-13 && (found.values[1].mean - 0.6).abs() < 1e-13);
            assert!(found.half_width.is_none() && found.misfit < 1e-13, "{found:?}");
        }
    }

    #[test]
    fn axes_that_are_not_known_are_not_told() {
        // Two directions and their opposites, or equal friction all around, or a pattern of four.
        let two = [0.0, 90.0, 180.0, 270.0];
        assert!(principal(&two, &[of_tensor(&two, [0.9, 0.6], 0.0)], 0.95).is_none());
        assert!(principal(&EIGHTH, &[vec![0.8; 8]], 0.95).is_none());
        let fourfold = EIGHTH.map(|degrees| 0.8 + 0.1 * libm::cos(4.0 * degrees.to_radians()));
        assert!(principal(&EIGHTH, &[fourfold.to_vec()], 0.95).is_none());
        // Surfaces that differ by more than the principal values do.
        let one = of_tensor(&EIGHTH, [0.9, 0.6], 0.0);
        let other = of_tensor(&EIGHTH, [0.9, 0.8], 90.0);
        assert!(principal(&EIGHTH, &[one.clone(), other], 0.95).is_none());
        // Little scatter leaves an interval of the direction: +-10 degrees of two surfaces.
        let turned = [-1.0, 1.0].map(|degrees| of_tensor(&EIGHTH, [0.9, 0.6], 20.0 + degrees));
        let found = principal(&EIGHTH, &turned, 0.95).unwrap();
        assert!((found.direction - 20.0).abs() < 1e-10);
        // t(1, 97.5 %) = 12.7062 times sin 2 degrees, over the amplitude cos 2 degrees of the mean.
        let expected = 0.5 * (12.7062 * 2f64.to_radians().tan()).atan().to_degrees();
        assert!((found.half_width.unwrap() - expected).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn the_largest_and_smallest_are_the_first_of_equal_ones() {
        assert_eq!(extremes(&[0.5, 0.9, 0.1, 0.9, 0.1]), [1, 2]);
        assert_eq!(extremes(&[0.5, 0.5]), [0, 0]);
    }
}
