//! Progress of a run.

use slipfront::Snapshot;
use slipfront_run::running::Running;

use super::display::{ProgressDisplay, time_left};

/// Shows how far a run has come.
pub(crate) struct RunProgress {
    display: ProgressDisplay,
    /// Step at which this process began.
    first_step: u64,
    last_step: u64,
    n_blocks: u64,
    end_star: f64,
}

impl RunProgress {
    /// For a run that begins, or is resumed, at its present step.
    pub(crate) fn new(running: &Running, quiet: bool) -> Self {
        let case = running.case();
        let (first_step, last_step) = (running.snapshot().step, case.time_plan.last_step);
        let display = ProgressDisplay::new("{bar:32} {percent:>3} %  {msg}  {per_sec}, {eta} left", quiet);
        display.start_from(first_step, last_step);
        Self {
            display,
            first_step,
            last_step,
            n_blocks: case.model.lattice.n_blocks() as u64,
            end_star: case.time_plan.end_star(),
        }
    }

    pub(crate) fn show(&mut self, now: &Snapshot) {
        let (time_star, mu_star) = (now.time_star, now.point.mu_star);
        self.display.move_bar(now.step, self.last_step, || {
            format!("t* = {time_star:.1}, mu* = {mu_star:.3}")
        });
        if now.step == self.first_step {
            return;
        }
        self.display.print_line_if_due(|passed| {
            let rate = (now.step - self.first_step) as f64 / passed.as_secs_f64();
            format!(
                "{:3.0} %  t* = {time_star:.1} of {:.1}  mu* = {mu_star:.3}  {:.1} million block-steps/s  {} left",
                100.0 * now.step as f64 / self.last_step as f64,
                self.end_star,
                rate * self.n_blocks as f64 / 1e6,
                time_left(self.last_step - now.step, rate)
            )
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
