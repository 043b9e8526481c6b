//! Strength that falls with slip.

use std::sync::Arc;

use slipfront::exact_solutions::slip_of_jump;
use slipfront::lattice::K_DRIVE;
use slipfront::{
    Coulomb, Drive, Friction, FrictionLaw, Lattice, Model, Program, Simulation, SlipWeakening, Surface,
};

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::Experiment;

/// Difference `S - K` of thresholds 1 and 0.5.
const DROP: f64 = 0.5;
/// Speed of the drive up to the threshold.
const FAST: f64 = 1e-3;
const DT_STAR: f64 = 0.05;

/// Eq. 4 with a strength that falls over a slip of `length` and does not heal.
pub(crate) fn falling_strength(length: f64) -> Coulomb {
    Coulomb {
        slip_weakening: Some(SlipWeakening {
            length,
            healing_time: None,
        }),
        ..FrictionLaw::Projection.into()
    }
}

/// One block that weakens by `weakening` per slip.
fn block(weakening: f64, damping: f64, segments: &[(f64, f64)]) -> Simulation {
    let lattice = Lattice::free(1, 1);
    let surface = Surface::uniform(&lattice, 1.0, 1.0 - DROP);
    let drive = Drive {
        program: Some(Arc::new(Program::new(segments.iter().copied()))),
        ..Drive::along_x(FAST)
    };
    let law = Friction::Coulomb(falling_strength(DROP / weakening));
    let model = Model::new(lattice, surface, drive, damping, 0.0, law);
    Experiment::at_rest(model, DT_STAR).begin()
}

/// Position where a block comes to rest after it has jumped without damping, while the drive is stopped at
/// the threshold; and the energy of weakening. NaN if the block still slides.
fn jumped(weakening: f64) -> [f64; 2] {
    let until = (1.0 / K_DRIVE / FAST / DT_STAR).ceil() * DT_STAR + DT_STAR;
    let mut simulation = block(weakening, 0.0, &[(FAST, until), (0.0, f64::INFINITY)]);
    while simulation.snapshot().time_star < until + 300.0 {
        simulation.step();
    }
    let now = simulation.snapshot();
    if now.totals.n_sliding > 0 {
        return [f64::NAN; 2];
    }
    [now.block(0).displacement[0], now.weakening_energy()]
}

/// Slip of a block that does not jump, after a path of the drive.
fn followed(weakening: f64, damping: f64, speed: f64, path: f64) -> f64 {
    let near = (0.97 / K_DRIVE / FAST).round();
    let mut simulation = block(weakening, damping, &[(FAST, near), (speed, f64::INFINITY)]);
    let until = near + (path - FAST * near) / speed;
    while simulation.snapshot().time_star < until - 0.5 * DT_STAR {
        simulation.step();
    }
    simulation.snapshot().block(0).displacement[0]
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    for weakening in [0.6, 1.0, 2.0] {
        let exact = slip_of_jump(DROP, weakening, K_DRIVE);
        let [found, energy] = jumped(weakening);
        chapter.add(
            format!("slip of a jump, W = {weakening}"),
            [exact, found],
            6.0 * FAST * DT_STAR,
            "the drive stops up to two steps beyond the threshold; the jump amplifies this up to three times",
        );
        chapter.add(
            format!("weakening energy of the jump, W = {weakening}"),
            [0.5 * DROP * DROP / weakening, energy],
            1e-15,
            "rounding",
        );
    }
    let (weakening, damping, speed) = (0.25, 0.5, 1e-5);
    let softness = 1.0 / (K_DRIVE - weakening);
    for slip in [0.5, 1.0, 1.5] {
        let path = (1.0 + (K_DRIVE - weakening) * slip) / K_DRIVE;
        chapter.add(
            format!("stable slip at X = {path:.4}, W = {weakening}"),
            [slip, followed(weakening, damping, speed, path)],
            1.2 * damping * speed * K_DRIVE * softness * softness,
            "lag due to damping, Ω V k_s/(k_s - W)², plus a fifth for the time step",
        );
    }
    Ok(())
}
