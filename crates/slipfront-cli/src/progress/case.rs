//! Progress of the building of a case: reading of files, and meshing of the texture.

use std::time::{Duration, Instant};

use super::display::{ProgressDisplay, time_left};

/// Time before any progress is shown; most cases take less.
const PATIENCE: Duration = Duration::from_millis(500);
/// Time between two updates of the display, which is called millions of times.
const PAUSE: Duration = Duration::from_millis(50);

/// Display of the completed fraction of a part of the work, if the case takes long.
pub(crate) struct CaseProgress {
    quiet: bool,
    began: Instant,
    next: Instant,
    display: Option<ProgressDisplay>,
}

impl CaseProgress {
    pub(crate) fn new(quiet: bool) -> Self {
        let began = Instant::now();
        Self {
            quiet,
            began,
            next: began + PATIENCE,
            display: None,
        }
    }

    pub(crate) fn show(&mut self, share: f64) {
        const ALL: u64 = 1000;
        let now = Instant::now();
        if now < self.next {
            return;
        }
        self.next = now + PAUSE;
        let (passed, done) = (self.began.elapsed(), (ALL as f64 * share) as u64);
        let display = self
            .display
            .get_or_insert_with(|| ProgressDisplay::new(self.quiet));
        display.show(done, ALL, |_| {
            let left = time_left(ALL - done, done, passed);
            format!("making the case: {:3.0} % of this part{left}", 100.0 * share)
        });
    }

    pub(crate) fn finish(&self) {
        if let Some(display) = &self.display {
            display.finish();
        }
    }
}
