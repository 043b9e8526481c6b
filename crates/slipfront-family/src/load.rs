//! Non-uniform pressure.

use slipfront::scales;

use crate::answer::{Answer, Chapter};
use crate::error::FamilyError;
use crate::runs::{AnswerRun, ROUNDING, rounding};

const V_STAR: f64 = 0.03;

pub(crate) fn chapter() -> Result<Chapter, FamilyError> {
    let mut answers = Vec::new();
    for (along, slope) in [("x", 0.8), ("y", -0.5)] {
        let text = format!(
            "friction.sigma_static_star = 0\nfriction.sigma_kinetic_star = 0\n[load]\n\
             profile = {{ along = \"{along}\", relative_slope = {slope} }}\n[drive]\nv_star = {V_STAR}\n\
             [time]\nduration_star = 100\nstep = 0.01"
        );
        let run = AnswerRun::of_case("load", &text)?;
        // The outermost blocks, half a block from the edge, have the least pressure.
        let least: f64 = 1.0 - f64::abs(slope) * (1.0 - 1.0 / 25.0);
        answers.push(Answer::seen_late(
            format!("t* of the first slip, slope {slope} along {along}"),
            [least / (0.375 * V_STAR), run.first_slip()],
            (0.01, "slip is detected at the next step"),
        ));
        let text = format!(
            "friction.sigma_static_star = 0\nfriction.sigma_kinetic_star = 0\nslider.omega_star = 1\n[load]\n\
             profile = {{ along = \"{along}\", relative_slope = {slope} }}\n[drive]\nv_star = 0.2\n\
             [time]\nduration_star = 200\nstep = 0.1"
        );
        answers.push(Answer::new(
            format!("steady level at V* = 0.2, slope {slope} along {along}"),
            [
                0.5 + scales::damping(1.0) * 0.2,
                AnswerRun::of_case("whole load", &text)?.mu_star_at(200.0),
            ],
            (rounding(200.0 * 0.2), ROUNDING),
        ));
    }
    Ok(Chapter {
        title: "Non-uniform load",
        name: "load",
        text: include_str!("text/load.md"),
        answers,
        picture: None,
    })
}
