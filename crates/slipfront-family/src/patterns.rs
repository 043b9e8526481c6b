//! Patterns of several scales.

use slipfront::scales;

use crate::answer::{Answer, Chapter};
use crate::error::FamilyError;
use crate::runs::{AnswerRun, ROUNDING, rounding};

pub(crate) fn chapter() -> Result<Chapter, FamilyError> {
    let groove = |width: f64, offset: f64| {
        format!("[[texture]]\nshape = \"groove\"\nwidth = \"{width} um\"\noffset = \"{offset} um\"\n")
    };
    let mut textures = String::new();
    let grooves = [
        (6.0, 0.0),
        (4.0, -15.0),
        (4.0, 15.0),
        (1.0, -22.5),
        (1.0, -7.5),
        (1.0, 7.5),
        (1.0, 22.5),
    ];
    for (width, offset) in grooves {
        textures += &groove(width, offset);
    }
    // A groove inside another one has no effect.
    textures += &groove(2.0, 0.0);
    let mut answers = Vec::new();
    for (redistribute, load, what) in [
        (
            false,
            0.7,
            "not redistributed; grooves of 6, 4 and 1 columns, one inside another, cover 30 %",
        ),
        (true, 1.0, "redistributed; independent of the pattern"),
    ] {
        let text = format!(
            "slider.blocks = [60, 60]\nslider.omega_star = 1\nload.redistribute = {redistribute}\n\
             friction.sigma_static_star = 0\nfriction.sigma_kinetic_star = 0\ndrive.v_star = 0.2\n\
             time.duration_star = 200\ntime.step = 0.1\n{textures}"
        );
        let run = AnswerRun::of_case("grooves of three widths", &text)?;
        let damping = scales::damping(1.0) * 0.2;
        answers.push(Answer::new(
            format!("load on the blocks in contact, from the steady level: {what}"),
            [load, (run.mu_star_at(200.0) - damping) / 0.5],
            (2.0 * rounding(200.0 * 0.2), ROUNDING),
        ));
    }
    Ok(Chapter {
        title: "Hierarchical patterns",
        name: "patterns",
        text: include_str!("text/patterns.md"),
        answers,
        picture: None,
    })
}
