//! A drive that stops while blocks slide.

use slipfront::lattice::K_DRIVE;
use slipfront::{Drive, FrictionLaw, Lattice, Loading, Model, Simulation, Surface};

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::Experiment;

/// Static threshold of a block.
const STATIC: f64 = 1.0;
/// Kinetic threshold of a block.
const KINETIC: f64 = 0.5;
const DT_STAR: f64 = 0.02;

/// Equal blocks without damping under a held drive.
fn equal_blocks([nx, ny]: [usize; 2], v_star: f64) -> Simulation {
    let lattice = Lattice::free(nx, ny);
    let surface = Surface::uniform(&lattice, STATIC, KINETIC);
    let (drive, law) = (Drive::along_x(v_star), FrictionLaw::Projection);
    let model = Model::new(lattice, surface, drive, 0.0, 0.0, law).with_loading(Loading::Held {
        onset_steps: u64::MAX,
    });
    Experiment::at_rest(model, DT_STAR).begin()
}

/// Path of the drive and mu* at the instant when blocks begin to slide, or have come to rest.
fn step_until(simulation: &mut Simulation, slides: bool) -> [f64; 2] {
    while (simulation.snapshot().totals.n_slipping > 0) != slides {
        simulation.step();
    }
    let now = simulation.snapshot();
    [now.model.drive.path(now.drive_time_star), now.point.mu_star]
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    for (blocks, v_star) in [([1, 1], 0.001), ([1, 1], 0.1), ([20, 16], 0.01)] {
        let [nx, ny] = blocks;
        let name = |what: &str| format!("{what}, {nx} x {ny} blocks at V* = {v_star}");
        let mut simulation = equal_blocks(blocks, v_star);
        let [path, peak] = step_until(&mut simulation, true);
        // The leapfrog solution oscillates about K, from rest until the step in which it stops. The relative
        // error of the fall is of the order of (sqrt(k_s) dt)^2.
        let of_the_step = K_DRIVE * DT_STAR * DT_STAR;
        let step = v_star * DT_STAR;
        chapter.add(
            name("mu* at the first slip"),
            [STATIC, peak],
            K_DRIVE * step,
            "path increment V dt of a step",
        );
        let [stopped, rest] = step_until(&mut simulation, false);
        chapter.add(
            name("drive path during the slip"),
            [0.0, stopped - path],
            0.0,
            "the path is a whole number of increments",
        );
        chapter.add(
            name("mu* after the slip"),
            [2.0 * KINETIC - peak, rest],
            (peak - KINETIC) * 2.0 * of_the_step,
            "blocks stop between two steps: of the order of k_s dt^2 times the slip",
        );
        let [next, _] = step_until(&mut simulation, true);
        chapter.add(
            name("drive path from the first slip to the second"),
            [2.0 * (peak - KINETIC) / K_DRIVE, next - path],
            2.0 * (peak - KINETIC) / K_DRIVE * of_the_step + step,
            "error of the slip, and path increment V dt",
        );
    }
    Ok(())
}
