//! Progress of a run.

use std::time::{Duration, Instant};

use slipfront::Snapshot;
use slipfront_run::running::Running;

use super::display::{ProgressDisplay, time_left};

/// Display of the progress of a run.
pub(crate) struct RunProgress {
    display: ProgressDisplay,
    /// None while the increments of a held drive are searched.
    steps: Option<Steps>,
}

/// The steps of a run.
struct Steps {
    /// Progress at which this process began.
    first: Place,
    /// Instant at which this process began.
    began: Instant,
    /// Number of steps in which the drive moves: all steps, unless the drive is held at times.
    last: u64,
    n_blocks: usize,
}

/// Progress of a run.
#[derive(Clone, Copy)]
struct Place {
    /// Steps done.
    step: u64,
    /// Steps in which the drive moved.
    drive_steps: u64,
    /// Name of the measure of progress: t*, or the path of a held drive.
    name: &'static str,
    value: f64,
}

impl Place {
    fn of(now: &Snapshot) -> Self {
        let drive = &now.model.drive;
        let (name, value) = if drive.is_held() {
            ("X*", drive.path(now.drive_time_star))
        } else {
            ("t*", now.time_star)
        };
        Self {
            step: now.step,
            drive_steps: now.drive_steps,
            name,
            value,
        }
    }

    fn text(&self, mu_star: f64) -> String {
        format!("{} = {:.1}  mu* = {mu_star:.3}", self.name, self.value)
    }
}

impl RunProgress {
    /// Makes the display for a run that begins or is resumed at its present step.
    pub(crate) fn new(running: &Running, quiet: bool) -> Self {
        Self {
            display: ProgressDisplay::new("{wide_bar} {msg}", quiet),
            steps: running.search().is_none().then(|| Steps::of(running)),
        }
    }

    pub(crate) fn show(&mut self, running: &Running) {
        if let Some(now) = running.search() {
            let (place, mu_star) = (Place::of(&now), now.point.mu_star);
            let text = |_| format!("loading until friction falls  {}", place.text(mu_star));
            self.display.show(0, 1, text);
            return;
        }
        let now = running.snapshot();
        let (place, mu_star) = (Place::of(&now), now.point.mu_star);
        let steps = self.steps.get_or_insert_with(|| Steps::of(running));
        let passed = steps.began.elapsed();
        self.display.show(now.drive_steps, steps.last, |_| {
            steps.text(place, mu_star, passed)
        });
    }

    /// Prints a line in addition to the progress, even if that is not shown.
    pub(crate) fn note(&self, text: &str) {
        self.display.note(text);
    }

    pub(crate) fn finish(&self) {
        self.display.finish();
    }
}

impl Steps {
    fn of(running: &Running) -> Self {
        let case = running.case();
        Self {
            first: Place::of(&running.snapshot()),
            began: Instant::now(),
            last: case.time_plan.last_step,
            n_blocks: case.model.lattice.n_blocks(),
        }
    }

    /// Progress line of a run. The rate counts only the steps of this process, which has run for the time
    /// `passed`.
    fn text(&self, now: Place, mu_star: f64, passed: Duration) -> String {
        let percent = 100.0 * now.drive_steps as f64 / self.last as f64;
        let state = format!("{percent:3.0} %  {}", now.text(mu_star));
        let here = now.drive_steps - self.first.drive_steps;
        if here == 0 {
            return state;
        }
        let rate = (now.step - self.first.step) as f64 * self.n_blocks as f64 / passed.as_secs_f64();
        let left = time_left(self.last - now.drive_steps, here, passed);
        format!("{state}  {rate:.1e} block-steps/s{left}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(step: u64, time_star: f64) -> Place {
        Place {
            step,
            drive_steps: step,
            name: "t*",
            value: time_star,
        }
    }

    /// A resumed run counts its own steps: half of the rest took a minute, so a minute is left, regardless of
    /// the steps of an earlier process.
    #[test]
    fn a_resumed_run_counts_its_own_steps() {
        let steps = Steps {
            first: at(8000, 800.0),
            began: Instant::now(),
            last: 10_000,
            n_blocks: 60,
        };
        assert_eq!(
            steps.text(at(9000, 900.0), 0.5123, Duration::from_secs(60)),
            " 90 %  t* = 900.0  mu* = 0.512  1.0e3 block-steps/s  60 seconds left"
        );
        assert_eq!(
            steps.text(at(8000, 800.0), 0.5123, Duration::from_secs(60)),
            " 80 %  t* = 800.0  mu* = 0.512"
        );
    }

    /// A held drive shows its path: the drive was at rest in 2000 of 3000 steps.
    #[test]
    fn a_held_drive_shows_its_path() {
        let steps = Steps {
            first: at(0, 0.0),
            began: Instant::now(),
            last: 2000,
            n_blocks: 60,
        };
        let now = Place {
            step: 3000,
            drive_steps: 1000,
            name: "X*",
            value: 3.04,
        };
        assert_eq!(
            steps.text(now, 0.5123, Duration::from_secs(60)),
            " 50 %  X* = 3.0  mu* = 0.512  3.0e3 block-steps/s  60 seconds left"
        );
    }

    #[test]
    fn the_longest_text_fits_a_terminal() {
        let steps = Steps {
            first: at(0, 0.0),
            began: Instant::now(),
            last: 100_000_000_000,
            n_blocks: 4_000_000_000,
        };
        let text = steps.text(
            at(98_765_432_100, 123_456_789.1),
            -0.345,
            Duration::from_secs(59 * 3600),
        );
        assert!(text.chars().count() <= 78, "{text}");
    }
}
