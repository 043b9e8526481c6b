//! Static friction that grows with age.

use slipfront::Ageing;
use slipfront::exact_solutions::ageing_slip_time;
use slipfront_plot::{Response, Responses};

use crate::answer::{Answer, Chapter};
use crate::error::FamilyError;
use crate::runs::AnswerRun;

const LAW: Ageing = Ageing { beta: 0.1, time: 1.0 };
const V_STAR: f64 = 0.05;
const DT_STAR: f64 = 0.05;
const HOLDS: [f64; 6] = [10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0];

pub(crate) fn chapter() -> Result<Chapter, FamilyError> {
    let (mut answers, mut found) = (Vec::new(), Vec::new());
    for hold in HOLDS {
        let text = format!(
            "[slider]\nblocks = [4, 3]\n[friction]\nsigma_static_star = 0\nsigma_kinetic_star = 0\n\
             ageing = {{ law = \"logarithmic\", beta = {}, time_star = {} }}\n\
             [drive]\nprogram = [{{ v_star = 0, until_star = {hold} }}, {{ v_star = {V_STAR} }}]\n\
             [time]\nstep = {DT_STAR}\nduration_star = {}",
            LAW.beta,
            LAW.time,
            hold + 150.0
        );
        let run = AnswerRun::of_case("ageing", &text)?;
        answers.push(Answer::seen_late(
            format!("t* of slip after a hold until t* = {hold}"),
            [ageing_slip_time(&LAW, 0.0, hold, 0.375, V_STAR), run.first_slip()],
            (DT_STAR, "slip is detected at the next step"),
        ));
        found.push(run.largest());
    }
    let fine: Vec<f64> = (0..=60).map(|k| libm::exp10(0.8 + 0.05 * f64::from(k))).collect();
    let peak = |hold: f64| 0.375 * V_STAR * (ageing_slip_time(&LAW, 0.0, hold, 0.375, V_STAR) - hold);
    Ok(Chapter {
        title: "Ageing of static friction",
        name: "ageing",
        text: include_str!("text/ageing.md"),
        answers,
        picture: Some((
            "Static friction after a hold against the duration of the hold.",
            Responses {
                x_title: "hold t*".to_owned(),
                log_x: true,
                y_title: "static friction \u{3bc}\u{209b}*".to_owned(),
                curves: vec![
                    Response::of_formula("exact", &fine, peak),
                    Response::of_values("computed", &HOLDS, &found),
                ],
                ..Responses::default()
            },
        )),
    })
}
