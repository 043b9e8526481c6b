//! Progress of a run on stderr: a bar on a terminal, else a plain line now and then.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use slipfront::Snapshot;
use slipfront_run::running::Running;
use slipfront_run::study::Progress as StudyState;

use crate::print_stderr::print_stderr;

/// Time from one plain line to the next after so long a time: 5 seconds at first, a minute in the log of hours.
fn pause(passed: Duration) -> Duration {
    (passed / 12).clamp(Duration::from_secs(5), Duration::from_secs(60))
}

/// Shows how far a run has come.
pub(crate) enum Progress {
    Silent,
    Bar(ProgressBar),
    Lines(Lines),
}

pub(crate) struct Lines {
    last_step: u64,
    n_blocks: u64,
    end_star: f64,
    /// Step at which this process began.
    first_step: u64,
    began: Instant,
    next: Instant,
}

impl Progress {
    /// Of a run that begins, or goes on, where it is now.
    pub(crate) fn new(running: &Running, quiet: bool) -> Self {
        let case = running.case();
        let (first_step, last_step) = (running.snapshot().step, case.schedule.last_step);
        if quiet {
            return Self::Silent;
        }
        if !std::io::stderr().is_terminal() {
            let (n_blocks, now) = (case.model.lattice.n_blocks() as u64, Instant::now());
            let end_star = case.schedule.end_star();
            return Self::Lines(Lines {
                last_step,
                n_blocks,
                end_star,
                first_step,
                began: now,
                next: now + pause(Duration::ZERO),
            });
        }
        let bar = ProgressBar::new(last_step);
        let template = "{bar:32} {percent:>3} %  {msg}  {per_sec}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        // What was done before says nothing of the rate.
        bar.set_position(first_step);
        bar.reset_eta();
        Self::Bar(bar)
    }

    pub(crate) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }

    /// Says something beside the progress, and also where none is shown: it is asked for, or a warning.
    pub(crate) fn note(&self, text: &str) {
        match self {
            Self::Bar(bar) => bar.println(text),
            Self::Silent | Self::Lines(_) => print_stderr(text),
        }
    }

    pub(crate) fn show(&mut self, now: &Snapshot) {
        match self {
            Self::Silent => {}
            Self::Bar(bar) => {
                bar.set_position(now.step);
                bar.set_message(format!(
                    "t* = {:.1}, mu* = {:.3}",
                    now.time_star, now.point.mu_star
                ));
            }
            Self::Lines(lines) => lines.show(now),
        }
    }
}

impl Lines {
    fn show(&mut self, now: &Snapshot) {
        if Instant::now() < self.next || now.step == self.first_step {
            return;
        }
        let passed = self.began.elapsed();
        self.next = Instant::now() + pause(passed);
        let rate = (now.step - self.first_step) as f64 / passed.as_secs_f64();
        let left = (self.last_step - now.step) as f64 / rate;
        print_stderr(&format!(
            "{:3.0} %  t* = {:.1} of {:.1}  mu* = {:.3}  {:.1} million block-steps/s  {} left",
            100.0 * now.step as f64 / self.last_step as f64,
            now.time_star,
            self.end_star,
            now.point.mu_star,
            rate * self.n_blocks as f64 / 1e6,
            HumanDuration(Duration::from_secs_f64(left)),
        ));
    }
}

/// Shows how far a study has come.
pub(crate) enum StudyProgress {
    Silent,
    Bar(ProgressBar),
    Lines { began: Instant, next: Instant },
}

impl StudyProgress {
    pub(crate) fn new(quiet: bool) -> Self {
        if quiet {
            return Self::Silent;
        }
        if !std::io::stderr().is_terminal() {
            let now = Instant::now();
            return Self::Lines {
                began: now,
                next: now + pause(Duration::ZERO),
            };
        }
        let bar = ProgressBar::new(0);
        if let Ok(style) =
            ProgressStyle::with_template("{bar:32} {pos}/{len} runs  {per_sec}, {eta} left  {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        Self::Bar(bar)
    }

    pub(crate) fn show(&mut self, now: &StudyState) {
        let failed = if now.failed > 0 {
            format!("  {} failed", now.failed)
        } else {
            String::new()
        };
        let worst = now.worst.map_or(String::new(), |worst| {
            format!("  widest interval \u{b1} {worst:.1e}")
        });
        match self {
            Self::Silent => {}
            Self::Bar(bar) => {
                if now.here == 0 {
                    // What was done before says nothing of the rate.
                    bar.set_length(now.total as u64);
                    bar.set_position(now.done as u64);
                    bar.reset_eta();
                }
                bar.set_length(now.total as u64);
                bar.set_position(now.done as u64);
                bar.set_message(format!("{failed}{worst}"));
            }
            Self::Lines { began, next } => {
                if Instant::now() < *next {
                    return;
                }
                *next = Instant::now() + pause(began.elapsed());
                // What was done before says nothing of the rate.
                let rate = if now.here > 0 {
                    let rate = now.here as f64 / began.elapsed().as_secs_f64();
                    let left = Duration::from_secs_f64((now.total - now.done) as f64 / rate);
                    format!("  {rate:.1} runs/s  {} left", HumanDuration(left))
                } else {
                    String::new()
                };
                let (done, total) = (now.done, now.total);
                print_stderr(&format!("{done} of {total} runs{rate}{failed}{worst}"));
            }
        }
    }

    pub(crate) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All runs were recorded before: there is no rate.
    #[test]
    fn a_study_in_which_nothing_is_left_has_no_rate() {
        let now = Instant::now();
        let mut progress = StudyProgress::Lines {
            began: now,
            next: now,
        };
        progress.show(&StudyState {
            done: 7,
            total: 7,
            here: 0,
            failed: 0,
            worst: None,
        });
    }
}
