//! Fig. 10: kinetic over static friction, R*.

use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::Number;
use crate::run::{Run, curves};
use crate::runner::FigureRunner;
use crate::statistics::{largest, mean, rises};
use crate::sweep::Sweep;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig10")?;
    let ratios = sweep.axis(0);
    let runs = runner.run(sweep.first_cases()?)?;
    data.panel(
        "fig10",
        "Friction and sliding blocks for four ratios of kinetic to static friction.",
        curves(&runs, |k| format!("R* = {}", ratios[k])),
    );
    // By how much friction falls from its peak, for each surface.
    let fall = |k: usize| {
        let [peaks, levels] =
            ["static_friction_star", "kinetic_friction_star"].map(|quantity| sweep.values(&[k], quantity));
        let falls: Vec<f64> = peaks.iter().zip(&levels).map(|(a, b)| a - b).collect();
        Number::of(&falls)
    };
    let falls: Vec<f64> = (0..ratios.len()).map(|k| fall(k).value).collect();
    data.value("largest_rise_of_fall", largest(rises(&falls)));
    data.number("fall_at_one", fall(ratios.len() - 1));
    let kinetics = sweep.means(&[], "kinetic_friction_star");
    let middle = (0..ratios.len()).filter(|&k| [0.5, 0.75].contains(&ratios[k]));
    data.value(
        "worst_excess_in_the_middle",
        largest(middle.map(|k| (kinetics[k] - ratios[k]).abs())),
    );
    excess_of_lowest(runner, &sweep, data)
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
    data.values("excess_of_lowest", &excess(usual));
    // The first swing of friction after the onset, which dominates the figure.
    let first_swing = |run: &Run| {
        let onset = run.record.summary.onset_time_star;
        mean(&run.friction_between(onset, onset + 2.5 / run.case.groups.v_star))
    };
    let early = runner.run(sweep.cases(&[0])?)?.iter().map(first_swing).collect();
    data.values("early_excess_of_lowest", &excess(early));
    let long = runner.study("fig10_long")?.values(&[], "kinetic_friction_star");
    data.values("long_excess_of_lowest", &excess(long));
    let windows = [
        (
            "from t_s* to t_s* + 2.5/V*: the first swing",
            "early_excess_of_lowest",
        ),
        (
            "from t_s* + 2.5/V* to 8/V*: as everywhere else here",
            "excess_of_lowest",
        ),
        ("from 12/V* to 60/V*", "long_excess_of_lowest"),
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
