//! Options for executing and showing a run.

use slipfront::Execution;
use slipfront_case::case::Case;
use slipfront_run::agree::RankFailure;

use super::checkpoint_timer::Interval;
use crate::device::DeviceArgs;
use crate::ranks::CommandRanks;
use crate::signals::Signals;

/// Options for executing and showing a run.
pub(super) struct RunOptions {
    pub(super) ranks: CommandRanks,
    pub(super) threads: usize,
    pub(super) device: DeviceArgs,
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

    /// How the ranks compute the steps of a case.
    pub(super) fn execution(&self, case: &Case) -> Result<Execution, RankFailure> {
        let device = self.device.open_for(case, self.ranks.size(), !self.is_verbose());
        Ok(Execution {
            communicator: self.ranks.communicator(),
            device: self.ranks.agree(device)?,
            ..Execution::on_threads(self.threads)
        })
    }
}
