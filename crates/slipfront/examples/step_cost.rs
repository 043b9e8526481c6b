//! Cost of a step of the baseline of Fig. 3 on a surface given block by block, and the mu_s* it gives.
//!
//! ```console
//! $ cargo run --release -p slipfront --example step_cost -- 50 mu_s.f64 mu_k.f64 2667
//! ```
//!
//! A slider of 50 x 50 blocks; the two files hold the local coefficients, row by row from y = 0, as
//! little-endian f64. `--no-skip` steps every block at every step, also at rest. Prints mu_s*, the step of
//! the peak and nanoseconds per block and step of the loop alone. `benches/peers/run.sh` compares other
//! programs with it.

use std::error::Error;
use std::time::Instant;

use slipfront::surface::{Coefficients, Load};
use slipfront::{Drive, Execution, FrictionLaw, Lattice, Model, Simulation, Surface, scales};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (inputs, skips) = match arguments.as_slice() {
        [inputs @ .., last] if last == "--no-skip" => (inputs, false),
        inputs => (inputs, true),
    };
    let [size, mu_static, mu_kinetic, steps] = inputs else {
        return Err("usage: step_cost SIZE MU_STATIC.f64 MU_KINETIC.f64 STEPS [--no-skip]".into());
    };
    let execution = Execution {
        skips,
        ..Execution::default()
    };
    let (size, steps): (usize, u64) = (size.parse()?, steps.parse()?);
    let lattice = Lattice::free(size, size);
    let n = lattice.n_blocks();
    let given = Coefficients::given(numbers(mu_static, n)?, numbers(mu_kinetic, n)?);
    let surface = Surface::new(given, vec![false; n], Load::Redistributed, 1.0)?;
    let model = Model::new(
        lattice,
        surface,
        Drive::along_x(0.03),
        scales::damping(0.1),
        1e-6,
        FrictionLaw::Projection,
    );
    let mut simulation = Simulation::new(model, 0.1, None, execution);

    let began = Instant::now();
    for _ in 0..steps {
        simulation.step();
    }
    let nanoseconds = began.elapsed().as_secs_f64() * 1e9;

    let peak = simulation.peak();
    if !peak.ended {
        return Err(format!("no transition within {steps} steps").into());
    }
    let per_block_step = nanoseconds / (n as f64 * steps as f64);
    println!("{:.17} {} {per_block_step:.4}", peak.mu_star, peak.step);
    Ok(())
}

/// The `count` numbers that a file holds.
fn numbers(path: &str, count: usize) -> Result<Vec<f64>, Box<dyn Error>> {
    let bytes = std::fs::read(path).map_err(|e| format!("{path}: {e}"))?;
    let (numbers, rest) = bytes.as_chunks::<8>();
    if numbers.len() != count || !rest.is_empty() {
        return Err(format!("{path} holds {} bytes, not {count} numbers", bytes.len()).into());
    }
    Ok(numbers.iter().map(|&number| f64::from_le_bytes(number)).collect())
}
