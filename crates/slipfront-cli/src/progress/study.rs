//! Progress of a study.

use std::time::Duration;

use slipfront_base::number_format::count;
use slipfront_study::Progress;

use super::display::{ProgressDisplay, time_left};

/// Shows the progress of a study.
pub(crate) fn show_study(display: &mut ProgressDisplay, now: &Progress) {
    display.show(now.done as u64, now.total as u64, |passed| text(now, passed));
}

/// Progress line: runs done, their rate in this process, which has run for the time `passed`, time left,
/// failed runs, and the widest interval of a study that continues until intervals are narrow.
fn text(now: &Progress, passed: Duration) -> String {
    let failed = match now.failed {
        0 => String::new(),
        failed => format!("  {failed} failed"),
    };
    let worst = now
        .worst
        .map_or(String::new(), |worst| format!("  widest \u{b1} {worst:.1e}"));
    // Runs recorded earlier do not count for the rate.
    let rate = match now.here {
        0 => String::new(),
        here => format!("  {}", rate(here as f64 / passed.as_secs_f64())),
    };
    let left = time_left((now.total - now.done) as u64, now.here as u64, passed);
    format!(
        "{} of {}{rate}{left}{failed}{worst}",
        now.done,
        count(now.total, "run")
    )
}

/// A rate in the unit in which it is easy to read.
fn rate(per_second: f64) -> String {
    if per_second >= 1.0 {
        format!("{per_second:.1} runs/s")
    } else if 60.0 * per_second >= 1.0 {
        format!("{:.1} runs/min", 60.0 * per_second)
    } else {
        format!("{:.1} runs/h", 3600.0 * per_second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_have_units_and_count_the_runs_of_this_process() {
        let mut now = Progress {
            done: 7,
            total: 7,
            here: 0,
            failed: 0,
            worst: None,
        };
        // All runs were recorded earlier: there is no rate.
        assert_eq!(text(&now, Duration::from_secs(1)), "7 of 7 runs");
        now = Progress {
            done: 100,
            total: 110,
            here: 5,
            ..now
        };
        assert_eq!(
            text(&now, Duration::from_secs(30)),
            "100 of 110 runs  10.0 runs/min  60 seconds left"
        );
        assert_eq!(rate(12.0), "12.0 runs/s");
        assert_eq!(rate(1.0 / 600.0), "6.0 runs/h");
    }

    /// The longest line fits a terminal, for the largest number of runs without confirmation.
    #[test]
    fn the_longest_text_fits_a_terminal() {
        let now = Progress {
            done: 9999,
            total: 10_000,
            here: 9998,
            failed: 99,
            worst: Some(1e-3),
        };
        let text = text(&now, Duration::from_secs(599_880));
        assert!(text.chars().count() <= 80, "{text}");
    }
}
