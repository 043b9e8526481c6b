//! Runs many cases on a [`Device`], which records the totals of their steps, and replays these steps for the
//! observers of each run. Cases that the device does not compute run on the CPU meanwhile.

use std::ops::ControlFlow::{self, Break, Continue};
use std::sync::Arc;

use slipfront::device::{Device, DeviceError, DeviceLattice, EnergySteps, StepRecord};
use slipfront::observe::Scheduled;
use slipfront::parallel::*;
use slipfront::{RunError, Simulation, Stop, StopReason};
use slipfront_case::case::Case;

/// Steps that a device records before they are replayed.
pub(super) const STEPS_AT_ONCE: u64 = 1024;

/// Memory for the records and numbers of the runs that are computed at once.
const MEMORY: usize = 1 << 30;

/// Most bytes of a block on its way through a device: those with strength that falls and heals.
const BYTES_PER_BLOCK: usize = 180;

/// A run whose steps a device computes, with the observers of what is kept of it.
pub(super) trait DeviceRun: Send + Sized {
    /// Numbers that are kept of the run.
    type Kept: Send;

    /// Case of the run.
    fn case(&self) -> &Case;

    /// Reason for which the device does not make the run; none if it does.
    fn refusal(&self, device: &dyn Device) -> Option<String> {
        refusal(self.case(), device)
    }

    /// Rule that ends the run.
    fn stop(&self) -> Stop;

    /// Largest number of steps that the run can take.
    fn last_step(&self) -> u64;

    /// Observers of every step.
    fn observers(&mut self) -> Vec<Scheduled<'_>>;

    /// Numbers of the run at its end.
    fn end(self, simulation: Simulation, reason: StopReason) -> Self::Kept;

    /// Makes the run on the CPU; none if `ends` gave it up.
    fn on_cpu(self, ends: &dyn Fn() -> bool) -> Option<Result<Self::Kept, RunError>>;
}

/// Outcome of a run; none if it was given up.
pub(super) type Outcome<R> = Option<Result<<R as DeviceRun>::Kept, RunError>>;

/// Reason for which a device does not compute the steps of a case; none if it does.
pub(super) fn refusal(case: &Case, device: &dyn Device) -> Option<String> {
    let (blocks, most) = (case.model.lattice.n_blocks(), device.most_blocks());
    if blocks > most {
        return Some(format!(
            "lattices of more than {most} blocks are computed on the CPU alone"
        ));
    }
    let plain = DeviceLattice::check(&case.model);
    plain.err().map(|reason| reason.to_string())
}

/// Makes runs on a device, and on rayon's threads those that it refuses, and returns their outcomes in the
/// order of the runs. A run is given up when `ends` returns true.
///
/// # Errors
/// When the device fails.
pub(super) fn make_runs<R: DeviceRun>(
    runs: Vec<R>,
    device: &dyn Device,
    ends: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<Outcome<R>>, DeviceError> {
    let is_refused: Vec<bool> = runs.iter().map(|run| run.refusal(device).is_some()).collect();
    let (mut on_cpu, mut on_device) = (Vec::new(), Vec::new());
    for (run, is_refused) in runs.into_iter().zip(&is_refused) {
        if *is_refused { &mut on_cpu } else { &mut on_device }.push(run);
    }
    let (on_device, on_cpu) = join(
        || make_on_device(on_device, device, ends),
        || -> Vec<Outcome<R>> {
            on_cpu
                .into_par_iter()
                .with_max_len(1)
                .map(|run| run.on_cpu(ends))
                .collect()
        },
    );
    let (mut on_device, mut on_cpu) = (on_device?.into_iter(), on_cpu.into_iter());
    let outcomes = is_refused.into_iter().filter_map(|is_refused| match is_refused {
        true => on_cpu.next(),
        false => on_device.next(),
    });
    Ok(outcomes.collect())
}

/// Makes runs that a device does not refuse.
fn make_on_device<R: DeviceRun>(
    runs: Vec<R>,
    device: &dyn Device,
    ends: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<Outcome<R>>, DeviceError> {
    let blocks = runs.iter().map(|run| run.case().model.lattice.n_blocks());
    let bytes =
        STEPS_AT_ONCE as usize * size_of::<StepRecord>() + blocks.max().unwrap_or(1) * BYTES_PER_BLOCK;
    let at_once = (MEMORY / bytes).max(1);
    let mut outcomes = Vec::with_capacity(runs.len());
    let mut runs = runs.into_iter();
    while runs.len() > 0 {
        outcomes.extend(make_at_once(runs.by_ref().take(at_once).collect(), device, ends)?);
    }
    Ok(outcomes)
}

/// A run that goes on, or the outcome of one that has ended.
type Replayed<R> = ControlFlow<Box<Outcome<R>>, Box<(R, Simulation)>>;

fn make_at_once<R: DeviceRun>(
    runs: Vec<R>,
    device: &dyn Device,
    ends: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<Outcome<R>>, DeviceError> {
    let longest = runs.iter().map(|run| run.last_step() + 1).max().unwrap_or(1);
    // Parts of equal length, so that little is computed beyond the end.
    let steps = longest.div_ceil(longest.div_ceil(STEPS_AT_ONCE)) as u32;
    let begun = runs.into_par_iter().map(|run| {
        let lattice = lattice_of(&run);
        (run, lattice)
    });
    let (runs, mut lattices): (Vec<R>, Vec<DeviceLattice>) = begun.unzip();
    device.run(&mut lattices.iter_mut().collect::<Vec<_>>(), steps)?;
    let begun = runs.into_par_iter().zip(lattices);
    let mut runs: Vec<Replayed<R>> = begun
        .map(|(run, lattice)| Continue(Box::new((run, Simulation::replay(lattice)))))
        .collect();
    loop {
        runs = runs.into_par_iter().map(|run| replay(run, ends)).collect();
        let going = runs.iter_mut().filter_map(|run| match run {
            Continue(going) => going.1.device_lattice(),
            Break(_) => None,
        });
        let mut going: Vec<&mut DeviceLattice> = going.collect();
        if going.is_empty() {
            let outcomes = runs.into_iter().map(|run| *run.break_value()?);
            return Ok(outcomes.collect());
        }
        device.run(&mut going, steps)?;
    }
}

/// The lattice of a run at its start.
fn lattice_of(run: &impl DeviceRun) -> DeviceLattice {
    let case = run.case();
    let (model, dt_star) = (Arc::clone(&case.model), case.time_plan.dt_star);
    // The end is not known before where a run stops at its onset, or its drive waits.
    let is_unknown = run.stop().is_after_onset() || model.drive.is_held();
    let energies = EnergySteps {
        every: if is_unknown { 1 } else { u64::MAX },
        last: run.last_step(),
    };
    let lattice = DeviceLattice::new(model, dt_star, case.state().as_ref(), energies);
    lattice.unwrap_or_else(|reason| panic!("a device was given a case that it refuses: {reason}"))
}

/// Goes through the steps of a run that have been recorded.
fn replay<R: DeviceRun>(run: Replayed<R>, ends: &dyn Fn() -> bool) -> Replayed<R> {
    let (mut run, mut simulation) = *run?;
    if ends() {
        return Break(Box::new(None));
    }
    let recorded = simulation
        .device_lattice()
        .map_or(0, |lattice| lattice.records.len());
    let stop = run.stop();
    let reached = simulation.advance(stop, recorded as u64, &mut run.observers());
    Break(Box::new(match reached {
        // The device has recorded steps with a drive that waits for exact rest.
        _ if simulation.rests_by_force() => run.on_cpu(ends),
        Ok(None) => return Continue(Box::new((run, simulation))),
        Ok(Some(reason)) => Some(Ok(run.end(simulation, reason))),
        // The sentence names the block that went farthest at the step at which the run diverged, which the
        // device has left behind.
        Err(_) => run.on_cpu(ends),
    }))
}
