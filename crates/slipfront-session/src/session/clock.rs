//! Times at which pictures, numbers and steps are due. All times count from a fixed instant of the host.

use std::time::Duration;

/// Longest time that steps take between two calls.
const SLICE: Duration = Duration::from_millis(3);

/// When pictures and numbers were last sent, and how fast steps are taken.
#[derive(Default)]
pub(super) struct Clock {
    pub(super) picture: Duration,
    pub(super) numbers: Option<Duration>,
    pub(super) probe: Option<Duration>,
    pub(super) kymograph: Option<Duration>,
    pub(super) search: Option<Duration>,
    pub(super) calibration: Option<Duration>,
    /// Number of steps due, with a fraction, and when they were last counted.
    pub(super) due: f64,
    last_count: Duration,
    /// Number of steps that are being taken, and the time at which they began.
    slice: Option<(u64, Duration)>,
    counted_from: Duration,
    counted_steps: u64,
    steps_per_second: f64,
    /// Time that a step takes, s; none before the first step.
    seconds_per_step: Option<f64>,
}

impl Clock {
    /// Seconds since steps were last counted, 0.25 at most: the time while a page was hidden is not made up
    /// for.
    pub(super) fn seconds_since_last_count(&mut self, now: Duration) -> f64 {
        let since = now.saturating_sub(self.last_count).as_secs_f64();
        self.last_count = now;
        since.min(0.25)
    }

    /// Counts steps that the run has taken.
    pub(super) fn count_steps(&mut self, steps: u64) {
        self.counted_steps += steps;
    }

    /// Marks that `steps` steps are taken from `now` until the next call, and that nothing else is done in
    /// that time.
    pub(super) fn begin_slice(&mut self, steps: u64, now: Duration) {
        self.slice = Some((steps, now));
    }

    /// Marks that something else was done since the last call.
    pub(super) fn disturb_slice(&mut self) {
        self.slice = None;
    }

    /// Measures how long a step takes, from the steps that were taken since the last call.
    pub(super) fn end_slice(&mut self, now: Duration) {
        let Some((steps, began)) = self.slice.take().filter(|(steps, _)| *steps > 0) else {
            return;
        };
        let each = now.saturating_sub(began).as_secs_f64() / steps as f64;
        let known = self.seconds_per_step.unwrap_or(INITIAL_SECONDS_PER_STEP);
        self.seconds_per_step = Some(known + 0.2 * (each - known));
    }

    /// Steps per second, counted over the last second.
    pub(super) fn steps_per_second(&mut self, now: Duration) -> f64 {
        let elapsed = now.saturating_sub(self.counted_from).as_secs_f64();
        if elapsed >= 1.0 {
            self.steps_per_second = self.counted_steps as f64 / elapsed;
            (self.counted_from, self.counted_steps) = (now, 0);
        }
        self.steps_per_second
    }

    /// Number of steps that take [`SLICE`], at least one.
    pub(super) fn steps_per_slice(&self) -> u64 {
        let each = self.seconds_per_step.unwrap_or(INITIAL_SECONDS_PER_STEP);
        ((SLICE.as_secs_f64() / each) as u64).max(1)
    }
}

/// Assumed duration of a step before the first one, s.
const INITIAL_SECONDS_PER_STEP: f64 = 1e-4;

/// Whether the interval `every` has passed since `last`, or there is no `last` yet. If so, sets `last` to
/// `now`.
pub(super) fn is_due(last: &mut Option<Duration>, every: Duration, now: Duration) -> bool {
    let due = last.is_none_or(|last| now.saturating_sub(last) >= every);
    if due {
        *last = Some(now);
    }
    due
}
