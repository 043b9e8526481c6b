//! Dependence of friction on the direction of the drive: the size of the difference, its statistical
//! significance, and friction across the drive.

use std::collections::HashMap;

use crate::friction_tensor::{MIN_REPLICATES, Principal, Tensor};
use crate::levels::{Levels, combinations, direction_axis};
use crate::plan::Plan;
use crate::statistics::{Sample, mean};
use crate::study_results::StudyResults;
use crate::summary_values::RunQuantity;
use slipfront_base::number_format::{are, count};

/// Names of friction along and across the drive.
pub(crate) const FRICTION: [(&str, &str); 2] = [
    (STATIC, "static_lateral_friction_star"),
    ("kinetic_friction_star", "kinetic_lateral_friction_star"),
];

/// Name of static friction, which a run without a transition does not have.
const STATIC: &str = "static_friction_star";

/// Difference in degrees below which two directions are equal.
const SAME: f64 = 1e-9;

/// Friction of one quantity over the directions, at the same levels of all other axes.
#[derive(Clone, Debug)]
pub struct Anisotropy {
    /// The name of the quantity.
    pub quantity: &'static str,
    /// Columns of the other axes, and their cells.
    pub levels: Vec<(String, String)>,
    /// Number of directions that are used: those in which at least half of the runs have a value.
    pub directions: usize,
    /// Number of replicates that are used: those with a value in each of these directions.
    pub replicates: usize,
    /// Sentence on the directions, replicates and runs that are left out.
    pub left_out: Option<String>,
    /// Result for these values, or a sentence on why they are too few.
    pub found: Result<OverDirections, String>,
}

/// Statistics over replicates of friction in all directions.
#[derive(Clone, Debug)]
pub struct OverDirections {
    /// The mean over the directions.
    pub mean: Sample,
    /// The direction in which the mean over replicates is largest, degrees from x towards y; the first if
    /// there are several.
    pub largest_direction: f64,
    /// The direction in which the mean over replicates is smallest.
    pub smallest_direction: f64,
    /// Difference of friction between the directions of largest and smallest friction, over the mean over all
    /// directions, for every replicate r after the first. The two directions are those in which the mean of
    /// the earlier replicates is largest and smallest:
    ///
    /// ```text
    /// (mu_r(largest direction of 0 .. r - 1) - mu_r(smallest direction of 0 .. r - 1))/mean(mu_r)
    /// ```
    ///
    /// If friction does not depend on the direction, the expected value is zero, while the difference between
    /// the largest and the smallest of the same values would be positive by chance alone.
    pub anisotropy: Sample,
    /// p-value of the test for axes: the probability of axes at least as pronounced if friction is isotropic.
    /// None for fewer than three directions within half a turn.
    pub p_value: Option<f64>,
    /// The axes of the friction tensor, if they are statistically significant.
    pub principal: Option<Principal>,
    /// The direction in which friction across the drive is largest in magnitude, and that friction, positive
    /// to the left of the drive. As for `anisotropy`, the earlier replicates determine the direction and the
    /// sign of each value.
    pub lateral: Option<(f64, Sample)>,
}

/// The anisotropy of static and kinetic friction at all levels of the other axes; empty if no axis is over
/// directions. Levels at which no run has a value are left out.
pub fn anisotropies(plan: &Plan, results: &StudyResults) -> Vec<Anisotropy> {
    let Some(over) = direction_axis(&plan.axes) else {
        return Vec::new();
    };
    let positions = plan.points.iter().enumerate();
    let positions = positions.map(|(position, point)| (plan.levels(point), position));
    let points = DirectedPoints {
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
struct DirectedPoints<'a> {
    plan: &'a Plan,
    results: &'a StudyResults,
    /// The axis of the directions.
    over: usize,
    /// Positions by levels.
    positions: HashMap<Vec<usize>, usize>,
}

impl DirectedPoints<'_> {
    fn anisotropy(&self, fixed: &Levels, (quantity, across): (&'static str, &str)) -> Option<Anisotropy> {
        let all = self.directions(fixed);
        let number = RunQuantity::named(quantity)?;
        let has = |&(_, position): &(f64, usize)| {
            let replicates = 0..self.results.points[position].replicates;
            let values = replicates.filter_map(|replicate| self.results.value(position, replicate, number));
            values.count()
        };
        all.iter().map(has).max().filter(|most| *most > 0)?;
        let is_used = |at: &&(f64, usize)| has(at) > 0 && 2 * has(at) >= self.results.points[at.1].replicates;
        let directions: Vec<(f64, usize)> = all.iter().filter(is_used).copied().collect();
        let values = self.replicates(&directions, number);
        let degrees: Vec<f64> = directions.iter().map(|(degrees, _)| *degrees).collect();
        let confidence = self.plan.settings.confidence();
        Some(Anisotropy {
            quantity,
            levels: self.levels(fixed),
            directions: degrees.len(),
            replicates: values.len(),
            left_out: self.left_out(quantity, &all, degrees.len(), values.len()),
            found: over_directions(&degrees, &values, confidence).map(|found| {
                let lateral = RunQuantity::named(across).map(|across| self.replicates(&directions, across));
                OverDirections {
                    lateral: lateral.and_then(|values| largest_in_size(&degrees, &values, confidence)),
                    ..found
                }
            }),
        })
    }

    /// Columns of the other axes, and their cells.
    fn levels(&self, fixed: &Levels) -> Vec<(String, String)> {
        let axes = self.plan.axes.iter().enumerate();
        let axes = axes.filter_map(|(axis, columns)| {
            let &(_, level) = fixed.iter().find(|(other, _)| *other == axis)?;
            let labels = columns.levels[level].labels.clone();
            Some(columns.columns.iter().cloned().zip(labels))
        });
        axes.flatten().collect()
    }

    /// The distinct directions that have a point at these levels of the other axes, with the positions of the
    /// points.
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

    /// The values of each replicate in all directions, for replicates without a missing value.
    fn replicates(&self, directions: &[(f64, usize)], quantity: RunQuantity) -> Vec<Vec<f64>> {
        let counts = directions.iter();
        let counts = counts.map(|(_, position)| self.results.points[*position].replicates);
        let values = |replicate: usize| {
            let value = |(_, position): &(f64, usize)| self.results.value(*position, replicate, quantity);
            directions.iter().map(value).collect::<Option<Vec<f64>>>()
        };
        (0..counts.min().unwrap_or(0)).filter_map(values).collect()
    }

    /// Sentence on the directions, replicates and runs that are not used.
    fn left_out(
        &self,
        quantity: &str,
        all: &[(f64, usize)],
        directions: usize,
        replicates: usize,
    ) -> Option<String> {
        let without = all
            .iter()
            .map(|&(_, position)| self.results.runs_without_transition(position, quantity));
        let without = if quantity == STATIC { without.sum() } else { 0 };
        let most = all
            .iter()
            .map(|(_, position)| self.results.points[*position].replicates)
            .max();
        let most = most.unwrap_or(0);
        let parts = [
            (without > 0).then(|| format!("{} left out for lack of a transition", are(without, "run"))),
            (directions < all.len()).then(|| {
                format!(
                    "{directions} of {} are used, those with values from at least half of the runs",
                    count(all.len(), "direction")
                )
            }),
            (replicates < most).then(|| {
                format!(
                    "{replicates} of {} are used, those with a value in every direction",
                    count(most, "replicate")
                )
            }),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }
}

/// Result for the values of replicates in these directions, without friction across the drive.
fn over_directions(degrees: &[f64], values: &[Vec<f64>], confidence: f64) -> Result<OverDirections, String> {
    if degrees.len() < 2 {
        return Err("anisotropy needs values in at least two directions".to_owned());
    }
    let too_few = || {
        format!(
            "with {} that {} a value in every direction anisotropy cannot be distinguished from scatter: use {MIN_REPLICATES} \
             or more (`study.replicates`)",
            count(values.len(), "replicate"),
            if values.len() == 1 { "has" } else { "have" },
        )
    };
    if values.len() < MIN_REPLICATES {
        return Err(too_few());
    }
    let sample = |values: Vec<f64>| Sample::from_values(&values, confidence).ok_or_else(too_few);
    let [largest, smallest] = extremes(&sums(values));
    let tensor = Tensor::fit(degrees, values, confidence);
    Ok(OverDirections {
        mean: sample(values.iter().map(|values| mean(values)).collect())?,
        largest_direction: degrees[largest],
        smallest_direction: degrees[smallest],
        anisotropy: sample(from_earlier_replicates(values, |before, values| {
            let [largest, smallest] = extremes(before);
            (values[largest] - values[smallest]) / mean(values)
        }))?,
        p_value: tensor.map(|tensor| tensor.p_value),
        principal: tensor.and_then(|tensor| tensor.principal),
        lateral: None,
    })
}

/// The value that is largest in magnitude, and its direction; none for fewer than three replicates.
fn largest_in_size(degrees: &[f64], values: &[Vec<f64>], confidence: f64) -> Option<(f64, Sample)> {
    if values.len() < MIN_REPLICATES {
        return None;
    }
    let largest = |sums: &[f64]| {
        let sizes: Vec<f64> = sums.iter().map(|sum| sum.abs()).collect();
        let [at, _] = extremes(&sizes);
        (at, 1f64.copysign(sums[at]))
    };
    let (at, sign) = largest(&sums(values));
    let sizes = from_earlier_replicates(values, |before, values| {
        let (at, sign_before) = largest(before);
        sign * sign_before * values[at]
    });
    Some((degrees[at], Sample::from_values(&sizes, confidence)?))
}

/// Applies `measure` to the sums over the earlier replicates and the values of a replicate, for every
/// replicate after the first. A direction that is chosen from earlier replicates does not depend on the
/// scatter of the replicate itself, as one chosen from all would, and no number depends on the choice for an
/// earlier one. The confidence interval of the numbers therefore has the stated coverage.
fn from_earlier_replicates(values: &[Vec<f64>], measure: impl Fn(&[f64], &[f64]) -> f64) -> Vec<f64> {
    let Some((first, later)) = values.split_first() else {
        return Vec::new();
    };
    let mut sums = first.clone();
    let number = |values: &Vec<f64>| {
        let number = measure(&sums, values);
        add(&mut sums, values);
        number
    };
    later.iter().map(number).collect()
}

/// The sum over replicates in each direction.
fn sums(values: &[Vec<f64>]) -> Vec<f64> {
    let mut sums = vec![0.0; values.first().map_or(0, Vec::len)];
    for values in values {
        add(&mut sums, values);
    }
    sums
}

fn add(sums: &mut [f64], values: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += value;
    }
}

/// Positions of the largest and the smallest value, the first of equal ones.
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

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use slipfront::surface::{Coefficients, Distribution};

    use super::*;
    use crate::plan::RunKey;
    use crate::study_file::StudyFile;
    use crate::study_results::PointResult;
    use crate::summary_values::SummaryValues;
    use slipfront_run::summary::Summary;

    const TWELVE: [f64; 12] = [
        0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 270.0, 300.0, 330.0,
    ];

    /// Replicates with normal scatter of 0.01 around this friction in each direction, and a common scatter of
    /// 0.02 for all directions of a replicate, such as that of its surface.
    fn planted(friction: [f64; 12], replicates: usize, seed: u64) -> Vec<Vec<f64>> {
        let normal = |deviation| Distribution { mean: 0.0, deviation };
        let drawn = Coefficients::draw(12 * replicates, normal(0.01), normal(0.02), seed);
        let (own, common) = (drawn.mu_static.chunks(12), drawn.mu_kinetic.chunks(12));
        own.zip(common)
            .map(|(own, common)| {
                let values = friction.iter().zip(own);
                values.map(|(friction, own)| friction + own + common[0]).collect()
            })
            .collect()
    }

    /// Number of trials with an interval above zero, and with one below.
    fn outside(found: &[Sample]) -> [usize; 2] {
        let ends: Vec<[f64; 2]> = found.iter().filter_map(Sample::interval).collect();
        let count = |is: fn(&[f64; 2]) -> bool| ends.iter().filter(|&ends| is(ends)).count();
        [count(|ends| ends[0] > 0.0), count(|ends| ends[1] < 0.0)]
    }

    /// The largest and the smallest of 12 means differ by chance; that difference must not count as
    /// anisotropy more often than the confidence level allows.
    #[test]
    fn isotropic_friction_is_called_anisotropic_no_more_often_than_it_may_be() {
        for replicates in [3, 6, 12] {
            let trials = 2000;
            let trial = |seed| {
                let values = planted([0.8; 12], replicates, seed);
                over_directions(&TWELVE, &values, 0.95).unwrap()
            };
            let found: Vec<OverDirections> = (0..trials).map(trial).collect();
            // 2.5 % of 2000 on either side are 50 +- 7; the bound is five standard errors. The differences of
            // replicates are independent and normal, except for the division by the mean, which scatters by
            // only 2 %.
            let differences: Vec<Sample> = found.iter().map(|found| found.anisotropy).collect();
            let [above, below] = outside(&differences);
            assert!(
                above.abs_diff(50) < 35 && below.abs_diff(50) < 35,
                "{replicates}: {above} {below}"
            );
            // 5 % are 100 +- 9.7; the bound is five standard errors.
            let axes = found.iter().filter(|found| found.principal.is_some());
            assert!(axes.count().abs_diff(100) < 49, "{replicates}");
            // Friction across the drive is zero, and its sign is chosen from the data, too; both sides
            // together are 5 %.
            let laterals = (0..trials).map(|seed| {
                let values = planted([0.0; 12], replicates, seed);
                largest_in_size(&TWELVE, &values, 0.95).unwrap().1
            });
            let [above, below] = outside(&laterals.collect::<Vec<_>>());
            assert!(
                (above + below).abs_diff(100) < 49,
                "{replicates}: {above} {below}"
            );
        }
    }

    #[test]
    fn planted_anisotropy_is_found_with_its_axis_and_size() {
        let friction = TWELVE.map(|degrees| 0.8 + 0.04 * libm::cos(2.0 * (degrees - 60_f64).to_radians()));
        let trials = 400;
        let found: Vec<OverDirections> = (0..trials)
            .map(|seed| over_directions(&TWELVE, &planted(friction, 8, seed), 0.95).unwrap())
            .collect();
        // The amplitude of 0.04 is 28 standard errors of 0.01 sqrt(2/12)/sqrt(8).
        assert!(found.iter().all(|found| found.principal.is_some()));
        // 95 % of 400 are 380 +- 4.4; the bound is five standard errors.
        let share = |is: &dyn Fn(&OverDirections) -> bool| found.iter().filter(|found| is(found)).count();
        let axis = share(&|found| {
            let principal = found.principal.unwrap();
            (principal.direction - 60.0).abs() < principal.half_width.unwrap()
        });
        let values = [(0, 0.84), (1, 0.76)].map(|(which, expected)| {
            share(&|found| {
                let [low, high] = found.principal.unwrap().values[which].interval().unwrap();
                (low..=high).contains(&expected)
            })
        });
        for covered in [axis, values[0], values[1]] {
            assert!(covered.abs_diff(380) < 23, "{axis} {values:?}");
        }
        // Friction is largest at 60 or 240 degrees, and smallest a quarter turn from there. At 30 degrees
        // from these, friction differs by 0.02, four standard errors of the difference of two means of eight
        // (3e-5). There are eight such pairs, so a wrong direction is expected in one of 400 trials about one
        // time in ten.
        let at = share(&|found| {
            found.largest_direction % 180.0 == 60.0 && found.smallest_direction % 180.0 == 150.0
        });
        assert!(at >= 398, "{at}");
        // If one or two replicates choose a wrong direction, a difference is smaller, by at most a twentieth
        // on average.
        let sizes: Vec<f64> = found.iter().map(|found| found.anisotropy.mean).collect();
        let size = mean(&sizes);
        assert!((0.095..=0.1002).contains(&size), "{size}");
    }

    #[test]
    fn too_few_directions_or_replicates_give_a_sentence() {
        let one = over_directions(&[0.0], &vec![vec![0.8]; 6], 0.95).unwrap_err();
        assert!(one.contains("at least two directions"), "{one}");
        let values = planted([0.8; 12], 2, 1);
        let two = over_directions(&TWELVE, &values, 0.95).unwrap_err();
        assert!(two.contains("with 2 replicates that have a value"), "{two}");
        assert!(largest_in_size(&TWELVE, &values, 0.95).is_none());
        // Two directions have a difference, but no axes.
        let values: Vec<Vec<f64>> = planted([0.8; 12], 3, 1)
            .into_iter()
            .map(|values| values[..2].to_vec())
            .collect();
        let found = over_directions(&TWELVE[..2], &values, 0.95).unwrap();
        assert!(found.p_value.is_none() && found.principal.is_none());
    }

    /// Failed directions and runs that never slide are left out, and a sentence says so; the others are used.
    #[test]
    fn what_has_no_value_is_left_out_and_said() {
        let text = "base.slider.blocks = [4, 4]\nstudy.replicates = 4\n[[axes]]\nkey = 'drive.direction'\nlist = [0, 60, 120, 90, 360]";
        let file = StudyFile::parse(text, "study.toml", "study", Path::new("")).unwrap();
        let plan = Plan::new(&file, None).unwrap();
        let result = |run: RunKey| match (run.point, run.replicate) {
            (2, _) => Err("it failed".to_owned()),
            (point, replicate) => Ok(Arc::new(SummaryValues::from_summary(&Summary {
                static_friction_star: 0.5 + 0.1 * point as f64 + 0.01 * replicate as f64,
                // 60 degrees never slides in replicate 1, 90 degrees only in replicate 3.
                transition: (point, replicate) != (1, 1) && (point != 3 || replicate == 3),
                ..Summary::default()
            }))),
        };
        let results = StudyResults {
            runs: plan.runs(4).map(|run| (run, result(run))).collect(),
            points: vec![
                PointResult {
                    replicates: 4,
                    narrow: None
                };
                5
            ],
            orphaned_runs: 0,
        };
        let found = &anisotropies(&plan, &results)[0];
        assert_eq!((found.directions, found.replicates), (2, 3), "{found:?}");
        let expected = "4 runs are left out for lack of a transition; 2 of 4 directions are used, those with values from \
                        at least half of the runs; 3 of 4 replicates are used, those with a value in every direction";
        assert_eq!(found.left_out.as_deref(), Some(expected));
        let numbers = found.found.as_ref().unwrap();
        assert_eq!(
            [numbers.largest_direction, numbers.smallest_direction],
            [60.0, 0.0]
        );
        // The means of replicates 0, 2 and 3 are around 0.55.
        assert!(
            (numbers.mean.mean - (0.55 + 0.05 / 3.0)).abs() < 1e-15,
            "{numbers:?}"
        );
        assert_eq!(numbers.anisotropy.n, 2);
    }

    /// The earlier replicates determine the directions of each difference.
    #[test]
    fn a_difference_is_between_directions_that_others_chose() {
        let values = [vec![0.9, 0.8, 0.7], vec![0.6, 0.8, 1.0], vec![0.7, 1.0, 0.7]];
        let numbers = from_earlier_replicates(&values, |before, values| {
            let [largest, smallest] = extremes(before);
            values[largest] - values[smallest]
        });
        // After one replicate, direction 0 is largest and 2 is smallest; after two, direction 2 is largest
        // with 1.7 and 0 is smallest with 1.5.
        let expected = [0.6 - 1.0, 0.7 - 0.7];
        assert_eq!(numbers, expected);
    }

    #[test]
    fn the_largest_and_smallest_are_the_first_of_equal_ones() {
        assert_eq!(extremes(&[0.5, 0.9, 0.1, 0.9, 0.1]), [1, 2]);
        assert_eq!(extremes(&[0.5, 0.5]), [0, 0]);
    }
}
