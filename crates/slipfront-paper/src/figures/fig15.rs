//! Fig. 15: reduction of static friction against the area of a circular cavity, for several roughnesses.

use crate::drawing::{Drawing, measured};
use crate::error::PaperError;
use crate::measurements::{Found, Number, largest, rises, smallest};
use crate::runner::Bench;
use slipfront_plot::Responses;
use slipfront_run::study::REDUCTION;

pub(super) fn find(bench: &mut Bench) -> Result<Found, PaperError> {
    let mut found = Found::default();
    let sweep = bench.study("fig15")?;
    let (areas, spreads) = (sweep.axis(0), sweep.axis(1));
    let curve = |spread: usize| -> Vec<Number> {
        (0..areas.len())
            .map(|area| sweep.number(&[area, spread], REDUCTION))
            .collect()
    };
    let numbers: Vec<Vec<Number>> = (0..spreads.len()).map(curve).collect();
    let curves = numbers
        .iter()
        .zip(&spreads)
        .map(|(numbers, spread)| measured(&spread.to_string(), &areas, numbers));
    found.panel(
        "fig15",
        "Reduction of static friction by a circular cavity against its area, for four spreads of the local static \
         coefficients: means of five surfaces with their 95 % intervals.",
        Drawing::Responses(Responses {
            x_title: "texture coverage A* (%)".to_owned(),
            y_title: "reduction of \u{3bc}\u{209b}* (%)".to_owned(),
            legend_title: "\u{3c3}\u{209b}*".to_owned(),
            curves: curves.collect(),
            ..Responses::default()
        }),
    );
    let means: Vec<Vec<f64>> = numbers
        .iter()
        .map(|numbers| numbers.iter().map(|number| number.value).collect())
        .collect();
    let place = |area: f64| areas.iter().position(|&other| other == area).unwrap_or(0);
    let (one, ten, last) = (place(1.0), place(10.0), areas.len() - 1);
    found.number("fig15.one_percent", numbers[0][one]);
    found.value("fig15.least_rise_with_area", smallest(rises(&means[0])));
    // Percent of friction for each percent of area, from nothing to 10 % and from there on.
    let first = means[0][ten] / areas[ten];
    let beyond = (means[0][last] - means[0][ten]) / (areas[last] - areas[ten]);
    found.value("fig15.slope_beyond_ten_over_before", beyond / first);
    let from_one_to_ten = (means[0][ten] - means[0][one]) / (areas[ten] - areas[one]);
    found.value(
        "fig15.slope_to_ten_over_to_one",
        from_one_to_ten / (means[0][one] / areas[one]),
    );
    found.value("fig15.largest_reduction", largest(means[0].iter().copied()));
    let with_roughness = (0..areas.len()).flat_map(|area| {
        let over_spread: Vec<f64> = means.iter().map(|means| means[area]).collect();
        rises(&over_spread)
    });
    found.value("fig15.largest_rise_with_roughness", largest(with_roughness));
    found.value(
        "fig15.roughest_over_smooth",
        means[spreads.len() - 1][ten] / means[0][ten],
    );
    Ok(found)
}
