//! When pictures, numbers and steps are due. All times count from some instant of the host.

use std::time::Duration;

/// Longest time of steps between two looks at the clock.
const SLICE: Duration = Duration::from_millis(3);

/// When pictures and numbers were sent last, and how fast steps are taken.
#[derive(Default)]
pub(super) struct Clock {
    pub(super) picture: Duration,
    pub(super) numbers: Option<Duration>,
    pub(super) probe: Option<Duration>,
    pub(super) kymograph: Option<Duration>,
    pub(super) search: Option<Duration>,
    pub(super) calibration: Option<Duration>,
    /// Steps that are due, with a fraction, and when they were counted last.
    pub(super) due: f64,
    last_count: Duration,
    /// Steps that are being taken, and since when.
    slice: Option<(u64, Duration)>,
    counted_from: Duration,
    counted_steps: u64,
    steps_per_second: f64,
    /// Time that a step takes, s; none before the first one.
    seconds_per_step: Option<f64>,
}

impl Clock {
    /// Seconds since the last count of steps, 0.25 at most: a page that was hidden is not made up for.
    pub(super) fn seconds_since_last_count(&mut self, now: Duration) -> f64 {
        let since = now.saturating_sub(self.last_count).as_secs_f64();
        self.last_count = now;
        since.min(0.25)
    }

    /// Counts steps of the run that were taken.
    pub(super) fn count_steps(&mut self, steps: u64) {
        self.counted_steps += steps;
    }

    /// Notes that steps are taken from `now` up to the next look at the clock, and that nothing else is done
    /// until then.
    pub(super) fn begin_slice(&mut self, steps: u64, now: Duration) {
        self.slice = Some((steps, now));
    }

    /// Notes that something else was done since the last look at the clock.
    pub(super) fn disturb_slice(&mut self) {
        self.slice = None;
    }

    /// Looks at the clock: learns from the steps that were taken since the last look how long one takes.
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

    /// Steps that take [`SLICE`], at least one.
    pub(super) fn steps_per_slice(&self) -> u64 {
        let each = self.seconds_per_step.unwrap_or(INITIAL_SECONDS_PER_STEP);
        ((SLICE.as_secs_f64() / each) as u64).max(1)
    }
}

/// Time that a step is taken to need before the first one, s.
const INITIAL_SECONDS_PER_STEP: f64 = 1e-4;

/// Whether the interval `every` has passed since `last`, if there was one, which then becomes the present.
pub(super) fn is_due(last: &mut Option<Duration>, every: Duration, now: Duration) -> bool {
    let due = last.is_none_or(|last| now.saturating_sub(last) >= every);
    if due {
        *last = Some(now);
    }
    due
}
