//! Time of a step of a lattice larger than any cache, compared with the time to move its bytes.
//!
//! ```console
//! $ cargo run --release -p slipfront --example large_step -- 4096 2
//! ```
//!
//! 4096 x 4096 blocks of the baseline of Fig. 3 on two threads, past their onset, every block at every step.
//! A step must read displacement and velocity of every block (32 bytes) and its two thresholds (16), and
//! write displacement and velocity (32): 80 bytes. A plain loop over six arrays that moves just these bytes,
//! on as many threads, gives the time they take. The two are measured alternately; the best of each counts.

use std::error::Error;
use std::time::Instant;

use rayon::prelude::*;
use slipfront::surface::{Coefficients, Distribution, Load};
use slipfront::{Drive, Execution, FrictionLaw, Lattice, Model, Simulation, Surface, scales};

/// Bytes that a step must move per block.
const BYTES: f64 = 80.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<usize> = std::env::args()
        .skip(1)
        .map(|word| word.parse())
        .collect::<Result<_, _>>()?;
    let [size, threads] = arguments[..] else {
        return Err("usage: large_step SIZE THREADS".into());
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()?;
    let n = size * size;
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let drawn = Coefficients::draw(n, gauss(1.0), gauss(0.5), 1);
    let surface = Surface::new(drawn, vec![false; n], Load::Redistributed, 1.0)?;
    let (drive, damping) = (Drive::along_x(0.03), scales::damping(0.1));
    let model = Model::new(
        Lattice::free(size, size),
        surface,
        drive,
        damping,
        1e-6,
        FrictionLaw::Projection,
    );
    let execution = Execution {
        threads,
        skips: false,
        ..Execution::default()
    };
    let mut simulation = Simulation::new(model, 0.1, None, execution);
    let mut arrays: [Vec<f64>; 6] = std::array::from_fn(|k| vec![k as f64; n]);

    let (mut step, mut stream) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..10 {
        let began = Instant::now();
        simulation.step();
        step = step.min(began.elapsed().as_secs_f64());
        let began = Instant::now();
        move_bytes(&mut arrays, threads);
        stream = stream.min(began.elapsed().as_secs_f64());
    }
    let per_block = |seconds: f64| seconds * 1e9 / n as f64;
    println!(
        "{size} x {size} blocks, {threads} threads: {:.2} ns per block and step; its 80 bytes alone {:.2} ns ({:.1} GB/s); \
         ratio {:.2}",
        per_block(step),
        per_block(stream),
        BYTES * n as f64 / stream * 1e-9,
        step / stream
    );
    Ok(())
}

/// Reads six arrays and writes four of them, as a step must.
fn move_bytes([ux, uy, vx, vy, static_limit, kinetic_force]: &mut [Vec<f64>; 6], threads: usize) {
    let part = ux.len().div_ceil(threads);
    let displacements = ux.par_chunks_mut(part).zip(uy.par_chunks_mut(part));
    let velocities = vx.par_chunks_mut(part).zip(vy.par_chunks_mut(part));
    let thresholds = static_limit.par_chunks(part).zip(kinetic_force.par_chunks(part));
    displacements.zip(velocities).zip(thresholds).for_each(
        |(((ux, uy), (vx, vy)), (static_limit, kinetic_force))| {
            for k in 0..ux.len() {
                ux[k] += 0.1 * vx[k];
                uy[k] += 0.1 * vy[k];
                vx[k] = 0.9 * vx[k] + 1e-9 * static_limit[k];
                vy[k] = 0.9 * vy[k] + 1e-9 * kinetic_force[k];
            }
        },
    );
}
