//! The steps that are due before the next picture.

use std::time::Duration;

use super::state::Session;
use crate::protocol::Reply;

impl Session {
    /// Time from one picture to the next.
    pub(super) fn picture_period(&self) -> Duration {
        Duration::from_secs_f64(1.0 / self.view.frames_per_second)
    }

    /// Takes some of the steps that are due before the next picture. Sends updates when none are left, or the
    /// picture is due.
    pub(super) fn run_until_next_picture(&mut self, now: Duration) {
        if !self.view.visible || self.live.is_none() || self.host.is_full() {
            self.is_stepping = false;
            return;
        }
        if let Err(sentence) = self.take_steps(now) {
            self.host.reply(Reply::Failed { sentence }.json());
            self.live = None;
            self.end_twin();
            self.is_stepping = false;
            return;
        }
        if !self.is_stepping
            && (self.pending.redraw || now.saturating_sub(self.clock.picture) >= self.picture_period())
        {
            self.clock.picture = now;
            self.send_updates(now);
        }
    }

    /// Takes some of the steps that are due before the next picture. Afterwards the session [is
    /// stepping](Self::is_stepping) if there may be more of them.
    fn take_steps(&mut self, now: Duration) -> Result<(), String> {
        let next = self.clock.picture + self.picture_period();
        let Some(live) = &mut self.live else { return Ok(()) };
        if self.view.paused {
            self.is_stepping = false;
            live.advance(std::mem::take(&mut self.single_steps))?;
            // This is reached only when there were steps to take, or there is something to draw.
            self.pending.redraw = true;
            return Ok(());
        }
        if !self.is_stepping {
            let steps_per_second = self.view.pace_when(live.has_slipped()) / live.case().time_plan.dt_star;
            self.clock.due = if steps_per_second > 0.0 {
                // Steps that cannot be taken before the next picture are dropped: the run is then slower than
                // requested.
                let since = self.clock.seconds_since_last_count(now);
                (self.clock.due + steps_per_second * since).min(steps_per_second)
            } else {
                f64::INFINITY
            };
            self.is_stepping = true;
        } else if now >= next {
            self.is_stepping = false;
            return Ok(());
        }
        let twin = self.twin.as_mut().map(|twin| &mut twin.live);
        let twin = twin.filter(|twin| {
            twin.ended.is_none() && (twin.time_star() < live.time_star() || live.ended.is_some())
        });
        if live.ended.is_some() {
            self.clock.due = 0.0;
        }
        let slice = self.clock.steps_per_slice();
        if let Some(twin) = twin {
            let before = twin.step();
            twin.advance(slice)?;
            self.clock.begin_slice(twin.step() - before, now);
        } else if self.clock.due >= 1.0 {
            let before = live.step();
            live.advance(slice.min(self.clock.due as u64))?;
            let taken = live.step() - before;
            self.clock.begin_slice(taken, now);
            self.clock.count_steps(taken);
            self.clock.due -= taken as f64;
            if self.view.pace > 0.0 && live.look_for_stages() > self.pending.stages_sent {
                // A page that keeps up with the run is notified at once, so that it can stop there.
                self.pending.redraw = true;
                self.is_stepping = false;
            }
        } else {
            self.is_stepping = false;
        }
        Ok(())
    }
}
