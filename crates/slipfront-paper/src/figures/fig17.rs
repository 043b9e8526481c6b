//! Fig. 17: contact stress around elongated cavities and grooves.

use crate::drawing::stress_maps;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::peak_maps;
use crate::runner::FigureRunner;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.plan("fig17")?;
    let runs = runner.run(sweep.first_cases()?)?;
    data.panel(
        "fig17",
        "Contact stress at the friction peak, with 10 % coverage. a: ellipse across the sliding \
         direction; b: ellipse along it; c: groove across it; d: groove along it.",
        stress_maps(peak_maps(&runs, &sweep.names(0))?, 4),
    );
    Ok(())
}
