//! Fig. 10: kinetic over static friction, R*.

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::Number;
use crate::run::Run;
use crate::runner::FigureRunner;
use crate::statistics::{largest, mean, rises};
use crate::sweep::Sweep;

pub(super) fn measure(runner: &mut FigureRunner) -> Result<FigureData, PaperError> {
    let mut data = FigureData::default();
    let sweep = runner.study("fig10")?;
    let ratios = sweep.axis(0);
    let runs = runner.run(sweep.first_cases()?)?;
    let curves = runs
        .iter()
        .zip(&ratios)
        .map(|(run, r)| run.curve(&format!("R* = {r}")));
    data.panel(
        "fig10",
        "Friction and sliding blocks for four ratios of kinetic to static friction.",
        Drawing::Curves(curves.collect()),
    );
    // By how much friction falls from its peak, for each surface.
    let fall = |k: usize| {
        let [peaks, levels] =
            ["static_friction_star", "kinetic_friction_star"].map(|quantity| sweep.values(&[k], quantity));
        let falls: Vec<f64> = peaks.iter().zip(&levels).map(|(a, b)| a - b).collect();
        Number::of(&falls)
    };
    let falls: Vec<f64> = (0..ratios.len()).map(|k| fall(k).value).collect();
    data.value("fig10.largest_rise_of_fall", largest(rises(&falls)));
    data.number("fig10.fall_at_one", fall(ratios.len() - 1));
    let excess = |k: usize| mean(&sweep.values(&[k], "kinetic_friction_star")) - ratios[k];
    let middle = (0..ratios.len()).filter(|&k| [0.5, 0.75].contains(&ratios[k]));
    data.value(
        "fig10.worst_excess_in_the_middle",
        largest(middle.map(|k| excess(k).abs())),
    );
    excess_of_lowest(runner, &sweep, &mut data)?;
    Ok(data)
}

/// Kinetic friction above R* at the lowest R*, by the window over which it is averaged.
fn excess_of_lowest(
    runner: &mut FigureRunner,
    sweep: &Sweep,
    data: &mut FigureData,
) -> Result<(), PaperError> {
    let ratio = sweep.axis(0)[0];
    let excess = |mu: Vec<f64>| -> Vec<f64> { mu.iter().map(|mu| mu - ratio).collect() };
    let usual = sweep.values(&[0], "kinetic_friction_star");
    data.values("fig10.excess_of_lowest", &excess(usual));
    // The first swing of friction after the onset, which dominates the figure.
    let first_swing = |run: &Run| {
        let onset = run.record.summary.onset_time_star;
        mean(&run.friction_between(onset, onset + 2.5 / run.case.groups.v_star))
    };
    let early = runner.run(sweep.cases(&[0])?)?.iter().map(first_swing).collect();
    data.values("fig10.early_excess_of_lowest", &excess(early));
    let long = runner.study("fig10_long")?.values(&[], "kinetic_friction_star");
    data.values("fig10.long_excess_of_lowest", &excess(long));
    let windows = [
        (
            "from t_s* to t_s* + 2.5/V*: the first swing",
            "fig10.early_excess_of_lowest",
        ),
        (
            "from t_s* + 2.5/V* to 8/V*: as everywhere else here",
            "fig10.excess_of_lowest",
        ),
        ("from 12/V* to 60/V*", "fig10.long_excess_of_lowest"),
    ];
    let rows = windows.map(|(window, name)| [window.to_owned(), data.numbers[name].shown(3)]);
    data.table(
        "fig10_windows",
        "Kinetic friction above R* at R* = 0.25, by the window over which it is averaged (D8).",
        ["window", "mu_k* - R*"],
        rows,
    );
    Ok(())
}
