//! Duration and time step of a case.

use slipfront::communicator::Communicator;
use slipfront::lattice::K_DRIVE;
use slipfront::observe::KineticStart;
use slipfront::{Increments, Loading, Model, ONSET_PATH, Scales, Stop, StopReason};

use super::dimensionless_groups::{Groups, MAX_V_STAR};
use crate::case_file::{
    self, Attached, AttachedEdge, AutoOr, CaseError, CaseFile, DriveSpeed, RunTime, Snapshots, TimeStep,
};
use slipfront_base::number_format::{four_digits, with_si_prefix};

/// Duration and time step of a run, its end, and the averaging window of kinetic friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimePlan {
    /// The time step dt*.
    pub dt_star: f64,
    /// Stability limit of the time step.
    pub step_limit: f64,
    /// Number of steps in which the drive moves: all, unless the drive is held.
    pub last_step: u64,
    /// The condition that ends the run.
    pub stop: Stop,
    /// Start of the averaging window of kinetic friction, in the time of the drive.
    pub kinetic: KineticStart,
    /// Whether the drive is held, and if so, the last of its steps in which the largest mu* counts as static
    /// friction.
    pub loading: Loading,
}

/// Ratio of the largest load of a block to that of every block if all touched under a uniform pressure. The
/// onset is later by up to this factor. None unless every block has a drive spring that can bear its load.
pub(super) fn largest_load(file: &CaseFile, model: &Model) -> Option<f64> {
    match file.drive.attached {
        Attached::At(AttachedEdge::All) => Some(model.surface.largest_load()),
        Attached::At(_) | Attached::File(_) => None,
    }
}

/// Step of "auto", if it is stable.
const AUTO_STEP: f64 = 0.1;

/// Largest number of steps of a run: the kernel stores step numbers in 32 bits.
const MAX_STEPS: f64 = 4e9;

impl TimePlan {
    /// The time plan of a case, which also sets the speed of a drive that is held for a bulk body; an error
    /// when the step is unstable, the run too long, or its kinetic window or a snapshot after its end. All
    /// ranks must call this together.
    pub(super) fn new(
        file: &CaseFile,
        scales: &Scales,
        groups: &Groups,
        model: &mut Model,
        ranks: &dyn Communicator,
    ) -> Result<Self, CaseError> {
        let time = &file.time;
        let limit = model.stable_step_limit(ranks);
        let auto = match model.body() {
            // Sliding blocks are as exact at any stable step.
            Some(_) => 0.9 * limit,
            None if AUTO_STEP < limit => AUTO_STEP,
            None => 0.5 * limit,
        };
        let dt_star = match time.step {
            TimeStep::Auto => auto,
            TimeStep::Paper => 2.0 / 3.0 * groups.v_star,
            TimeStep::Number(dt_star) => dt_star,
        };
        if model.rests_by_excess() {
            model.drive.v_star = slipfront::speed_of_increments(model, dt_star);
        }
        let model = &*model;
        if dt_star >= limit {
            let sentence = format!(
                "the step dt* = {} is not stable: it must be less than {}; \"auto\" is {}",
                four_digits(dt_star),
                four_digits(limit),
                four_digits(auto)
            );
            return Err(file.source.error("time.step", sentence));
        }
        let (key, end_star) = match &time.duration {
            RunTime::Star(AutoOr::Auto) => ("time.duration_star", auto_duration(file, scales, model)),
            RunTime::Star(AutoOr::Number(duration)) => ("time.duration_star", *duration),
            RunTime::Duration(duration) => ("time.duration", duration.si() / scales.time()),
        };
        // A duration that is a whole number of steps must not gain a step by rounding.
        let steps = (end_star / dt_star - 1e-6).ceil().max(1.0);
        if steps > MAX_STEPS {
            let sentence = format!(
                "a run to t* = {end_star:.4e} in steps of {} takes {steps:.2e} steps, more than {MAX_STEPS:.0e}: {}",
                four_digits(dt_star),
                shorter(file, groups.v_star, steps / MAX_STEPS)
            );
            return Err(file.source.error(key, sentence));
        }
        let last_step = steps as u64;
        let (kinetic, loading) = match (file.drive.loading, time.kinetic_from_star) {
            (case_file::Loading::Constant, AutoOr::Auto) => (KineticStart::Auto, Loading::Constant),
            (case_file::Loading::Constant, AutoOr::Number(from)) => {
                (KineticStart::At(from), Loading::Constant)
            }
            (case_file::Loading::Held, from) => {
                let from = match from {
                    AutoOr::Auto => auto_onset_end(file, scales, model),
                    AutoOr::Number(from) => from,
                };
                held(from, dt_star, last_step)
            }
        };
        let stop = match time.stop {
            StopReason::End => Stop::at_step(last_step),
            StopReason::Onset => Stop::after_onset(last_step),
        };
        let plan = TimePlan {
            dt_star,
            step_limit: limit,
            last_step,
            stop,
            kinetic,
            loading,
        };
        plan.check_end(file)?;
        Ok(plan)
    }

    /// Refuses a kinetic window or snapshots after the end of the run.
    fn check_end(&self, file: &CaseFile) -> Result<(), CaseError> {
        let end_star = self.end_star();
        if let AutoOr::Number(from) = file.time.kinetic_from_star
            && from >= end_star
        {
            let sentence =
                format!("the kinetic window cannot begin at t* = {from}: the run ends at {end_star:.4}");
            return Err(file.source.error("time.kinetic_from_star", sentence));
        }
        let is_late = |time: &&f64| (**time / self.dt_star).round() > self.last_step as f64;
        if let Snapshots::At(times) = &file.output.snapshots
            && let Some(time) = times.iter().find(is_late)
        {
            let sentence = format!("no snapshot can be taken at t* = {time}: the run ends at {end_star:.4}");
            return Err(file.source.error("output.snapshots", sentence));
        }
        Ok(())
    }

    /// The plan with the increments that lead a bulk body to its onset.
    pub(super) fn with_increments(self, increments: &Increments) -> Self {
        let onset_steps = increments.onset_steps;
        // Increments after the onset are smaller than those of the plan.
        let last_step = onset_steps + self.last_step * slipfront::REFINEMENT as u64;
        Self {
            last_step,
            stop: if self.stop.is_after_onset() {
                Stop::after_onset(last_step)
            } else {
                Stop::at_step(last_step)
            },
            kinetic: KineticStart::At(onset_steps as f64 * self.dt_star),
            loading: Loading::Held { onset_steps },
            ..self
        }
    }

    /// t* of the last step.
    pub fn end_star(&self) -> f64 {
        self.last_step as f64 * self.dt_star
    }
}

/// Duration of "auto": 8/V*, which shows onset and sliding of the paper's slider, or longer. Where some
/// blocks bear up to f times the load, because others do not touch or the pressure differs from place to
/// place, the onset comes before their own drive springs bear their load at f/(k_s V*). The 2.5/V* before the
/// kinetic window must follow this time, which takes longer than 8/V* for an f above 2.06: under a uniform
/// pressure, where less than 48 % of the blocks touch. A drive that loads more slowly, adhesion, and a dead
/// load against the drive delay the onset. Under a program of speeds, the duration counts from the last of
/// them.
fn auto_duration(file: &CaseFile, scales: &Scales, model: &Model) -> f64 {
    let last = match &file.drive.speed {
        DriveSpeed::Program(segments) => segments
            .iter()
            .filter_map(|segment| segment.until_star)
            .next_back(),
        DriveSpeed::VStar(_) | DriveSpeed::Speed(_) => None,
    };
    let path = f64::max(
        8.0,
        largest_load(file, model).unwrap_or(1.0) / K_DRIVE + ONSET_PATH,
    );
    last.unwrap_or(0.0) + path / model.loading_speed() * delay(file, scales) + time_against_load(model)
}

/// Advice on a run with `times` as many steps as can be made. The drive is then too slow, or its springs are
/// too soft, by this factor.
fn shorter(file: &CaseFile, v_star: f64, times: f64) -> String {
    if file.time.duration != RunTime::Star(AutoOr::Auto) {
        return format!(
            "reduce its duration by a factor of {} or more",
            four_digits(times)
        );
    }
    // Rounded up to two digits, so that the speed that is named suffices.
    let enough = |speed: f64| {
        let unit = libm::pow(10.0, libm::floor(libm::log10(speed * times)) - 1.0);
        (speed * times / unit).ceil() * unit
    };
    let speed = match &file.drive.speed {
        _ if enough(v_star) > MAX_V_STAR => None,
        DriveSpeed::VStar(v_star) => Some(format!("`drive.v_star` = {}", four_digits(enough(*v_star)))),
        DriveSpeed::Speed(speed) => Some(format!(
            "`drive.speed` = \"{}\"",
            with_si_prefix(enough(speed.si()), "m/s")
        )),
        DriveSpeed::Program(_) => None,
    };
    let speed = speed.map_or(String::new(), |speed| {
        format!(
            ", or {speed} or more; with `drive.loading` = \"held\" such a speed still gives the static friction of slow loading"
        )
    });
    format!(
        "the drive loads the slider too slowly for a model that resolves waves; drive springs that are {} times stiffer would \
         do{speed}. `slipfront check` of such a case lists speeds with their errors and times",
        four_digits(times)
    )
}

/// Time by which a dead load against the drive delays the onset.
fn time_against_load(model: &Model) -> f64 {
    let [along, _] = model.mean_dead_load();
    (-along).max(0.0) / K_DRIVE / model.loading_speed()
}

/// Factor by which adhesion delays the onset.
fn delay(file: &CaseFile, scales: &Scales) -> f64 {
    1.0 + file.friction.adhesion.si() / scales.stress()
}

/// Time t* of a held drive up to which the largest mu* counts as static friction: twice the time of the onset
/// (Eq. 12), or the time at which the drive springs of all blocks bear their loads, if that is later.
pub(super) fn auto_onset_end(file: &CaseFile, scales: &Scales, model: &Model) -> f64 {
    let path = f64::max(
        2.0 * ONSET_PATH,
        largest_load(file, model).unwrap_or(1.0) / K_DRIVE,
    );
    path / model.loading_speed() * delay(file, scales) + time_against_load(model)
}

/// The averaging window of kinetic friction under a held drive, and its loading. The largest mu* before the
/// window, or of the whole run, counts as static friction. A run that ends earlier has no window.
fn held(from_star: f64, dt_star: f64, last_step: u64) -> (KineticStart, Loading) {
    let first = (from_star / dt_star).ceil().max(1.0) as u64;
    let kinetic = KineticStart::At(first.min(last_step + 1) as f64 * dt_star);
    let onset_steps = first.min(last_step);
    (kinetic, Loading::Held { onset_steps })
}
