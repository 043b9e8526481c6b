//! Programs of speeds.

use super::answer::{Answer, Chapter};
use super::runs::Run;
use crate::error::PaperError;

pub(super) fn chapter() -> Result<Chapter, PaperError> {
    let mut answers = Vec::new();
    let equal = "friction.sigma_static_star = 0\nfriction.sigma_kinetic_star = 0\n";
    let text = format!(
        "{equal}slider.omega_star = 1\ntime.duration_star = 700\n[drive]\n\
         program = [{{ v_star = 0.05, until_star = 300 }}, {{ v_star = 0.2, until_star = 450 }}, {{ v_star = 0.05 }}]"
    );
    let run = Run::of_case("speeds", &text)?;
    for (time, v_star) in [(299.0, 0.05), (449.0, 0.2), (699.0, 0.05)] {
        answers.push(Answer::new(
            format!("level of steady sliding at V* = {v_star}, t* = {time}"),
            [0.5 + f64::sqrt(0.75) * v_star, run.mu_star_at(time)],
            (1e-9, "what is left of the swing, exp(-Ω t/2), and rounding"),
        ));
    }
    let text = format!(
        "{equal}time.duration_star = 200\ntime.step = 0.01\n[drive]\n\
         program = [{{ v_star = 0.05, until_star = 20 }}, {{ v_star = 0, until_star = 70 }}, {{ v_star = 0.1 }}]"
    );
    let run = Run::of_case("hold", &text)?;
    answers.push(Answer::new(
        "first slip after a hold of 50 at V* = 0.05, 0, 0.1: t*",
        [70.0 + (1.0 / 0.375 - 1.0) / 0.1, run.first_slip()],
        (0.01 * (1.0 + 1e-9), "it is seen at the next step"),
    ));
    let energies = run.rows.last().map(|row| row.energies);
    answers.push(Answer::new(
        "relative error of the balance of energy over the same run",
        [0.0, energies.map_or(f64::NAN, |energies| energies.error())],
        (1e-3, "of second order in the step where blocks stop"),
    ));
    Ok(Chapter {
        title: "Programs of speeds",
        name: "program",
        text: include_str!("text/program.md"),
        answers,
        picture: None,
    })
}
