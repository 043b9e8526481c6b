//! Fig. 5: the same material in three sizes.

use crate::drawing::stress_maps;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::curves;
use crate::runner::FigureRunner;
use crate::statistics::mean;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig05")?;
    let runs = runner.run(sweep.first_cases()?)?;
    let sides = sweep.axis(0);
    let name = |size: usize| format!("{0} \u{d7} {0} blocks", sides[size]);
    data.panel(
        "fig05",
        "Friction and sliding blocks of sliders of 5 x 5, 25 x 25 and 75 x 75 blocks.",
        curves(&runs, name),
    );
    let mut maps = Vec::new();
    for (size, run) in runs.iter().enumerate() {
        for letter in ['C', 'D', 'E'] {
            maps.push(run.stress_map(run.instant(letter)?, &format!("{}, {letter}", name(size)))?);
        }
    }
    data.panel(
        "fig05c",
        "Contact stress in the three sizes at the peak of friction (C), when most blocks slide (D), and at the least \
         friction after it (E).",
        stress_maps(maps, 3),
    );
    // Each surface against the mean of the largest size: scatter counts as much as bias, as for one run.
    let long = runner.study("fig05_long")?;
    for (sweep, quantity) in [(&sweep, "static_friction_star"), (&long, "kinetic_friction_star")] {
        let largest_size = mean(&sweep.values(&[2], quantity));
        let errors = |size: usize| -> Vec<f64> {
            let values = sweep.values(&[size], quantity);
            values.iter().map(|value| (value - largest_size).abs()).collect()
        };
        let (small, middle) = (errors(0), errors(1));
        data.values(&format!("{quantity}_error_5"), &small);
        data.values(&format!("{quantity}_error_25"), &middle);
        data.value(&format!("{quantity}_error_ratio"), mean(&middle) / mean(&small));
    }
    Ok(())
}
