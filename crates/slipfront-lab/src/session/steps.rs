//! The steps that are due until the next picture.

use std::time::{Duration, Instant};

use super::state::Session;
use crate::protocol::Reply;

impl Session {
    /// Steps until the next picture is due, and tells what is new.
    pub(super) fn work(&mut self) {
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
        if self.news.redraw || self.clock.picture.elapsed() >= period {
            self.clock.picture = Instant::now();
            self.tell();
        }
    }

    /// Takes the steps that are due until the next picture.
    fn take_steps(&mut self, next: Instant) -> Result<(), String> {
        let Some(live) = &mut self.live else { return Ok(()) };
        let dt_star = live.case().time_plan.dt_star;
        if self.view.paused {
            live.advance(std::mem::take(&mut self.single_steps))?;
            self.news.redraw = true;
            return Ok(());
        }
        self.clock.due = match self.view.pace {
            0.0 => f64::INFINITY,
            // What cannot be taken until the next picture is left out: the run is slower than asked for then.
            pace => (self.clock.due + pace / dt_star * self.clock.since_asked()).min(pace / dt_star),
        };
        loop {
            let before = live.step();
            let began = Instant::now();
            let steps = self.clock.piece().min(self.clock.due as u64);
            live.advance(steps)?;
            let taken = live.step() - before;
            self.clock.count(taken, began.elapsed());
            self.clock.due -= taken as f64;
            let twin = self.twin.as_mut().filter(|twin| twin.live.ended.is_none());
            let twin_left = match twin {
                Some(twin) if twin.live.time_star() < live.time_star() || live.ended.is_some() => {
                    twin.live.advance(self.clock.piece())?;
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
