//! Fig. 12: static friction against the spread of the local coefficients.

use crate::drawing::{Drawing, measured};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::{MeasuredNumber, values};
use crate::run::{FigureRun, on_each};
use crate::runner::FigureRunner;
use crate::statistics::{deviation, distances, farthest, largest, mean, range, ratios, rises, smallest};
use crate::sweep::ParameterSweep;
use slipfront_plot::Responses;

/// Number of surfaces in each mean of the paper.
const SURFACES: usize = 5;
/// The largest deviation from such a mean in the paper.
const DEVIATION: f64 = 0.015;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig12")?;
    let (spreads, speeds) = (sweep.axis(0), sweep.axis(1));
    let mut curves = Vec::new();
    let (mut steps, mut limits, mut reductions) = (Vec::new(), Vec::new(), Vec::new());
    for (v, speed) in speeds.iter().enumerate() {
        let numbers = sweep.numbers(&[v], "static_friction_star");
        let means = values(&numbers);
        reductions.push(100.0 * (1.0 - means[means.len() - 1] / means[0]));
        steps.extend(rises(&means));
        limits.push((means[0] - 1.0).abs());
        curves.push(measured(&speed.to_string(), &spreads, &numbers));
    }
    data.panel(
        "fig12",
        "Static friction against the spread of the local static coefficients, for four speeds. Lines: means over five random \
         surfaces; bands: 95 % confidence intervals of these means.",
        Drawing::Responses(Responses {
            x_title: "spread of static coefficients \u{3c3}\u{209b}*".to_owned(),
            y_title: "static friction \u{3bc}\u{209b}*".to_owned(),
            legend_title: "V*".to_owned(),
            curves,
            note: runner.note_on_bands(),
            ..Responses::default()
        }),
    );
    data.value("largest_rise", largest(steps));
    data.value("distance_of_limit", largest(limits));
    data.value("least_reduction_percent", smallest(reductions));
    // On a smooth surface no block slips before the others.
    let run = runner.run_one(sweep.case(&[sweep.level(0.0), 0], 0)?)?;
    data.value("slip_times_apart", range(&run.slip_times()));
    surfaces(runner, data)?;
    kinetic(runner, data)
}

/// Share of groups of five surfaces with as little scatter as the paper's, at every point of the figure with
/// a spread.
fn surfaces(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig12_surfaces")?;
    let readings: [(&str, &str, Scatter); 2] = [
        ("fives_within", "largest deviation", |five| {
            farthest(five, mean(five))
        }),
        (
            "fives_within_as_standard",
            "standard deviation",
            standard_deviation,
        ),
    ];
    let mut rows = Vec::new();
    for (name, reading, measure) in readings {
        let [all, without_slowest] = [0, 1].map(|first| fives_within_percent(&sweep, first, measure));
        data.value(&format!("{name}_percent"), all);
        data.value(&format!("{name}_without_slowest_percent"), without_slowest);
        rows.push([
            reading.to_owned(),
            format!("{all:.0}"),
            format!("{without_slowest:.0}"),
        ]);
    }
    data.table(
        "fig12_fives",
        "Percentage of 7800 groups of five, taken from two hundred surfaces, with a deviation below 0.015 at all points of Fig. 12 that \
         have a spread, for two readings of \"deviation\".",
        ["reading", "all 24 points (%)", "18 points, without V* = 0.01 (%)"],
        rows,
    );
    Ok(())
}

/// A measure of the scatter of five values.
type Scatter = fn(&[f64]) -> f64;

/// The standard deviation of a sample, with n - 1 in the denominator.
fn standard_deviation(sample: &[f64]) -> f64 {
    let n = sample.len() as f64;
    deviation(sample) * (n / (n - 1.0)).sqrt()
}

/// Share of groups of five surfaces with a scatter below 0.015 at all points from this speed on, %. A group
/// has surfaces at equal distances in the cyclic list.
fn fives_within_percent(sweep: &ParameterSweep, first_speed: usize, scatter: Scatter) -> f64 {
    let points = (0..sweep.axis(0).len())
        .flat_map(|spread| (first_speed..sweep.axis(1).len()).map(move |speed| [spread, speed]));
    let points = points.map(|point| sweep.values(&point, "static_friction_star"));
    let points: Vec<Vec<f64>> = points.collect();
    let surfaces = points[0].len();
    let (mut fives, mut within) = (0_usize, 0_usize);
    for distance in 1..surfaces / SURFACES {
        for first in 0..surfaces {
            let five = |statics: &Vec<f64>| {
                std::array::from_fn::<f64, SURFACES, _>(|k| statics[(first + k * distance) % surfaces])
            };
            fives += 1;
            within += usize::from(points.iter().all(|statics| scatter(&five(statics)) < DEVIATION));
        }
    }
    100.0 * within as f64 / fives as f64
}

/// The effect of sigma_k* on friction, on the onset and on the fluctuation of kinetic friction.
fn kinetic(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig12_kinetic")?;
    let levels = sweep.axis(0).len();
    // Paired by surface, compared with no spread.
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
    fluctuations(runner, data)
}

/// The effect of sigma_k* on the fluctuation of kinetic friction, on a smooth surface and on a rough one.
fn fluctuations(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.plan("fig12_fluctuations")?;
    let (spreads, kinetic_spreads) = (sweep.axis(0), sweep.axis(1));
    let names = ["smooth", "rough"];
    let mut rows = Vec::new();
    for (k, name) in names.into_iter().enumerate() {
        let mut fluctuations = Vec::new();
        for (l, kinetic) in kinetic_spreads.iter().enumerate() {
            let values = on_each(
                &runner.run(sweep.cases(&[k, l])?)?,
                FigureRun::kinetic_fluctuation,
            )?;
            rows.push([
                spreads[k].to_string(),
                kinetic.to_string(),
                MeasuredNumber::from_values(&values).shown(3),
            ]);
            fluctuations.push(values);
        }
        let most = &fluctuations[fluctuations.len() - 1];
        let factor = mean(&ratios(most, &fluctuations[0]));
        data.value(
            &format!("fluctuation_changed_percent_{name}"),
            100.0 * (factor - 1.0).abs(),
        );
    }
    data.table(
        "fig12_fluctuations",
        "Standard deviation of mu* in the kinetic window, for runs to t* = 1000.",
        ["sigma_s*", "sigma_k*", "standard deviation"],
        rows,
    );
    Ok(())
}
