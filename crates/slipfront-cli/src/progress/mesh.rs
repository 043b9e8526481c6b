//! Progress of a texture that is laid over the blocks.

use std::time::{Duration, Instant};

use super::display::ProgressDisplay;

/// Time before anything is shown: most textures take less.
const PATIENCE: Duration = Duration::from_millis(500);
/// Time between two looks at the display, of which there are millions.
const PAUSE: Duration = Duration::from_millis(50);

/// Shows which share of the texture is laid over the blocks, if that takes long.
pub(crate) struct MeshProgress {
    quiet: bool,
    next: Instant,
    display: Option<ProgressDisplay>,
}

impl MeshProgress {
    pub(crate) fn new(quiet: bool) -> Self {
        Self {
            quiet,
            next: Instant::now() + PATIENCE,
            display: None,
        }
    }

    pub(crate) fn show(&mut self, share: f64) {
        let now = Instant::now();
        if now < self.next {
            return;
        }
        self.next = now + PAUSE;
        let new = || ProgressDisplay::new("{bar:32} {percent:>3} %  {msg}  {eta} left", self.quiet);
        let display = self.display.get_or_insert_with(new);
        display.move_bar((1000.0 * share) as u64, 1000, || {
            "of the texture meshed".to_owned()
        });
        display.print_line_if_due(|_| format!("{:3.0} %  of the texture meshed", 100.0 * share));
    }

    pub(crate) fn finish(&self) {
        if let Some(display) = &self.display {
            display.finish();
        }
    }
}
