//! Estimate of the cost of a run from some of its steps.

use std::ops::{Add, Mul};
use std::time::{Duration, Instant};

use slipfront::{Execution, Simulation};
use slipfront_case::case::Case;

/// Measurements of each kind in an estimate.
const MEASUREMENTS: usize = 5;
/// Duration of a measurement, which has one step at least.
const MEASUREMENT: Duration = Duration::from_millis(5);
/// Duration of the measurements of a kind from which on no other begins.
const ENOUGH: Duration = Duration::from_millis(300);

/// Bounds of the time that a computation takes, in s, from several short measurements: other work on the
/// machine makes it longer, and the range wider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimeRange {
    /// The lower bound.
    pub least: f64,
    /// The upper bound.
    pub most: f64,
}

impl Add for TimeRange {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            least: self.least + other.least,
            most: self.most + other.most,
        }
    }
}

impl Mul<[f64; 2]> for TimeRange {
    type Output = Self;
    /// The time of a number of steps between two bounds.
    fn mul(self, [fewest, most]: [f64; 2]) -> Self {
        Self {
            least: fewest * self.least,
            most: most * self.most,
        }
    }
}

impl Mul<f64> for TimeRange {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self * [factor; 2]
    }
}

/// Time of the steps of this case, see [`Case::expected_steps`].
pub fn time_of_run(case: &Case) -> TimeRange {
    time_per_step(case) * case.expected_steps()
}

/// Time of a step of this case: at least that of a slider at rest, most of whose blocks are skipped, and at
/// most that of a step that computes every block.
pub fn time_per_step(case: &Case) -> TimeRange {
    let measured = [true, false].map(|skips| measurements(case, skips)).concat();
    TimeRange {
        least: measured.iter().copied().fold(f64::INFINITY, f64::min),
        most: measured.iter().copied().fold(0.0, f64::max),
    }
}

/// Seconds per step of some measurements from the start of the case on.
fn measurements(case: &Case, skips: bool) -> Vec<f64> {
    let execution = Execution {
        skips,
        ..Execution::default()
    };
    let mut simulation = Simulation::new(case.model.clone(), case.time_plan.dt_star, None, execution);
    // The first step brings the lattice into the cache.
    simulation.step();
    let began = Instant::now();
    let mut measured = Vec::new();
    while measured.is_empty() || (measured.len() < MEASUREMENTS && began.elapsed() < ENOUGH) {
        measured.push(seconds_per_step(&mut simulation));
    }
    measured
}

/// Seconds per step of one measurement.
fn seconds_per_step(simulation: &mut Simulation) -> f64 {
    let (began, mut steps) = (Instant::now(), 0);
    while steps == 0 || began.elapsed() < MEASUREMENT {
        simulation.step();
        steps += 1;
    }
    began.elapsed().as_secs_f64() / f64::from(steps)
}
