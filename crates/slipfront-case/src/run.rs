//! [`Case`] -> [`Record`]: one run with all observers that its files need.

use slipfront::observe::frames::Selection;
use slipfront::observe::{
    Curve, CurveRow, FirstSlip, Frame, Frames, Instants, KineticHistory, Observer, Schedule, Scheduled,
};
use slipfront::{Execution, RunError, Simulation, Snapshot, StopReason};

use crate::case::{Case, Snapshots};
use crate::summary::{Observed, Summary};

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

/// Runs a case to its end, on at most `threads` threads. `watcher` is shown every `watch_every`-th step, for a display of
/// progress.
///
/// # Errors
/// [`RunError`] when the run diverges.
pub fn run(
    case: &Case,
    threads: usize,
    watch_every: u64,
    watcher: &mut dyn Observer,
) -> Result<Record, RunError> {
    let schedule = &case.schedule;
    let selection = Selection {
        fields: case.output.fields.iter().map(|field| field.observed()).collect(),
        stride: case.output.stride,
    };
    let mut curve = Curve::every(case.output.series_stride);
    let mut history = KineticHistory::new(schedule.last_step);
    let mut instants = Instants::new(selection.clone(), schedule.kinetic, schedule.end_star());
    let mut frames = Frames::new(selection);

    let mut observers = vec![
        Scheduled::always(&mut curve),
        Scheduled::always(&mut history),
        Scheduled::new(Schedule::Every(watch_every), watcher),
    ];
    match &case.output.snapshots {
        Snapshots::Instants => observers.push(Scheduled::always(&mut instants)),
        Snapshots::At(steps) => observers.push(Scheduled::new(Schedule::At(steps.clone()), &mut frames)),
        Snapshots::Every(steps) => observers.push(Scheduled::new(Schedule::Every(*steps), &mut frames)),
    }
    let execution = Execution {
        threads: (case.model.lattice.n_blocks() / BLOCKS_PER_THREAD).clamp(1, threads),
        ..Execution::default()
    };
    let mut simulation = Simulation::executed(&case.model, schedule.dt_star, None, execution);
    let reason = simulation.run(schedule.stop, &mut observers)?;
    drop(observers);

    let first_slip = FirstSlip::of(&simulation);
    let instants = match case.output.snapshots {
        Snapshots::Instants => instants.found(),
        Snapshots::At(_) | Snapshots::Every(_) => Vec::new(),
    };
    let peak = simulation.peak();
    let kinetic_from = schedule.kinetic.time_star(&peak, case.groups.v_star);
    // A run that stops at its onset has no kinetic phase, wherever the window was meant to begin, and neither has one in
    // which nothing slipped.
    let kinetic = match reason {
        StopReason::End if first_slip.earliest.is_none() => None,
        StopReason::End => history.kinetic(kinetic_from, schedule.dt_star),
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
    let summary = Summary::new(case, &found);
    Ok(Record {
        summary,
        rows: curve.rows,
        frames: if instants.is_empty() {
            unlettered(frames.frames)
        } else {
            merged(instants)
        },
        first_slip_time_star: first_slip.time_star,
        contact_stress_max: simulation.contact_stress_max(),
    })
}

/// Runs a case on one thread as long as `ends` does not say otherwise; none if it was given up.
///
/// # Errors
/// [`RunError`] when the run diverges.
pub fn run_unless(case: &Case, ends: &dyn Fn() -> bool) -> Option<Result<Record, RunError>> {
    let record = run(case, 1, case.steps_per_look(), &mut Watchdog(ends));
    if record.is_err() && ends() {
        None
    } else {
        Some(record)
    }
}

/// Ends a run when asked to.
struct Watchdog<'a>(&'a dyn Fn() -> bool);

impl Observer for Watchdog<'_> {
    fn observe(&mut self, _: &Snapshot) -> Result<(), RunError> {
        if (self.0)() {
            Err(RunError::Observer("given up".to_owned()))
        } else {
            Ok(())
        }
    }
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
