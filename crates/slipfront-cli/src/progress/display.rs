//! How progress is shown: a bar on a terminal, else plain lines.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use crate::print_stderr::{is_silent, print_stderr};
use crate::wrap::for_stderr;

/// Shows how far some work has come.
pub(crate) struct ProgressDisplay {
    began: Instant,
    sink: Sink,
}

enum Sink {
    /// Where the user asked for quiet, or another process speaks for this one.
    Silent,
    Bar(ProgressBar),
    /// Plain lines, and when the next one is due.
    Lines(Instant),
}

impl ProgressDisplay {
    /// `template` is that of the bar, as indicatif reads it.
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

    /// Moves the bar, or prints a line if one is due; `text` is given the time passed since the beginning.
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

    /// Prints a line where lines are shown.
    pub(crate) fn print_line(&self, text: impl FnOnce() -> String) {
        if let Sink::Lines(_) = self.sink {
            print_stderr(&text());
        }
    }

    /// Prints a line beside the progress, also where none is shown: for what was asked for, and for warnings.
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

/// The time left for `more` things of which `here` were done in the time that has `passed`; empty where none was.
pub(crate) fn time_left(more: u64, here: u64, passed: Duration) -> String {
    let seconds = more as f64 * passed.as_secs_f64() / here as f64;
    match Duration::try_from_secs_f64(seconds) {
        Ok(left) if here > 0 => format!("  {} left", HumanDuration(left)),
        _ => String::new(),
    }
}

/// Time between two plain lines when so much time has passed: 5 seconds at first, a minute in the log of hours.
fn pause(passed: Duration) -> Duration {
    (passed / 12).clamp(Duration::from_secs(5), Duration::from_secs(60))
}
