//! Adhesion, which needs no load.

use slipfront::exact_solutions::{Facing, groove_edge_factor};
use slipfront::scales;
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::AnswerRun;

/// Adhesion over the pressure times mu_s.
const STRENGTHS: [f64; 4] = [0.0, 0.25, 0.5, 1.0];

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let mut smooth = Vec::new();
    for adhesion in STRENGTHS {
        let text = format!(
            "friction.adhesion = \"{} kPa\"\ntime.step = 0.01",
            100.0 * adhesion
        );
        let found = AnswerRun::of_equal_blocks("adhesion", &text)?.peak();
        smooth.push(found);
        chapter.add(
            format!("μ_s* without texture, τ_a/(P μ̄_s) = {adhesion}"),
            [1.0 + adhesion, found],
            0.375 * (0.03 * 0.01 + 0.03 * 0.03 / (2.0 * (0.5 + adhesion))),
            "drive force of one step, and spring extension until the slider reaches the drive speed",
        );
    }
    for adhesion in STRENGTHS {
        // Five columns of twenty are a groove across the drive. At this speed, the lag of the waves is
        // negligible.
        let text = format!(
            "friction.adhesion = \"{} kPa\"\n\
             slider.blocks = [20, 20]\nslider.edges = \"periodic\"\nslider.omega_star = 0.3\ndrive.v_star = 1e-3\n\
             time.step = 0.5\ntime.duration_star = 5000\n[[texture]]\nshape = \"groove\"\norientation = \"across\"\nwidth = \"5 um\"",
            100.0 * adhesion
        );
        let run = AnswerRun::of_equal_blocks("adhesion on a groove", &text)?;
        let at_edge = groove_edge_factor(Facing::Across, 5);
        chapter.add(
            format!("k_s V t* at the first slip next to a groove, τ_a/(P μ̄_s) = {adhesion}"),
            [
                (20.0 / 15.0 + adhesion) / at_edge,
                0.375 * 1e-3 * run.first_slip(),
            ],
            0.375 * 1e-3 * 0.5 + 2.5 * scales::damping(0.3) * 1e-3 / at_edge,
            "drive force of one step, and drag Ω V* of each free row, half of it on each edge",
        );
    }
    chapter.draw(
        "Static friction of a smooth uniform surface against adhesion. Line: exact; points: computed.",
        [
            "adhesion \u{3c4}\u{2090}/(P \u{27e8}\u{3bc}\u{209b}\u{27e9})",
            "static friction \u{3bc}\u{209b}*",
        ],
        vec![
            Response::of_formula("exact", &STRENGTHS, |adhesion| 1.0 + adhesion),
            Response::of_values("computed", &STRENGTHS, &smooth),
        ],
    );
    Ok(())
}
