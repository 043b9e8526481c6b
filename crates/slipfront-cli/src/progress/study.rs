//! Progress of a study.

use slipfront_run::study::Progress;

use super::display::{ProgressDisplay, time_left};

/// Shows how far a study has come.
pub(crate) struct StudyProgress(ProgressDisplay);

impl StudyProgress {
    pub(crate) fn new(quiet: bool) -> Self {
        let template = "{bar:32} {pos}/{len} runs  {per_sec}, {eta} left  {msg}";
        Self(ProgressDisplay::new(template, quiet))
    }

    pub(crate) fn show(&mut self, now: &Progress) {
        let (done, total) = (now.done as u64, now.total as u64);
        if now.here == 0 {
            self.0.start_from(done, total);
        }
        let notes = notes(now);
        self.0.move_bar(done, total, || notes.clone());
        self.0.print_line_if_due(|passed| {
            // Runs recorded before say nothing of the rate.
            let rate = if now.here > 0 {
                let rate = now.here as f64 / passed.as_secs_f64();
                format!("  {rate:.1} runs/s  {} left", time_left(total - done, rate))
            } else {
                String::new()
            };
            format!("{done} of {total} runs{rate}{notes}")
        });
    }

    pub(crate) fn finish(&self) {
        self.0.finish();
    }
}

/// Failed runs, and the widest interval of a study that goes on until intervals are narrow.
fn notes(now: &Progress) -> String {
    let failed = match now.failed {
        0 => String::new(),
        failed => format!("  {failed} failed"),
    };
    let worst = now.worst.map_or(String::new(), |worst| {
        format!("  widest interval \u{b1} {worst:.1e}")
    });
    failed + &worst
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All runs were recorded before: there is no rate.
    #[test]
    fn a_study_in_which_nothing_is_left_has_no_rate() {
        let mut progress = StudyProgress(ProgressDisplay::due_lines());
        progress.show(&Progress {
            done: 7,
            total: 7,
            here: 0,
            failed: 0,
            worst: None,
        });
    }
}
