//! Display of progress: a bar on a terminal, otherwise plain lines.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use crate::print_stderr::{is_silent, print_stderr};
use crate::wrap::for_stderr;

/// Display of the progress of some work.
pub(crate) struct ProgressDisplay {
    began: Instant,
    /// Hidden unless stderr is a terminal.
    bar: ProgressBar,
    /// Time at which the next plain line is due; none if there are no lines, because there is a bar, the user
    /// asked for quiet, or another process prints for this one.
    next_line: Option<Instant>,
}

impl ProgressDisplay {
    /// Makes a display with a bar and a text.
    pub(crate) fn new(quiet: bool) -> Self {
        Self::with_bar("{wide_bar} {msg}", quiet)
    }

    /// Makes a display; `template` is the template of its bar, in the format of indicatif.
    pub(crate) fn with_bar(template: &str, quiet: bool) -> Self {
        let (began, shows) = (Instant::now(), !quiet && !is_silent());
        let is_terminal = std::io::stderr().is_terminal();
        let bar = if shows && is_terminal {
            ProgressBar::new(0)
        } else {
            ProgressBar::hidden()
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        Self {
            began,
            bar,
            next_line: (shows && !is_terminal).then(|| began + pause(Duration::ZERO)),
        }
    }

    /// Moves the bar, or prints a line if one is due; `text` gets the time passed since the beginning.
    pub(crate) fn show(&mut self, done: u64, total: u64, text: impl FnOnce(Duration) -> String) {
        let (now, passed) = (Instant::now(), self.began.elapsed());
        match &mut self.next_line {
            Some(next) if now >= *next => {
                *next = now + pause(passed);
                print_stderr(&text(passed));
            }
            _ => self.move_bar(done, total, || text(passed)),
        }
    }

    /// Moves the bar, if there is one.
    pub(crate) fn move_bar(&self, done: u64, total: u64, message: impl FnOnce() -> String) {
        if !self.bar.is_hidden() {
            self.bar.set_length(total);
            self.bar.set_position(done);
            self.bar.set_message(message());
        }
    }

    /// Prints a line if progress is shown as lines.
    pub(crate) fn print_line(&self, line: &str) {
        if self.next_line.is_some() {
            print_stderr(line);
        }
    }

    /// Prints a line in addition to the progress, even if that is not shown: for requested output and for
    /// warnings.
    pub(crate) fn note(&self, text: &str) {
        let text = for_stderr(text);
        if self.bar.is_hidden() {
            print_stderr(&text);
        } else {
            self.bar.println(text);
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Time left for `more` items, when `here` items took the time `passed`; empty if `here` is 0.
pub(crate) fn time_left(more: u64, here: u64, passed: Duration) -> String {
    let left = duration_left(more as f64, here as f64, passed);
    left.map_or_else(String::new, |left| format!("  {left} left"))
}

/// Time left for `more` work, when `here` work took the time `passed`; none if `here` is 0.
pub(super) fn duration_left(more: f64, here: f64, passed: Duration) -> Option<HumanDuration> {
    let seconds = more * passed.as_secs_f64() / here;
    let left = Duration::try_from_secs_f64(seconds).ok()?;
    (here > 0.0).then_some(HumanDuration(left))
}

/// Time between two plain lines after `passed`: 5 seconds at first, a minute in a log of hours.
fn pause(passed: Duration) -> Duration {
    (passed / 12).clamp(Duration::from_secs(5), Duration::from_secs(60))
}
