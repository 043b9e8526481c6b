//! The stack of a case under a sinusoidal traction, against the body that it models.

use std::f64::consts::TAU;
use std::sync::Arc;

use slipfront::{Execution, Simulation, State, VectorField};
use slipfront_case::case::Case;

use crate::dimples::{BLOCK, YOUNG_MODULUS, three_sheets};
use crate::layer;

/// Number of blocks of the longest wave length of the stack: q l is 0.05 to 0.4 where the stack is fitted.
const LONGEST: usize = 126;

/// A bulk body without texture, with a longest wave length of `longest` blocks. Its height is given over that
/// wave length, and infinite if not given.
pub(crate) fn bare(longest: usize, poisson: f64, height: Option<f64>) -> Case {
    let metres = |height: f64| format!("slider.height='{:e} m'", height * longest as f64 * BLOCK);
    let mut keys: Vec<String> = height.map(metres).into_iter().collect();
    keys.push(format!("slider.poisson={poisson}"));
    bare_with(longest, &keys)
}

/// Three sheets for a deep body of nu = 1/4 without texture, with a longest wave length of `longest` blocks.
pub(crate) fn of_three_sheets(longest: usize) -> Case {
    bare_with(longest, &three_sheets(longest))
}

fn bare_with(longest: usize, keys: &[String]) -> Case {
    let text = format!(
        "slider = {{ blocks = [{longest}, 3], block_size = '{BLOCK:e} m', young_modulus = '{YOUNG_MODULUS} Pa', density = '1 g/cm^3',\n\
         edges = 'periodic', body = 'bulk', omega_star = 0.2 }}\nload.pressure = '1 kPa'\n\
         friction = {{ sigma_static_star = 0, sigma_kinetic_star = 0 }}"
    );
    Case::parse(&text, "bare", "", keys).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// Unit of stiffness per area of a case, E h/l^2 with the thickness of the lower sheet, in G per block.
pub(crate) fn unit_of_stiffness(case: &Case, poisson: f64) -> f64 {
    case.scales.thickness / case.scales.block_size * 2.0 * (1.0 + poisson)
}

/// Traction over displacement along and across a wave that fits `waves` times in the longest wave length, in
/// G per block: stuck blocks are displaced, and the upper sheet comes to rest.
fn of_the_stack(case: &Case, poisson: f64, waves: usize) -> [f64; 2] {
    const AMPLITUDE: f64 = 1e-3;
    /// Upper sheets oscillate with damping close to critical, and are then at rest to 1e-5 of their path.
    const STEPS: usize = 1500;
    let n = 3 * LONGEST;
    let phase = |b: usize| TAU * (waves * (b % LONGEST)) as f64 / LONGEST as f64;
    let wave: Vec<f64> = (0..n).map(|b| AMPLITUDE * phase(b).cos()).collect();
    let mut model = (*case.model).clone();
    model.drive.v_star = 0.0;
    let model = Arc::new(model);
    [0, 1].map(|axis| {
        let mut displacement = VectorField::zeros(n);
        *[&mut displacement.x, &mut displacement.y][axis] = wave.clone();
        let state = State {
            displacement,
            velocity: VectorField::zeros(n),
        };
        let dt = case.time_plan.dt_star;
        let mut simulation = Simulation::new(Arc::clone(&model), dt, Some(state), Execution::default());
        for _ in 0..STEPS {
            simulation.step();
        }
        let now = simulation.snapshot();
        assert_eq!(now.totals.n_sliding, 0);
        unit_of_stiffness(case, poisson) * now.block(0).force_friction[axis] / AMPLITUDE
    })
}

/// Waves in the longest wave length, and the stiffness of the stack over that of the body, along and across.
///
/// A stack that is right in the mean is too stiff along the wave and too soft across it: its sheets are made
/// a little stiffer along the wave, so that the reductions of friction are right. Beyond 8 waves it is a
/// sheet, and its stiffness grows as q^2.
type Ratios = [(usize, [f64; 2]); 5];

const DEEP: Ratios = [
    (1, [1.027, 0.995]),
    (2, [1.071, 0.936]),
    (4, [1.034, 0.967]),
    (8, [1.090, 0.923]),
    (16, [1.530, 1.028]),
];
const GLUED: Ratios = [
    (1, [0.966, 1.055]),
    (2, [1.023, 0.974]),
    (4, [1.051, 0.952]),
    (8, [1.093, 0.918]),
    (16, [1.481, 1.036]),
];

#[test]
fn a_stack_answers_waves_as_its_body_does() {
    let deep = (1.0 / 3.0, None, DEEP);
    let glued = (0.25, Some(0.2), GLUED);
    for (poisson, height, ratios) in [deep, glued] {
        let case = bare(LONGEST, poisson, height);
        for (waves, ratios) in ratios {
            let q = TAU * waves as f64 / LONGEST as f64;
            let body = match height {
                None => [q / (1.0 - poisson), q],
                Some(height) => {
                    let blocks = height * LONGEST as f64;
                    layer::response(q * blocks, poisson).map(|r| r / blocks)
                }
            };
            let stack = of_the_stack(&case, poisson, waves);
            let found = [stack[0] / body[0], stack[1] / body[1]];
            let mean = (found[0] * found[1]).sqrt();
            println!("nu = {poisson:.2}, height {height:?}, {waves} waves: {found:.3?}, mean {mean:.3}");
            for (found, measured) in found.into_iter().zip(ratios) {
                // Rounding of the measured value.
                assert!((found - measured).abs() < 1e-3, "{waves}: {found} {measured}");
            }
            // From the longest wave to an eighth of it, for which two sheets are fitted.
            if waves <= 8 {
                assert!((mean - 1.0).abs() < 0.02, "{waves}: {mean}");
            }
        }
    }
}

/// All blocks together have the stiffness of the springs in series, and a body has G/H. A stack does not
/// model waves longer than its longest one, and is too stiff if it is higher than a tenth of that wave
/// length.
#[test]
fn all_blocks_together_yield_less_than_in_a_body() {
    let poisson = 1.0 / 3.0;
    for (height, measured) in [
        (0.05, 0.9988),
        (0.1, 1.0097),
        (0.2, 1.2167),
        (0.5, 2.1248),
        (1.0, 3.9514),
    ] {
        let case = bare(LONGEST, poisson, Some(height));
        let [coupling, mount] = [case.model.sheets()[0].coupling, case.model.drive.k_drive];
        let series = unit_of_stiffness(&case, poisson) * coupling * mount / (coupling + mount);
        let found = series * height * LONGEST as f64;
        // Rounding of the measured value.
        assert!(
            (found / measured - 1.0).abs() < 1e-3,
            "{height}: {found} {measured}"
        );
    }
}
