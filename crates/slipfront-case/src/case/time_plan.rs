//! Duration and time step of a case.

use slipfront::lattice::dt_star_limit;
use slipfront::observe::KineticStart;
use slipfront::{Lattice, Scales, Stop, StopReason};

use super::drive::loading_share;
use super::groups::Groups;
use crate::case_file::{AutoOr, CaseError, CaseFile, DriveSpeed, RunTime, Step};

/// Duration and time step of a run, its end and the window of the kinetic friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimePlan {
    /// The time step dt*.
    pub dt_star: f64,
    /// Number of steps.
    pub last_step: u64,
    /// The condition that ends the run.
    pub stop: Stop,
    /// Start of the window that kinetic friction is averaged over.
    pub kinetic: KineticStart,
}

/// Longest run, in steps, of which the kernel keeps the numbers in 32 bits.
const MAX_STEPS: f64 = 4e9;

impl TimePlan {
    /// The time plan of a case file, refused when the step is unstable, the run too long, or the kinetic window empty.
    pub(super) fn of(
        file: &CaseFile,
        scales: &Scales,
        groups: &Groups,
        lattice: &Lattice,
    ) -> Result<Self, CaseError> {
        let time = &file.time;
        let dt_star = match time.step {
            Step::Auto => 0.1,
            Step::Paper => 2.0 / 3.0 * groups.v_star,
            Step::Number(dt_star) => dt_star,
        };
        if dt_star >= dt_star_limit() {
            let sentence = format!(
                "the step dt* = {dt_star:.4} is not stable: it must be less than {:.4}; \"auto\" takes 0.1",
                dt_star_limit()
            );
            return Err(file.source.error("time.step", sentence));
        }
        let (key, end_star) = match &time.duration {
            RunTime::Star(AutoOr::Auto) => (
                "time.duration_star",
                auto_duration(file, scales, groups, lattice)?,
            ),
            RunTime::Star(AutoOr::Number(duration)) => ("time.duration_star", *duration),
            RunTime::Duration(duration) => ("time.duration", duration.si() / scales.time()),
        };
        // A duration that is a whole number of steps up to rounding must not gain one.
        let steps = (end_star / dt_star - 1e-6).ceil().max(1.0);
        if steps > MAX_STEPS {
            let sentence = format!(
                "a run to t* = {end_star:.4e} in steps of {dt_star} takes {steps:.2e} steps, more than {MAX_STEPS:.0e}: \
                 shorten it or raise the step"
            );
            return Err(file.source.error(key, sentence));
        }
        let kinetic = match time.kinetic_from_star {
            AutoOr::Auto => KineticStart::Auto,
            AutoOr::Number(from) if from < end_star => KineticStart::At(from),
            AutoOr::Number(from) => {
                let sentence =
                    format!("the kinetic window cannot begin at t* = {from}: the run ends at {end_star:.4}");
                return Err(file.source.error("time.kinetic_from_star", sentence));
            }
        };
        let last_step = steps as u64;
        let stop = match time.stop {
            StopReason::End => Stop::at_step(last_step),
            StopReason::Onset => Stop::after_onset(last_step),
        };
        Ok(TimePlan {
            dt_star,
            last_step,
            stop,
            kinetic,
        })
    }

    /// The number of the step nearest to a time.
    pub(super) fn step_at(&self, time_star: f64) -> f64 {
        (time_star / self.dt_star).round()
    }

    /// t* of the last step.
    pub fn end_star(&self) -> f64 {
        self.last_step as f64 * self.dt_star
    }
}

/// 8/V* shows onset and sliding of the paper's slider. A drive that loads more slowly and adhesion delay the onset; under a program
/// of speeds it is counted from the last of them.
fn auto_duration(
    file: &CaseFile,
    scales: &Scales,
    groups: &Groups,
    lattice: &Lattice,
) -> Result<f64, CaseError> {
    let Some(share) = loading_share(file, scales, lattice) else {
        let sentence = "how fast these blocks load the slider is known only when the file has been read: set `time.duration_star`, \
                        or `drive.total_stiffness_star`";
        return Err(file.source.error("drive.attach_file", sentence));
    };
    let delay = 1.0 + file.friction.adhesion.si() / scales.stress();
    let from = match &file.drive.speed {
        DriveSpeed::Program(segments) => segments
            .iter()
            .filter_map(|segment| segment.until_star)
            .next_back(),
        _ => None,
    };
    Ok(from.unwrap_or(0.0) + 8.0 / (groups.v_star * share) * delay)
}
