//! Non-uniform pressure.

use slipfront::scales;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::{AnswerRun, LATE_SLIP, ROUNDING, rounding};

const V_STAR: f64 = 0.03;

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    for (along, slope) in [("x", 0.8), ("y", -0.5)] {
        let profile = format!("load.profile = {{ along = \"{along}\", relative_slope = {slope} }}\n");
        let text = format!("{profile}drive.v_star = {V_STAR}\ntime.duration_star = 100\ntime.step = 0.01");
        let run = AnswerRun::of_equal_blocks("load", &text)?;
        // The outermost blocks, half a block from the edge, have the least pressure.
        let least: f64 = 1.0 - f64::abs(slope) * (1.0 - 1.0 / 25.0);
        chapter.add_late(
            format!("t* of the first slip, slope {slope} along {along}"),
            [least / (0.375 * V_STAR), run.first_slip()],
            0.01,
            LATE_SLIP,
        );
        let text = format!(
            "{profile}slider.omega_star = 1\ndrive.v_star = 0.2\ntime.duration_star = 200\ntime.step = 0.1"
        );
        let run = AnswerRun::of_equal_blocks("whole load", &text)?;
        chapter.add(
            format!("steady level at V* = 0.2, slope {slope} along {along}"),
            [0.5 + scales::damping(1.0) * 0.2, run.mu_star_at(200.0)],
            rounding(200.0 * 0.2),
            ROUNDING,
        );
    }
    Ok(())
}
