//! Fig. 9: damping.

use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{Run, curves, mu_star, on_each};
use crate::runner::FigureRunner;
use crate::statistics::{largest, range, rises, smallest};
use crate::sweep::Sweep;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig09")?;
    let dampings = sweep.axis(0);
    let runs = runner.run(sweep.first_cases()?)?;
    data.panel(
        "fig09",
        "Friction and sliding blocks for six dampings.",
        curves(&runs, |k| format!("\u{3a9}* = {}", dampings[k])),
    );
    let first_slip = smallest(on_each(&runs, Run::first_slip)?);
    // One step short of it: friction may differ from where the first block moves.
    let before = [0.0, first_slip - runs[0].case.time_plan.dt_star];
    let difference = |window| runs[0].largest_difference_of(&runs, window, mu_star);
    data.value("difference_before_slip", difference(before));
    let onset = runs[0].record.summary.onset_time_star;
    let after = [onset, onset + 2.5 / runs[0].case.groups.v_star];
    data.value("difference_after_onset", difference(after));
    friction(&sweep, &runs, data)
}

/// The effect of damping on static and kinetic friction, on the number of sliding blocks and on the fluctuation of friction.
fn friction(sweep: &Sweep, runs: &[Run], data: &mut FigureData) -> Result<(), PaperError> {
    let dampings = sweep.axis(0);
    let statics = sweep.means(&[], "static_friction_star");
    data.value("static_friction_spread", range(&statics));
    let kinetics = sweep.means(&[], "kinetic_friction_star");
    data.value("least_rise_of_kinetic_friction", smallest(rises(&kinetics)));
    // With stick-slip and without it, each on its own.
    let first_strong = dampings.partition_point(|&omega| omega < 1.0);
    let (weak, strong) = kinetics.split_at(first_strong);
    data.value(
        "least_rise_within_regimes",
        smallest([rises(weak), rises(strong)].concat()),
    );
    let sliding = (first_strong..dampings.len()).flat_map(|k| sweep.values(&[k], "sliding_percent_kinetic"));
    data.value("least_sliding_of_strong_percent", smallest(sliding));
    let fluctuations = on_each(&runs[first_strong..], Run::kinetic_fluctuation)?;
    data.value(
        "fluctuation_of_strong_percent",
        100.0 * largest(fluctuations) / runs[sweep.level(0.1)].kinetic_fluctuation()?,
    );
    Ok(())
}
