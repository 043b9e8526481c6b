//! Runs many cases on a [`Device`] and keeps only their curves, as [`run_curve`](crate::run_curve) does for
//! one case on the CPU.

use slipfront::device::{Device, DeviceError};
use slipfront::observe::Scheduled;
use slipfront::{RunError, Simulation, Stop, StopReason};
use slipfront_case::case::Case;

use super::runs::{DeviceRun, Outcome, make_runs};
use crate::run_curve::{CurveCase, RunCurve, Tracing, in_si_units, steps_to};

/// Runs cases on a device, and returns their curves in the order of the cases, with the bits of
/// [`CurveCase::curve_unless`]; none of a run that was given up because `ends` returned true. Cases that the
/// device does not compute run on the CPU.
///
/// # Errors
/// When the device fails.
pub fn device_curves(
    cases: &[&CurveCase],
    device: &dyn Device,
    ends: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<Option<Result<RunCurve, RunError>>>, DeviceError> {
    let runs = cases.iter().map(|&curve_case| {
        let steps = steps_to(&curve_case.case, curve_case.along, curve_case.end);
        CurveRun {
            curve_case,
            steps,
            tracing: Tracing::of_steps(steps),
        }
    });
    make_runs(runs.collect(), device, ends)
}

/// A run on a device, with the observer of its curve.
struct CurveRun<'a> {
    curve_case: &'a CurveCase,
    steps: u64,
    tracing: Tracing,
}

impl DeviceRun for CurveRun<'_> {
    type Kept = RunCurve;

    fn case(&self) -> &Case {
        &self.curve_case.case
    }

    fn stop(&self) -> Stop {
        Stop::at_step(self.steps)
    }

    fn last_step(&self) -> u64 {
        self.steps
    }

    fn observers(&mut self) -> Vec<Scheduled<'_>> {
        vec![Scheduled::always(&mut self.tracing)]
    }

    fn end(self, _: Simulation, _: StopReason) -> RunCurve {
        in_si_units(&self.curve_case.case, self.tracing)
    }

    fn on_cpu(self, ends: &dyn Fn() -> bool) -> Outcome<Self> {
        self.curve_case.curve_unless(ends)
    }
}

#[cfg(test)]
mod tests {
    use slipfront::testing::FusedDevice;

    use super::*;
    use crate::device::runs::STEPS_AT_ONCE;
    use crate::measured::Measure;

    /// Curves over time and over displacement, of different lengths, the sentence on a run that diverges, and
    /// a case that the device does not compute.
    #[test]
    fn the_curves_are_those_of_the_cpu() {
        let cases = [
            ("drive.v_star = 0.02", Measure::Time, 150.0),
            (
                "texture = [{ shape = 'cavity', coverage = 10 }]",
                Measure::Displacement,
                3.0,
            ),
            (
                "drive.program = [{ v_star = 0.1, until_star = 40 }, { v_star = 0.2 }]",
                Measure::Time,
                70.0,
            ),
            ("drive.attach = 'left'", Measure::Time, 30.0),
            (
                "friction.slip_weakening = { length_star = 0.5 }\ndrive.v_star = 0.1",
                Measure::Time,
                50.0,
            ),
            (
                "slider.omega_star = 0\nload.pressure = '50 GPa'\ndrive.v_star = 10\n\
                 friction = { r_star = 0, sigma_static_star = 1 }\ntime.step = 0.9",
                Measure::Time,
                2000.0,
            ),
        ];
        let cases = cases.map(|(text, along, end_star)| {
            let case = Case::parse(&format!("slider.blocks = [9, 8]\n{text}"), "case", "", &[]).unwrap();
            let unit = match along {
                Measure::Displacement => case.scales.displacement(),
                _ => case.scales.time(),
            };
            CurveCase {
                case,
                along,
                end: end_star * unit,
            }
        });
        let lengths = cases
            .each_ref()
            .map(|one| steps_to(&one.case, one.along, one.end));
        assert!(lengths[0] > STEPS_AT_ONCE && lengths[1] != lengths[2]);
        let found = device_curves(&cases.each_ref(), &FusedDevice, &|| false).unwrap();
        for (one, found) in cases.iter().zip(&found) {
            assert_eq!(*found, one.curve_unless(&|| false));
        }
        assert!(found[2].as_ref().unwrap().is_ok() && found[5].as_ref().unwrap().is_err());
        let given_up = device_curves(&cases.each_ref(), &FusedDevice, &|| true).unwrap();
        assert!(given_up.iter().all(Option::is_none));
    }
}
