//! Fig. 10: kinetic over static friction, R*.

use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::MeasuredNumber;
use crate::run::{FigureRun, curves, on_each};
use crate::runner::FigureRunner;
use crate::statistics::{largest, mean, rises};

/// Ends of the time windows, from the end of the transition on, over which the kinetic friction of the lowest
/// R* is averaged; the last one is the end of the run, 8/V*.
const WINDOW_ENDS: [f64; 6] = [150.0, 160.0, 180.0, 200.0, 220.0, 266.7];

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let (sweep, runs) = runner.study_with_runs("fig10", 1)?;
    let ratios = sweep.axis(0);
    data.panel(
        "fig10",
        "Friction and sliding blocks for four ratios of kinetic to static friction.",
        curves(&runs, |k| format!("R* = {}", ratios[k])),
    );
    // Fall of friction from its peak, for each surface.
    let fall = |k: usize| {
        let [peaks, levels] =
            ["static_friction_star", "kinetic_friction_star"].map(|quantity| sweep.values(&[k], quantity));
        let falls: Vec<f64> = peaks.iter().zip(&levels).map(|(a, b)| a - b).collect();
        MeasuredNumber::from_values(&falls)
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
    excess_of_lowest(runner, data)
}

/// Excess of kinetic friction over R* at the lowest R*, by the window over which it is averaged.
fn excess_of_lowest(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let runs = runner.run(runner.plan("fig10_windows")?.cases(&[])?)?;
    let excess_in = |window: &dyn Fn(&FigureRun) -> Result<[f64; 2], PaperError>| {
        on_each(&runs, |run| {
            let [from, until] = window(run)?;
            Ok(mean(&run.friction_between(from, until)) - run.case.groups.r_star)
        })
    };
    let mut windows = Vec::new();
    for end in WINDOW_ENDS {
        let excess = excess_in(&|run| Ok([run.instant('E')?.time_star, end]))?;
        windows.push((format!("from E to t* = {end}"), excess));
    }
    let excess = excess_in(&FigureRun::kinetic_window)?;
    windows.push((
        "from t_s* + 2.5/V* to 8/V* (used in all other results)".to_owned(),
        excess,
    ));
    let long = runner.study("fig10_long")?.values(&[], "kinetic_friction_star");
    let excess = runs.iter().zip(long).map(|(run, mu)| mu - run.case.groups.r_star);
    windows.push(("from 12/V* to 60/V*".to_owned(), excess.collect()));
    let rows = windows.iter().map(|(window, excess)| {
        let below = excess.iter().filter(|&&excess| excess < 0.0).count();
        let below = format!("{below} of {}", excess.len());
        [
            window.clone(),
            MeasuredNumber::from_values(excess).shown(3),
            below,
        ]
    });
    data.table(
        "fig10_windows",
        "Difference mu_k* - R* at R* = 0.25 for several averaging windows (D8), and the number of surfaces with mu_k* \
         below R*. The end of the transition, E, is at t* = 87.",
        ["window", "mu_k* - R*", "below R*"],
        rows,
    );
    for (place, name) in [(2, "until_180"), (5, "until_the_end")] {
        data.values(&format!("excess_of_lowest_{name}"), &windows[place].1);
    }
    Ok(())
}
