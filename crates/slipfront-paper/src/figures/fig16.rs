//! Fig. 16: elongated cavities, and grooves as their limit; and how general the 31 % is (D9).

use crate::drawing::{Drawing, formula, measured};
use crate::error::PaperError;
use crate::measurements::{Found, Number, Table, largest, mean, rises, smallest};
use crate::runner::Bench;
use slipfront_plot::Responses;
use slipfront_run::study::REDUCTION;

/// Levels of the second axis.
const ACROSS: usize = 0;
const ALONG: usize = 1;

pub(super) fn find(bench: &mut Bench) -> Result<Found, PaperError> {
    let mut found = Found::default();
    let sweep = bench.study("fig16")?;
    let elongations = sweep.axis(0);
    let curve = |way: usize| -> Vec<Number> {
        (0..elongations.len())
            .map(|k| sweep.number(&[k, way], REDUCTION))
            .collect()
    };
    let (across, along) = (curve(ACROSS), curve(ALONG));
    let grooves = bench.study("fig16_grooves")?;
    let groove = |way: usize| grooves.number(&[way], REDUCTION);
    let ends = [elongations[0], elongations[elongations.len() - 1]];
    let level = |way: usize, label: &str| formula(label, &ends, |_| groove(way).value);
    found.panel(
        "fig16",
        "Reduction of static friction by an elliptical cavity under 10 % of the slider against its elongation, across \
         and along the sliding direction, beside grooves of the same area.",
        Drawing::Responses(Responses {
            x_title: "elongation w".to_owned(),
            y_title: "reduction of \u{3bc}\u{209b}* (%)".to_owned(),
            curves: vec![
                measured("across", &elongations, &across),
                measured("along", &elongations, &along),
                level(ACROSS, "groove across"),
                level(ALONG, "groove along"),
            ],
            ..Responses::default()
        }),
    );
    let circle = across[0];
    found.number("fig16.circle_percent", circle);
    found.number("fig16.groove_across_percent", groove(ACROSS));
    let means = |numbers: &[Number]| -> Vec<f64> { numbers.iter().map(|number| number.value).collect() };
    found.value("fig16.least_rise_across", smallest(rises(&means(&across))));
    found.value("fig16.gain_across", largest(means(&across)) - circle.value);
    let losses: Vec<f64> = means(&along)[1..]
        .iter()
        .map(|reduction| circle.value - reduction)
        .collect();
    found.value("fig16.mean_loss_along", mean(&losses));
    found.value("fig16.largest_loss_along", largest(losses));
    found.value(
        "fig16.groove_along_beside_circle",
        (groove(ALONG).value - circle.value).abs(),
    );

    let general = bench.study("fig16_generality")?;
    let names = general.names(0);
    let reductions: Vec<Number> = (0..names.len())
        .map(|k| general.number(&[k], REDUCTION))
        .collect();
    let others = reductions
        .iter()
        .map(|number| (number.value - reductions[0].value).abs());
    found.value("fig16.circle_moved_by_size_and_speed", largest(others));
    found.tables.push(Table {
        name: "fig16_generality".to_owned(),
        caption: "The 31 % of the circular cavity under 10 % of the slider, in other sizes and at other speeds (D9)."
            .to_owned(),
        header: ["slider", "reduction of mu_s* (%)"].map(str::to_owned).to_vec(),
        rows: names
            .into_iter()
            .zip(&reductions)
            .map(|(name, number)| vec![name, crate::claims::with_interval(number, 1)])
            .collect(),
    });
    Ok(found)
}
