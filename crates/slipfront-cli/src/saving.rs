//! When the checkpoints of a run are saved: by the clock, when asked for, and when the run is told to stop.

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::{Duration, Instant};

use slipfront_case::checkpoint::Checkpoints;
use slipfront_case::run::Running;

use crate::failure::Failure;
use crate::progress::Progress;
use crate::signals::Signals;

/// Wall time from one checkpoint to the next; none for no checkpoints at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval(Option<Duration>);

impl Interval {
    /// Whether checkpoints are saved at all.
    pub(crate) fn saves(self) -> bool {
        self.0.is_some()
    }
}

impl FromStr for Interval {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "off" {
            return Ok(Self(None));
        }
        let duration = text.parse::<jiff::SignedDuration>();
        duration
            .ok()
            .and_then(|duration| Duration::try_from(duration).ok())
            .map(|duration| Self(Some(duration)))
            .ok_or_else(|| "write a time such as 5min, 30s or 1h, or `off` for no checkpoints".to_owned())
    }
}

/// A checkpoint is followed by this many times the time that it took, so that all of them take at most 1 % of the run.
const RUN_PER_SAVE: u32 = 99;

/// Saves the checkpoints of a run.
pub(crate) struct Saving {
    folder: PathBuf,
    checkpoints: Checkpoints,
    interval: Interval,
    due: Option<Instant>,
    signals: Signals,
}

impl Saving {
    /// The first checkpoint is due an interval from now.
    pub(crate) fn new(folder: &Path, checkpoints: Checkpoints, interval: Interval, signals: Signals) -> Self {
        Self {
            folder: folder.to_owned(),
            checkpoints,
            interval,
            due: interval.0.and_then(|every| Instant::now().checked_add(every)),
            signals,
        }
    }

    /// Saves a checkpoint if it is time, or if one was asked for.
    ///
    /// # Errors
    /// [`Failure::Stopped`] if the run is to end here. A checkpoint that could not be saved does not end it.
    pub(crate) fn look(&mut self, running: &Running, progress: &Progress) -> Result<(), Failure> {
        if self.signals.stopped().is_some() {
            return Err(self.stop(running));
        }
        let asked = self.signals.take_usr1();
        if asked && !self.interval.saves() {
            progress.note("warning: no checkpoint is saved, since --checkpoint is off");
        } else if asked || self.due.is_some_and(|due| Instant::now() >= due) {
            let began = Instant::now();
            let step = running.snapshot().step;
            match self.checkpoints.save(running) {
                Ok(()) if asked => {
                    let seconds = began.elapsed().as_secs_f64();
                    progress.note(&format!("saved a checkpoint of step {step} in {seconds:.2} s"));
                }
                Ok(()) => {}
                Err(error) => progress.note(&format!(
                    "warning: cannot save a checkpoint of step {step} in {}: {error}; the run goes on, and the one before \
                     is kept",
                    self.folder.display()
                )),
            }
            let every = self
                .interval
                .0
                .unwrap_or_default()
                .max(began.elapsed() * RUN_PER_SAVE);
            self.due = Instant::now().checked_add(every);
        }
        Ok(())
    }

    /// Saves a last checkpoint.
    fn stop(&self, running: &Running) -> Failure {
        let (step, last_step) = (running.snapshot().step, running.case().schedule.last_step);
        let folder = self.folder.display();
        let sentence = if !self.interval.saves() {
            format!(
                "stopped by a signal at step {step} of {last_step}; nothing is saved, since --checkpoint is off"
            )
        } else {
            match self.checkpoints.save(running) {
                Ok(()) => format!(
                    "stopped by a signal at step {step} of {last_step}, which is saved: `slipfront run --resume {folder}` goes on"
                ),
                Err(error) => format!(
                    "stopped by a signal at step {step} of {last_step}, which cannot be saved in {folder}: {error}"
                ),
            }
        };
        Failure::stopped(&self.signals, anyhow::anyhow!(sentence))
    }
}
