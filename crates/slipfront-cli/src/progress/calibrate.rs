//! Progress of a calibration.

use std::time::Duration;

use slipfront_calibrate::{CalibrationProgress, CalibrationStage};

use super::display::{ProgressDisplay, time_left};

/// Display of the progress of a calibration.
pub(crate) struct CalibrateProgress(ProgressDisplay);

impl CalibrateProgress {
    pub(crate) fn new(quiet: bool) -> Self {
        Self(ProgressDisplay::new("{wide_bar} {msg}", quiet))
    }

    pub(crate) fn show(&mut self, now: &CalibrationProgress) {
        self.0
            .show(now.runs as u64, now.of as u64, |passed| text(now, passed));
    }

    pub(crate) fn finish(&self) {
        self.0.finish();
    }
}

/// Progress line: runs done, time left, and purpose of the runs.
fn text(now: &CalibrationProgress, passed: Duration) -> String {
    let stage = match now.stage {
        CalibrationStage::Training => "training",
        CalibrationStage::FinerBlocks => "blocks of half the size",
        CalibrationStage::Further => "further experiments",
        CalibrationStage::Prediction => "calibrated model",
        CalibrationStage::Closest => {
            return format!("{} runs  search for the closest curve", now.runs);
        }
        CalibrationStage::OtherStep => "another time step",
        CalibrationStage::Planning => "planned experiments",
    };
    let left = time_left((now.of - now.runs) as u64, now.runs as u64, passed);
    format!("{} of {} runs{left}  {stage}", now.runs, now.of)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_says_what_runs_are_for() {
        let now = CalibrationProgress {
            stage: CalibrationStage::FinerBlocks,
            runs: 50,
            of: 100,
        };
        let text = text(&now, Duration::from_secs(10));
        assert!(
            text.starts_with("50 of 100 runs") && text.ends_with("half the size"),
            "{text}"
        );
    }
}
