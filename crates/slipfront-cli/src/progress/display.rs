//! Display of progress: a bar on a terminal, otherwise plain lines.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use crate::print_stderr::{is_silent, print_stderr};
use crate::wrap::for_stderr;

/// Display of the progress of some work.
pub(crate) struct ProgressDisplay {
    began: Instant,
    sink: Sink,
}

enum Sink {
    /// No display, because the user asked for quiet, or another process prints for this one.
    Silent,
    Bar(ProgressBar),
    /// Plain lines, and the time at which the next one is due.
    Lines(Instant),
}

impl ProgressDisplay {
    /// Makes a display; `template` is the template of its bar, in the format of indicatif.
    pub(crate) fn new(template: &str, quiet: bool) -> Self {
        let began = Instant::now();
        let sink = if quiet || is_silent() {
            Sink::Silent
        } else if !std::io::stderr().is_terminal() {
            Sink::Lines(began + pause(Duration::ZERO))
        } else {
            let bar = ProgressBar::new(0);
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style.progress_chars("=> "));
            }
            Sink::Bar(bar)
        };
        Self { began, sink }
    }

    /// Moves the bar, or prints a line if one is due; `text` gets the time passed since the beginning.
    pub(crate) fn show(&mut self, done: u64, total: u64, text: impl FnOnce(Duration) -> String) {
        let passed = self.began.elapsed();
        match &mut self.sink {
            Sink::Silent => {}
            Sink::Bar(_) => self.move_bar(done, total, || text(passed)),
            Sink::Lines(next) => {
                let now = Instant::now();
                if now >= *next {
                    *next = now + pause(passed);
                    print_stderr(&text(passed));
                }
            }
        }
    }

    /// Moves the bar, if there is one.
    pub(crate) fn move_bar(&self, done: u64, total: u64, message: impl FnOnce() -> String) {
        if let Sink::Bar(bar) = &self.sink {
            bar.set_length(total);
            bar.set_position(done);
            bar.set_message(message());
        }
    }

    /// Prints a line if progress is shown as lines.
    pub(crate) fn print_line(&self, text: impl FnOnce() -> String) {
        if let Sink::Lines(_) = self.sink {
            print_stderr(&text());
        }
    }

    /// Prints a line in addition to the progress, even if that is not shown: for requested output and for
    /// warnings.
    pub(crate) fn note(&self, text: &str) {
        let text = for_stderr(text);
        match &self.sink {
            Sink::Bar(bar) => bar.println(text),
            Sink::Silent | Sink::Lines(_) => print_stderr(&text),
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Sink::Bar(bar) = &self.sink {
            bar.finish_and_clear();
        }
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
