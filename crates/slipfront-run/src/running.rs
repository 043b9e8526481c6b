//! Runs a [`Case`] with all observers that its files need, and makes its [`RunData`].

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use slipfront::device::{Device, DeviceError};
use slipfront::observe::frames::{Selection, kept};
use slipfront::observe::{CurveRow, Field, Frame, Frames, Instants, Kinetic, Kymograph, Schedule, Scheduled};
use slipfront::{
    Checkpoint, Execution, Increments, Kernel, Model, RunError, Search, SearchOutcome, Simulation, Snapshot,
    State, StopReason,
};

use crate::columns::Columns;
use crate::fields::FieldFrame;
use crate::manifest::Processors;
use crate::observers::{OptionalObservers, both};
use crate::summary::Summary;
use crate::summary_observers::SummaryObservers;
use slipfront_case::case::{Case, Output, Snapshots};

/// All results of a run, in memory.
#[derive(Clone, Debug)]
pub struct RunData {
    /// The model that was computed: the case's, with the increments of a held drive that were found.
    pub model: Arc<Model>,
    /// The numbers.
    pub summary: Summary,
    /// The recorded curve.
    pub rows: Vec<CurveRow>,
    /// The observers that only some runs have.
    pub observers: OptionalObservers,
    /// Share of sliding blocks against place along the drive and time.
    pub kymograph: Kymograph,
    /// Fields in the order of time, each with the letters of the instants A-F that it shows.
    pub frames: Vec<(String, Frame)>,
    /// Times t* of the first slip of every block.
    pub first_slip_time_star: Vec<f64>,
    /// Largest contact stress tau_c^max, in units of `P mu_s`.
    pub contact_stress_max: f64,
    /// The last state, in which another case can begin, in m and m/s, if the case asks for it.
    pub final_state: Option<State>,
}

/// Least number of blocks for which a thread is worth the cost of its synchronization.
fn blocks_per_thread(kernel: Kernel) -> usize {
    match kernel {
        Kernel::Fused => 1 << 13,
        Kernel::General => 1 << 10,
    }
}

/// Runs a case to its end, on at most `threads` threads, unless the run diverges.
pub fn run(case: &Arc<Case>, threads: usize) -> Result<RunData, RunError> {
    let mut running = Running::start(case, None, Execution::on_threads(threads));
    loop {
        if let Some(reason) = running.advance(u64::MAX)? {
            return Ok(running.record(reason));
        }
    }
}

/// A run in progress, with the observers that its files need.
pub struct Running {
    case: Arc<Case>,
    pub(crate) simulation: Simulation,
    pub(crate) observers: Observers,
    /// The search that precedes the slow loading of a bulk body.
    search: Option<Search>,
    /// Threads, each of which has enough blocks, ranks and device.
    execution: Execution,
}

/// Recordings of a run up to now.
#[derive(Debug, Serialize, Deserialize)]
pub struct Observers {
    pub(crate) summary: SummaryObservers,
    kymograph: Kymograph,
    /// The snapshots at the instants A-F.
    instants: Option<Box<Instants>>,
    /// The snapshots at given times.
    snapshots: Option<Frames>,
}

/// State from which a run can be resumed, without the numbers of its blocks; written as [`Running::state`].
#[derive(Debug, Serialize, Deserialize)]
pub struct RunState<O = Observers> {
    simulation: Checkpoint,
    observers: O,
    /// Increments of a held drive, if a search has found them.
    increments: Option<Increments>,
    /// Whether the search goes on.
    searches: bool,
}

impl RunState {
    /// Columns of the numbers per block that belong to the state.
    pub fn columns(&self, case: &Case) -> [Columns; 2] {
        self.observers.columns(case)
    }
}

/// Number of threads, of `most`, on which a run of this case is computed: as many as have enough blocks.
pub fn useful_threads(case: &Case, most: usize) -> usize {
    on_useful_threads(case, Execution::on_threads(most)).threads
}

/// Reduces the threads to those that have enough blocks.
fn on_useful_threads(case: &Case, execution: Execution) -> Execution {
    let per_thread = blocks_per_thread(execution.kernel.for_model(&case.model));
    Execution {
        threads: (case.model.surface.n_blocks() / per_thread).clamp(1, execution.threads),
        ..execution
    }
}

/// The instants A-F of a run of this case, with these fields at each; none for a run that keeps snapshots
/// only at given times.
pub(crate) fn instants_of(case: &Case, fields: Vec<Field>) -> Option<Instants> {
    let (plan, stride) = (&case.time_plan, case.output.stride);
    let has_instants = !matches!(case.output.snapshots, Snapshots::At(_));
    has_instants.then(|| Instants::new(Selection { fields, stride }, plan.kinetic, plan.end_star()))
}

/// The fields of the output of a case, as the observers select them.
fn selection(output: &Output) -> Selection {
    Selection {
        fields: output.fields.clone(),
        stride: output.stride,
    }
}

impl Observers {
    /// Observers of a run that begins.
    fn new(case: &Case) -> Self {
        let output = &case.output;
        let has_times = !matches!(output.snapshots, Snapshots::Instants);
        Self {
            summary: SummaryObservers::new(case),
            kymograph: Kymograph::default(),
            instants: instants_of(case, output.fields.clone()).map(Box::new),
            snapshots: has_times.then(|| Frames::new(selection(output))),
        }
    }

    /// Whether the observers can be those of a run of this case at a checkpoint.
    fn belong_to(&self, case: &Case, checkpoint: &Checkpoint) -> bool {
        let step = checkpoint.step;
        let new = Self::new(case);
        both(&self.instants, &new.instants, |old, new| {
            old.is_consistent_with(new, step)
        }) && both(&self.snapshots, &new.snapshots, |old, new| {
            old.is_consistent_with(new, step)
        }) && self.kymograph.is_consistent_with(&case.model, step)
            && self
                .summary
                .is_consistent_with(&new.summary, checkpoint, case.time_plan.dt_star)
    }

    /// Columns of the numbers per block that a checkpoint keeps: those of the simulation, and those of every
    /// field of every frame.
    fn columns(&self, case: &Case) -> [Columns; 2] {
        let (lattice, stride) = (&case.model.lattice, case.output.stride);
        let columns = |count: usize, stride: usize, number_bytes: usize| Columns {
            count: count as u64,
            rows: kept(0..lattice.ny, stride).len() as u64,
            row_length: kept(0..lattice.nx, stride).len() as u64,
            number_bytes: number_bytes as u64,
        };
        let fields = self.frames().len() * case.output.fields.len();
        let of_event = usize::from(self.paths_before().is_some());
        [
            columns(case.model.n_columns() + of_event, 1, size_of::<f64>()),
            columns(fields, stride, size_of::<f32>()),
        ]
    }

    /// Displacements from which the slip of blocks is measured in the event in progress, if the run keeps a
    /// catalogue of events and there is one in progress.
    fn paths_before(&self) -> Option<&[f64]> {
        self.summary.optional.events.as_ref()?.paths_before()
    }

    fn scheduled(&mut self, snapshots: &Snapshots) -> Vec<Scheduled<'_>> {
        let mut scheduled = self.summary.scheduled();
        scheduled.push(self.kymograph.scheduled());
        if let Some(instants) = &mut self.instants {
            scheduled.push(Scheduled::always(&mut **instants));
        }
        if let Some(frames) = &mut self.snapshots {
            let schedule = match snapshots {
                Snapshots::Instants => None,
                Snapshots::At(steps) => Some(Schedule::At(steps.clone())),
                Snapshots::Every(steps) => Some(Schedule::Every(*steps)),
            };
            scheduled.extend(schedule.map(|schedule| Scheduled::new(schedule, frames)));
        }
        scheduled
    }

    /// The frames that are held at present, in a fixed order.
    fn frames(&self) -> Vec<&Frame> {
        let instants = self.instants.iter().flat_map(|instants| instants.frames());
        let frames = self.snapshots.iter().flat_map(|frames| &frames.frames);
        instants.chain(frames).collect()
    }

    /// The frames that are held at present, in a fixed order, to be filled again.
    fn frames_mut(&mut self) -> Vec<&mut Frame> {
        let instants = self
            .instants
            .iter_mut()
            .flat_map(|instants| instants.frames_mut());
        let frames = self.snapshots.iter_mut().flat_map(|frames| &mut frames.frames);
        instants.chain(frames).collect()
    }
}

/// Rows of fields that this process holds, counted among every `stride`-th row of the lattice.
fn own_rows_of_fields(case: &Case) -> Range<usize> {
    kept(case.model.rows.clone(), case.output.stride)
}

/// Number of values of a field that are written and read at once.
const PART: usize = 1 << 17;

impl Running {
    /// Starts a run from the given state, in which blocks may be displaced and slide, or from the state of
    /// the case. The run is computed as `execution` says, on no more threads than have enough blocks; ranks
    /// that share the lattice must all call this, and then the same functions.
    ///
    /// # Panics
    /// If a number of the state is not finite, or the state has another number of blocks.
    pub fn start(case: &Arc<Case>, state: Option<State>, execution: Execution) -> Self {
        let (model, dt_star) = (Arc::clone(&case.model), case.time_plan.dt_star);
        let execution = on_useful_threads(case, execution);
        let search = if state.is_none() {
            case.search(execution.clone())
        } else {
            None
        };
        let state = state.or_else(|| case.state());
        Self {
            case: Arc::clone(case),
            simulation: Simulation::new(model, dt_star, state, execution.clone()),
            observers: Observers::new(case),
            search,
            execution,
        }
    }

    /// The instant that the search for the increments of a held drive has reached; none once the run has
    /// begun.
    pub fn search(&self) -> Option<Snapshot<'_>> {
        self.search.as_ref().map(Search::snapshot)
    }

    /// Resumes a run from a saved state; none if the state does not belong to this case. `read` gets a byte
    /// offset in the columns of the state and a buffer for the bytes from there on.
    ///
    /// # Errors
    /// Errors of `read`.
    pub fn resume<E>(
        case: &Arc<Case>,
        state: RunState,
        execution: Execution,
        mut read: impl FnMut(u64, &mut [u8]) -> Result<(), E>,
    ) -> Result<Option<Self>, E> {
        if state.searches {
            return Ok(Some(Self::start(case, None, execution)));
        }
        let case = match state.increments {
            Some(increments) => &Arc::new(case.with_increments(increments)),
            None => case,
        };
        let (checkpoint, mut observers) = (state.simulation, state.observers);
        let is_possible = checkpoint.is_consistent_with(&case.model)
            && checkpoint.drive_steps <= case.time_plan.last_step
            && observers.belong_to(case, &checkpoint);
        if !is_possible {
            return Ok(None);
        }
        let [blocks, fields] = observers.columns(case);
        let mut bytes = Vec::new();
        let first_row = case.model.rows.start;
        let (model, dt_star) = (Arc::clone(&case.model), case.time_plan.dt_star);
        let execution = on_useful_threads(case, execution);
        let mut read_blocks = |column: usize, first: usize, values: &mut [f64]| {
            bytes.resize(size_of_val(values), 0);
            read(blocks.offset(column, first_row, first), &mut bytes)?;
            for (value, bytes) in values.iter_mut().zip(bytes.as_chunks().0) {
                *value = f64::from_le_bytes(*bytes);
            }
            Ok(())
        };
        let simulation =
            Simulation::resume(model, dt_star, &checkpoint, execution.clone(), &mut read_blocks)?;
        let Some(simulation) = simulation else {
            return Ok(None);
        };
        let events = observers.summary.optional.events.as_mut();
        if let Some(events) = events.filter(|events| events.goes_on()) {
            let mut paths = vec![0.0; case.model.surface.n_blocks()];
            for (part, values) in paths.chunks_mut(PART).enumerate() {
                read_blocks(case.model.n_columns(), part * PART, values)?;
            }
            events.resume(&case.model, paths);
        }
        let (rows, begin) = (
            own_rows_of_fields(case),
            blocks.offset(blocks.count as usize, 0, 0),
        );
        let mut column = 0;
        for frame in observers.frames_mut() {
            for _ in &case.output.fields {
                let mut field = vec![0.0; rows.len() * fields.row_length as usize];
                for (part, values) in field.chunks_mut(PART).enumerate() {
                    bytes.resize(size_of_val(values), 0);
                    read(begin + fields.offset(column, rows.start, part * PART), &mut bytes)?;
                    for (value, bytes) in values.iter_mut().zip(bytes.as_chunks().0) {
                        *value = f32::from_le_bytes(*bytes);
                    }
                }
                frame.values.push(field);
                column += 1;
            }
        }
        Ok(Some(Self {
            case: Arc::clone(case),
            simulation,
            observers,
            search: None,
            execution,
        }))
    }

    /// Makes at most `steps` steps; returns the reason for the end, if the run ended. An error means that the
    /// run diverges. All ranks must call this together.
    pub fn advance(&mut self, steps: u64) -> Result<Option<StopReason>, RunError> {
        if let Some(search) = self.search.take() {
            match search.advance(steps)? {
                SearchOutcome::Unfinished(search) => self.search = Some(search),
                SearchOutcome::Found(increments) => self.begin(increments),
            }
            return Ok(None);
        }
        let mut observers = self.observers.scheduled(&self.case.output.snapshots);
        self.simulation
            .advance(self.case.time_plan.stop, steps, &mut observers)
    }

    /// Begins the run with the increments that were found.
    fn begin(&mut self, increments: Increments) {
        let case = Arc::new(self.case.with_increments(increments));
        let (model, dt_star) = (Arc::clone(&case.model), case.time_plan.dt_star);
        self.simulation = Simulation::new(model, dt_star, case.state(), self.execution.clone());
        self.observers = Observers::new(&case);
        self.case = case;
    }

    /// The present instant.
    pub fn snapshot(&self) -> Snapshot<'_> {
        self.simulation.snapshot()
    }

    /// The present fields of the output of the case, in SI units; tau_c* is divided by its largest value so
    /// far. All ranks must call this together.
    pub fn fields(&self) -> FieldFrame {
        let output = &self.case.output;
        let frame = selection(output).capture(&self.snapshot());
        let scale = self.simulation.contact_stress_max();
        FieldFrame::in_si_units(frame, String::new(), &output.fields, &self.case.scales, scale)
    }

    /// The recorded curve up to now.
    pub fn rows(&self) -> &[CurveRow] {
        &self.observers.summary.curve.rows
    }

    /// Share of sliding blocks against place along the drive and time, up to now.
    pub fn kymograph(&self) -> &Kymograph {
        &self.observers.kymograph
    }

    /// The instants A-F that are known by now and t* of the drive at each, see [`Instants::by_now`]; none for
    /// a run that keeps snapshots only at given times.
    pub fn instants(&self) -> impl Iterator<Item = (char, f64)> {
        let instants = self.observers.instants.iter();
        instants.flat_map(|instants| instants.by_now())
    }

    /// Friction in the kinetic window up to now; none before it begins or if no block has slipped. All ranks
    /// must call this together.
    pub fn kinetic(&self) -> Option<Kinetic> {
        let now = self.snapshot();
        now.peak.first_slip_drive_time_star?;
        self.observers.summary.kinetic(&self.case, &now.peak)
    }

    /// Largest number of threads on which the run is computed.
    pub fn threads(&self) -> usize {
        self.execution.threads
    }

    /// Threads or device that compute the run.
    pub fn processors(&self) -> Processors {
        let device = self.simulation.device();
        Processors {
            threads: self.execution.threads,
            device: device
                .filter(|_| self.device_failure().is_none())
                .map(Device::name),
        }
    }

    /// The failure of the device that computed the first steps, if the CPU computes the others.
    pub fn device_failure(&self) -> Option<&DeviceError> {
        self.simulation.device_failure()
    }

    /// The largest contact stress so far, in units of `P mu_s`.
    pub fn contact_stress_max(&self) -> f64 {
        self.simulation.contact_stress_max()
    }

    /// Displacements now, velocities half a step later.
    pub fn motion(&self) -> State {
        self.simulation.state()
    }

    /// The case that is run.
    pub fn case(&self) -> &Arc<Case> {
        &self.case
    }

    /// State from which the run can be resumed, together with its [columns](Self::write_columns), in the form
    /// in which it is written. All ranks must call this together.
    pub fn state(&self) -> impl Serialize + '_ {
        RunState {
            simulation: self.simulation.checkpoint(),
            observers: &self.observers,
            increments: self.case.increments(),
            searches: self.search.is_some(),
        }
    }

    /// Columns of the numbers per block that belong to the state.
    pub fn columns(&self) -> [Columns; 2] {
        self.observers.columns(&self.case)
    }

    /// Passes the numbers of the rows that are held here to `write`, with a byte offset in the columns and
    /// the bytes from there on.
    ///
    /// # Errors
    /// Errors of `write`.
    pub fn write_columns<E>(&self, mut write: impl FnMut(u64, &[u8]) -> Result<(), E>) -> Result<(), E> {
        let [blocks, fields] = self.columns();
        let mut bytes = Vec::new();
        let first_row = self.case.model.rows.start;
        let mut write_blocks = |column: usize, first: usize, values: &[f64]| {
            bytes.resize(size_of_val(values), 0);
            for (value, bytes) in values.iter().zip(bytes.as_chunks_mut().0) {
                *bytes = value.to_le_bytes();
            }
            write(blocks.offset(column, first_row, first), &bytes)
        };
        self.simulation.write_columns(&mut write_blocks)?;
        let paths = self.observers.paths_before().unwrap_or_default();
        for (part, values) in paths.chunks(PART).enumerate() {
            write_blocks(self.case.model.n_columns(), part * PART, values)?;
        }
        let (row, begin) = (
            own_rows_of_fields(&self.case).start,
            blocks.offset(blocks.count as usize, 0, 0),
        );
        let frames = self.observers.frames().into_iter();
        for (column, field) in frames.flat_map(|frame| &frame.values).enumerate() {
            for (part, values) in field.chunks(PART).enumerate() {
                bytes.resize(size_of_val(values), 0);
                for (value, bytes) in values.iter().zip(bytes.as_chunks_mut().0) {
                    *bytes = value.to_le_bytes();
                }
                write(begin + fields.offset(column, row, part * PART), &bytes)?;
            }
        }
        Ok(())
    }

    /// The numbers of a run that has ended; the run itself stays. All ranks must call this together.
    pub fn summary(&self, reason: StopReason) -> Summary {
        let instants = self.observers.instants.as_deref().cloned();
        let instants = instants.map_or(Vec::new(), Instants::found);
        let mut numbers = self
            .observers
            .summary
            .end(&self.case, &self.simulation, reason, &instants);
        let first_slips = self.snapshot().first_slip_time_star();
        let communicator = &*self.execution.communicator;
        let observers = &self.observers.summary;
        observers.add_front(&mut numbers, &self.case, &first_slips, communicator);
        numbers
    }

    /// All results of the run, once it has ended. All ranks must call this together.
    pub fn record(self, reason: StopReason) -> RunData {
        let final_state = self.case.output.final_state.then(|| self.final_state());
        let (case, simulation) = (self.case, self.simulation);
        let Observers {
            summary,
            kymograph,
            instants,
            snapshots,
        } = self.observers;
        let instants = instants.map_or(Vec::new(), |instants| instants.found());
        let frames = snapshots.map_or(Vec::new(), |frames| frames.frames);
        let mut numbers = summary.end(&case, &simulation, reason, &instants);
        let contact_stress_max = simulation.contact_stress_max();
        let first_slip_time_star = simulation.into_first_slip_time_star();
        let communicator = &*self.execution.communicator;
        summary.add_front(&mut numbers, &case, &first_slip_time_star, communicator);
        RunData {
            model: Arc::clone(&case.model),
            summary: numbers,
            rows: summary.curve.rows,
            observers: summary.optional,
            kymograph,
            frames: lettered(instants, frames),
            contact_stress_max,
            first_slip_time_star,
            final_state,
        }
    }
}

/// Runs a case on one thread until `ends` returns true; none if it was given up.
pub fn run_unless(case: &Arc<Case>, ends: &dyn Fn() -> bool) -> Option<Result<RunData, RunError>> {
    let mut running = Running::start(case, None, Execution::default());
    while !ends() {
        match running.advance(case.steps_per_poll()) {
            Ok(None) => {}
            Ok(Some(reason)) => return Some(Ok(running.record(reason))),
            Err(error) => return Some(Err(error)),
        }
    }
    None
}

/// Frames without letters, and instants with theirs, in order of time. Frames of the same step, which
/// instants on a uniform lattice may share, become one frame with all letters, because times in a file must
/// increase.
fn lettered(instants: Vec<(char, Frame)>, frames: Vec<Frame>) -> Vec<(String, Frame)> {
    let frames = frames.into_iter().map(|frame| (String::new(), frame));
    let instants = instants
        .into_iter()
        .map(|(letter, frame)| (letter.to_string(), frame));
    let mut all: Vec<(String, Frame)> = frames.chain(instants).collect();
    all.sort_by(|(letter, frame), (other, next)| (frame.step, letter).cmp(&(next.step, other)));
    all.dedup_by(|(letters, frame), (kept_letters, kept)| {
        let is_same = frame.step == kept.step;
        if is_same {
            kept_letters.push_str(letters);
        }
        is_same
    });
    all
}

#[cfg(test)]
mod tests {
    use slipfront::testing::FusedDevice;

    use super::*;

    /// The values known during the run become its results.
    #[test]
    fn a_run_can_be_looked_at_on_its_way() {
        let text = "slider.blocks = [20, 20]\n[[texture]]\nshape = 'cavity'\ncoverage = 10\n";
        let case = Arc::new(Case::parse(text, "case", "", &[]).unwrap());
        let mut running = Running::start(&case, None, Execution::default());
        let letters = |running: &Running| running.instants().map(|(letter, _)| letter).collect::<String>();
        // With a texture, blocks in contact do not slip before t* = 30.
        running.advance((30.0 / case.time_plan.dt_star) as u64).unwrap();
        assert_eq!((letters(&running), running.kinetic()), ("A".to_owned(), None));
        assert!(!running.snapshot().peak.ended);
        while !running.snapshot().peak.ended {
            assert_eq!(running.advance(1).unwrap(), None);
        }
        let peak = running.snapshot().peak;
        assert!(running.instants().any(|found| found == ('C', peak.time_star)));
        assert_eq!((letters(&running), running.kinetic()), ("ABC".to_owned(), None));
        let reason = running.advance(u64::MAX).unwrap().unwrap();
        let instants: Vec<_> = running.instants().collect();
        let (kinetic, kymograph) = (running.kinetic().unwrap(), running.kymograph().clone());
        let record = running.record(reason);
        let summary = &record.summary;
        let found = summary.instants.iter();
        let found: Vec<_> = found.map(|found| (found.instant, found.time_star)).collect();
        assert_eq!((instants.len(), instants), (6, found));
        assert_eq!(summary.onset_time_star, peak.time_star);
        assert_eq!(summary.kinetic_friction_star, Some(kinetic.mu_star));
        assert_eq!(summary.kinetic_window_star, Some(kinetic.window_star));
        assert_eq!(record.kymograph, kymograph);
    }

    /// A sheet on a mount without texture moves as a whole: forces, paths and displacements in SI units are
    /// equal on blocks of half the size, with steps of the same duration.
    #[test]
    fn a_sheet_is_one_slider_on_any_blocks() {
        let run = |blocks: usize, size: f64, step: f64| {
            let text = format!(
                "slider = {{ blocks = [{blocks}, {blocks}], block_size = '{size} um', thickness = '500 um', damping_rate = '1e5 1/s' }}\n\
                 friction = {{ sigma_static_star = 0, sigma_kinetic_star = 0 }}\n\
                 drive = {{ speed = '1 mm/s', stiffness_per_area = '0.1 N/um/mm^2' }}\n\
                 time = {{ duration = '3 ms', step = {step} }}\noutput = {{ series = {}, snapshots = [] }}\n",
                200.0 * step
            );
            let case = Arc::new(Case::parse(&text, "sheet", "", &[]).unwrap());
            let record = super::run(&case, 1).unwrap();
            let area = (blocks as f64 * size).powi(2);
            let force = case.scales.force() / (size * size) * area;
            let rows = record.rows.iter().map(|row| {
                let seconds = row.time_star * case.scales.time();
                (
                    seconds,
                    row.point.mu_star * force,
                    record.summary.onset_time_star * case.scales.time(),
                )
            });
            rows.collect::<Vec<_>>()
        };
        let (coarse, fine) = (run(6, 40.0, 0.1), run(12, 20.0, 0.2));
        assert_eq!(coarse.len(), fine.len());
        assert!(coarse.len() > 100);
        // Rounding of sums and differences of numbers of order 1 over some thousand steps.
        let is_near = |one: f64, other: f64| (one - other).abs() <= 1e-9 * one.abs().max(other.abs());
        for (one, other) in coarse.iter().zip(&fine) {
            assert!(
                is_near(one.0, other.0) && is_near(one.1, other.1) && is_near(one.2, other.2),
                "{one:?} {other:?}"
            );
        }
    }

    #[test]
    fn a_run_on_a_device_has_the_same_results() {
        for text in [
            "slider.blocks = [20, 20]\n[[texture]]\nshape = 'cavity'\ncoverage = 10\n",
            "slider = { blocks = [14, 11], edges = ['periodic', 'free'] }\ndrive = { v_star = 0.1, direction = 30 }\n\
             output.snapshots = { every = 7.0 }\n",
            "slider = { blocks = [12, 12], outline = 'disc' }\ntime = { duration_star = 200, stop = 'after_onset' }\n",
            "slider.blocks = [12, 9]\ndrive.loading = 'held'\noutput.snapshots = { every = 20.0 }\ntime.duration_star = 150\n",
            // The block of this slider creeps to its place of rest, and its drive waits until its force is
            // negligible.
            "slider = { blocks = [1, 1], omega_star = 5 }\ndrive = { loading = 'held', v_star = 0.1 }\ntime = { duration_star = 60, step = 0.1 }\n",
            // This run diverges.
            "slider = { blocks = [20, 12], omega_star = 0 }\nload.pressure = '50 GPa'\ndrive.v_star = 10\n\
             friction = { r_star = 0, sigma_static_star = 1 }\ntime = { step = 0.9, duration_star = 2000 }\n",
            // Computed on the CPU alone.
            "slider.blocks = [9, 9]\nfriction.ageing = { law = 'logarithmic', beta = 0.07, time_star = 1 }\n",
        ] {
            let case = Arc::new(Case::parse(text, "case", "", &[]).unwrap());
            let results = |device: Option<Arc<dyn Device>>| {
                let execution = Execution {
                    device,
                    ..Execution::default()
                };
                let mut running = Running::start(&case, None, execution);
                let device = running.processors().device;
                loop {
                    match running.advance(61) {
                        Ok(None) => {}
                        Ok(Some(reason)) => return (device, format!("{:?}", running.record(reason))),
                        Err(error) => return (device, error.to_string()),
                    }
                }
            };
            let (none, on_cpu) = results(None);
            let (device, on_device) = results(Some(Arc::new(FusedDevice)));
            assert!(on_cpu == on_device, "{text}");
            let is_covered = !text.contains("ageing");
            assert_eq!((none, device.is_some()), (None, is_covered));
        }
    }

    #[test]
    fn a_run_shows_its_fields_in_si_units() {
        let text = "slider.blocks = [4, 3]\ntime.duration_star = 40\ndrive.v_star = 0.2\n\
                    output.fields = ['contact_stress_star', 'displacement_x']\n";
        let case = Arc::new(Case::parse(text, "case", "", &[]).unwrap());
        let steps = case.time_plan.last_step / 2 + 100;
        let mut running = Running::start(&case, None, Execution::default());
        assert_eq!(running.advance(steps).unwrap(), None);
        let fields = running.fields();
        assert_eq!(fields.step, steps);
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
