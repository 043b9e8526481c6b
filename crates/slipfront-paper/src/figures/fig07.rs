//! Fig. 7: a fast slider, which the paper calls unstable, in several time steps (D7, D11).

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::measurements::{Found, deviation, largest, smallest};
use crate::runner::{Bench, mu_star};

pub(super) fn find(bench: &mut Bench) -> Result<Found, PaperError> {
    let mut found = Found::default();
    let sweep = bench.study("fig07")?;
    let names = sweep.names(0);
    let cases = (0..names.len())
        .map(|k| sweep.case(&[k], 0))
        .collect::<Result<_, _>>()?;
    let runs = bench.run(cases)?;
    let [paper, .., finest] = &runs[..] else {
        return Ok(found);
    };
    found.panel(
        "fig07",
        "V* = 0.2 in the paper's time step and in one 27 times finer: the fluctuation is the same, and so is no instability.",
        Drawing::Curves(vec![
            paper.curve(&format!("\u{394}t* = {:.3}", paper.case.time_plan.dt_star)),
            finest.curve(&format!("\u{394}t* = {}", finest.case.time_plan.dt_star)),
        ]),
    );
    let amplitude = |run: &crate::runner::Run| -> Result<f64, PaperError> {
        let [from, until] = run.kinetic_window()?;
        Ok(deviation(&run.friction_between(from, until)))
    };
    let amplitudes = runs.iter().map(amplitude).collect::<Result<Vec<f64>, _>>()?;
    let slow = bench.run_one(bench.case("fig04", &[])?)?;
    found.value("fig07.fluctuation", amplitudes[amplitudes.len() - 1]);
    found.value(
        "fig07.fluctuation_over_slow",
        amplitudes[amplitudes.len() - 1] / amplitude(&slow)?,
    );
    let spread = largest(amplitudes.iter().copied()) - smallest(amplitudes.iter().copied());
    found.value(
        "fig07.fluctuation_spread_percent",
        100.0 * spread / amplitudes[amplitudes.len() - 1],
    );
    let until = finest.record.summary.onset_time_star + 2.5 / finest.case.groups.v_star;
    let differences = runs
        .iter()
        .map(|run| run.largest_difference(finest, [0.0, until], mu_star));
    found.value("fig07.difference_between_steps", largest(differences));
    // D11: how far do fine steps lead from coarse ones, at low and at high speed?
    let steps = bench.study("fig07_steps")?;
    for (speed, name) in ["slow", "fast"].into_iter().enumerate() {
        let statics: Vec<f64> = (0..steps.axis(1).len())
            .flat_map(|step| steps.values(&[speed, step], "static_friction_star"))
            .collect();
        let spread = largest(statics.iter().copied()) - smallest(statics.iter().copied());
        found.value(&format!("fig07.static_friction_spread_{name}"), spread);
    }
    Ok(found)
}
