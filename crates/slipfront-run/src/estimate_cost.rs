//! Estimate of the cost of a run from some of its steps.

use std::ops::{Add, Mul};
use std::sync::Arc;
use std::time::Duration;

use serde::Serialize;
use slipfront::{Execution, Model, Simulation, State};
use slipfront_base::machine::thread_time;
use slipfront_case::case::{Case, ExpectedSteps};

/// Measurements of each kind in an estimate.
const MEASUREMENTS: usize = 5;
/// Duration of a measurement, which has one step at least.
const MEASUREMENT: Duration = Duration::from_millis(5);
/// Duration of the measurements of a kind from which on no other begins.
const ENOUGH: Duration = Duration::from_millis(300);
/// Duration of a pilot run whose blocks slide in every step, in s.
const PILOT: f64 = 0.3;
/// Largest number of blocks of a pilot run, which takes a second model into memory.
const MOST_PILOT_BLOCKS: usize = 1_000_000;
/// V* N above which blocks slide in every step: a faster pilot has as many of them.
const ALWAYS_SLIDING: f64 = 5.0;

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
    slip: SlipTime,
}

/// Time by which slip lengthens the steps, in the mean of a run: slip takes a time of its own, however slow
/// the loading is between. It follows V* N, the time in which a slip front crosses the slider over that of
/// loading, as
///
/// ```text
/// t (V* N/x)^e
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
struct SlipTime {
    /// V* N at which the time was found.
    front_ratio: f64,
    /// Bounds of the time of a step, in s.
    seconds: TimeRange,
    /// Exponents of the lower and of the upper bound at a smaller V* N.
    exponents: [f64; 2],
}

impl StepTime {
    /// Measures some steps of a case, and a run of it that a faster drive makes short.
    pub fn of(case: &Case) -> Self {
        let at_rest = measured(case, None);
        let sliding = measured(case, Some(sliding(case)));
        Self {
            at_rest,
            sliding,
            slip: SlipTime::of_pilot(case, at_rest, sliding)
                .unwrap_or_else(|| SlipTime::expected(at_rest, sliding)),
        }
    }

    /// Time of these steps.
    pub fn of_steps(&self, expected: &ExpectedSteps) -> TimeRange {
        let [fewest, most] = expected.steps;
        let slip = self.slip.at(expected.front_ratio);
        TimeRange {
            least: fewest * (self.at_rest.least + slip.least),
            most: if expected.stands {
                f64::INFINITY
            } else {
                most * (self.at_rest.most + slip.most)
            },
        }
    }
}

impl SlipTime {
    /// The time from a run over the whole path of the drive, as fast as its time has to be short; none where
    /// a faster drive is no other case of the same kind.
    fn of_pilot(case: &Case, at_rest: TimeRange, sliding: TimeRange) -> Option<Self> {
        let drive = &case.model.drive;
        if drive.program.is_some() || drive.is_held() || case.model.n_blocks() > MOST_PILOT_BLOCKS {
            return None;
        }
        let expected = case.expected_steps();
        let steps = 0.5 * (expected.steps[0] + expected.steps[1]);
        let faster = (steps * sliding.most.max(at_rest.most) / PILOT).max(1.0);
        let mut model = Model::clone(&case.model);
        model.drive.v_star *= faster;
        let mut simulation = Simulation::new(
            Arc::new(model),
            case.time_plan.dt_star,
            None,
            Execution::default(),
        );
        let n_steps = (steps / faster).ceil();
        let began = thread_time();
        for _ in 0..n_steps as u64 {
            simulation.step();
        }
        let per_step = (thread_time() - began).as_secs_f64() / n_steps;
        let rest = 0.5 * (at_rest.least + at_rest.most);
        let slip = (per_step - rest).max(0.0);
        Some(Self {
            front_ratio: (faster * expected.front_ratio).min(ALWAYS_SLIDING),
            seconds: TimeRange {
                least: slip,
                most: slip,
            },
            exponents: [0.6, 0.2],
        })
    }

    /// The time where none was measured: in runs with V* N from 0.002 to 5 blocks slid in half or twice (V*
    /// N)^0.4/2 of the steps.
    fn expected(at_rest: TimeRange, sliding: TimeRange) -> Self {
        let longer = |sliding: f64, at_rest: f64| (sliding - at_rest).max(0.0);
        Self {
            front_ratio: 1.0,
            seconds: TimeRange {
                least: 0.25 * longer(sliding.least, at_rest.least),
                most: longer(sliding.most, at_rest.most),
            },
            exponents: [0.4; 2],
        }
    }

    /// Bounds of the time at this V* N.
    fn at(&self, front_ratio: f64) -> TimeRange {
        let slower = front_ratio / self.front_ratio;
        let [least, most] = self
            .exponents
            .map(|exponent| libm::pow(slower.min(1.0), exponent));
        TimeRange {
            least: least * self.seconds.least,
            most: most * self.seconds.most,
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

/// Seconds per step of one measurement. The clock is read seldom, since that takes as long as a step of a few
/// blocks.
fn seconds_per_step(simulation: &mut Simulation) -> f64 {
    let (began, mut steps) = (thread_time(), 0_u32);
    let passed = loop {
        for _ in 0..steps.max(1) {
            simulation.step();
        }
        steps += steps.max(1);
        let passed = thread_time() - began;
        if passed >= MEASUREMENT {
            break passed;
        }
    };
    passed.as_secs_f64() / f64::from(steps)
}
