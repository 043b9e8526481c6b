//! The steps that are due until the next picture.

use std::time::{Duration, Instant};

use super::state::Session;
use crate::protocol::Reply;

impl Session {
    /// Takes the steps that are due until the next picture, and sends what is new when it is due.
    pub(super) fn run_until_next_picture(&mut self) {
        if !self.view.visible || self.live.is_none() || self.outbox.is_full() {
            return;
        }
        let period = Duration::from_secs_f64(1.0 / self.view.frames_per_second);
        let next = self.clock.picture + period;
        if let Err(sentence) = self.take_steps(next) {
            self.outbox.reply(&Reply::Failed { sentence });
            (self.live, self.twin) = (None, None);
            return;
        }
        if self.pending.redraw || self.clock.picture.elapsed() >= period {
            self.clock.picture = Instant::now();
            self.send_updates();
        }
    }

    /// Takes the steps that are due until the next picture.
    fn take_steps(&mut self, next: Instant) -> Result<(), String> {
        let Some(live) = &mut self.live else { return Ok(()) };
        let dt_star = live.case().time_plan.dt_star;
        if self.view.paused {
            live.advance(std::mem::take(&mut self.single_steps))?;
            self.pending.redraw = true;
            return Ok(());
        }
        self.clock.due = match self.view.pace {
            0.0 => f64::INFINITY,
            // What cannot be taken until the next picture is left out: the run is slower than asked for then.
            pace => {
                (self.clock.due + pace / dt_star * self.clock.seconds_since_last_call()).min(pace / dt_star)
            }
        };
        loop {
            let before = live.step();
            let began = Instant::now();
            let steps = self.clock.steps_per_slice().min(self.clock.due as u64);
            live.advance(steps)?;
            let taken = live.step() - before;
            self.clock.record_steps(taken, began.elapsed());
            self.clock.due -= taken as f64;
            let twin = self.twin.as_mut().filter(|twin| twin.live.ended.is_none());
            let twin_left = match twin {
                Some(twin) if twin.live.time_star() < live.time_star() || live.ended.is_some() => {
                    twin.live.advance(self.clock.steps_per_slice())?;
                    true
                }
                _ => false,
            };
            let is_left = live.ended.is_none() && self.clock.due >= 1.0;
            if !(is_left || twin_left) || Instant::now() >= next {
                break;
            }
        }
        if live.ended.is_some() {
            self.clock.due = 0.0;
        }
        Ok(())
    }
}
