//! Times at which checkpoints of a run are saved: by the clock, on request, and when a signal stops the run.

use std::fmt;
use std::str::FromStr;
use std::time::{Duration, Instant};

use slipfront_run::agree::RankFailure;
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::running::Running;

use super::execution::RunOptions;
use crate::failure::Failure;
use crate::progress::run::RunProgress;

/// Wall time between checkpoints; none if no checkpoints are saved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval(Option<Duration>);

impl Interval {
    /// Whether checkpoints are saved at all.
    pub(crate) fn saves(self) -> bool {
        self.0.is_some()
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(time) => write!(f, "{time:?}"),
            None => f.write_str("off"),
        }
    }
}

impl FromStr for Interval {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "off" {
            return Ok(Self(None));
        }
        match text.parse::<jiff::SignedDuration>().map(Duration::try_from) {
            Ok(Ok(duration)) => Ok(Self(Some(duration))),
            _ => Err("write a time such as 5min, 30s or 1h, or `off` for no checkpoints".to_owned()),
        }
    }
}

/// Smallest ratio of the time until the next checkpoint to the time that the last one took: in the long run
/// checkpoints take at most 1 % of the time.
const RUN_PER_SAVE: u32 = 99;

/// Wall time to the next checkpoint after one that took `cost`.
fn pause(every: Duration, cost: Duration) -> Duration {
    every.max(cost.saturating_mul(RUN_PER_SAVE))
}

/// Saves the checkpoints of a run when they are due.
pub(super) struct CheckpointTimer<'a> {
    checkpoints: Checkpoints,
    options: &'a RunOptions,
    due: Option<Instant>,
}

impl<'a> CheckpointTimer<'a> {
    /// Makes the first checkpoint due one interval from now.
    pub(super) fn new(checkpoints: Checkpoints, options: &'a RunOptions) -> Self {
        let interval = options.interval.0;
        Self {
            checkpoints,
            options,
            due: interval.and_then(|every| Instant::now().checked_add(every)),
        }
    }

    /// Saves a checkpoint on all ranks if it is due or was requested on any of them.
    ///
    /// # Errors
    /// If a signal stops the run. A checkpoint that could not be saved does not end it.
    pub(super) fn save_if_due(
        &mut self,
        running: &Running,
        progress: &RunProgress,
    ) -> Result<(), RankFailure> {
        let is_due = self.due.is_some_and(|due| Instant::now() >= due);
        let mut reasons = [
            f64::from(self.options.signals.stopped().unwrap_or_default()),
            f64::from(self.options.signals.take_usr1()),
            f64::from(is_due),
        ];
        self.options.ranks.largest(&mut reasons);
        let (signal, asked, is_due) = (reasons[0] as i32, reasons[1] > 0.0, reasons[2] > 0.0);
        if signal > 0 {
            return Err(self.stop(signal, running).into());
        }
        if asked && !self.options.interval.saves() {
            progress.note("warning: no checkpoint is saved, because --checkpoint is off");
        } else if asked || is_due {
            let began = Instant::now();
            let step = running.snapshot().step;
            match self.save(running) {
                Ok(()) if asked => {
                    let seconds = began.elapsed().as_secs_f64();
                    progress.note(&format!("saved a checkpoint of step {step} in {seconds:.2} s"));
                }
                Ok(()) => {}
                Err(error) => {
                    let kept = self.checkpoints.saved_step().map_or_else(
                        || "there is no earlier one".to_owned(),
                        |step| format!("the checkpoint of step {step} is kept"),
                    );
                    progress.note(&format!(
                        "warning: cannot save a checkpoint of step {step} in {}: {error}; the run continues, and {kept}",
                        self.checkpoints.folder().display()
                    ));
                }
            }
            let pause = pause(self.options.interval.0.unwrap_or_default(), began.elapsed());
            self.due = Instant::now().checked_add(pause);
        }
        Ok(())
    }

    /// Saves a checkpoint; it counts as saved only if all ranks have saved it.
    fn save(&mut self, running: &Running) -> Result<(), RankFailure> {
        let ranks = &self.options.ranks;
        let saved = self.checkpoints.save(running, &*ranks.communicator());
        ranks.agree(saved.map_err(Failure::running))
    }

    /// Saves a last checkpoint, and returns the failure with which the run ends.
    fn stop(&mut self, signal: i32, running: &Running) -> Failure {
        let (step, last_step) = (running.snapshot().drive_steps, running.case().time_plan.last_step);
        let stopped = format!("stopped by a signal at step {step} of {last_step}");
        if !self.options.interval.saves() {
            let sentence = format!("{stopped}; nothing is saved, because --checkpoint is off");
            return Failure::Stopped(signal, sentence);
        }
        match self.save(running) {
            Ok(()) => {
                let command = self.resume_command();
                let sentence = format!("{stopped}; the state is saved, and `{command}` resumes the run");
                Failure::Stopped(signal, sentence)
            }
            // Not status 128 + signal: a job script would conclude that nothing was lost.
            Err(error) => {
                let (folder, remedy) = (self.checkpoints.folder().display(), self.remedy());
                Failure::running(format!(
                    "{stopped}; the state cannot be saved in {folder}: {error}; {remedy}"
                ))
            }
        }
    }

    /// The command that resumes the run.
    fn resume_command(&self) -> String {
        self.options.ranks.resume_command(self.checkpoints.folder())
    }

    /// The remedy when a checkpoint cannot be written.
    pub(super) fn remedy(&self) -> String {
        let from = match self.checkpoints.saved_step() {
            Some(step) => format!("step {step}"),
            None => "the start".to_owned(),
        };
        format!(
            "after a correction `{}` resumes from {from}",
            self.resume_command()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checkpoint_that_took_long_is_followed_by_a_long_pause() {
        let seconds = Duration::from_secs;
        assert_eq!(pause(seconds(300), seconds(1)), seconds(300));
        assert_eq!(pause(seconds(300), seconds(10)), seconds(990));
        assert_eq!(
            pause(Duration::ZERO, Duration::from_millis(10)),
            Duration::from_millis(990)
        );
    }

    #[test]
    fn intervals_are_written_as_people_write_them() {
        let interval = |text: &str| text.parse::<Interval>().map(|interval| interval.0);
        let seconds = |seconds| Ok(Some(Duration::from_secs(seconds)));
        assert_eq!(interval("5min"), seconds(300));
        assert_eq!(interval("1h 30min"), seconds(5400));
        assert_eq!(interval("0s"), seconds(0));
        assert_eq!(interval("off"), Ok(None));
        for wrong in ["", "5", "-5min", "soon", "1 fortnight"] {
            assert!(interval(wrong).is_err(), "{wrong}");
        }
    }
}
