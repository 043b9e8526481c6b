//! Static friction that grows with age.

use slipfront::Ageing;
use slipfront::exact_solutions::ageing_slip_time;
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::{AnswerRun, LATE_SLIP};

const LAW: Ageing = Ageing { beta: 0.1, time: 1.0 };
const V_STAR: f64 = 0.05;
const DT_STAR: f64 = 0.05;
const HOLDS: [f64; 6] = [10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0];

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let mut found = Vec::new();
    for hold in HOLDS {
        let text = format!(
            "slider.blocks = [4, 3]\n\
             friction.ageing = {{ law = \"logarithmic\", beta = {}, time_star = {} }}\n\
             drive.program = [{{ v_star = 0, until_star = {hold} }}, {{ v_star = {V_STAR} }}]\n\
             time.step = {DT_STAR}\ntime.duration_star = {}",
            LAW.beta,
            LAW.time,
            hold + 150.0
        );
        let run = AnswerRun::of_equal_blocks("ageing", &text)?;
        chapter.add_late(
            format!("t* of slip after a hold until t* = {hold}"),
            [ageing_slip_time(&LAW, 0.0, hold, 0.375, V_STAR), run.first_slip()],
            DT_STAR,
            LATE_SLIP,
        );
        found.push(run.largest());
    }
    let fine: Vec<f64> = (0..=60).map(|k| libm::exp10(0.8 + 0.05 * f64::from(k))).collect();
    let peak = |hold: f64| 0.375 * V_STAR * (ageing_slip_time(&LAW, 0.0, hold, 0.375, V_STAR) - hold);
    let picture = chapter.draw(
        "Static friction after a hold against the duration of the hold.",
        ["hold t*", "static friction \u{3bc}\u{209b}*"],
        vec![
            Response::of_formula("exact", &fine, peak),
            Response::of_values("computed", &HOLDS, &found),
        ],
    );
    picture.log_x = true;
    Ok(())
}
