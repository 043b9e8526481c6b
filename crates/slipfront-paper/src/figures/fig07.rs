//! Fig. 7: a fast slider, which the paper calls unstable, in several time steps (D7, D11).

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{Run, mu_star, on_each};
use crate::runner::FigureRunner;
use crate::statistics::{largest, range};

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig07")?;
    let runs = runner.run(sweep.first_cases()?)?;
    let [paper, .., finest] = &runs[..] else {
        return Ok(());
    };
    data.panel(
        "fig07",
        "V* = 0.2 in the paper's time step and in one 27 times finer: the fluctuation is the same, and so is no instability.",
        Drawing::Curves(vec![
            paper.curve(&format!("\u{394}t* = {:.3}", paper.case.time_plan.dt_star)),
            finest.curve(&format!("\u{394}t* = {}", finest.case.time_plan.dt_star)),
        ]),
    );
    let amplitudes = on_each(&runs, Run::kinetic_fluctuation)?;
    let amplitude = amplitudes[amplitudes.len() - 1];
    let slow = runner.run_one(runner.case("table1/case8", &[])?)?;
    data.value("fluctuation", amplitude);
    data.value("fluctuation_over_slow", amplitude / slow.kinetic_fluctuation()?);
    data.value(
        "fluctuation_spread_percent",
        100.0 * range(&amplitudes) / amplitude,
    );
    let until = finest.record.summary.onset_time_star + 2.5 / finest.case.groups.v_star;
    let differences = runs
        .iter()
        .map(|run| run.largest_difference(finest, [0.0, until], mu_star));
    data.value("difference_between_steps", largest(differences));
    // D11: how far do fine steps lead from coarse ones, at low and at high speed?
    let steps = runner.study("fig07_steps")?;
    for (speed, name) in ["slow", "fast"].into_iter().enumerate() {
        let statics: Vec<f64> = (0..steps.axis(1).len())
            .flat_map(|step| steps.values(&[speed, step], "static_friction_star"))
            .collect();
        data.value(&format!("static_friction_spread_{name}"), range(&statics));
    }
    Ok(())
}
