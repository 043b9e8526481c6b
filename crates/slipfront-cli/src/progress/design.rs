//! Progress of a design.

use std::time::Duration;

use slipfront_case::number_format::four_digits;
use slipfront_study::design::{DesignStage, SearchProgress};

use super::display::{ProgressDisplay, time_left};

/// Shows how far a design has come.
pub(crate) struct DesignProgress(ProgressDisplay);

impl DesignProgress {
    pub(crate) fn new(quiet: bool) -> Self {
        Self(ProgressDisplay::new("{wide_bar} {msg}", quiet))
    }

    pub(crate) fn show(&mut self, now: &SearchProgress) {
        let (done, total) = (now.runs as u64, now.of as u64);
        self.0.show(done.min(total), total, |passed| text(now, passed));
    }

    pub(crate) fn finish(&self) {
        self.0.finish();
    }
}

/// Runs done, what is left, what is being done, and the best so far.
fn text(now: &SearchProgress, passed: Duration) -> String {
    let left = time_left(now.of.saturating_sub(now.runs) as u64, now.runs as u64, passed);
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
    fn the_best_so_far_is_shown() {
        let now = SearchProgress {
            runs: 50,
            of: 100,
            stage: DesignStage::Exploring,
            best: 31.25,
            best_texture: None,
        };
        let text = text(&now, Duration::from_secs(10));
        assert!(
            text.starts_with("50 of 100 runs") && text.ends_with("one surface  best 31.25"),
            "{text}"
        );
    }
}
