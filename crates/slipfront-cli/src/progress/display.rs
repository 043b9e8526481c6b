//! How progress is shown: a bar on a terminal, else plain lines.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use crate::print_stderr::print_stderr;

/// Shows how far some work has come.
pub(crate) enum ProgressDisplay {
    /// Where the user asked for quiet.
    Silent,
    Bar(ProgressBar),
    Lines(LineTimer),
}

/// When the next plain line is due.
pub(crate) struct LineTimer {
    began: Instant,
    next: Instant,
}

impl ProgressDisplay {
    /// `template` is that of the bar, as indicatif reads it.
    pub(crate) fn new(template: &str, quiet: bool) -> Self {
        if quiet {
            return Self::Silent;
        }
        if !std::io::stderr().is_terminal() {
            let now = Instant::now();
            return Self::Lines(LineTimer {
                began: now,
                next: now + pause(Duration::ZERO),
            });
        }
        let bar = ProgressBar::new(0);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        Self::Bar(bar)
    }

    /// Sets what had been done before, which does not count for the rate.
    pub(crate) fn start_from(&self, done: u64, total: u64) {
        if let Self::Bar(bar) = self {
            bar.set_length(total);
            bar.set_position(done);
            bar.reset_eta();
        }
    }

    /// Moves the bar, if there is one.
    pub(crate) fn move_bar(&self, done: u64, total: u64, message: impl FnOnce() -> String) {
        if let Self::Bar(bar) = self {
            bar.set_length(total);
            bar.set_position(done);
            bar.set_message(message());
        }
    }

    /// Prints a line where lines are shown.
    pub(crate) fn print_line(&self, text: impl FnOnce() -> String) {
        if let Self::Lines(_) = self {
            print_stderr(&text());
        }
    }

    /// Prints a line where lines are shown and one is due; `text` is given the time passed since the beginning.
    pub(crate) fn print_line_if_due(&mut self, text: impl FnOnce(Duration) -> String) {
        let Self::Lines(timer) = self else { return };
        if Instant::now() < timer.next {
            return;
        }
        let passed = timer.began.elapsed();
        timer.next = Instant::now() + pause(passed);
        print_stderr(&text(passed));
    }

    /// Prints a line beside the progress, also where none is shown: for what was asked for, and for warnings.
    pub(crate) fn note(&self, text: &str) {
        match self {
            Self::Bar(bar) => bar.println(text),
            Self::Silent | Self::Lines(_) => print_stderr(text),
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
impl ProgressDisplay {
    /// One that prints a line at once.
    pub(crate) fn due_lines() -> Self {
        let now = Instant::now();
        Self::Lines(LineTimer {
            began: now,
            next: now,
        })
    }
}

/// The time left for `count` more at a rate per second.
pub(crate) fn time_left(count: u64, rate: f64) -> HumanDuration {
    HumanDuration(Duration::from_secs_f64(count as f64 / rate))
}

/// Time between two plain lines when so much time has passed: 5 seconds at first, a minute in the log of hours.
fn pause(passed: Duration) -> Duration {
    (passed / 12).clamp(Duration::from_secs(5), Duration::from_secs(60))
}
