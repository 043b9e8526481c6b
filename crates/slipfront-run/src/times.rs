//! Times as they are printed for a reader.

use slipfront::Scales;
use slipfront_base::number_format::{four_digits, with_si_prefix};

/// An instant, dimensionless and in seconds.
pub fn instant(time_star: f64, scales: &Scales) -> String {
    let seconds = with_si_prefix(time_star * scales.time(), "s");
    format!("t* = {} ({seconds})", four_digits(time_star))
}
