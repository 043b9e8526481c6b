//! The clock of a session: what is due now, and when something is due next.

use std::time::Duration;

use super::state::Session;
use crate::protocol::CalibrationOutcome;

/// Time between two checks of the jobs outside the session.
const FOLLOW_INTERVAL: Duration = Duration::from_millis(100);

impl Session {
    /// Does what is due by `now`, for some milliseconds per call. Returns the time of the next call: `now` if
    /// more is to be done at once, and none if there is nothing to do before the next request of the page.
    ///
    /// All times count from the same instant. Messages that have arrived must be [handled](Self::handle)
    /// before.
    pub fn advance(&mut self, now: Duration) -> Option<Duration> {
        self.clock.end_slice(now);
        // Changes that arrive while steps are taken wait for the picture, so that the case is made only once
        // for all of them.
        let is_changed = !self.is_stepping && self.has_edits();
        if is_changed {
            self.apply_edits();
        }
        self.follow_repetition();
        self.follow_search(now);
        self.follow_calibration(now);
        self.follow_errands();
        // A host may call more often than anything moves.
        if !self.is_idle() {
            self.run_until_next_picture(now);
        }
        if is_changed {
            self.clock.disturb_slice();
        }
        let follows = self.search.is_some()
            || self.repeating.is_some()
            || self.calibration.is_some()
            || !self.errands.is_empty();
        let followed = follows.then_some(now + FOLLOW_INTERVAL);
        self.next_picture(now).into_iter().chain(followed).min()
    }

    /// Abandons all jobs outside the session, because their case is no longer the present one.
    pub(super) fn give_up_work(&mut self) {
        self.give_up_search();
        self.end_repetition();
        self.end_calibration(CalibrationOutcome::GivenUp, None, None);
        self.give_up_errands();
    }

    /// Time at which there is something to do for the next picture; none if nothing moves.
    fn next_picture(&self, now: Duration) -> Option<Duration> {
        if self.is_idle() {
            return None;
        }
        if self.host.is_full() {
            return Some(now + self.picture_period());
        }
        let is_due = self.is_stepping || self.pending.redraw || self.clock.due >= 1.0 || self.has_edits();
        if is_due {
            return Some(now);
        }
        Some(now.max(self.clock.picture + self.picture_period()))
    }

    /// Whether there is nothing to do before the next request of the page.
    fn is_idle(&self) -> bool {
        if self.has_edits() {
            return false;
        }
        if !self.view.visible || self.live.is_none() {
            return true;
        }
        let runs = 1 + usize::from(self.twin.is_some());
        let moves = self.count_ended() < runs && (!self.view.paused || self.single_steps > 0);
        !(moves || self.pending.redraw || self.pending.ends_sent != self.count_ended())
    }
}
