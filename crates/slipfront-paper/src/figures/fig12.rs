//! Fig. 12: static friction against the spread of the local coefficients.

use crate::drawing::{Drawing, measured};
use crate::error::PaperError;
use crate::measurements::{Found, Number, deviation, largest, mean, rises, smallest};
use crate::runner::{Bench, Run};
use slipfront_plot::Responses;

/// Surfaces from which the paper takes each mean.
const SURFACES: usize = 5;
/// The largest deviation from such a mean that the paper has seen.
const DEVIATION: f64 = 0.015;

pub(super) fn find(bench: &mut Bench) -> Result<Found, PaperError> {
    let mut found = Found::default();
    let sweep = bench.study("fig12")?;
    let (spreads, speeds) = (sweep.axis(0), sweep.axis(1));
    let mut curves = Vec::new();
    let (mut deviations, mut steps, mut limits) = (Vec::new(), Vec::new(), Vec::new());
    for (v, speed) in speeds.iter().enumerate() {
        let numbers: Vec<Number> = (0..spreads.len())
            .map(|k| sweep.number(&[k, v], "static_friction_star"))
            .collect();
        for k in 0..spreads.len() {
            deviations.push(farthest(&sweep.values(&[k, v], "static_friction_star")));
        }
        let means: Vec<f64> = numbers.iter().map(|number| number.value).collect();
        steps.extend(rises(&means));
        limits.push((means[0] - 1.0).abs());
        curves.push(measured(&speed.to_string(), &spreads, &numbers));
    }
    found.panel(
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
    found.value("fig12.largest_deviation", largest(deviations));
    found.value("fig12.largest_rise", largest(steps));
    found.value("fig12.distance_of_limit", largest(limits));
    // On a smooth surface no block slips before the others.
    let smooth = spreads.iter().position(|&spread| spread == 0.0).unwrap_or(0);
    let run = bench.run_one(sweep.case(&[smooth, 0], 0)?)?;
    let times = run.slip_times();
    found.value(
        "fig12.slip_times_apart",
        largest(times.iter().copied()) - smallest(times.iter().copied()),
    );
    surfaces(bench, &mut found)?;
    kinetic(bench, &mut found)?;
    Ok(found)
}

/// The largest distance from the mean.
fn farthest(values: &[f64]) -> f64 {
    let center = mean(values);
    largest(values.iter().map(|value| (value - center).abs()))
}

/// How often five surfaces are as close together as the paper's.
fn surfaces(bench: &mut Bench, found: &mut Found) -> Result<(), PaperError> {
    let statics = bench.study("fig12_surfaces")?.values(&[], "static_friction_star");
    let close: Vec<f64> = statics
        .chunks_exact(SURFACES)
        .map(|five| f64::from(u8::from(farthest(five) < DEVIATION)))
        .collect();
    found.value("fig12.fives_within_percent", 100.0 * mean(&close));
    found.value("fig12.standard_deviation", deviation(&statics));
    Ok(())
}

/// What sigma_k* does.
fn kinetic(bench: &mut Bench, found: &mut Found) -> Result<(), PaperError> {
    let sweep = bench.study("fig12_kinetic")?;
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
    found.value(
        "fig12.static_friction_moved_by_sigma_k",
        change("static_friction_star"),
    );
    let onset = mean(&sweep.values(&[0], "onset_time_star"));
    found.value(
        "fig12.onset_moved_by_sigma_k_percent",
        100.0 * change("onset_time_star") / onset,
    );
    found.value(
        "fig12.first_slip_moved_by_sigma_k",
        change("first_slip_time_star"),
    );
    let fluctuation = |run: &Run| -> Result<f64, PaperError> {
        let [from, until] = run.kinetic_window()?;
        Ok(deviation(&run.friction_between(from, until)))
    };
    let long = bench.plan("fig12_fluctuations")?;
    let mut means = Vec::new();
    for k in 0..long.axis(0).len() {
        let runs = bench.run(long.cases(&[k])?)?;
        means.push(runs.iter().map(fluctuation).collect::<Result<Vec<f64>, _>>()?);
    }
    let [none, most] = &means[..] else { return Ok(()) };
    let factors: Vec<f64> = most.iter().zip(none).map(|(most, none)| most / none).collect();
    found.values("fig12.fluctuation_factor_of_sigma_k", &factors);
    Ok(())
}
