//! Progress of a calibration.

use std::time::Duration;

use slipfront_calibrate::{CalibrationProgress, CalibrationStage};

use super::display::{ProgressDisplay, time_left};

/// Shows the progress of a calibration.
pub(crate) fn show_calibration(display: &mut ProgressDisplay, now: &CalibrationProgress) {
    display.show(now.runs as u64, now.total as u64, |passed| text(now, passed));
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
    let left = time_left((now.total - now.runs) as u64, now.runs as u64, passed);
    format!("{} of {} runs{left}  {stage}", now.runs, now.total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_says_what_runs_are_for() {
        let now = CalibrationProgress {
            stage: CalibrationStage::FinerBlocks,
            runs: 50,
            total: 100,
        };
        let text = text(&now, Duration::from_secs(10));
        assert!(
            text.starts_with("50 of 100 runs") && text.ends_with("half the size"),
            "{text}"
        );
    }
}
