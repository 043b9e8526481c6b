//! Progress of the figures of the paper.

use slipfront_base::number_format::count;
use slipfront_paper::{Stage, StepRule};

use super::display::ProgressDisplay;

/// Bar for the figures, in the format of indicatif.
pub(crate) const PAPER_BAR: &str = "{wide_bar} {pos} of {len} figures  {elapsed}  {msg}";

/// Shows the figure being made: a bar on a terminal, otherwise a line for each figure.
pub(crate) fn show_paper(display: &ProgressDisplay, stage: &Stage) {
    let step = match stage.step {
        StepRule::Auto => "",
        StepRule::Paper => ", with the paper's time step",
    };
    display.move_bar(stage.done as u64, stage.total as u64, || {
        let runs = stage.study.map_or(String::new(), |study| {
            format!(", {} of {}", study.done, count(study.total, "run"))
        });
        format!("{}{step}{runs}", stage.figure.name)
    });
    if stage.study.is_none() {
        let (number, total, title) = (stage.number, stage.total, &stage.figure.title);
        display.print_line(&format!("{number:>2} of {total}: {title}{step}"));
    }
}
