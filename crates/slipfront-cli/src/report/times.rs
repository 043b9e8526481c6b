//! Durations as they are printed for a reader.

use std::time::Duration;

use indicatif::HumanDuration;

/// Duration of a computation.
pub(super) fn duration(seconds: f64) -> String {
    if seconds < 1.0 {
        return "less than a second".to_owned();
    }
    let rounded = Duration::from_secs_f64(seconds.min(1e15));
    format!("about {}", HumanDuration(rounded))
}
