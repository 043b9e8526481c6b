//! Runs a second of many small sliders on a GPU, beside one core and all cores of the machine, and whether
//! they have the same bits.
//!
//! ```console
//! $ cargo run --release -p slipfront-gpu --features cuda --example gpu_ensembles
//! ```
//!
//! Sliders are those of the paper's Fig. 3 on 25 x 25 and 50 x 50 blocks at V* = 0.03, each with a surface of
//! its own, through 1000 steps of 0.1 t*, and a number for each from all its steps: its largest mu*. Times
//! of the GPU count from the models to these numbers: surfaces are made on the CPU before, copied there, and
//! records are copied back and replayed on all cores.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;
use slipfront::communicator::Alone;
use slipfront::device::{Device, DeviceLattice, EnergySteps};
use slipfront::surface::{Coefficients, Contact, Distribution, Load};
use slipfront::{Drive, Execution, FrictionLaw, Lattice, Model, Simulation, Slider, Stop, Surface, scales};
use slipfront_gpu::Gpu;

const DT_STAR: f64 = 0.1;
const STEPS: u32 = 1000;
/// No energies but at the start.
const ENERGIES: EnergySteps = EnergySteps {
    every: u64::MAX,
    last: 0,
};

fn model(size: usize, seed: u64) -> Result<Arc<Model>, Box<dyn Error + Send + Sync>> {
    let lattice = Lattice::free(size, size);
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let coefficients = Coefficients::draw_blocks(0..lattice.n_blocks(), gauss(1.0), gauss(0.5), seed);
    let contact = Contact::new(Load::Redistributed, 1.0);
    let textured = vec![false; lattice.n_blocks()];
    let surface = Surface::of_ranks(coefficients, textured, contact, &Slider::default(), &Alone)?;
    let damping = scales::damping(0.1);
    Ok(Arc::new(Model::new(
        lattice,
        surface,
        Drive::along_x(0.03),
        damping,
        1e-6,
        FrictionLaw::Projection,
    )))
}

/// The largest mu* of a run after the step at t = 0.
fn largest(mut simulation: Simulation) -> f64 {
    // Such a run does not diverge, and has no observer that could fail.
    let ended = simulation.run(Stop::at_step(u64::from(STEPS) - 1), &mut []);
    ended.map_or(f64::NAN, |_| simulation.peak().largest.mu_star)
}

fn on_gpu(gpu: &Gpu, models: &[Arc<Model>]) -> Result<Vec<f64>, Box<dyn Error + Send + Sync>> {
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

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let gpu = Gpu::open()?;
    println!("{}, beside {} threads", gpu.name()?, rayon::current_num_threads());
    println!("blocks   runs/s: one core   all cores   GPU   GPU over one core   same bits");
    for (size, n) in [(25, 8192), (50, 4096), (64, 2048)] {
        let models = (0..n)
            .map(|seed| model(size, seed))
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
            "{size}^2   {rate:.0}   {all_rate:.0}   {gpu_rate:.0}   {:.0}   {}",
            gpu_rate / rate,
            if is_same { "yes" } else { "NO" }
        );
    }
    Ok(())
}
