//! Fig. 12: static friction against the spread of the local coefficients.

use crate::drawing::{Drawing, measured};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::values;
use crate::run::Run;
use crate::runner::FigureRunner;
use crate::statistics::{deviation, largest, mean, range, ratios, rises};
use slipfront_plot::Responses;

/// Surfaces from which the paper takes each mean.
const SURFACES: usize = 5;
/// The largest deviation from such a mean that the paper has seen.
const DEVIATION: f64 = 0.015;

pub(super) fn measure(runner: &mut FigureRunner) -> Result<FigureData, PaperError> {
    let mut data = FigureData::default();
    let sweep = runner.study("fig12")?;
    let (spreads, speeds) = (sweep.axis(0), sweep.axis(1));
    let mut curves = Vec::new();
    let (mut deviations, mut steps, mut limits) = (Vec::new(), Vec::new(), Vec::new());
    for (v, speed) in speeds.iter().enumerate() {
        let numbers = sweep.numbers(&[v], "static_friction_star");
        for k in 0..spreads.len() {
            deviations.push(farthest(&sweep.values(&[k, v], "static_friction_star")));
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
    data.value("fig12.largest_deviation", largest(deviations));
    data.value("fig12.largest_rise", largest(steps));
    data.value("fig12.distance_of_limit", largest(limits));
    // On a smooth surface no block slips before the others.
    let smooth = spreads.iter().position(|&spread| spread == 0.0).unwrap_or(0);
    let run = runner.run_one(sweep.case(&[smooth, 0], 0)?)?;
    let times = run.slip_times();
    data.value("fig12.slip_times_apart", range(&times));
    surfaces(runner, &mut data)?;
    kinetic(runner, &mut data)?;
    Ok(data)
}

/// The largest distance of a value from the mean.
fn farthest(values: &[f64]) -> f64 {
    let center = mean(values);
    largest(values.iter().map(|value| (value - center).abs()))
}

/// How often five surfaces are as close together as the paper's.
fn surfaces(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let statics = runner
        .study("fig12_surfaces")?
        .values(&[], "static_friction_star");
    let close: Vec<f64> = statics
        .chunks_exact(SURFACES)
        .map(|five| f64::from(u8::from(farthest(five) < DEVIATION)))
        .collect();
    data.value("fig12.fives_within_percent", 100.0 * mean(&close));
    data.value("fig12.standard_deviation", deviation(&statics));
    Ok(())
}

/// The effect of sigma_k* on friction, on the onset and on the fluctuation of kinetic friction.
fn kinetic(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig12_kinetic")?;
    let levels = sweep.axis(0).len();
    // Surface by surface, against no spread at all.
    let change = |quantity: &str| {
        let none = sweep.values(&[0], quantity);
        let changes = (1..levels).flat_map(|k| {
            let values = sweep.values(&[k], quantity);
            let pairs: Vec<f64> = values
                .iter()
                .zip(&none)
                .map(|(value, none)| (value - none).abs())
                .collect();
            pairs
        });
        largest(changes)
    };
    data.value(
        "fig12.static_friction_moved_by_sigma_k",
        change("static_friction_star"),
    );
    let onset = mean(&sweep.values(&[0], "onset_time_star"));
    data.value(
        "fig12.onset_moved_by_sigma_k_percent",
        100.0 * change("onset_time_star") / onset,
    );
    data.value(
        "fig12.first_slip_moved_by_sigma_k",
        change("first_slip_time_star"),
    );
    let long = runner.plan("fig12_fluctuations")?;
    let mut means = Vec::new();
    for k in 0..long.axis(0).len() {
        let runs = runner.run(long.cases(&[k])?)?;
        let fluctuations = runs.iter().map(Run::kinetic_fluctuation);
        means.push(fluctuations.collect::<Result<Vec<f64>, _>>()?);
    }
    let [none, most] = &means[..] else { return Ok(()) };
    data.values("fig12.fluctuation_factor_of_sigma_k", &ratios(most, none));
    Ok(())
}
