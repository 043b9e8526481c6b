//! Estimate of the cost of a run from some of its steps.

use std::ops::{Add, Mul};
use std::time::Duration;

use serde::Serialize;
use slipfront::{Execution, Simulation, State};
use slipfront_base::machine::thread_time;
use slipfront_case::case::{Case, ExpectedSteps};

/// Measurements of each kind in an estimate.
const MEASUREMENTS: usize = 5;
/// Duration of a measurement, which has one step at least.
const MEASUREMENT: Duration = Duration::from_millis(5);
/// Duration of the measurements of a kind from which on no other begins.
const ENOUGH: Duration = Duration::from_millis(300);

/// Bounds of the time that a computation takes on a machine without other work, in s, from several short
/// measurements. In JSON it is `[least, most]`,
/// where no upper bound is null.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(into = "[f64; 2]")]
pub struct TimeRange {
    /// The lower bound.
    pub least: f64,
    /// The upper bound; infinite if a held drive may stand for any number of steps.
    pub most: f64,
}

impl From<TimeRange> for [f64; 2] {
    fn from(time: TimeRange) -> Self {
        [time.least, time.most]
    }
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

impl Mul<f64> for TimeRange {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            least: factor * self.least,
            most: factor * self.most,
        }
    }
}

/// Time of a step of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepTime {
    /// While the slider rests: most of its blocks are skipped.
    pub at_rest: TimeRange,
    /// While blocks slide: every block is computed.
    pub sliding: TimeRange,
}

impl StepTime {
    /// Measures some steps of a case.
    pub fn of(case: &Case) -> Self {
        Self {
            at_rest: measured(case, None),
            sliding: measured(case, Some(sliding(case))),
        }
    }

    /// Time of these steps.
    pub fn of_steps(&self, expected: &ExpectedSteps) -> TimeRange {
        let [fewest, most] = expected.steps;
        let [least_share, largest_share] = expected.sliding_share();
        let mean = |at_rest: f64, sliding: f64, share: f64| at_rest + share * (sliding - at_rest).max(0.0);
        TimeRange {
            least: fewest * mean(self.at_rest.least, self.sliding.least, least_share),
            most: if expected.stands {
                f64::INFINITY
            } else {
                most * mean(self.at_rest.most, self.sliding.most, largest_share)
            },
        }
    }
}

/// A state in which all blocks slide, and go on for longer than a measurement takes.
fn sliding(case: &Case) -> State {
    const SPEED_STAR: f64 = 1e3;
    let mut state = State::at_rest(case.model.lattice.n_blocks());
    state.velocity.x.fill(SPEED_STAR);
    state
}

/// Time of a step by some measurements from a state on, from the start of the case if there is none.
fn measured(case: &Case, state: Option<State>) -> TimeRange {
    let execution = Execution {
        skips: state.is_none(),
        ..Execution::default()
    };
    let mut simulation = Simulation::new(case.model.clone(), case.time_plan.dt_star, state, execution);
    // The first step brings the lattice into the cache.
    simulation.step();
    let began = thread_time();
    let mut measured = Vec::new();
    while measured.is_empty() || (measured.len() < MEASUREMENTS && thread_time() - began < ENOUGH) {
        measured.push(seconds_per_step(&mut simulation));
    }
    TimeRange {
        least: measured.iter().copied().fold(f64::INFINITY, f64::min),
        most: measured.iter().copied().fold(0.0, f64::max),
    }
}

/// Seconds per step of one measurement.
fn seconds_per_step(simulation: &mut Simulation) -> f64 {
    let (began, mut steps) = (thread_time(), 0);
    let passed = loop {
        simulation.step();
        steps += 1;
        let passed = thread_time() - began;
        if passed >= MEASUREMENT {
            break passed;
        }
    };
    passed.as_secs_f64() / f64::from(steps)
}
