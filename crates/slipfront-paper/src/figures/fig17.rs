//! Fig. 17: contact stress around elongated cavities and grooves.

use crate::drawing::stress_maps;
use crate::error::PaperError;
use crate::measurements::Found;
use crate::runner::Bench;

pub(super) fn find(bench: &mut Bench) -> Result<Found, PaperError> {
    let mut found = Found::default();
    let sweep = bench.plan("fig17")?;
    let names = sweep.names(0);
    let cases = (0..names.len())
        .map(|k| sweep.case(&[k], 0))
        .collect::<Result<_, _>>()?;
    let mut maps = Vec::new();
    for (run, name) in bench.run(cases)?.iter().zip(&names) {
        maps.push(run.stress_map(run.instant('C')?, name)?);
    }
    found.panel(
        "fig17",
        "Contact stress at the peak of friction, with a tenth of the slider textured: a, an ellipse across the sliding \
         direction; b, along it; c, a groove across; d, along.",
        stress_maps(maps, 4),
    );
    Ok(found)
}
