//! Fig. 5: the same material in three sizes.

use crate::drawing::stress_maps;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{FigureRun, curves, mu_star, sliding_percent};
use crate::runner::FigureRunner;
use crate::statistics::mean;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let (sweep, runs) = runner.study_with_runs("fig05", usize::MAX)?;
    let sides = sweep.axis(0);
    let firsts = &runs[..sides.len()];
    let name = |size: usize| format!("{0} \u{d7} {0} blocks", sides[size]);
    data.panel(
        "fig05",
        "Friction and sliding blocks for sliders of 5 x 5, 25 x 25 and 75 x 75 blocks.",
        curves(firsts, name),
    );
    let mut maps = Vec::new();
    for (size, run) in firsts.iter().enumerate() {
        for letter in ['C', 'D', 'E'] {
            maps.push(run.stress_map(run.instant(letter)?, &format!("{}, {letter}", name(size)))?);
        }
    }
    data.panel(
        "fig05c",
        "Contact stress for the three sizes at the friction peak (C), when most blocks slide (D), and at the lowest \
         friction after the peak (E).",
        stress_maps(maps, 3),
    );
    whole_curves(&runs, data);
    // Compare each surface with the mean of the largest size, so the error includes scatter as well as bias,
    // as for a single run.
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

/// Distances of the curves of the smaller sizes from the mean curve of the largest. There is a run in each of
/// the three sizes for each surface.
fn whole_curves(runs: &[FigureRun], data: &mut FigureData) {
    let [small, middle, large] =
        [0, 1, 2].map(|size| runs.iter().skip(size).step_by(3).collect::<Vec<&FigureRun>>());
    for (name, value) in [
        ("curve_error", mu_star as fn(&_) -> f64),
        ("sliding_curve_error", sliding_percent),
    ] {
        let mean_curve = |time: f64| mean(&large.iter().map(|run| run.at(time, value)).collect::<Vec<_>>());
        let errors = |runs: &[&FigureRun]| -> Vec<f64> {
            let error = |run: &&FigureRun| {
                let rows = run.record.rows.iter();
                let squares = rows.map(|row| (value(&row.point) - mean_curve(row.time_star)).powi(2));
                mean(&squares.collect::<Vec<_>>()).sqrt()
            };
            runs.iter().map(error).collect()
        };
        let (small, middle) = (errors(&small), errors(&middle));
        data.values(&format!("{name}_5"), &small);
        data.values(&format!("{name}_25"), &middle);
        data.value(&format!("{name}_ratio"), mean(&middle) / mean(&small));
    }
}
