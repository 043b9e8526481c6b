//! Time of a step of either kernel, in block-steps per second, and of reading a field of all blocks, on the
//! baseline of Fig. 3 once it slides. Time of drawing the coefficients, compared with all steps of a run.

use std::time::{Duration, Instant};

use slipfront::exact_solutions::first_slip_time_star;
use slipfront::observe::Field;
use slipfront::surface::{Coefficients, CorrelatedField, Distribution, Load};
use slipfront::{Drive, Execution, FrictionLaw, Kernel, Lattice, Model, Simulation, Surface, scales};

fn gauss(mean: f64) -> Distribution {
    Distribution {
        mean,
        deviation: 0.05 * mean,
    }
}

fn baseline(n: usize) -> Model {
    let lattice = Lattice::free(n, n);
    let drawn = Coefficients::draw(n * n, gauss(1.0), gauss(0.5), 1);
    let surface = Surface::new(drawn, vec![false; n * n], Load::Redistributed, 1.0).expect("all in contact");
    let damping = scales::damping(0.1);
    Model::new(
        lattice,
        surface,
        Drive::along_x(0.03),
        damping,
        1e-6,
        FrictionLaw::Projection,
    )
}

/// A simulation past the transition, where blocks stick and slip as in most steps of a run.
fn sliding(n: usize, kernel: Kernel) -> Simulation {
    let model = baseline(n);
    let first = first_slip_time_star(&model.surface.mu_static, &model.surface.mu_kinetic, 1.0, 0.03);
    // Every block at every step, so that the result does not depend on where the slider happens to rest.
    let execution = Execution {
        kernel,
        skips: false,
        ..Execution::default()
    };
    let mut simulation = Simulation::new(model, 0.1, None, execution);
    while simulation.time_star() < first + 60.0 {
        simulation.step();
    }
    simulation
}

/// Sizes of the lattices of `n` x `n` blocks that are stepped.
const SIZES: [usize; 4] = [25, 50, 200, 512];

/// Fields that are read.
const FIELDS: [Field; 5] = [
    Field::ContactStress,
    Field::Traction,
    Field::DisplacementX,
    Field::VelocityX,
    Field::Sliding,
];

/// Lattices and kernels from which fields are read.
const READ: [(usize, Kernel); 3] = [(256, Kernel::Fused), (512, Kernel::Fused), (256, Kernel::General)];

/// Sizes of the lattices of `n` x `n` blocks for which coefficients are drawn.
const DRAWN: [usize; 3] = [25, 50, 200];

/// Duration of a measurement.
const MEASURED: Duration = Duration::from_millis(500);

/// Runs `work` repeatedly, and prints its least and its median time and the number of `items` per second at
/// the median.
fn measure(name: &str, items: usize, mut work: impl FnMut()) {
    let began = Instant::now();
    let mut times = Vec::new();
    while times.len() < 3 || began.elapsed() < MEASURED {
        let begun = Instant::now();
        work();
        times.push(begun.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    let (least, median) = (times[0], times[times.len() / 2]);
    let rate = items as f64 / median;
    println!(
        "{name:<50} {:>12.2} us {:>12.2} us {rate:>12.3e}/s",
        1e6 * least,
        1e6 * median
    );
}

fn main() {
    println!("{:<50} {:>15} {:>15} {:>14}", "", "least", "median", "blocks");
    for (name, kernel) in [("fused step", Kernel::Fused), ("general step", Kernel::General)] {
        for n in SIZES {
            let mut simulation = sliding(n, kernel);
            measure(&format!("{name}, {n}"), n * n, || simulation.step());
        }
    }
    for (n, kernel) in READ {
        let simulation = sliding(n, kernel);
        let (mut values, mut times) = (vec![0.0; n * n], vec![0.0; n * n]);
        for field in FIELDS {
            let name = format!("read {field:?}, {n}, {kernel:?}");
            measure(&name, n * n, || {
                simulation.snapshot().read_field(field, &mut values);
            });
        }
        let name = format!("read first slips, {n}, {kernel:?}");
        measure(&name, n * n, || {
            simulation.snapshot().read_first_slips(&mut times);
        });
    }
    for n in DRAWN {
        for length in [0.25, 1.0, 5.0] {
            draw(n, length);
        }
        let model = baseline(n);
        measure(&format!("all steps of a run, {n}"), n * n, || {
            let mut simulation = Simulation::new(model.clone(), 0.1, None, Execution::default());
            (0..2667).for_each(|_| simulation.step());
        });
    }
}

/// Measures drawing coefficients with correlation length `length`, each time from another seed, as in the
/// runs of a study.
fn draw(n: usize, length: f64) {
    let lattice = Lattice::free(n, n);
    let mut seed = 0;
    measure(
        &format!("draw coefficients, {n}, alike over {length}"),
        n * n,
        || {
            seed += 1;
            let field = CorrelatedField::new(&lattice, length);
            let drawn = Coefficients::draw_correlated(&field, &(0..n), gauss(1.0), gauss(0.5), seed);
            std::hint::black_box(drawn);
        },
    );
}
