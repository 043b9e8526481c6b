//! Measures how many runs per second of small sliders a GPU, one CPU core and all cores compute, and checks
//! that GPU and CPU give the same bits. Prints a table, with tabs between its columns.
//!
//! ```console
//! $ cargo run --release -p slipfront-gpu --features cuda --example gpu_ensembles
//! ```
//!
//! The sliders are those of the paper's Fig. 3, with 25 x 25, 50 x 50 and 100 x 100 blocks and V* = 0.03.
//! Each has its own surface, takes 1000 steps of 0.1 t*, and yields one number from all its steps: the
//! largest mu*. The times of the GPU run from the models to these numbers. They exclude the generation of
//! surfaces, and include the copies to and from the GPU and the replay of the records on all CPU cores.

mod support;

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;
use slipfront::device::{Device, DeviceLattice};
use slipfront::{Execution, Model, Simulation, Stop};
use slipfront_gpu::Gpu;

use self::support::{DT_STAR, ENERGIES, Failure, model};

const STEPS: u32 = 1000;

/// The largest mu* of a run after the step at t = 0.
fn largest(mut simulation: Simulation) -> f64 {
    // Such a run does not diverge, and has no observer that could fail.
    let ended = simulation.run(Stop::at_step(u64::from(STEPS) - 1), &mut []);
    ended.map_or(f64::NAN, |_| simulation.peak().largest.mu_star)
}

fn on_gpu(gpu: &Gpu, models: &[Arc<Model>]) -> Result<Vec<f64>, Failure> {
    let begun = models
        .par_iter()
        .map(|model| DeviceLattice::new(Arc::clone(model), DT_STAR, None, ENERGIES));
    let mut lattices = begun.collect::<Result<Vec<_>, _>>()?;
    gpu.run(&mut lattices.iter_mut().collect::<Vec<_>>(), STEPS)?;
    Ok(lattices
        .into_par_iter()
        .map(|lattice| largest(Simulation::replay(lattice)))
        .collect())
}

fn on_cpu(model: &Arc<Model>) -> f64 {
    largest(Simulation::new(
        model.clone(),
        DT_STAR,
        None,
        Execution::default(),
    ))
}

fn main() -> Result<(), Failure> {
    let gpu = Gpu::open()?;
    println!("blocks\tone core\tall cores\tGPU\tGPU over one core\tsame bits");
    for (size, n) in [(25, 8192), (50, 4096), (100, 1024)] {
        let models = (0..n)
            .map(|seed| model(size, 0.03, seed))
            .collect::<Result<Vec<_>, _>>()?;
        on_gpu(&gpu, &models[..64])?;
        let began = Instant::now();
        let by_gpu = on_gpu(&gpu, &models)?;
        let gpu_rate = n as f64 / began.elapsed().as_secs_f64();
        let some = &models[..models.len() / 16];
        let began = Instant::now();
        let by_cpu: Vec<f64> = some.par_iter().map(on_cpu).collect();
        let all_rate = some.len() as f64 / began.elapsed().as_secs_f64();
        let alone = &some[..some.len() / 8];
        let began = Instant::now();
        alone.iter().for_each(|model| {
            on_cpu(model);
        });
        let rate = alone.len() as f64 / began.elapsed().as_secs_f64();
        let is_same = by_gpu
            .iter()
            .zip(&by_cpu)
            .all(|(a, b)| a.to_bits() == b.to_bits());
        println!(
            "{size} x {size}\t{rate:.0}\t{all_rate:.0}\t{gpu_rate:.0}\t{:.0}\t{}",
            gpu_rate / rate,
            if is_same { "yes" } else { "NO" }
        );
    }
    Ok(())
}
