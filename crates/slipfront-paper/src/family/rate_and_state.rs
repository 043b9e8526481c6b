//! Friction of rate and state.

use slipfront::exact_solutions::{friction_after_speed_step, rate_and_state_growth};
use slipfront::{Drive, Friction, Lattice, Model, RateAndState, Surface, scales};
use slipfront_plot::Responses;

use super::answer::{Answer, Chapter};
use super::runs::growth_of_disturbance;
use crate::drawing::{Drawing, formula, measured};
use crate::error::PaperError;
use crate::number::Number;

const LAW: RateAndState = RateAndState {
    a: 0.01,
    b: 0.02,
    d_c: 0.5,
    v_0: 0.03,
    mu_0: 0.6,
    theta_0: 0.5 / 0.03,
    slip_speed: 1e-3,
};
const V_STAR: f64 = 0.03;
const DT_STAR: f64 = 0.05;
/// Stiffness of the drive over the critical one.
const RATIOS: [f64; 6] = [0.7, 0.85, 0.95, 1.05, 1.2, 1.5];

/// Growth rate of a small disturbance of steady sliding of blocks that move as one.
fn computed(k_drive: f64, damping: f64) -> f64 {
    let lattice = Lattice::free(2, 2);
    let drive = Drive {
        k_drive,
        ..Drive::along_x(V_STAR)
    };
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    let model = Model::new(lattice, surface, drive, damping, 0.0, Friction::RateAndState(LAW));
    growth_of_disturbance(model, DT_STAR, 60.0, 36.0)
}

pub(super) fn chapter() -> Result<Chapter, PaperError> {
    let mut answers = Vec::new();
    for ratio in [0.1, 10.0] {
        let (v_1, v_2) = (0.01, 0.01 * ratio);
        let mut theta = LAW.d_c / v_1;
        let (dt, steps) = (0.5, 20);
        for _ in 0..steps {
            theta = LAW.evolve(theta, v_2, dt);
        }
        let slip = v_2 * dt * f64::from(steps);
        answers.push(Answer::new(
            format!("μ - μ_ss after a step of speed by {ratio} and a slip of {slip}"),
            [
                friction_after_speed_step(&LAW, v_1, v_2, slip),
                LAW.coefficient(v_2, theta) - LAW.steady_coefficient(v_2),
            ],
            (2e-15, "rounding: the state is exact at constant speed"),
        ));
    }
    let damping = scales::damping(0.1);
    let critical = LAW.critical_stiffness(1.0, damping, V_STAR);
    answers.push(Answer::new(
        "critical stiffness k_c at V* = 0.03: where the growth rate of the cubic is 0",
        [0.0, rate_and_state_growth(&LAW, 1.0, V_STAR, critical, damping)],
        (1e-9, "rounding of the roots of the cubic"),
    ));
    let exact = |ratio: f64| rate_and_state_growth(&LAW, 1.0, V_STAR, ratio * critical, damping);
    let found = RATIOS.map(|ratio| computed(ratio * critical, damping));
    for (ratio, found) in RATIOS.into_iter().zip(found) {
        answers.push(Answer::new(
            format!("growth rate on a drive of {ratio} k_c"),
            [exact(ratio), found],
            (2.5e-4 * DT_STAR / 0.05, "of first order in the step"),
        ));
    }
    let fine: Vec<f64> = (0..=50).map(|k| 0.6 + 0.02 * f64::from(k)).collect();
    Ok(Chapter {
        title: "Rate and state",
        name: "rate-and-state",
        text: include_str!("text/rate_and_state.md"),
        answers,
        picture: Some((
            "Growth rate of a small disturbance of steady sliding against the stiffness of the drive: softer than k_c it grows into stick-slip.",
            Drawing::Responses(Responses {
                x_title: "stiffness of the drive over k_c".to_owned(),
                y_title: "growth rate".to_owned(),
                curves: vec![
                    formula("exact", &fine, exact),
                    measured("computed", &RATIOS, &found.map(Number::exact)),
                ],
                ..Responses::default()
            }),
        )),
    })
}
