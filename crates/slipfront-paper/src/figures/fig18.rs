//! Fig. 18: the shape of a cavity.

use crate::drawing::{Drawing, estimate, stress_maps};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::{MeasuredNumber, values};
use crate::run::peak_maps;
use crate::runner::FigureRunner;
use crate::statistics::{farthest, largest, range};
use slipfront_plot::{Bar, BarChart, BarGroup, FieldMap};
use slipfront_study::REDUCTION;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig18")?;
    let names = sweep.names(0);
    let reductions = sweep.numbers(&[], REDUCTION);
    let bar = |(name, number): (&String, &MeasuredNumber)| Bar {
        label: name.clone(),
        value: estimate(number),
    };
    data.panel(
        "fig18a",
        "a: reduction of static friction by cavities of seven shapes, each with 10 % coverage. Bars: means over five random surfaces; \
         error bars: 95 % confidence intervals of these means.",
        Drawing::Bars(BarChart {
            y_title: "reduction of \u{3bc}\u{209b}* (%)".to_owned(),
            groups: vec![BarGroup {
                label: String::new(),
                bars: names.iter().zip(&reductions).map(bar).collect(),
            }],
            ..BarChart::default()
        }),
    );
    let runs = runner.run(sweep.first_cases()?.split_off(1))?;
    let maps = peak_maps(&runs, &names[1..])?;
    // After the circle come triangles, squares and pentagons, each round and sharp.
    let lettered = [(0, "b: "), (1, "c: "), (2, ""), (4, "d: "), (5, "e: "), (3, "")];
    let maps = lettered.map(|(index, letter)| FieldMap {
        label: format!("{letter}{}", maps[index].label),
        ..maps[index].clone()
    });
    data.panel(
        "fig18_maps",
        "b-e: contact stress at the friction peak around the shapes with the fewest and with the most vertices (the text of the paper \
         does not name the shapes of its four maps). The maps without a letter show the squares.",
        stress_maps(maps.to_vec(), 3),
    );
    let means = values(&reductions);
    data.value("spread_percent", range(&means[1..]));
    let is_exception = |name: &str| name == "triangle, sharp";
    let others = means
        .iter()
        .zip(&names)
        .skip(1)
        .filter(|(_, name)| !is_exception(name));
    let others: Vec<f64> = others.map(|(mean, _)| *mean).collect();
    data.value("spread_without_sharp_triangle", range(&others));
    data.value("farthest_from_circle_percent", farthest(&means, means[0]));
    // After the circle, round and sharp shapes are in pairs.
    let pairs = means[1..].chunks_exact(2).map(|pair| (pair[1] - pair[0]).abs());
    let pairs: Vec<f64> = pairs.collect();
    data.value("sharpness_percent", largest(pairs.iter().copied()));
    data.value("sharpness_beyond_triangle", largest(pairs[1..].iter().copied()));
    Ok(())
}
