//! [`Case`] -> [`Record`]: one run with all observers that its files need.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use slipfront::checkpoint::BlockNumbers;
use slipfront::observe::frames::Selection;
use slipfront::observe::{CurveRow, Frame, Frames, Instants, Schedule, Scheduled};
use slipfront::{Checkpoint, Execution, RunError, Simulation, Snapshot, Stop, StopReason};

use crate::fields::FieldFrame;
use crate::summary::{Summary, SummaryObservers};
use slipfront_case::case::{Case, Output, Snapshots};

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

/// Runs a case to its end, on at most `threads` threads, unless the run diverges.
pub fn run(case: &Arc<Case>, threads: usize) -> Result<Record, RunError> {
    let mut running = Running::start(case, threads);
    loop {
        if let Some(reason) = running.advance(u64::MAX)? {
            return Ok(running.record(reason));
        }
    }
}

/// A run in progress, with all that its files need of it.
pub struct Running {
    case: Arc<Case>,
    /// When it ends.
    stop: Stop,
    simulation: Simulation,
    observers: Observers,
}

/// What a run has recorded up to now.
#[derive(Debug, Serialize, Deserialize)]
pub struct Observers {
    summary: SummaryObservers,
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

fn execution(case: &Case, threads: usize) -> Execution {
    Execution {
        threads: (case.model.lattice.n_blocks() / BLOCKS_PER_THREAD).clamp(1, threads),
        ..Execution::default()
    }
}

/// The fields of the output of a case, as the observers select them.
fn selection(output: &Output) -> Selection {
    Selection {
        fields: output.fields.clone(),
        stride: output.stride,
    }
}

impl Observers {
    /// Those of a run of at most `last_step` steps, [`u64::MAX`] for a run without an end.
    fn new(case: &Case, last_step: u64) -> Self {
        let (time_plan, output) = (&case.time_plan, &case.output);
        let selection = selection(output);
        let fields = match output.snapshots {
            Snapshots::Instants => {
                let instants = Instants::new(selection, time_plan.kinetic, time_plan.end_star());
                Fields::Instants(Box::new(instants))
            }
            Snapshots::At(_) | Snapshots::Every(_) => Fields::Frames(Frames::new(selection)),
        };
        Self {
            summary: SummaryObservers::new(case, last_step),
            fields,
        }
    }

    /// Whether they can be those of a run of this case after `step` steps.
    fn belong_to(&self, case: &Case, step: u64) -> bool {
        let (new, lattice) = (Self::new(case, case.time_plan.last_step), &case.model.lattice);
        let fields = match (&self.fields, &new.fields) {
            (Fields::Instants(old), Fields::Instants(new)) => old.is_consistent_with(new, lattice, step),
            (Fields::Frames(old), Fields::Frames(new)) => old.is_consistent_with(new, lattice, step),
            _ => false,
        };
        fields && self.summary.is_consistent_with(&new.summary, step)
    }

    fn scheduled(&mut self, snapshots: &Snapshots) -> Vec<Scheduled<'_>> {
        let schedule = match snapshots {
            Snapshots::Instants => Schedule::Every(1),
            Snapshots::At(steps) => Schedule::At(steps.clone()),
            Snapshots::Every(steps) => Schedule::Every(*steps),
        };
        let mut scheduled = self.summary.scheduled();
        scheduled.push(match &mut self.fields {
            Fields::Instants(instants) => Scheduled::new(schedule, &mut **instants),
            Fields::Frames(frames) => Scheduled::new(schedule, frames),
        });
        scheduled
    }
}

impl Running {
    /// Begins a run on at most `threads` threads.
    pub fn start(case: &Arc<Case>, threads: usize) -> Self {
        Self::begin(case, threads, case.time_plan.stop, case.time_plan.last_step)
    }

    /// Begins a run that goes on as long as it is advanced, whatever its case says. Its [state](Self::state) cannot be
    /// resumed.
    pub fn start_without_end(case: &Arc<Case>, threads: usize) -> Self {
        Self::begin(case, threads, Stop::at_step(u64::MAX), u64::MAX)
    }

    fn begin(case: &Arc<Case>, threads: usize, stop: Stop, last_step: u64) -> Self {
        let (model, dt_star) = (Arc::clone(&case.model), case.time_plan.dt_star);
        Self {
            case: Arc::clone(case),
            stop,
            simulation: Simulation::with_execution(model, dt_star, None, execution(case, threads)),
            observers: Observers::new(case, last_step),
        }
    }

    /// Goes on with a run where its state was written down; none if the state is not one of this case.
    pub fn resume(case: &Arc<Case>, threads: usize, state: RunState) -> Option<Self> {
        let (step, observers) = (state.simulation.step, state.observers);
        if step > case.time_plan.last_step || !observers.belong_to(case, step) {
            return None;
        }
        let (model, dt_star) = (Arc::clone(&case.model), case.time_plan.dt_star);
        Some(Self {
            case: Arc::clone(case),
            stop: case.time_plan.stop,
            simulation: Simulation::resume(model, dt_star, state.simulation, execution(case, threads))?,
            observers,
        })
    }

    /// At most `steps` steps; why the run ended, if it did. An error says that it diverges.
    pub fn advance(&mut self, steps: u64) -> Result<Option<StopReason>, RunError> {
        let mut observers = self.observers.scheduled(&self.case.output.snapshots);
        self.simulation.advance(self.stop, steps, &mut observers)
    }

    /// The present instant.
    pub fn snapshot(&self) -> Snapshot<'_> {
        self.simulation.snapshot()
    }

    /// The present fields of the output of the case, in SI units; tau_c* is divided by its largest value so far.
    pub fn fields(&self) -> FieldFrame {
        let output = &self.case.output;
        let frame = selection(output).capture(&self.snapshot());
        let scale = self.simulation.contact_stress_max();
        FieldFrame::in_si_units(frame, String::new(), &output.fields, &self.case.scales, scale)
    }

    /// The case that is run.
    pub fn case(&self) -> &Arc<Case> {
        &self.case
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
        let (case, simulation) = (self.case, self.simulation);
        let Observers { summary, fields } = self.observers;
        let (instants, frames) = match fields {
            Fields::Instants(instants) => (instants.found(), Vec::new()),
            Fields::Frames(frames) => (Vec::new(), frames.frames),
        };
        Record {
            summary: summary.end(&case, &simulation, reason, &instants),
            rows: summary.curve.rows,
            frames: lettered(instants, frames),
            first_slip_time_star: simulation.snapshot().first_slip_time_star(),
            contact_stress_max: simulation.contact_stress_max(),
        }
    }
}

/// Runs a case on one thread as long as `ends` does not say otherwise; none if it was given up.
pub fn run_unless(case: &Arc<Case>, ends: &dyn Fn() -> bool) -> Option<Result<Record, RunError>> {
    let mut running = Running::start(case, 1);
    while !ends() {
        match running.advance(case.steps_per_poll()) {
            Ok(None) => {}
            Ok(Some(reason)) => return Some(Ok(running.record(reason))),
            Err(error) => return Some(Err(error)),
        }
    }
    None
}

/// Frames without letters, and instants with theirs. Instants that coincide, as on a uniform lattice, are one frame with
/// several letters: times of a file must rise.
fn lettered(mut instants: Vec<(char, Frame)>, frames: Vec<Frame>) -> Vec<(String, Frame)> {
    let frames = frames.into_iter().map(|frame| (String::new(), frame));
    let mut frames: Vec<(String, Frame)> = frames.collect();
    instants.sort_by_key(|(letter, frame)| (frame.step, *letter));
    for (letter, frame) in instants {
        match frames.last_mut() {
            Some((letters, last)) if last.step == frame.step => letters.push(letter),
            _ => frames.push((letter.to_string(), frame)),
        }
    }
    frames
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfront::observe::Field;

    #[test]
    fn a_run_without_an_end_goes_on_and_shows_its_fields_in_si_units() {
        let text = "slider.blocks = [4, 3]\ntime.duration_star = 20\ndrive.v_star = 0.2\n\
                    output.fields = ['contact_stress_star', 'displacement_x']\n";
        let case = Arc::new(Case::parse(text, "case", &[]).unwrap());
        let last_step = case.time_plan.last_step;
        let mut running = Running::start_without_end(&case, 1);
        assert_eq!(running.advance(last_step + 100).unwrap(), None);
        let fields = running.fields();
        assert_eq!(fields.step, last_step + 100);
        let place = |name| {
            case.output
                .fields
                .iter()
                .position(|field| *field == name)
                .unwrap()
        };
        let stress = &fields.values[place(Field::ContactStress)];
        assert!(stress.iter().all(|star| (0.0..=1.0).contains(star)), "{stress:?}");
        let displacement = &fields.values[place(Field::DisplacementX)];
        for (b, metres) in displacement.iter().enumerate() {
            let star = running.snapshot().block(b).displacement[0];
            let expected = f64::from(star as f32) * case.scales.displacement();
            assert_eq!(*metres, expected as f32);
        }
    }
}
