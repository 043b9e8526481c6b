//! Progress of the figures of the paper.

use slipfront_base::number_format::count;
use slipfront_paper::{Stage, StepRule};

use super::display::ProgressDisplay;

/// Display of the figure being made: a bar on a terminal, otherwise a line for each figure.
pub(crate) struct PaperProgress(ProgressDisplay);

impl PaperProgress {
    pub(crate) fn new(quiet: bool) -> Self {
        Self(ProgressDisplay::new(
            "{wide_bar} {pos} of {len} figures  {elapsed}  {msg}",
            quiet,
        ))
    }

    pub(crate) fn show(&self, stage: &Stage) {
        let step = match stage.step {
            StepRule::Auto => "",
            StepRule::Paper => ", with the paper's time step",
        };
        self.0.move_bar(stage.done as u64, stage.total as u64, || {
            let runs = stage.study.map_or(String::new(), |study| {
                format!(", {} of {}", study.done, count(study.total, "run"))
            });
            format!("{}{step}{runs}", stage.figure.name)
        });
        if stage.study.is_none() {
            self.0.print_line(|| {
                let (number, total, title) = (stage.number, stage.total, &stage.figure.title);
                format!("{number:>2} of {total}: {title}{step}")
            });
        }
    }

    pub(crate) fn finish(&self) {
        self.0.finish();
    }
}
