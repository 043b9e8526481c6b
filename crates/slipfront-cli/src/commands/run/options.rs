//! Options for executing and showing a run.

use crate::checkpoint_timer::Interval;
use crate::ranks::CommandRanks;
use crate::signals::Signals;

/// Options for executing and showing a run.
pub(super) struct RunOptions {
    pub(super) ranks: CommandRanks,
    pub(super) threads: usize,
    pub(super) interval: Interval,
    /// Whether to draw pictures, and the movie if the case requests one.
    pub(super) draws: bool,
    pub(super) signals: Signals,
    pub(super) quiet: bool,
    pub(super) json: bool,
}

impl RunOptions {
    /// Whether to print physics and summary for a human reader.
    pub(super) fn is_verbose(&self) -> bool {
        !self.quiet && !self.json
    }
}
