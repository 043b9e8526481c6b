//! Runs many cases on a [`Device`] and keeps only their summaries, as
//! [`run_summary`](crate::run_summary::run_summary) does of one on the CPU.

use std::sync::Arc;

use slipfront::device::{Device, DeviceError, DeviceLattice, EnergySteps, StepRecord};
use slipfront::observe::{Instants, Scheduled};
use slipfront::parallel::*;
use slipfront::{RunError, Simulation, StopReason};
use slipfront_case::case::Case;

use crate::run_summary::{run_summary_unless, summary};
use crate::running::instants_of;
use crate::summary::Summary;
use crate::summary_observers::SummaryObservers;

/// Steps that a device records before they are replayed.
const STEPS_AT_ONCE: u64 = 1024;

/// Memory for the records and numbers of the runs that are computed at once.
const MEMORY: usize = 1 << 30;

/// Bytes that a block takes while a device computes its run.
const BYTES_PER_BLOCK: usize = 128;

/// Reason why a device does not compute a case; none if it does.
pub fn refusal(case: &Case, device: &dyn Device) -> Option<String> {
    if case.file.output.events {
        return Some("the catalogue of events (`output.events`) is computed on the CPU alone".to_owned());
    }
    let (blocks, most) = (case.model.lattice.n_blocks(), device.most_blocks());
    if blocks > most {
        return Some(format!(
            "lattices of more than {most} blocks are computed on the CPU alone"
        ));
    }
    let plain = DeviceLattice::check(&case.model);
    plain.err().map(|reason| reason.to_string())
}

/// Runs every case to the end that its `time.stop` sets, and returns the numbers of `summary.json` in the
/// order of the cases, bit for bit as [`run_summary`](crate::run_summary::run_summary) does. There is none
/// for a run that was given up because `ends` returned true.
///
/// # Errors
/// When the device fails.
///
/// # Panics
/// If a case is one that a device [refuses](refusal).
pub fn device_summaries(
    cases: &[Arc<Case>],
    device: &dyn Device,
    ends: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<Option<Result<Summary, RunError>>>, DeviceError> {
    let blocks = cases
        .iter()
        .map(|case| case.model.lattice.n_blocks())
        .max()
        .unwrap_or(1);
    let bytes = STEPS_AT_ONCE as usize * size_of::<StepRecord>() + blocks * BYTES_PER_BLOCK;
    let mut summaries = Vec::with_capacity(cases.len());
    for some in cases.chunks((MEMORY / bytes).max(1)) {
        summaries.extend(run_at_once(some, device, ends)?);
    }
    Ok(summaries)
}

/// A run on a device, with the observers of its numbers.
struct DeviceRun<'a> {
    case: &'a Arc<Case>,
    simulation: Simulation,
    numbers: SummaryObservers,
    instants: Option<Instants>,
}

/// A run that has not ended, or the result of one that has.
enum Replayed<'a> {
    Going(Box<DeviceRun<'a>>),
    Ended(Box<Option<Result<Summary, RunError>>>),
}

fn run_at_once(
    cases: &[Arc<Case>],
    device: &dyn Device,
    ends: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<Option<Result<Summary, RunError>>>, DeviceError> {
    let longest = cases
        .iter()
        .map(|case| case.time_plan.last_step + 1)
        .max()
        .unwrap_or(1);
    // Parts of equal length, so that little is computed beyond the end.
    let steps = longest.div_ceil(longest.div_ceil(STEPS_AT_ONCE)) as u32;
    let begun = cases.par_iter().map(|case| {
        let state = case.state();
        DeviceLattice::new(
            Arc::clone(&case.model),
            case.time_plan.dt_star,
            state.as_ref(),
            energies(case),
        )
    });
    let mut lattices: Vec<DeviceLattice> = begun
        .collect::<Result<_, _>>()
        .unwrap_or_else(|reason| panic!("a device was given a case that it refuses: {reason}"));
    device.run(&mut lattices.iter_mut().collect::<Vec<_>>(), steps)?;
    let mut runs: Vec<Replayed> = cases
        .par_iter()
        .zip(lattices)
        .map(|(case, lattice)| {
            Replayed::Going(Box::new(DeviceRun {
                case,
                simulation: Simulation::replay(lattice),
                numbers: SummaryObservers::without_curve(case),
                instants: instants_of(case, Vec::new()),
            }))
        })
        .collect();
    loop {
        runs = runs
            .into_par_iter()
            .map(|run| match run {
                Replayed::Going(run) => run.replay(ends),
                ended @ Replayed::Ended(_) => ended,
            })
            .collect();
        let mut going: Vec<&mut DeviceLattice> = runs.iter_mut().filter_map(Replayed::lattice).collect();
        if going.is_empty() {
            return Ok(runs.into_iter().map(Replayed::ended).collect());
        }
        device.run(&mut going, steps)?;
    }
}

/// Steps at which energies are recorded for a summary. It needs those of the last step, which is not known in
/// advance if a run stops at its onset.
fn energies(case: &Case) -> EnergySteps {
    let plan = &case.time_plan;
    EnergySteps {
        every: if plan.stop.is_after_onset() { 1 } else { u64::MAX },
        last: plan.last_step,
    }
}

impl<'a> DeviceRun<'a> {
    /// Goes through the steps that have been recorded.
    fn replay(mut self: Box<Self>, ends: &dyn Fn() -> bool) -> Replayed<'a> {
        if ends() {
            return Replayed::Ended(Box::new(None));
        }
        let recorded = self
            .simulation
            .device_lattice()
            .map_or(0, |lattice| lattice.records.len());
        let mut observers = self.numbers.scheduled();
        observers.extend(self.instants.as_mut().map(|instants| Scheduled::always(instants)));
        let stop = self.case.time_plan.stop;
        match self.simulation.advance(stop, recorded as u64, &mut observers) {
            Ok(None) => Replayed::Going(self),
            Ok(Some(reason)) => Replayed::Ended(Box::new(Some(Ok(self.summary(reason))))),
            // The message names the block that has moved farthest at the step of divergence. The device has
            // already passed this step, so the CPU repeats the run.
            Err(_) => Replayed::Ended(Box::new(run_summary_unless(self.case, ends))),
        }
    }

    fn summary(self, reason: StopReason) -> Summary {
        let Self {
            case,
            simulation,
            numbers,
            instants,
        } = self;
        summary(case, simulation, reason, &numbers, instants)
    }
}

impl Replayed<'_> {
    /// The lattice of a run that has not ended, for the device.
    fn lattice(&mut self) -> Option<&mut DeviceLattice> {
        match self {
            Self::Going(run) => run.simulation.device_lattice(),
            Self::Ended(_) => None,
        }
    }

    fn ended(self) -> Option<Result<Summary, RunError>> {
        match self {
            Self::Going(_) => None,
            Self::Ended(summary) => *summary,
        }
    }
}

#[cfg(test)]
mod tests {
    use slipfront::testing::FusedDevice;

    use super::*;
    use crate::run_summary::run_summary;

    fn case(text: &str) -> Arc<Case> {
        let text = format!("slider.blocks = [20, 12]\n{text}");
        Arc::new(Case::parse(&text, "case", "", &[]).unwrap())
    }

    /// Cases that end at different steps, after more steps than are recorded at once, and one that diverges.
    #[test]
    fn the_summaries_are_those_of_the_cpu() {
        let cases: Vec<_> = [
            "texture = [{ shape = 'cavity', coverage = 10 }]",
            "texture = [{ shape = 'cavity', coverage = 10 }]\ntime.stop = 'after_onset'",
            "time.stop = 'after_onset'\ndrive.direction = 40\nfriction.seed = 7",
            "drive.program = [{ v_star = 0.1, until_star = 40 }, { v_star = 0.2 }]\noutput.series = 7",
            "drive.v_star = 0.1\ntime.duration_star = 20",
            "drive.v_star = 0.1\noutput.snapshots = [10, 20]\nslider.edges = 'periodic'",
            "slider.omega_star = 0\nload.pressure = '50 GPa'\ndrive.v_star = 10\n\
             friction = { r_star = 0, sigma_static_star = 1 }\ntime = { step = 0.9, duration_star = 2000 }",
        ]
        .map(case)
        .into();
        let longest = cases.iter().map(|case| case.time_plan.last_step).max().unwrap();
        assert!(longest > STEPS_AT_ONCE);
        let found = device_summaries(&cases, &FusedDevice, &|| false).unwrap();
        for (case, found) in cases.iter().zip(found) {
            assert_eq!(
                format!("{:?}", found.unwrap()),
                format!("{:?}", run_summary(case))
            );
        }
    }

    #[test]
    fn runs_are_given_up_when_they_are_told_so() {
        let cases = ["", "time.stop = 'after_onset'"].map(case);
        let found = device_summaries(&cases, &FusedDevice, &|| true).unwrap();
        assert_eq!(found, [None, None]);
    }

    #[test]
    fn cases_of_the_cpu_are_refused_with_the_reason() {
        for (text, reason) in [
            ("output.events = true", "`output.events`"),
            ("drive.attach = 'left'", "drive springs"),
            ("drive.loading = 'held'", "a drive that is held"),
            (
                "friction = { law = 'rate_and_state', a = 0.02, b = 0.06, d_c_star = 0.05, v_0_star = 0.01, mu_0 = 0.6 }",
                "constant coefficients",
            ),
        ] {
            let refused = refusal(&case(text), &FusedDevice).unwrap();
            assert!(
                refused.contains(reason) && refused.ends_with("CPU alone"),
                "{refused}"
            );
        }
        assert_eq!(
            refusal(
                &case("texture = [{ shape = 'groove', coverage = 10 }]"),
                &FusedDevice
            ),
            None
        );
    }
}
