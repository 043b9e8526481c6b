//! Fig. 18: the shape of a cavity.

use crate::drawing::{Drawing, stress_maps};
use crate::error::PaperError;
use crate::measurements::{Found, Number, largest, smallest};
use crate::runner::Bench;
use slipfront_plot::{Bar, BarChart, BarGroup};
use slipfront_run::study::REDUCTION;

pub(super) fn find(bench: &mut Bench) -> Result<Found, PaperError> {
    let mut found = Found::default();
    let sweep = bench.study("fig18")?;
    let names = sweep.names(0);
    let reductions: Vec<Number> = (0..names.len()).map(|k| sweep.number(&[k], REDUCTION)).collect();
    let bar = |(name, number): (&String, &Number)| {
        let [mean, low, high] = number.ends();
        Bar {
            label: name.clone(),
            mean,
            low,
            high,
        }
    };
    found.panel(
        "fig18a",
        "Reduction of static friction by cavities of seven shapes, each under 10 % of the slider: means of five surfaces \
         with their 95 % intervals.",
        Drawing::Bars(BarChart {
            y_title: "reduction of \u{3bc}\u{209b}* (%)".to_owned(),
            groups: vec![BarGroup {
                label: String::new(),
                bars: names.iter().zip(&reductions).map(bar).collect(),
            }],
            ..BarChart::default()
        }),
    );
    let cases = (1..names.len())
        .map(|k| sweep.case(&[k], 0))
        .collect::<Result<_, _>>()?;
    let mut maps = Vec::new();
    for (run, name) in bench.run(cases)?.iter().zip(&names[1..]) {
        maps.push(run.stress_map(run.instant('C')?, name)?);
    }
    found.panel(
        "fig18b",
        "Contact stress around six of them at the peak of friction.",
        stress_maps(maps, 3),
    );
    let means: Vec<f64> = reductions.iter().map(|number| number.value).collect();
    let polygons = means[1..].iter().copied();
    found.value(
        "fig18.spread_percent",
        largest(polygons.clone()) - smallest(polygons),
    );
    found.value(
        "fig18.farthest_from_circle_percent",
        largest(means.iter().map(|mean| (mean - means[0]).abs())),
    );
    // Round and sharp stand in pairs after the circle.
    let pairs = means[1..].chunks_exact(2).map(|pair| (pair[1] - pair[0]).abs());
    found.value("fig18.sharpness_percent", largest(pairs));
    Ok(found)
}
