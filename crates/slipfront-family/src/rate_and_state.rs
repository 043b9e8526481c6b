//! Rate-and-state friction.

use slipfront::exact_solutions::{friction_after_speed_step, rate_and_state_growth};
use slipfront::{Drive, Friction, Lattice, Model, RateAndState, State, Surface, scales};
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::{Experiment, along_x, growth_of_perturbation};

const LAW: RateAndState = RateAndState {
    a: 0.01,
    b: 0.02,
    d_c: 0.5,
    v_0: 0.03,
    mu_0: 0.6,
    theta_0: 0.5 / 0.03,
    slip_speed: 1e-3,
};
const V_STAR: f64 = 0.03;
const DT_STAR: f64 = 0.05;
/// Stiffness of the drive over the critical one.
const RATIOS: [f64; 6] = [0.7, 0.85, 0.95, 1.05, 1.2, 1.5];

/// Growth rate of a small perturbation of steady sliding, for blocks that move together.
fn computed(k_drive: f64, damping: f64) -> f64 {
    let drive = Drive {
        k_drive,
        ..Drive::along_x(V_STAR)
    };
    let law = Friction::RateAndState(LAW);
    growth_of_perturbation(drive, damping, law, DT_STAR, [60.0, 36.0])
}

/// Effective mass of a block with steps of [`DT_STAR`]: friction depends on the speed half a step later,
/// `mu(v + dt v'/2)`, as if the mass were larger by `sigma a dt/(2 V)`.
const MASS: f64 = 1.0 + LAW.a * DT_STAR / (2.0 * V_STAR);

/// The friction law, divided by this mass.
const HEAVIER: RateAndState = RateAndState {
    a: LAW.a / MASS,
    b: LAW.b / MASS,
    ..LAW
};

/// V* before the velocity step.
const V_1: f64 = 0.01;
/// Time t* from the velocity step to the reading of friction.
const AFTER: f64 = 10.0;
/// Stiffness of the drive springs that hold blocks at the speed of the drive.
const STIFF: f64 = 2500.0;
/// Damping Omega: oscillations about the speed of the drive decay to exp(-Omega t/2) = exp(-50).
const STIFF_DAMPING: f64 = 10.0;

/// `mu - mu_ss` at a time [`AFTER`] after a velocity step of the drive from [`V_1`], with steady sliding, to
/// `v_2`. The springs are so stiff that the blocks follow the drive.
fn after_step(v_2: f64) -> f64 {
    let law = RateAndState {
        theta_0: LAW.d_c / V_1,
        ..LAW
    };
    let lattice = Lattice::free(2, 2);
    let drive = Drive {
        k_drive: STIFF,
        ..Drive::along_x(v_2)
    };
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    let drag = STIFF_DAMPING * v_2;
    let extension = (law.coefficient(v_2, law.theta_0) + drag) / STIFF;
    let friction = Friction::RateAndState(law);
    let model = Model::new(lattice, surface, drive, STIFF_DAMPING, 0.0, friction);
    let experiment = Experiment {
        state: Some(State {
            displacement: along_x(-extension, 4),
            velocity: along_x(v_2, 4),
        }),
        ..Experiment::at_rest(model, 0.01)
    };
    let [pull] = experiment.values([AFTER], |now| now.point.mu_star);
    pull - drag - law.steady_coefficient(v_2)
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    for ratio in [0.1, 10.0] {
        let v_2 = V_1 * ratio;
        let slip = v_2 * AFTER;
        let left = (ratio - 1.0) * libm::exp(-slip / LAW.d_c);
        // Magnitude of d mu/dx at this slip.
        let slope = LAW.b * left.abs() / (LAW.d_c * (1.0 + left));
        chapter.add(
            format!("μ - μ_ss after a velocity step by a factor of {ratio} and a slip of {slip}"),
            [friction_after_speed_step(&LAW, V_1, v_2, slip), after_step(v_2)],
            slope / STIFF * (LAW.b * libm::log(ratio).abs() + LAW.a + STIFF_DAMPING * v_2),
            "spring extension Δμ/k and its rate V/k dμ/dx, which changes the terms in a and Ω",
        );
    }
    let damping = scales::damping(0.1);
    let critical = LAW.critical_stiffness(1.0, damping, V_STAR);
    let exact = |ratio: f64| rate_and_state_growth(&LAW, 1.0, V_STAR, ratio * critical, damping);
    let in_steps =
        |ratio: f64| rate_and_state_growth(&HEAVIER, 1.0, V_STAR, ratio * critical / MASS, damping / MASS);
    let found = RATIOS.map(|ratio| computed(ratio * critical, damping));
    let zero = |[below, above]: [f64; 2]| 0.95 + 0.1 * below / (below - above);
    let shift = MASS * HEAVIER.critical_stiffness(1.0, damping / MASS, V_STAR) / critical - 1.0;
    chapter.add(
        "k/k_c at zero growth rate, interpolated between 0.95 and 1.05",
        [1.0, zero([found[2], found[3]])],
        1.2 * shift.abs() + (zero([exact(0.95), exact(1.05)]) - 1.0).abs(),
        "first-order error, the mass m + σaΔt/2V in k_c, plus a fifth for higher orders; linear interpolation",
    );
    for (ratio, found) in RATIOS.into_iter().zip(found) {
        chapter.add(
            format!("growth rate at k = {ratio} k_c"),
            [exact(ratio), found],
            1.2 * (in_steps(ratio) - exact(ratio)).abs(),
            "first-order error, the mass m + σaΔt/2V in the cubic equation, plus a fifth for higher orders",
        );
    }
    let fine: Vec<f64> = (0..=50).map(|k| 0.6 + 0.02 * f64::from(k)).collect();
    chapter.draw(
        "Growth rate of a small perturbation of steady sliding against the drive stiffness. At a drive stiffness below k_c it grows into stick-slip.",
        ["drive stiffness over k_c", "growth rate"],
        vec![
            Response::of_formula("exact", &fine, exact),
            Response::of_values("computed", &RATIOS, &found),
        ],
    );
    Ok(())
}
