//! Options for executing and showing a run.

use crate::checkpoint_timer::Interval;
use crate::ranks::CommandRanks;
use crate::signals::Signals;

/// Options for executing and showing a run.
pub(super) struct RunOptions {
    pub(super) ranks: CommandRanks,
    pub(super) threads: usize,
    pub(super) interval: Interval,
    /// Whether pictures are drawn, and the movie that the case asks for.
    pub(super) draws: bool,
    pub(super) signals: Signals,
    pub(super) quiet: bool,
    pub(super) json: bool,
}

impl RunOptions {
    /// Whether physics and summary are printed for a reader.
    pub(super) fn is_verbose(&self) -> bool {
        !self.quiet && !self.json
    }
}
