//! Times as they are printed for a reader.

use std::time::Duration;

use indicatif::HumanDuration;
use slipfront::Scales;
use slipfront_base::number_format::{four_digits, with_si_prefix};

/// An instant, dimensionless and in seconds.
pub(super) fn instant(time_star: f64, scales: &Scales) -> String {
    let seconds = with_si_prefix(time_star * scales.time(), "s");
    format!("t* = {} ({seconds})", four_digits(time_star))
}

/// Duration of a computation.
pub(super) fn duration(seconds: f64) -> String {
    if seconds < 1.0 {
        return "less than a second".to_owned();
    }
    let rounded = Duration::from_secs_f64(seconds.min(1e15));
    format!("about {}", HumanDuration(rounded))
}
