//! When pictures, numbers and steps are due.

use std::time::{Duration, Instant};

/// Longest time of steps between two looks at the clock.
const SLICE: Duration = Duration::from_millis(3);

/// When pictures and numbers were sent last, and how fast steps are taken.
pub(super) struct Clock {
    pub(super) picture: Instant,
    pub(super) numbers: Instant,
    pub(super) probe: Instant,
    pub(super) kymograph: Instant,
    pub(super) search: Instant,
    /// Steps that are due, with a fraction, and when they were counted last.
    pub(super) due: f64,
    last_call: Instant,
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
            search: long_ago,
            due: 0.0,
            last_call: now,
            counted_from: now,
            counted_steps: 0,
            steps_per_second: 0.0,
            seconds_per_step: 1e-4,
        }
    }

    /// Seconds since the last call, 0.25 at most: a page that was hidden is not made up for.
    pub(super) fn seconds_since_last_call(&mut self) -> f64 {
        let since = self.last_call.elapsed().as_secs_f64();
        self.last_call = Instant::now();
        since.min(0.25)
    }

    /// Counts steps that took some time.
    pub(super) fn record_steps(&mut self, steps: u64, took: Duration) {
        if steps == 0 {
            return;
        }
        let each = took.as_secs_f64() / steps as f64;
        self.seconds_per_step += 0.2 * (each - self.seconds_per_step);
        self.counted_steps += steps;
    }

    /// Steps per second, counted over the last second.
    pub(super) fn steps_per_second(&mut self) -> f64 {
        let elapsed = self.counted_from.elapsed().as_secs_f64();
        if elapsed >= 1.0 {
            self.steps_per_second = self.counted_steps as f64 / elapsed;
            (self.counted_from, self.counted_steps) = (Instant::now(), 0);
        }
        self.steps_per_second
    }

    /// Steps that take [`SLICE`], at least one.
    pub(super) fn steps_per_slice(&self) -> u64 {
        ((SLICE.as_secs_f64() / self.seconds_per_step) as u64).max(1)
    }
}

/// Whether the interval `every` has passed since `last`, which then becomes the present.
pub(super) fn is_due(last: &mut Instant, every: Duration) -> bool {
    let due = last.elapsed() >= every;
    if due {
        *last = Instant::now();
    }
    due
}
