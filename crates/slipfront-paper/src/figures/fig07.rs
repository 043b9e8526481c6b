//! Fig. 7: a fast slider, which the paper calls unstable, with several time steps (D7, D11).

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{FigureRun, mu_star, on_each};
use crate::runner::FigureRunner;
use crate::statistics::{largest, range, smallest};
use crate::sweep::ParameterSweep;

/// Negligible difference of static friction: a tenth of the scatter over surfaces, 0.015 (Fig. 12).
const SAME: f64 = 0.0015;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let (_, runs) = runner.study_with_runs("fig07", 1)?;
    let [paper, .., finest] = &runs[..] else {
        return Ok(());
    };
    data.panel(
        "fig07",
        "V* = 0.2 with the paper's time step and with a step 27 times smaller. The fluctuation is the same, so it is not an instability.",
        Drawing::Curves(vec![
            paper.curve(&format!("\u{394}t* = {:.3}", paper.case.time_plan.dt_star)),
            finest.curve(&format!("\u{394}t* = {}", finest.case.time_plan.dt_star)),
        ]),
    );
    let amplitudes = on_each(&runs, FigureRun::kinetic_fluctuation)?;
    let amplitude = amplitudes[amplitudes.len() - 1];
    let least = smallest(amplitudes.iter().copied());
    let slow = runner.run_one(runner.case("table1/case8", &[])?)?;
    data.value("fluctuation", amplitude);
    data.value("fluctuation_over_slow", amplitude / slow.kinetic_fluctuation()?);
    data.value("least_fluctuation_over_slow", least / slow.kinetic_fluctuation()?);
    data.value(
        "fluctuation_spread_percent",
        100.0 * range(&amplitudes) / amplitude,
    );
    let until = finest.record.summary.onset_time_star + 2.5 / finest.case.groups.v_star;
    data.value(
        "difference_between_steps",
        paper.largest_difference(finest, [0.0, until], mu_star),
    );
    steps(&runner.study("fig07_steps")?, data);
    literal(&runner.study("fig07_literal")?, data);
    Ok(())
}

/// Static friction for time steps including the paper's (Eq. 13), at several speeds (D11).
fn steps(sweep: &ParameterSweep, data: &mut FigureData) {
    // A quantity at one speed for all steps: the first step is the paper's, and the last is the finest.
    let [slow, fast] = [0.01, 0.2].map(|v| sweep.level(v));
    let over_steps = |speed: usize, quantity: &str| -> Vec<f64> {
        let steps = 0..sweep.axis(1).len();
        steps
            .map(|step| sweep.number(&[speed, step], quantity).value)
            .collect()
    };
    let statics = |speed| over_steps(speed, "static_friction_star");
    data.value("static_friction_spread_fast", range(&statics(fast)));
    let errors = |speed| -> Vec<f64> {
        let statics = statics(speed);
        let finest = statics[statics.len() - 1];
        statics.iter().map(|mu| (mu - finest).abs()).collect()
    };
    let of_paper_step = (0..sweep.axis(0).len()).map(|speed| errors(speed)[0]);
    data.value("error_of_paper_step", largest(of_paper_step));
    // Ratio of the coarsest step with the same static friction to the paper's step.
    let same = over_steps(slow, "dt_star").into_iter().zip(errors(slow));
    let same: Vec<f64> = same
        .filter(|(_, error)| *error < SAME)
        .map(|(dt, _)| dt)
        .collect();
    let paper_step = over_steps(slow, "dt_star")[0];
    data.value("paper_steps_in_one_that_does", largest(same) / paper_step);
}

/// Eq. 4 as printed: the time step at which kinetic friction is about R*, as in the paper, at several speeds
/// (D11).
fn literal(sweep: &ParameterSweep, data: &mut FigureData) {
    let (speeds, steps) = (sweep.axis(0), sweep.axis(1));
    let best: Vec<f64> = (0..speeds.len())
        .map(|speed| {
            let number = |step: usize, quantity: &str| sweep.number(&[speed, step], quantity).value;
            let excess: Vec<f64> = (0..steps.len())
                .map(|step| number(step, "kinetic_friction_star") - number(step, "r_star"))
                .collect();
            zero(&steps, &excess)
        })
        .collect();
    data.value("literal_step_ratio", best[best.len() - 1] / best[0]);
    let rows = speeds.iter().zip(&best);
    data.table(
        "fig07_literal",
        "Time step at which Eq. 4 as printed gives mu_k* = R* = 0.5, interpolated between steps from 0.05 to 0.3, and the step of \
         Eq. 13. Smaller steps give a higher mu_k*, larger steps a lower one (D2, D11).",
        ["V*", "dt*", "(2/3) V*"],
        rows.map(|(v, dt)| [v.to_string(), format!("{dt:.3}"), format!("{:.4}", 2.0 / 3.0 * v)]),
    );
}

/// Position at which values fall through zero, interpolated between two places; NaN if they do not.
fn zero(places: &[f64], values: &[f64]) -> f64 {
    let crossing = (1..values.len()).find(|&k| values[k - 1] > 0.0 && values[k] <= 0.0);
    crossing.map_or(f64::NAN, |k| {
        let share = values[k - 1] / (values[k - 1] - values[k]);
        places[k - 1] + share * (places[k] - places[k - 1])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_lies_between_the_signs() {
        assert_eq!(zero(&[0.1, 0.2, 0.4], &[0.3, 0.1, -0.1]), 0.2 + 0.5 * 0.2);
        assert!(zero(&[0.1, 0.2], &[-0.1, -0.2]).is_nan());
    }
}
