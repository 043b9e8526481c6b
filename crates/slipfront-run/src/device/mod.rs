//! Runs of many cases on a device, of which only curves or summaries are kept.

mod curves;
mod runs;
mod summaries;

pub use self::curves::device_curves;
pub use self::summaries::{device_summaries, refusal_of_run};
