//! Progress of a run.

use std::time::Duration;

use slipfront::Snapshot;
use slipfront_run::running::Running;

use super::display::{ProgressDisplay, time_left};

/// Shows how far a run has come.
pub(crate) struct RunProgress {
    display: ProgressDisplay,
    steps: Steps,
}

/// The steps of a run.
struct Steps {
    /// Step at which this process began.
    first: u64,
    last: u64,
    n_blocks: usize,
}

impl RunProgress {
    /// For a run that begins, or is resumed, at its present step.
    pub(crate) fn new(running: &Running, quiet: bool) -> Self {
        let case = running.case();
        Self {
            display: ProgressDisplay::new("{wide_bar} {msg}", quiet),
            steps: Steps {
                first: running.snapshot().step,
                last: case.time_plan.last_step,
                n_blocks: case.model.lattice.n_blocks(),
            },
        }
    }

    pub(crate) fn show(&mut self, now: &Snapshot) {
        let (time_star, mu_star) = (now.time_star, now.point.mu_star);
        let steps = &self.steps;
        self.display.show(now.step, steps.last, |passed| {
            steps.text(now.step, time_star, mu_star, passed)
        });
    }

    /// Prints a line beside the progress, also where none is shown.
    pub(crate) fn note(&self, text: &str) {
        self.display.note(text);
    }

    pub(crate) fn finish(&self) {
        self.display.finish();
    }
}

impl Steps {
    /// The state of a run at a step. Its rate is that of the steps of this process, which has run for the time `passed`.
    fn text(&self, step: u64, time_star: f64, mu_star: f64, passed: Duration) -> String {
        let percent = 100.0 * step as f64 / self.last as f64;
        let state = format!("{percent:3.0} %  t* = {time_star:.1}  mu* = {mu_star:.3}");
        let here = step - self.first;
        if here == 0 {
            return state;
        }
        let rate = here as f64 * self.n_blocks as f64 / passed.as_secs_f64();
        let left = time_left(self.last - step, here, passed);
        format!("{state}  {rate:.1e} block-steps/s{left}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half of what is left took a minute: a minute is left, however much an earlier process had done.
    #[test]
    fn a_resumed_run_counts_its_own_steps() {
        let steps = Steps {
            first: 8000,
            last: 10_000,
            n_blocks: 60,
        };
        assert_eq!(
            steps.text(9000, 900.0, 0.5123, Duration::from_secs(60)),
            " 90 %  t* = 900.0  mu* = 0.512  1.0e3 block-steps/s  60 seconds left"
        );
        assert_eq!(
            steps.text(8000, 800.0, 0.5123, Duration::from_secs(60)),
            " 80 %  t* = 800.0  mu* = 0.512"
        );
    }

    #[test]
    fn the_longest_text_fits_a_terminal() {
        let steps = Steps {
            first: 0,
            last: 100_000_000_000,
            n_blocks: 4_000_000_000,
        };
        let text = steps.text(
            98_765_432_100,
            123_456_789.1,
            -0.345,
            Duration::from_secs(59 * 3600),
        );
        assert!(text.chars().count() <= 78, "{text}");
    }
}
