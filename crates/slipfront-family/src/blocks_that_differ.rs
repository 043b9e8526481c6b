//! Heterogeneous sliders: grades, outlines, dampers in parallel to the springs.

use slipfront::exact_solutions::{lagged_decay_rate, oscillation_growth, pair_modes, viscous_decay_rate};
use slipfront::{Drive, FrictionLaw, Lattice, Model, Slider, State, Surface};

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::{AnswerRun, Experiment, LATE_SLIP};

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let text = "[slider]\nblocks = [50, 4]\nstiffness_grade = { along = \"x\", from = 1, to = 0.1 }\n\
                [time]\nstep = 0.01\nduration_star = 120";
    let run = AnswerRun::of_equal_blocks("graded", text)?;
    let stiffest = 1.0 - 0.9 * 0.5 / 50.0;
    chapter.add_late(
        "t* of the first slip of a slider graded from E to E/10, at its stiff edge",
        [1.0 / (0.375 * 0.03 * stiffest), run.first_slip()],
        0.01,
        LATE_SLIP,
    );
    let text = "[slider]\nblocks = [30, 30]\noutline = \"disc\"\n[time]\nstep = 0.01\nstop = \"after_onset\"";
    let run = AnswerRun::of_equal_blocks("disc", text)?;
    chapter.add(
        "μ_s* of a disc of equal blocks",
        [1.0, run.peak()],
        0.375 * (0.03 * 0.01 + 0.03 * 0.03),
        "drive force of one step, and spring extension until the slider reaches the drive speed",
    );
    for viscosity_time in [0.05, 0.2] {
        let dt = 0.01;
        let rate = decay(viscosity_time, dt);
        let [_, against] = pair_modes([1.0; 2], [1.0; 2]);
        chapter.add(
            format!("decay rate of two blocks in antiphase, τ_v = {viscosity_time}, for Δt* = {dt}"),
            [lagged_decay_rate(against.omega_squared, viscosity_time, dt), rate],
            // Each step rounds the last digit of four amplitudes in a random direction.
            4.0 * (2.8_f64 / dt).sqrt() * f64::EPSILON,
            "rounding of four amplitudes: a random walk of 280 steps of ε",
        );
        let exact = viscous_decay_rate(against.omega_squared, 0.0, viscosity_time);
        chapter.add(
            format!("decay rate of two blocks in antiphase, τ_v = {viscosity_time}, in the limit Δt* = 0"),
            [exact, rate],
            0.6 * exact * viscosity_time * 1.5 * dt,
            "first-order error, relative ½ τ_v (ω² - k_s) Δt, plus a fifth for higher orders",
        );
    }
    Ok(())
}

/// Decay rate of two equal blocks in antiphase, without friction.
fn decay(viscosity_time: f64, dt_star: f64) -> f64 {
    let lattice = Lattice::free(2, 1);
    let surface = Surface::uniform(&lattice, 0.0, 0.0);
    let (drive, law) = (Drive::along_x(0.0), FrictionLaw::Projection);
    let model = Model::new(lattice, surface, drive, 0.0, 0.0, law).with_slider(Slider {
        viscosity_time,
        ..Slider::default()
    });
    let mut state = State::at_rest(2);
    state.displacement.x = vec![0.5, -0.5];
    let experiment = Experiment {
        state: Some(state),
        ..Experiment::at_rest(model, dt_star)
    };
    let apart = 0.7;
    let times = [1.0, 2.0, 3.0, 4.0].map(|k| k * apart);
    let values = experiment.values(times, |now| now.block(0).displacement[0]);
    -oscillation_growth(values, apart)
}
