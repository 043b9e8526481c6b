//! Progress of a design.

use std::time::Duration;

use slipfront_case::number_format::four_digits;
use slipfront_study::design::{DesignStage, SearchProgress};

use super::display::{ProgressDisplay, time_left};

/// Display of the progress of a design.
pub(crate) struct DesignProgress {
    display: ProgressDisplay,
    /// Runs of earlier calls.
    before: usize,
}

impl DesignProgress {
    /// The display for a design of which `before` runs were made by earlier calls.
    pub(crate) fn new(quiet: bool, before: usize) -> Self {
        Self {
            display: ProgressDisplay::new("{wide_bar} {msg}", quiet),
            before,
        }
    }

    pub(crate) fn show(&mut self, now: &SearchProgress) {
        let (done, total) = (now.runs as u64, now.of as u64);
        let here = now.known.saturating_sub(self.before);
        self.display
            .show(done.min(total), total, |passed| text(now, here, passed));
    }

    pub(crate) fn finish(&self) {
        self.display.finish();
    }
}

/// Text of the progress: runs done, the time left from the runs made `here`, the stage, and the best value so far.
fn text(now: &SearchProgress, here: usize, passed: Duration) -> String {
    let left = time_left(now.of.saturating_sub(now.runs) as u64, here as u64, passed);
    let stage = match now.stage {
        DesignStage::Exploring => "one surface",
        DesignStage::Refining => "several surfaces",
        DesignStage::Judging => "verdict",
    };
    let best = if now.best.is_finite() {
        format!("  best {}", four_digits(now.best))
    } else {
        String::new()
    };
    format!("{} of {} runs{left}  {stage}{best}", now.runs.min(now.of), now.of)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_so_far_and_the_time_left_are_shown() {
        let now = SearchProgress {
            runs: 50,
            of: 100,
            known: 45,
            textures: 20,
            stage: DesignStage::Exploring,
            best: 31.25,
            best_texture: None,
        };
        // Five of the runs were made in these four seconds, the others by an earlier call.
        assert_eq!(
            text(&now, 5, Duration::from_secs(4)),
            "50 of 100 runs  40 seconds left  one surface  best 31.25"
        );
        assert_eq!(
            text(&now, 0, Duration::from_secs(4)),
            "50 of 100 runs  one surface  best 31.25"
        );
    }
}
