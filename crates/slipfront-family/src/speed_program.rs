//! Programs of speeds.

use slipfront::observe::CurveRow;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::{AnswerRun, LATE_SLIP, ROUNDING, rounding};

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let text = "slider.omega_star = 1\ntime.duration_star = 700\ntime.step = 0.1\n[drive]\n\
                program = [{ v_star = 0.05, until_star = 300 }, { v_star = 0.2, until_star = 450 }, { v_star = 0.05 }]";
    let run = AnswerRun::of_equal_blocks("speeds", text)?;
    for (time, v_star, path) in [(299.0, 0.05, 15.0), (449.0, 0.2, 45.0), (699.0, 0.05, 57.5)] {
        chapter.add(
            format!("steady level at V* = {v_star}, t* = {time}"),
            [0.5 + f64::sqrt(0.75) * v_star, run.mu_star_at(time)],
            rounding(path),
            ROUNDING,
        );
    }
    let text = "time.duration_star = 200\ntime.step = 0.01\n[drive]\n\
                program = [{ v_star = 0.05, until_star = 20 }, { v_star = 0, until_star = 70 }, { v_star = 0.1 }]";
    let run = AnswerRun::of_equal_blocks("hold", text)?;
    chapter.add_late(
        "t* of the first slip at V* = 0.05, 0 (a hold of 50), 0.1",
        [70.0 + (1.0 / 0.375 - 1.0) / 0.1, run.first_slip()],
        0.01,
        LATE_SLIP,
    );
    let energies = run.rows.last().map(|row| row.energies).unwrap_or_default();
    let is_sliding = |row: &CurveRow| row.point.n_sliding > 0;
    let pairs = run.rows.windows(2);
    let turns = pairs.filter(|pair| is_sliding(&pair[0]) != is_sliding(&pair[1]));
    let n_blocks = run.simulation.snapshot().model.n_blocks();
    let missing = (0.5_f64 * 0.01).powi(2) / 2.0 * n_blocks as f64;
    chapter.add(
        "relative error of the energy balance in the same run",
        [0.0, energies.error()],
        (turns.count() + 1) as f64 * missing / energies.work,
        "½(μ_k F_n Δt)² per block, at every start, every stop and the end",
    );
    Ok(())
}
