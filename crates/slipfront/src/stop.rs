//! The end of a run.

use serde::{Deserialize, Serialize};

use crate::snapshot::{MU_STAR_ROUNDING, Snapshot};

/// Condition for the end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop {
    last_step: u64,
    after_onset: bool,
}

/// Reason why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// The last step is done.
    End,
    /// The fall that ends the first peak of mu* has occurred, or a held drive has moved by the path up to
    /// which the largest mu* counts.
    #[serde(rename = "after_onset")]
    Onset,
}

impl Stop {
    /// Stops after `last_step` steps of the drive, which are all steps unless the drive is held.
    pub fn at_step(last_step: u64) -> Self {
        Self {
            last_step,
            after_onset: false,
        }
    }

    /// Stops as soon as the fall that ends the first peak has occurred, under a held drive as soon as the
    /// largest mu* is known, and after `last_step` steps at the latest.
    pub fn after_onset(last_step: u64) -> Self {
        Self {
            last_step,
            after_onset: true,
        }
    }

    /// Never stops: the run continues for as long as it is advanced.
    pub fn never() -> Self {
        Self::at_step(u64::MAX)
    }

    /// Whether the run stops as soon as static friction is known.
    pub fn is_after_onset(&self) -> bool {
        self.after_onset
    }

    /// Whether the next step may be the last. A fall of mu* is known one step ahead.
    pub(crate) fn may_end(&self, now: &Snapshot) -> bool {
        let next = now.next_clock();
        let onset_ends = || now.peak.ends_at(&next, now.mu_star_next() - MU_STAR_ROUNDING);
        next.drive_steps >= self.last_step || (self.after_onset && onset_ends())
    }

    /// Reason why the run ends now, if it does.
    pub(crate) fn reached(&self, now: &Snapshot) -> Option<StopReason> {
        if self.after_onset && now.peak.is_final() {
            Some(StopReason::Onset)
        } else if now.drive_steps >= self.last_step {
            Some(StopReason::End)
        } else {
            None
        }
    }
}
