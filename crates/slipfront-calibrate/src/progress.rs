//! Progress of a calibration: the purpose of its runs, and how many have ended.

use std::sync::atomic::AtomicBool;

/// Purpose of runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationStage {
    /// Runs of the case over the ranges.
    Training,
    /// Runs on blocks of half the size.
    FinerBlocks,
    /// Runs of experiments that may be made next.
    Further,
    /// Runs of the calibrated model.
    Prediction,
    /// Search for the closest curve; its number of runs is not known before.
    Closest,
    /// Runs of the calibrated model at half the time step.
    HalfStep,
    /// Runs of a planned experiment.
    Planning,
}

/// Progress of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CalibrationProgress {
    /// Present stage.
    pub stage: CalibrationStage,
    /// Number of runs of this call that have ended.
    pub runs: usize,
    /// Number of all runs of this call, as far as it is known.
    pub of: usize,
}

/// Function that takes the number of runs that have ended since it was called before.
pub type RunsEnded<'a> = dyn FnMut(usize) + 'a;

/// Runs of a calibration in progress.
pub(crate) struct RunCounter<'a> {
    pub(crate) stop: &'a AtomicBool,
    watch: &'a mut dyn FnMut(&CalibrationProgress),
    ended: usize,
    of: usize,
}

impl<'a> RunCounter<'a> {
    /// A call of `of` runs.
    pub(crate) fn new(
        stop: &'a AtomicBool,
        of: usize,
        watch: &'a mut dyn FnMut(&CalibrationProgress),
    ) -> Self {
        Self {
            stop,
            watch,
            ended: 0,
            of,
        }
    }

    /// Shows that `runs` more runs have ended.
    pub(crate) fn show(&mut self, stage: CalibrationStage, runs: usize) {
        self.ended += runs;
        self.of = self.of.max(self.ended);
        (self.watch)(&CalibrationProgress {
            stage,
            runs: self.ended,
            of: self.of,
        });
    }
}
