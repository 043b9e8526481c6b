//! Patterns of several scales.

use slipfront::scales;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::{AnswerRun, ROUNDING, rounding};

/// Widths and offsets of the grooves, um. The last one is inside another one, so that it has no effect.
const GROOVES: [(f64, f64); 8] = [
    (6.0, 0.0),
    (4.0, -15.0),
    (4.0, 15.0),
    (1.0, -22.5),
    (1.0, -7.5),
    (1.0, 7.5),
    (1.0, 22.5),
    (2.0, 0.0),
];

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let textures = GROOVES.map(|(width, offset)| {
        format!("[[texture]]\nshape = \"groove\"\nwidth = \"{width} um\"\noffset = \"{offset} um\"\n")
    });
    for (redistribute, load, what) in [
        (
            false,
            0.7,
            "not redistributed; grooves of 6, 4 and 1 columns, one inside another, cover 30 %",
        ),
        (true, 1.0, "redistributed; independent of the pattern"),
    ] {
        let text = format!(
            "slider.blocks = [60, 60]\nslider.omega_star = 1\nload.redistribute = {redistribute}\ndrive.v_star = 0.2\n\
             time.duration_star = 200\ntime.step = 0.1\n{}",
            textures.concat()
        );
        let run = AnswerRun::of_equal_blocks("grooves of three widths", &text)?;
        let damping = scales::damping(1.0) * 0.2;
        chapter.add(
            format!("load on the blocks in contact, from the steady level: {what}"),
            [load, (run.mu_star_at(200.0) - damping) / 0.5],
            2.0 * rounding(200.0 * 0.2),
            ROUNDING,
        );
    }
    Ok(())
}
