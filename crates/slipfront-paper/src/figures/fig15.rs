//! Fig. 15: reduction of static friction against the area of a circular cavity, for several roughnesses.

use crate::drawing::{Drawing, measured};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::figures::fig11::starts;
use crate::number::{MeasuredNumber, values};
use crate::runner::FigureRunner;
use crate::statistics::{largest, mean, rises, smallest};
use slipfront_plot::Responses;
use slipfront_study::REDUCTION;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig15")?;
    let (areas, spreads) = (sweep.axis(0), sweep.axis(1));
    let numbers: Vec<Vec<MeasuredNumber>> = (0..spreads.len())
        .map(|spread| sweep.numbers(&[spread], REDUCTION))
        .collect();
    // The coverage of the meshed texture (Eq. 15) is nearly the specified coverage.
    let meshed = sweep.means(&[0], "texture_percent");
    let curves = numbers
        .iter()
        .zip(&spreads)
        .map(|(numbers, spread)| measured(&spread.to_string(), &meshed, numbers));
    data.panel(
        "fig15",
        "Reduction of static friction by a circular cavity against its area, for four spreads of the local static \
         coefficients. Lines: means over five random surfaces; bands: 95 % confidence intervals of these means.",
        Drawing::Responses(Responses {
            x_title: "meshed texture coverage A* (%)".to_owned(),
            y_title: "reduction of \u{3bc}\u{209b}* (%)".to_owned(),
            legend_title: "\u{3c3}\u{209b}*".to_owned(),
            curves: curves.collect(),
            note: runner.note_on_bands(),
            ..Responses::default()
        }),
    );
    let means: Vec<Vec<f64>> = numbers.iter().map(|numbers| values(numbers)).collect();
    let (one, ten, last) = (sweep.level(1.0), sweep.level(10.0), areas.len() - 1);
    data.number("one_percent", numbers[0][one]);
    data.value("least_rise_with_area", smallest(rises(&means[0])));
    // Percent of friction per percent of area, from 0 to 10 % and beyond.
    let first = means[0][ten] / areas[ten];
    let beyond = (means[0][last] - means[0][ten]) / (areas[last] - areas[ten]);
    data.value("slope_beyond_ten_over_before", beyond / first);
    let from_one_to_ten = (means[0][ten] - means[0][one]) / (areas[ten] - areas[one]);
    data.value(
        "slope_to_ten_over_to_one",
        from_one_to_ten / (means[0][one] / areas[one]),
    );
    data.value("largest_reduction", largest(means[0].iter().copied()));
    let with_roughness = (0..areas.len()).flat_map(|area| {
        let over_spread: Vec<f64> = means.iter().map(|means| means[area]).collect();
        rises(&over_spread)
    });
    data.value("largest_rise_with_roughness", largest(with_roughness));
    data.value(
        "roughest_over_smooth",
        means[spreads.len() - 1][ten] / means[0][ten],
    );
    starting_points(runner, data)
}

/// Number of places where slip begins before the peak without a texture, for each spread of the local static
/// coefficients.
fn starting_points(runner: &FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.plan("fig15_starts")?;
    let mut means = Vec::new();
    let mut rows = Vec::new();
    for (k, spread) in sweep.axis(0).iter().enumerate() {
        let runs = runner.run(sweep.cases(&[k])?)?;
        let counts: Vec<f64> = runs.iter().map(|run| starts(run).len() as f64).collect();
        rows.push([spread.to_string(), MeasuredNumber::from_values(&counts).shown(0)]);
        means.push(mean(&counts));
    }
    data.value("least_rise_of_starts", smallest(rises(&means)));
    let rough = &means[sweep.level(0.05)..];
    data.value("least_rise_of_starts_when_rough", smallest(rises(rough)));
    data.table(
        "fig15_starts",
        "Number of blocks that slip before the friction peak and before all their neighbours, in 50 x 50 blocks without \
         texture.",
        ["sigma_s*", "starting points"],
        rows,
    );
    Ok(())
}
