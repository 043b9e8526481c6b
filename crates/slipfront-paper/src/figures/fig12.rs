//! Fig. 12: static friction against the spread of the local coefficients.

use crate::drawing::{Drawing, measured};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::values;
use crate::run::{Run, on_each};
use crate::runner::FigureRunner;
use crate::statistics::{deviation, distances, farthest, largest, mean, range, ratios, rises};
use slipfront_plot::Responses;

/// Surfaces from which the paper takes each mean.
const SURFACES: usize = 5;
/// The largest deviation from such a mean that the paper has seen.
const DEVIATION: f64 = 0.015;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig12")?;
    let (spreads, speeds) = (sweep.axis(0), sweep.axis(1));
    let mut curves = Vec::new();
    let (mut deviations, mut steps, mut limits) = (Vec::new(), Vec::new(), Vec::new());
    for (v, speed) in speeds.iter().enumerate() {
        let numbers = sweep.numbers(&[v], "static_friction_star");
        for k in 0..spreads.len() {
            let statics = sweep.values(&[k, v], "static_friction_star");
            deviations.push(farthest(&statics, mean(&statics)));
        }
        let means = values(&numbers);
        steps.extend(rises(&means));
        limits.push((means[0] - 1.0).abs());
        curves.push(measured(&speed.to_string(), &spreads, &numbers));
    }
    data.panel(
        "fig12",
        "Static friction against the spread of the local static coefficients, for four speeds: means of five surfaces \
         with their 95 % intervals.",
        Drawing::Responses(Responses {
            x_title: "spread of static coefficients \u{3c3}\u{209b}*".to_owned(),
            y_title: "static friction \u{3bc}\u{209b}*".to_owned(),
            legend_title: "V*".to_owned(),
            curves,
            ..Responses::default()
        }),
    );
    data.value("largest_deviation", largest(deviations));
    data.value("largest_rise", largest(steps));
    data.value("distance_of_limit", largest(limits));
    // On a smooth surface no block slips before the others.
    let run = runner.run_one(sweep.case(&[sweep.level(0.0), 0], 0)?)?;
    data.value("slip_times_apart", range(&run.slip_times()));
    surfaces(runner, data)?;
    kinetic(runner, data)
}

/// How often five surfaces are as close together as the paper's.
fn surfaces(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let statics = runner
        .study("fig12_surfaces")?
        .values(&[], "static_friction_star");
    let fives = statics.chunks_exact(SURFACES);
    let count = fives.len() as f64;
    let close = fives.filter(|five| farthest(five, mean(five)) < DEVIATION);
    data.value("fives_within_percent", 100.0 * (close.count() as f64 / count));
    data.value("standard_deviation", deviation(&statics));
    Ok(())
}

/// The effect of sigma_k* on friction, on the onset and on the fluctuation of kinetic friction.
fn kinetic(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig12_kinetic")?;
    let levels = sweep.axis(0).len();
    // Surface by surface, against no spread at all.
    let change = |quantity: &str| {
        let none = sweep.values(&[0], quantity);
        largest((1..levels).flat_map(|k| distances(&sweep.values(&[k], quantity), &none)))
    };
    data.value("static_friction_moved_by_sigma_k", change("static_friction_star"));
    let onset = mean(&sweep.values(&[0], "onset_time_star"));
    data.value(
        "onset_moved_by_sigma_k_percent",
        100.0 * change("onset_time_star") / onset,
    );
    data.value("first_slip_moved_by_sigma_k", change("first_slip_time_star"));
    let long = runner.plan("fig12_fluctuations")?;
    let mut means = Vec::new();
    for k in 0..long.axis(0).len() {
        let runs = runner.run(long.cases(&[k])?)?;
        means.push(on_each(&runs, Run::kinetic_fluctuation)?);
    }
    let [none, most] = &means[..] else { return Ok(()) };
    data.values("fluctuation_factor_of_sigma_k", &ratios(most, none));
    Ok(())
}
