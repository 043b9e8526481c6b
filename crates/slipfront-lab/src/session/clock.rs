//! When what is done: pictures, numbers, steps.

use std::time::{Duration, Instant};

/// Longest time of steps between two looks at the clock.
const PIECE: Duration = Duration::from_millis(3);

/// When things were done last.
pub(super) struct Clock {
    pub(super) picture: Instant,
    pub(super) numbers: Instant,
    pub(super) probe: Instant,
    pub(super) kymograph: Instant,
    /// Steps that are due, as a number with its fraction, and when this was found out.
    pub(super) due: f64,
    asked: Instant,
    counted_from: Instant,
    counted_steps: u64,
    steps_per_second: f64,
    seconds_per_step: f64,
}

impl Clock {
    pub(super) fn new() -> Self {
        let now = Instant::now();
        let long_ago = now.checked_sub(Duration::from_secs(60)).unwrap_or(now);
        Self {
            picture: now,
            numbers: long_ago,
            probe: long_ago,
            kymograph: long_ago,
            due: 0.0,
            asked: now,
            counted_from: now,
            counted_steps: 0,
            steps_per_second: 0.0,
            seconds_per_step: 1e-4,
        }
    }

    /// Seconds since this was asked last, a quarter of one at most: a page that was hidden is not made up for.
    pub(super) fn since_asked(&mut self) -> f64 {
        let since = self.asked.elapsed().as_secs_f64();
        self.asked = Instant::now();
        since.min(0.25)
    }

    /// Counts steps that took some time.
    pub(super) fn count(&mut self, steps: u64, took: Duration) {
        if steps == 0 {
            return;
        }
        let each = took.as_secs_f64() / steps as f64;
        self.seconds_per_step += 0.2 * (each - self.seconds_per_step);
        self.counted_steps += steps;
    }

    /// The steps of the last second.
    pub(super) fn rate(&mut self) -> f64 {
        let elapsed = self.counted_from.elapsed().as_secs_f64();
        if elapsed >= 1.0 {
            self.steps_per_second = self.counted_steps as f64 / elapsed;
            (self.counted_from, self.counted_steps) = (Instant::now(), 0);
        }
        self.steps_per_second
    }

    /// Steps that take a small piece of time.
    pub(super) fn piece(&self) -> u64 {
        ((PIECE.as_secs_f64() / self.seconds_per_step) as u64).max(1)
    }
}

/// Whether so much time has passed since; if so, it counts anew.
pub(super) fn is_due(last: &mut Instant, every: Duration) -> bool {
    let due = last.elapsed() >= every;
    if due {
        *last = Instant::now();
    }
    due
}
