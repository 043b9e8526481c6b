//! Fig. 9: damping.

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{Run, mu_star};
use crate::runner::FigureRunner;
use crate::statistics::{largest, mean, range, rises, smallest};
use crate::sweep::Sweep;

pub(super) fn measure(runner: &mut FigureRunner) -> Result<FigureData, PaperError> {
    let mut data = FigureData::default();
    let sweep = runner.study("fig09")?;
    let dampings = sweep.axis(0);
    let runs = runner.run(sweep.first_cases()?)?;
    let curves = runs
        .iter()
        .zip(&dampings)
        .map(|(run, omega)| run.curve(&format!("\u{3a9}* = {omega}")));
    data.panel(
        "fig09",
        "Friction and sliding blocks for six dampings.",
        Drawing::Curves(curves.collect()),
    );
    let first_slip = smallest(
        runs.iter()
            .map(Run::first_slip)
            .collect::<Result<Vec<f64>, _>>()?,
    );
    // One step short of it: friction may differ from where the first block moves.
    let before = [0.0, first_slip - runs[0].case.time_plan.dt_star];
    let differences = runs
        .iter()
        .map(|run| runs[0].largest_difference(run, before, mu_star));
    data.value("fig09.difference_before_slip", largest(differences));
    let onset = runs[0].record.summary.onset_time_star;
    let after = [onset, onset + 2.5 / runs[0].case.groups.v_star];
    let differences = runs
        .iter()
        .map(|run| runs[0].largest_difference(run, after, mu_star));
    data.value("fig09.difference_after_onset", largest(differences));
    friction(&sweep, &runs, &mut data)?;
    Ok(data)
}

/// The effect of damping on static and kinetic friction, on the number of sliding blocks and on the fluctuation of friction.
fn friction(sweep: &Sweep, runs: &[Run], data: &mut FigureData) -> Result<(), PaperError> {
    let dampings = sweep.axis(0);
    let means = |quantity: &str| -> Vec<f64> {
        (0..dampings.len())
            .map(|k| mean(&sweep.values(&[k], quantity)))
            .collect()
    };
    let statics = means("static_friction_star");
    data.value("fig09.static_friction_spread", range(&statics));
    let kinetics = means("kinetic_friction_star");
    data.value("fig09.least_rise_of_kinetic_friction", smallest(rises(&kinetics)));
    // With stick-slip and without it, each on its own.
    let (weak, strong) = kinetics.split_at(dampings.partition_point(|&omega| omega < 1.0));
    data.value(
        "fig09.least_rise_within_regimes",
        smallest([rises(weak), rises(strong)].concat()),
    );
    let strong: Vec<usize> = (0..dampings.len()).filter(|&k| dampings[k] >= 1.0).collect();
    let sliding = strong
        .iter()
        .flat_map(|&k| sweep.values(&[k], "sliding_percent_kinetic"));
    data.value("fig09.least_sliding_of_strong_percent", smallest(sliding));
    let fluctuations = strong
        .iter()
        .map(|&k| runs[k].kinetic_fluctuation())
        .collect::<Result<Vec<f64>, _>>()?;
    let usual = dampings.iter().position(|&omega| omega == 0.1).unwrap_or(0);
    data.value(
        "fig09.fluctuation_of_strong_percent",
        100.0 * largest(fluctuations) / runs[usual].kinetic_fluctuation()?,
    );
    Ok(())
}
