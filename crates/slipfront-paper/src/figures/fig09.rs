//! Fig. 9: damping.

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::values;
use crate::run::{FigureRun, mu_star, on_each};
use crate::runner::FigureRunner;
use crate::statistics::{largest, range, rises, smallest};
use crate::sweep::ParameterSweep;

/// Values of damping that are drawn.
const DRAWN: [f64; 6] = [0.0, 0.03, 0.1, 0.3, 1.0, 3.0];
/// Least rise of N* from one value of damping to the next that counts as a jump, in % of the blocks. In
/// stick-slip, N* rises by less than 3 % from each value to the next.
const JUMP: f64 = 5.0;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let (sweep, runs) = runner.study_with_runs("fig09", 1)?;
    let drawn = DRAWN.map(|omega| runs[sweep.level(omega)].curve(&format!("\u{3a9}* = {omega}")));
    data.panel(
        "fig09",
        "Friction and sliding blocks for six dampings.",
        Drawing::Curves(drawn.into()),
    );
    let first_slip = smallest(on_each(&runs, FigureRun::first_slip)?);
    // One step before the first slip, since friction may differ from there on.
    let before = [0.0, first_slip - runs[0].case.time_plan.dt_star];
    let difference = |window| runs[0].largest_difference_of(&runs, window, mu_star);
    data.value("difference_before_slip", difference(before));
    let onset = runs[0].record.summary.onset_time_star;
    let after = [onset, onset + 2.5 / runs[0].case.groups.v_star];
    data.value("difference_after_onset", difference(after));
    friction(&sweep, &runs, data)
}

/// The effect of damping on static and kinetic friction, on the number of sliding blocks and on the
/// fluctuation of friction.
fn friction(sweep: &ParameterSweep, runs: &[FigureRun], data: &mut FigureData) -> Result<(), PaperError> {
    let dampings = sweep.axis(0);
    let [statics, kinetics, sliding] = [
        "static_friction_star",
        "kinetic_friction_star",
        "sliding_percent_kinetic",
    ]
    .map(|quantity| sweep.numbers(&[], quantity));
    let rows = (0..dampings.len()).map(|k| {
        [
            dampings[k].to_string(),
            statics[k].shown(3),
            kinetics[k].shown(3),
            sliding[k].shown(1),
        ]
    });
    data.table(
        "fig09_damping",
        "Friction and sliding blocks against damping, means over five random surfaces.",
        ["Omega*", "mu_s*", "mu_k*", "N* in the kinetic window (%)"],
        rows,
    );
    let [statics, kinetics, sliding] = [&statics, &kinetics, &sliding].map(|numbers| values(numbers));
    let (one, first_strong) = (sweep.level(1.0), dampings.partition_point(|&omega| omega < 1.0));
    data.value("static_friction_spread", range(&statics));
    data.value("static_friction_spread_up_to_one", range(&statics[..=one]));
    data.value("least_rise_of_kinetic_friction", smallest(rises(&kinetics)));
    let pairs = rises(&kinetics).into_iter().zip(rises(&sliding));
    let without_jump = pairs.filter(|(_, sliding)| *sliding < JUMP).map(|(rise, _)| rise);
    data.value("least_rise_without_jump", smallest(without_jump));
    let sliding = (first_strong..dampings.len()).flat_map(|k| sweep.values(&[k], "sliding_percent_kinetic"));
    data.value("least_sliding_of_strong_percent", smallest(sliding));
    let fluctuations = on_each(&runs[first_strong..], FigureRun::kinetic_fluctuation)?;
    data.value(
        "fluctuation_of_strong_percent",
        100.0 * largest(fluctuations) / runs[sweep.level(0.1)].kinetic_fluctuation()?,
    );
    Ok(())
}
