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
        "Contact stress at the peak of friction, with a tenth of the slider textured: a, an ellipse across the sliding \
         direction; b, along it; c, a groove across; d, along.",
        stress_maps(peak_maps(&runs, &sweep.names(0))?, 4),
    );
    Ok(())
}
