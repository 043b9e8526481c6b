//! Runs many cases on a [`Device`] and keeps only their summaries, as
//! [`run_summary`](crate::run_summary::run_summary) does for one case on the CPU.

use std::sync::Arc;

use slipfront::device::{Device, DeviceError};
use slipfront::observe::{Instants, Scheduled};
use slipfront::{RunError, Simulation, Stop, StopReason};
use slipfront_case::case::Case;

use super::runs::{DeviceRun, Outcome, make_runs, refusal};
use crate::run_summary::{run_summary_unless, summary};
use crate::running::instants_of;
use crate::summary::Summary;
use crate::summary_observers::SummaryObservers;

/// Runs cases up to the ends that their `time.stop` set, and returns the numbers of their `summary.json` in
/// the order of the cases, with the bits of [`run_summary`](crate::run_summary::run_summary); none of a run
/// that was given up because `ends` returned true. Cases that the device does not compute run on the CPU.
///
/// # Errors
/// When the device fails.
pub fn device_summaries(
    cases: &[Arc<Case>],
    device: &dyn Device,
    ends: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<Option<Result<Summary, RunError>>>, DeviceError> {
    make_runs(cases.iter().map(SummaryRun::new).collect(), device, ends)
}

/// Reason for which a device does not make the run of a case with its observers; none if it does.
pub fn refusal_of_run(case: &Case, device: &dyn Device) -> Option<String> {
    if case.file.output.events {
        return Some("the catalogue of events (`output.events`) is computed on the CPU alone".to_owned());
    }
    refusal(case, device)
}

/// A run on a device, with the observers of its numbers.
struct SummaryRun<'a> {
    case: &'a Arc<Case>,
    numbers: SummaryObservers,
    instants: Option<Instants>,
}

impl<'a> SummaryRun<'a> {
    fn new(case: &'a Arc<Case>) -> Self {
        Self {
            case,
            numbers: SummaryObservers::without_curve(case),
            instants: instants_of(case, Vec::new()),
        }
    }
}

impl DeviceRun for SummaryRun<'_> {
    type Kept = Summary;

    fn case(&self) -> &Case {
        self.case
    }

    /// Refuses also events, which need numbers of single blocks.
    fn refusal(&self, device: &dyn Device) -> Option<String> {
        refusal_of_run(self.case, device)
    }

    fn stop(&self) -> Stop {
        self.case.time_plan.stop
    }

    fn last_step(&self) -> u64 {
        self.case.time_plan.last_step
    }

    fn observers(&mut self) -> Vec<Scheduled<'_>> {
        let mut observers = self.numbers.scheduled();
        observers.extend(self.instants.as_mut().map(|instants| Scheduled::always(instants)));
        observers
    }

    fn end(self, simulation: Simulation, reason: StopReason) -> Summary {
        summary(self.case, simulation, reason, &self.numbers, self.instants)
    }

    fn on_cpu(self, ends: &dyn Fn() -> bool) -> Outcome<Self> {
        run_summary_unless(self.case, ends)
    }
}

#[cfg(test)]
mod tests {
    use slipfront::testing::FusedDevice;

    use super::*;
    use crate::device::runs::STEPS_AT_ONCE;
    use crate::run_summary::run_summary;

    fn case(text: &str) -> Arc<Case> {
        let text = format!("slider.blocks = [12, 8]\n{text}");
        Arc::new(Case::parse(&text, "case", "", &[]).unwrap())
    }

    /// Cases that end at different steps, more of them than are recorded at once, one that diverges, and some
    /// that the device does not compute.
    #[test]
    fn the_summaries_are_those_of_the_cpu() {
        let cases: Vec<_> = [
            "texture = [{ shape = 'cavity', coverage = 10 }]",
            "texture = [{ shape = 'cavity', coverage = 10 }]\ntime.stop = 'after_onset'",
            "time.stop = 'after_onset'\ndrive.direction = 40\nfriction.seed = 7",
            "drive.program = [{ v_star = 0.1, until_star = 40 }, { v_star = 0.2 }]\noutput.series = 7",
            "drive.loading = 'held'\ntime.stop = 'after_onset'",
            "slider.omega_star = 5\ndrive.loading = 'held'\ndrive.v_star = 0.1\ntime.duration_star = 60",
            "drive.v_star = 0.1\ntime.duration_star = 20",
            "drive.v_star = 0.1\ntime.duration_star = 20\noutput.events = true",
            "drive.v_star = 0.1\noutput.snapshots = [10, 20]\nslider.edges = 'periodic'",
            "time.stop = 'after_onset'\ndrive.v_star = 0.1\nfriction.slip_weakening = { length_star = 0.5 }",
            "drive = { v_star = 0.1, loading = 'held' }\ntime.duration_star = 60\nslider.omega_star = 5\n\
             friction.slip_weakening = { length_star = 0.1 }",
            "drive.v_star = 0.1\noutput.series = 7\n\
             friction = { healing_time_star = 1, slip_weakening = { length_star = 0.1 } }",
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
            (
                "friction = { law = 'rate_and_state', a = 0.02, b = 0.06, d_c_star = 0.05, v_0_star = 0.01, mu_0 = 0.6 }",
                "constant coefficients",
            ),
        ] {
            let case = case(text);
            let refused = SummaryRun::new(&case).refusal(&FusedDevice).unwrap();
            assert!(
                refused.contains(reason) && refused.ends_with("CPU alone"),
                "{refused}"
            );
        }
        let plain = case("texture = [{ shape = 'groove', coverage = 10 }]");
        assert_eq!(SummaryRun::new(&plain).refusal(&FusedDevice), None);
    }
}
