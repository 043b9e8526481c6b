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
    /// Number of steps at which this process began, and of those in which the drive moved.
    first: [u64; 2],
    /// Instant at which this process began.
    began: Instant,
    /// Number of steps in which the drive moves: all steps, unless the drive is held at times.
    last: u64,
    n_blocks: usize,
}

/// Measure of progress, t* or the path of a held drive, and friction.
fn state(now: &Snapshot) -> String {
    let drive = &now.model.drive;
    let (name, value) = if drive.is_held() {
        ("X*", drive.path(now.drive_time_star))
    } else {
        ("t*", now.time_star)
    };
    format!("{name} = {value:.1}  mu* = {:.3}", now.point.mu_star)
}

impl RunProgress {
    /// Makes the display for a run that begins or is resumed at its present step.
    pub(crate) fn new(running: &Running, quiet: bool) -> Self {
        Self {
            display: ProgressDisplay::new(quiet),
            steps: running.search().is_none().then(|| Steps::new(running)),
        }
    }

    pub(crate) fn show(&mut self, running: &Running) {
        if let Some(now) = running.search() {
            let text = |_| format!("loading until friction falls  {}", state(&now));
            self.display.show(0, 1, text);
            return;
        }
        let now = running.snapshot();
        let steps = self.steps.get_or_insert_with(|| Steps::new(running));
        let passed = steps.began.elapsed();
        self.display.show(now.drive_steps, steps.last, |_| {
            steps.text([now.step, now.drive_steps], &state(&now), passed)
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
    fn new(running: &Running) -> Self {
        let (now, case) = (running.snapshot(), running.case());
        Self {
            first: [now.step, now.drive_steps],
            began: Instant::now(),
            last: case.time_plan.last_step,
            n_blocks: case.model.lattice.n_blocks(),
        }
    }

    /// Progress line of a run in this state after some steps, in `drive_steps` of which the drive moved. The
    /// rate counts only the steps of this process, which has run for the time `passed`.
    fn text(&self, [step, drive_steps]: [u64; 2], state: &str, passed: Duration) -> String {
        let percent = 100.0 * drive_steps as f64 / self.last as f64;
        let [first_step, first_drive_step] = self.first;
        let here = drive_steps - first_drive_step;
        if here == 0 {
            return format!("{percent:3.0} %  {state}");
        }
        let rate = (step - first_step) as f64 * self.n_blocks as f64 / passed.as_secs_f64();
        let left = time_left(self.last - drive_steps, here, passed);
        format!("{percent:3.0} %  {state}  {rate:.1e} block-steps/s{left}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(first: u64, last: u64, n_blocks: usize) -> Steps {
        Steps {
            first: [first; 2],
            began: Instant::now(),
            last,
            n_blocks,
        }
    }

    /// A resumed run counts its own steps: half of the rest took a minute, so a minute is left, regardless of
    /// the steps of an earlier process.
    #[test]
    fn a_resumed_run_counts_its_own_steps() {
        let steps = steps(8000, 10_000, 60);
        let text = |step| steps.text([step; 2], "t* = 900.0  mu* = 0.512", Duration::from_secs(60));
        assert_eq!(
            text(9000),
            " 90 %  t* = 900.0  mu* = 0.512  1.0e3 block-steps/s  60 seconds left"
        );
        assert_eq!(text(8000), " 80 %  t* = 900.0  mu* = 0.512");
    }

    /// The time left of a held drive follows from the steps in which it moves: it was at rest in 2000 of 3000
    /// steps.
    #[test]
    fn a_held_drive_counts_the_steps_in_which_it_moves() {
        assert_eq!(
            steps(0, 2000, 60).text([3000, 1000], "X* = 3.0", Duration::from_secs(60)),
            " 50 %  X* = 3.0  3.0e3 block-steps/s  60 seconds left"
        );
    }

    #[test]
    fn the_longest_text_fits_a_terminal() {
        let text = steps(0, 100_000_000_000, 4_000_000_000).text(
            [98_765_432_100; 2],
            "t* = 123456789.1  mu* = -0.345",
            Duration::from_secs(59 * 3600),
        );
        assert!(text.chars().count() <= 78, "{text}");
    }
}
