//! [`Case`] -> [`Record`]: one run with all observers that its files need.

use serde::{Deserialize, Serialize};
use slipfront::checkpoint::BlockNumbers;
use slipfront::observe::frames::Selection;
use slipfront::observe::{
    Curve, CurveRow, FirstSlip, Frame, Frames, Instants, KineticHistory, Observer, Schedule, Scheduled,
};
use slipfront::{Checkpoint, Execution, RunError, Simulation, Snapshot, StopReason};

use crate::summary::{Observed, Summary};
use slipfront_case::case::{Case, Snapshots};

/// Everything a run leaves behind, in memory.
#[derive(Debug)]
pub struct Record {
    /// The numbers.
    pub summary: Summary,
    /// The recorded curve.
    pub rows: Vec<CurveRow>,
    /// Fields in the order of time, each with the letters of the instants A-F that it shows.
    pub frames: Vec<(String, Frame)>,
    /// t* of the first slip of every block.
    pub first_slip_time_star: Vec<f64>,
    /// tau_c^max, in units of `P mu_s`.
    pub contact_stress_max: f64,
}

/// Fewest blocks for which a thread is worth its share in keeping step with the others.
const BLOCKS_PER_THREAD: usize = 1 << 16;

/// Runs a case to its end, on at most `threads` threads.
///
/// # Errors
/// [`RunError`] when the run diverges.
pub fn run(case: &Case, threads: usize) -> Result<Record, RunError> {
    let mut running = Running::start(case, threads);
    loop {
        if let Some(reason) = running.advance(u64::MAX)? {
            return Ok(running.record(reason));
        }
    }
}

/// A run in progress, with all that its files need of it.
pub struct Running<'c> {
    case: &'c Case,
    simulation: Simulation<'c>,
    observers: Observers,
}

/// What a run has recorded up to now.
#[derive(Debug, Serialize, Deserialize)]
pub struct Observers {
    curve: Curve,
    history: KineticHistory,
    fields: Fields,
}

/// The snapshots.
#[derive(Debug, Serialize, Deserialize)]
enum Fields {
    Instants(Box<Instants>),
    Frames(Frames),
}

/// All that a run needs to go on later, written down as [`Running::state`].
#[derive(Debug, Serialize, Deserialize)]
pub struct RunState<N = BlockNumbers, O = Observers> {
    simulation: Checkpoint<N>,
    observers: O,
}

impl Observers {
    fn new(case: &Case) -> Self {
        let (time_plan, output) = (&case.time_plan, &case.output);
        let selection = Selection {
            fields: output.fields.clone(),
            stride: output.stride,
        };
        Self {
            curve: Curve::every(output.series_stride),
            history: KineticHistory::new(time_plan.last_step),
            fields: match output.snapshots {
                Snapshots::Instants => Fields::Instants(Box::new(Instants::new(
                    selection,
                    time_plan.kinetic,
                    time_plan.end_star(),
                ))),
                Snapshots::At(_) | Snapshots::Every(_) => Fields::Frames(Frames::new(selection)),
            },
        }
    }

    /// Whether they can be those of a run of this case after `step` steps.
    fn belong_to(&self, case: &Case, step: u64) -> bool {
        let (new, lattice) = (Self::new(case), &case.model.lattice);
        let fields = match (&self.fields, &new.fields) {
            (Fields::Instants(old), Fields::Instants(new)) => old.continues(new, lattice, step),
            (Fields::Frames(old), Fields::Frames(new)) => old.continues(new, lattice, step),
            _ => false,
        };
        fields && self.curve.continues(&new.curve, step) && self.history.continues(&new.history, step)
    }

    fn scheduled(&mut self, snapshots: &Snapshots) -> [Scheduled<'_>; 3] {
        let schedule = match snapshots {
            Snapshots::Instants => Schedule::Always,
            Snapshots::At(steps) => Schedule::At(steps.clone()),
            Snapshots::Every(steps) => Schedule::Every(*steps),
        };
        let fields: &mut dyn Observer = match &mut self.fields {
            Fields::Instants(instants) => &mut **instants,
            Fields::Frames(frames) => frames,
        };
        [
            Scheduled::always(&mut self.curve),
            Scheduled::always(&mut self.history),
            Scheduled::new(schedule, fields),
        ]
    }
}

impl<'c> Running<'c> {
    fn execution(case: &Case, threads: usize) -> Execution {
        Execution {
            threads: (case.model.lattice.n_blocks() / BLOCKS_PER_THREAD).clamp(1, threads),
            ..Execution::default()
        }
    }

    /// Begins a run on at most `threads` threads.
    pub fn start(case: &'c Case, threads: usize) -> Self {
        let execution = Self::execution(case, threads);
        Self {
            case,
            simulation: Simulation::executed(&case.model, case.time_plan.dt_star, None, execution),
            observers: Observers::new(case),
        }
    }

    /// Goes on with a run where its state was written down; none if the state is not one of this case.
    pub fn resume(case: &'c Case, threads: usize, state: RunState) -> Option<Self> {
        let RunState {
            simulation,
            observers,
        } = state;
        let step = simulation.step;
        if step > case.time_plan.last_step || !observers.belong_to(case, step) {
            return None;
        }
        let execution = Self::execution(case, threads);
        Some(Self {
            case,
            simulation: Simulation::resume(&case.model, case.time_plan.dt_star, simulation, execution)?,
            observers,
        })
    }

    /// At most `steps` steps; why the run ended, if it did.
    ///
    /// # Errors
    /// [`RunError`] when the run diverges.
    pub fn advance(&mut self, steps: u64) -> Result<Option<StopReason>, RunError> {
        let mut observers = self.observers.scheduled(&self.case.output.snapshots);
        self.simulation
            .advance(self.case.time_plan.stop, steps, &mut observers)
    }

    /// The present instant.
    pub fn snapshot(&self) -> Snapshot<'_> {
        self.simulation.snapshot()
    }

    /// The case that is run.
    pub fn case(&self) -> &'c Case {
        self.case
    }

    /// All that the run needs to go on later, to be written down.
    pub fn state(&self) -> impl Serialize + '_ {
        RunState {
            simulation: self.simulation.checkpoint(),
            observers: &self.observers,
        }
    }

    /// What the run leaves behind, once it has ended.
    pub fn record(self, reason: StopReason) -> Record {
        let Self {
            case,
            simulation,
            observers,
        } = self;
        let Observers {
            curve,
            history,
            fields,
        } = observers;
        let time_plan = &case.time_plan;
        let first_slip = FirstSlip::of(&simulation);
        let (instants, frames) = match fields {
            Fields::Instants(instants) => (instants.found(), Vec::new()),
            Fields::Frames(frames) => (Vec::new(), frames.frames),
        };
        let peak = simulation.peak();
        let kinetic_from = time_plan.kinetic.time_star(&peak, case.groups.v_star);
        // A run that stops at its onset has no kinetic phase, wherever the window was meant to begin, and neither has one
        // in which nothing slipped.
        let kinetic = match reason {
            StopReason::End if first_slip.earliest.is_none() => None,
            StopReason::End => history.kinetic(kinetic_from, time_plan.dt_star),
            StopReason::Onset => None,
        };
        let (steps, energies) = curve
            .rows
            .last()
            .map(|row| (row.step, row.energies))
            .unwrap_or_default();
        let found = Observed {
            reason,
            steps,
            peak,
            kinetic,
            first_slip: first_slip.earliest,
            sliding_percent_max: history.sliding_percent_max(),
            energies,
            instants: &instants,
        };
        Record {
            summary: Summary::new(case, &found),
            rows: curve.rows,
            frames: if instants.is_empty() {
                unlettered(frames)
            } else {
                merged(instants)
            },
            first_slip_time_star: first_slip.time_star,
            contact_stress_max: simulation.contact_stress_max(),
        }
    }
}

/// Runs a case on one thread as long as `ends` does not say otherwise; none if it was given up.
///
/// # Errors
/// [`RunError`] when the run diverges.
pub fn run_unless(case: &Case, ends: &dyn Fn() -> bool) -> Option<Result<Record, RunError>> {
    let mut running = Running::start(case, 1);
    while !ends() {
        match running.advance(case.steps_per_look()) {
            Ok(None) => {}
            Ok(Some(reason)) => return Some(Ok(running.record(reason))),
            Err(error) => return Some(Err(error)),
        }
    }
    None
}

fn unlettered(frames: Vec<Frame>) -> Vec<(String, Frame)> {
    frames.into_iter().map(|frame| (String::new(), frame)).collect()
}

/// Instants that coincide, as on a uniform lattice, are one frame with several letters: times of a file must rise.
fn merged(mut instants: Vec<(char, Frame)>) -> Vec<(String, Frame)> {
    instants.sort_by_key(|(letter, frame)| (frame.step, *letter));
    let mut frames: Vec<(String, Frame)> = Vec::new();
    for (letter, frame) in instants {
        match frames.last_mut() {
            Some((letters, last)) if last.step == frame.step => letters.push(letter),
            _ => frames.push((letter.to_string(), frame)),
        }
    }
    frames
}
