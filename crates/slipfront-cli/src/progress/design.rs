//! Progress of a design.

use std::time::Duration;

use slipfront_base::number_format::{count, four_digits};
use slipfront_design::{DesignStage, SearchProgress};

use super::display::{ProgressDisplay, duration_left};

/// Shows the progress of a design.
pub(crate) fn show_design(display: &mut ProgressDisplay, now: &SearchProgress) {
    let share = now.work.here / (now.work.here + now.work.left);
    display.show((1000.0 * share) as u64, 1000, |passed| text(now, passed));
}

/// Progress line: runs done of this stage, time left for search and verdict, the stage, and the best value so
/// far.
fn text(now: &SearchProgress, passed: Duration) -> String {
    let left = duration_left(now.work.left, now.work.here, passed);
    let left = left.map_or_else(String::new, |left| format!("  at most {left} left"));
    let stage = match now.stage {
        DesignStage::Exploring => "one surface",
        DesignStage::Refining => "several surfaces",
        DesignStage::Judging => "verdict",
    };
    let best = match now.best {
        best if best.is_finite() => format!("  best {}", four_digits(best)),
        _ => String::new(),
    };
    let rejected = match now.rejected {
        0 => String::new(),
        rejected => format!("  {} rejected", count(rejected, "draft")),
    };
    format!(
        "{} of {} runs{left}  {stage}{best}{rejected}",
        now.runs.min(now.total),
        now.total
    )
}

#[cfg(test)]
mod tests {
    use slipfront_design::RunCost;

    use super::*;

    /// The time left follows from the cost of the runs, not from their number.
    #[test]
    fn the_best_so_far_and_the_time_left_are_shown() {
        let now = |here: f64| SearchProgress {
            runs: 50,
            total: 100,
            textures: 20,
            rejected: 0,
            stage: DesignStage::Exploring,
            best: 31.25,
            best_texture: None,
            best_shares: None,
            work: RunCost { here, left: 1e9 },
        };
        assert_eq!(
            text(&now(1e8), Duration::from_secs(4)),
            "50 of 100 runs  at most 40 seconds left  one surface  best 31.25"
        );
        let rejected = SearchProgress {
            rejected: 7,
            ..now(0.0)
        };
        assert!(text(&rejected, Duration::ZERO).ends_with("best 31.25  7 drafts rejected"));
        // All runs were made by an earlier call.
        assert_eq!(
            text(&now(0.0), Duration::from_secs(4)),
            "50 of 100 runs  one surface  best 31.25"
        );
    }
}
