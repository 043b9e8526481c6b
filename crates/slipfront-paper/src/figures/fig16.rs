//! Fig. 16: elongated cavities, and grooves as their limit; and the generality of the 31 % (D9).

use crate::drawing::{Drawing, measured};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::values;
use crate::runner::FigureRunner;
use crate::statistics::{farthest, largest, mean, rises, smallest};
use crate::sweep::ParameterSweep;
use slipfront_plot::{Response, Responses};
use slipfront_study::REDUCTION;

/// Levels of the second axis.
const ACROSS: usize = 0;
const ALONG: usize = 1;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig16")?;
    let elongations = sweep.axis(0);
    let [across, along] = [ACROSS, ALONG].map(|direction| sweep.numbers(&[direction], REDUCTION));
    let grooves = runner.study("fig16_grooves")?.numbers(&[], REDUCTION);
    let ends = [elongations[0], elongations[elongations.len() - 1]];
    let level =
        |direction: usize, label: &str| Response::of_formula(label, &ends, |_| grooves[direction].value);
    data.panel(
        "fig16",
        "Reduction of static friction by an elliptical cavity with 10 % coverage against its elongation across \
         and along the sliding direction, and by grooves of the same area. Curves: means over five random surfaces; bands: \
         95 % confidence intervals of these means.",
        Drawing::Responses(Responses {
            x_title: "elongation w".to_owned(),
            y_title: "reduction of \u{3bc}\u{209b}* (%)".to_owned(),
            curves: vec![
                measured("across", &elongations, &across),
                measured("along", &elongations, &along),
                level(ACROSS, "groove across"),
                level(ALONG, "groove along"),
            ],
            note: runner.note_on_bands(),
            ..Responses::default()
        }),
    );
    let circle = across[0];
    data.number("circle_percent", circle);
    data.number("groove_across_percent", grooves[ACROSS]);
    data.value("least_rise_across", smallest(rises(&values(&across))));
    data.value("gain_across", largest(values(&across)) - circle.value);
    let losses: Vec<f64> = along[1..]
        .iter()
        .map(|number| circle.value - number.value)
        .collect();
    data.value("mean_loss_along", mean(&losses));
    data.value("largest_loss_along", largest(losses));
    data.value(
        "groove_along_beside_circle",
        (grooves[ALONG].value - circle.value).abs(),
    );
    generality(&runner.study("fig16_generality")?, data);
    Ok(())
}

/// Measures the reduction by a circular cavity against the size and the speed of the slider.
fn generality(sweep: &ParameterSweep, data: &mut FigureData) {
    let reductions = sweep.numbers(&[], REDUCTION);
    let moved = farthest(&values(&reductions), reductions[0].value);
    data.value("circle_moved_by_size_and_speed", moved);
    let rows = sweep.names(0).into_iter().zip(&reductions);
    data.table(
        "fig16_generality",
        "The 31 % of the circular cavity under 10 % of the slider, in other sizes and at other speeds (D9).",
        ["slider", "reduction of mu_s* (%)"],
        rows.map(|(name, number)| [name, number.shown(1)]),
    );
}
