//! Estimate of the cost of a run from some of its steps: a lower and an upper bound of its time in s on an
//! otherwise idle machine.

use std::sync::Arc;
use std::time::Duration;

use slipfront::{Execution, State};
use slipfront_base::machine::thread_time;
use slipfront_case::case::{Case, ExpectedSteps};

use crate::running::Running;

/// Number of measurements of each kind in an estimate.
const MEASUREMENTS: usize = 5;
/// Duration of a measurement, which has at least one step, in s.
const MEASUREMENT: f64 = 0.005;
/// Total duration of the measurements of a kind after which no further one begins.
const ENOUGH: Duration = Duration::from_millis(300);
/// Duration of a pilot run in which blocks slide in every step, in s.
const PILOT: f64 = 0.5;
/// Largest number of blocks of a pilot run, which holds a second model in memory.
const MOST_PILOT_BLOCKS: usize = 1_000_000;
/// V* N above which blocks slide in every step: a faster pilot run has no larger share of such steps.
const ALWAYS_SLIDING: f64 = 5.0;

/// Time of a step of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepTime {
    /// Time while the slider rests, in s: most of its blocks are skipped.
    pub at_rest: f64,
    /// Time while blocks slide, in s: every block is computed.
    pub sliding: f64,
    slip: SlipTime,
}

/// Mean time per step of a run by which slip lengthens the steps. Slip takes a certain time, however slow the
/// loading between slips is. The time depends on V* N, the ratio of the time in which a slip front crosses
/// the slider to the time of loading, as
///
/// ```text
/// t (V* N/x)^e
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
struct SlipTime {
    /// x, the V* N at which the time t was found.
    front_ratio: f64,
    /// Bounds of the time t, in s.
    seconds: [f64; 2],
    /// Upper limit of the time, in s, which it has if blocks slide in every step.
    longest: f64,
    /// Exponents of the lower and of the upper bound at a smaller V* N.
    exponents: [f64; 2],
}

impl StepTime {
    /// Measures some steps of a case, and a run of the case that is shortened by a faster drive.
    pub fn measure(case: &Case) -> Self {
        let at_rest = measured(case, None);
        let sliding = measured(case, Some(sliding(case)));
        Self {
            at_rest,
            sliding,
            slip: SlipTime::of_pilot(case, at_rest, sliding)
                .unwrap_or_else(|| SlipTime::expected(at_rest, sliding)),
        }
    }

    /// Bounds of the time of these steps, in s; the upper one is infinite if a held drive may pause for any
    /// number of steps.
    pub fn of_steps(&self, expected: &ExpectedSteps) -> [f64; 2] {
        let [fewest, most] = expected.steps;
        let [shortest, longest] = self.slip.at(expected.front_ratio);
        let most = if expected.stands {
            f64::INFINITY
        } else {
            most * (self.at_rest + longest)
        };
        [fewest * (self.at_rest + shortest), most]
    }
}

impl SlipTime {
    /// The time from a pilot run over the whole path of the drive, which is fast enough to keep the run
    /// short; none if a faster drive would change the kind of the case, or if the case has too many blocks.
    /// With Coulomb friction, slip takes a smaller share of the steps under a slower drive. Where strength
    /// falls with slip, blocks creep, and slip takes the same share.
    fn of_pilot(case: &Case, at_rest: f64, sliding: f64) -> Option<Self> {
        let drive = &case.model.drive;
        if drive.program.is_some() || drive.is_held() || case.model.n_blocks() > MOST_PILOT_BLOCKS {
            return None;
        }
        let expected = case.expected_steps();
        let steps = 0.5 * (expected.steps[0] + expected.steps[1]);
        let faster = (steps * sliding.max(at_rest) / PILOT).max(1.0);
        let mut pilot = case.clone();
        Arc::make_mut(&mut pilot.model).drive.v_star *= faster;
        let mut running = started(pilot, None);
        let (seconds, made) = seconds_of(&mut running, (steps / faster).ceil() as u64);
        let slip = (seconds / made as f64 - at_rest).max(0.0);
        Some(Self {
            front_ratio: (faster * expected.front_ratio).min(ALWAYS_SLIDING),
            seconds: [slip; 2],
            longest: slip.max(sliding - at_rest),
            exponents: [0.35, -0.1],
        })
    }

    /// The time if none was measured: in runs with V* N from 0.002 to 5, the share of steps with sliding
    /// blocks was within a factor of two of (V* N)^0.4/2.
    fn expected(at_rest: f64, sliding: f64) -> Self {
        let longer = (sliding - at_rest).max(0.0);
        Self {
            front_ratio: 1.0,
            seconds: [0.25 * longer, longer],
            longest: longer,
            exponents: [0.4; 2],
        }
    }

    /// Bounds of the time at this V* N.
    fn at(&self, front_ratio: f64) -> [f64; 2] {
        let slower = (front_ratio / self.front_ratio).min(1.0);
        let bound = |k: usize| libm::pow(slower, self.exponents[k]) * self.seconds[k];
        [bound(0), bound(1).min(self.longest)]
    }
}

/// A state in which all blocks slide for longer than a measurement takes.
fn sliding(case: &Case) -> State {
    const SPEED_STAR: f64 = 1e3;
    let mut state = State::at_rest(case.model.lattice.n_blocks());
    state.velocity.x.fill(SPEED_STAR);
    state
}

/// Time of a step in s: the shortest of some measurements that start from a state, or from the start of the
/// case if there is none. The shortest is taken because a slider that begins to move is not at rest at once.
fn measured(case: &Case, state: Option<State>) -> f64 {
    let mut running = started(case.clone(), state);
    // The first step brings the lattice into the cache.
    let (mut shortest, _) = seconds_of(&mut running, 1);
    let began = thread_time();
    for _ in 0..MEASUREMENTS {
        shortest = shortest.min(seconds_per_step(&mut running));
        if thread_time() - began > ENOUGH {
            break;
        }
    }
    shortest
}

/// A run of a case, with all that it records, from a state in which blocks slide in every step, or from its
/// start.
fn started(case: Case, state: Option<State>) -> Running {
    let execution = Execution {
        skips: state.is_none(),
        ..Execution::default()
    };
    Running::start(&Arc::new(case), state, execution)
}

/// Time of `steps` steps in s, or of fewer if the run ends, and their number.
fn seconds_of(running: &mut Running, steps: u64) -> (f64, u64) {
    let (began, first) = (thread_time(), running.snapshot().step);
    // A run that diverges has also ended.
    let _ = running.advance(steps);
    let made = running.snapshot().step - first;
    ((thread_time() - began).as_secs_f64(), made)
}

/// Time of a step in one measurement, in s; infinite if the run has ended. The clock is read rarely, because
/// reading it takes as long as a step of a few blocks.
fn seconds_per_step(running: &mut Running) -> f64 {
    let (mut passed, mut steps) = (0.0, 0);
    while passed < MEASUREMENT {
        let (more, made) = seconds_of(running, steps.max(1));
        passed += more;
        steps += made;
        if made == 0 {
            break;
        }
    }
    if steps == 0 {
        f64::INFINITY
    } else {
        passed / steps as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slip takes a smaller share of the steps at a slower drive, and no share is larger than under a drive
    /// with which blocks slide all the time. The pauses of a held drive have no upper bound.
    #[test]
    fn the_time_of_steps_follows_the_share_of_slip() {
        let time = StepTime {
            at_rest: 1.0,
            sliding: 5.0,
            slip: SlipTime {
                front_ratio: 4.0,
                seconds: [2.0, 4.0],
                longest: 4.0,
                exponents: [1.0, -0.5],
            },
        };
        let of = |front_ratio: f64, stands: bool| {
            time.of_steps(&ExpectedSteps {
                steps: [10.0, 20.0],
                front_ratio,
                stands,
            })
        };
        assert_eq!(of(4.0, false), [30.0, 100.0]);
        assert_eq!(of(1.0, false), [15.0, 100.0]);
        assert_eq!(of(9.0, false), of(4.0, false));
        assert_eq!(of(1.0, true), [15.0, f64::INFINITY]);
    }
}
