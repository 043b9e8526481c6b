//! Slip fronts, with and without drive springs.

use slipfront::exact_solutions::front_speed;
use slipfront::lattice::K_STRAIGHT;
use slipfront::{DeadLoad, Drive, Friction, FrictionLaw, Lattice, Model, State, Surface};
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::Experiment;

const BLOCKS: usize = 200;
const KINETIC: f64 = 0.5;
const DT_STAR: f64 = 5e-3;
const PRESTRESSES: [f64; 6] = [0.4, 0.5, 0.6, 0.7, 0.8, 0.9];

/// Speed of a front over that of sound, in a chain under a dead load with drive springs of `kappa` times the
/// stiffness of the chain.
pub(crate) fn front_speed_in_a_chain(
    kappa: f64,
    prestress: f64,
    friction: Friction,
    dt_star: f64,
) -> Result<f64, FamilyError> {
    let lattice = Lattice::free(BLOCKS, 1);
    let drive = Drive {
        k_drive: kappa * K_STRAIGHT,
        ..Drive::along_x(0.0)
    };
    let surface = Surface::uniform(&lattice, 1.0, KINETIC);
    let force = [KINETIC + prestress * (1.0 - KINETIC), 0.0];
    let model =
        Model::new(lattice, surface, drive, 0.0, 0.0, friction).with_dead_load(DeadLoad::uniform(force));
    let sound = K_STRAIGHT.sqrt();
    let mut state = State::at_rest(BLOCKS);
    state.velocity.x[..5].fill(0.5 * sound * (1.0 - KINETIC) / K_STRAIGHT);
    let steps = (1.5 * BLOCKS as f64 / (0.75 * sound) / dt_star) as u64;
    let experiment = Experiment {
        state: Some(state),
        ..Experiment::at_rest(model, dt_star)
    };
    let run = experiment.run("fronts", steps)?;
    let first = run.simulation.snapshot().first_slip_time_star();
    let (from, to) = (BLOCKS / 2, BLOCKS - 20);
    Ok((to - from) as f64 / (first[to] - first[from]) / sound)
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let mut curves = vec![Response::of_formula(
        "no drive springs, exact",
        &(0..=50).map(|k| 0.4 + 0.01 * f64::from(k)).collect::<Vec<_>>(),
        |prestress| front_speed(1.0, prestress),
    )];
    for (kappa, label) in [
        (0.0, "no drive springs"),
        (1.0 / 3.0, "k\u{209b} = K/3"),
        (1.0, "k\u{209b} = K"),
    ] {
        let speed =
            |prestress| front_speed_in_a_chain(kappa, prestress, FrictionLaw::Projection.into(), DT_STAR);
        let found: Vec<f64> = PRESTRESSES.into_iter().map(speed).collect::<Result<_, _>>()?;
        if kappa == 0.0 {
            for (prestress, found) in PRESTRESSES.into_iter().zip(&found) {
                let exact = front_speed(1.0, prestress);
                chapter.add(
                    format!("front speed v/c, prestress {prestress}"),
                    [exact, *found],
                    0.5 * K_STRAIGHT.sqrt() * DT_STAR * exact * exact,
                    "blocks start at whole steps, up to half a step from the interval l/v",
                );
            }
        }
        curves.push(Response::of_values(label, &PRESTRESSES, &found));
    }
    chapter.draw(
        "Speed of slip fronts along a chain relative to the speed of sound. Drive springs slow fronts most at low prestress.",
        ["prestress \u{3c4}", "front speed v/c"],
        curves,
    );
    Ok(())
}
