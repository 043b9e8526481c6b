//! Patterns of several scales.

use super::answer::{Answer, Chapter};
use super::runs::Run;
use crate::error::PaperError;
use slipfront::communicator::Alone;

pub(super) fn chapter() -> Result<Chapter, PaperError> {
    let groove = |width: f64, offset: f64| {
        format!("[[texture]]\nshape = \"groove\"\nwidth = \"{width} um\"\noffset = \"{offset} um\"\n")
    };
    let mut text = "slider.blocks = [60, 60]\nload.redistribute = true\nfriction.sigma_static_star = 0\n\
                    friction.sigma_kinetic_star = 0\ntime.stop = \"after_onset\"\n"
        .to_owned();
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
        text += &groove(width, offset);
    }
    // A groove inside another one adds nothing.
    text += &groove(2.0, 0.0);
    let run = Run::of_case("grooves of three widths", &text)?;
    let surface = &run.model.surface;
    let load: f64 = (0..3600).map(|b| surface.normal_force(b)).sum();
    let answers = vec![
        Answer::new(
            "coverage of grooves of 6, 4 and 1 blocks and of one within another, %",
            [30.0, surface.texture_percent()],
            (0.0, "blocks are counted"),
        ),
        Answer::new(
            "load on the blocks in contact over P L_x L_y",
            [1.0, load / 3600.0],
            (1e-13, "rounding of a sum"),
        ),
        Answer::new(
            "steady level over R*: load is conserved whatever the pattern",
            [
                1.0,
                (run.model.steady_level(&Alone) - run.model.damping * 0.03) / 0.5,
            ],
            (1e-13, "rounding of a sum"),
        ),
    ];
    Ok(Chapter {
        title: "Patterns of several scales",
        name: "patterns",
        text: include_str!("text/patterns.md"),
        answers,
        picture: None,
    })
}
