//! Cost of a step of either kernel, in block-steps per second, and of reading a field of all blocks, on the baseline of Fig. 3
//! once it slides; cost of drawing its coefficients, beside that of all steps of a run.

use divan::Bencher;
use divan::counter::ItemsCount;
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

/// Lattices of `n` x `n` blocks whose steps are timed.
const SIZES: [usize; 4] = [25, 50, 200, 512];

/// Lattices and kernels from which fields are read.
const READ: [(usize, Kernel); 3] = [(256, Kernel::Fused), (512, Kernel::Fused), (256, Kernel::General)];

/// Lattices of `n` x `n` blocks whose coefficients are drawn.
const DRAWN: [usize; 3] = [25, 50, 200];

fn main() {
    divan::main();
}

fn step(bencher: Bencher, n: usize, kernel: Kernel) {
    let mut simulation = sliding(n, kernel);
    let bencher = bencher.counter(ItemsCount::new(n * n));
    bencher.bench_local(|| simulation.step());
}

#[divan::bench(args = SIZES)]
fn general_step(bencher: Bencher, n: usize) {
    step(bencher, n, Kernel::General);
}

#[divan::bench(args = SIZES)]
fn fused_step(bencher: Bencher, n: usize) {
    step(bencher, n, Kernel::Fused);
}

fn read_field_cases() -> impl Iterator<Item = (usize, Kernel, Field)> {
    let fields = [
        Field::ContactStress,
        Field::Traction,
        Field::DisplacementX,
        Field::VelocityX,
        Field::Sliding,
    ];
    READ.into_iter()
        .flat_map(move |(n, kernel)| fields.map(|field| (n, kernel, field)))
}

#[divan::bench(args = read_field_cases())]
fn read_field(bencher: Bencher, (n, kernel, field): (usize, Kernel, Field)) {
    let simulation = sliding(n, kernel);
    let mut values = vec![0.0; n * n];
    let bencher = bencher.counter(ItemsCount::new(n * n));
    bencher.bench_local(|| simulation.snapshot().read_field(field, &mut values));
}

#[divan::bench(args = READ)]
fn read_first_slips(bencher: Bencher, (n, kernel): (usize, Kernel)) {
    let simulation = sliding(n, kernel);
    let mut times = vec![0.0; n * n];
    let bencher = bencher.counter(ItemsCount::new(n * n));
    bencher.bench_local(|| simulation.snapshot().read_first_slips(&mut times));
}

fn draw_cases() -> impl Iterator<Item = (usize, f64)> {
    DRAWN
        .into_iter()
        .flat_map(|n| [0.25, 1.0, 5.0].map(|length| (n, length)))
}

/// Coefficients that are alike over `length` blocks.
#[divan::bench(args = draw_cases(), sample_count = 10)]
fn draw(bencher: Bencher, (n, length): (usize, f64)) {
    let lattice = Lattice::free(n, n);
    // Each time of another seed, as the runs of a study do.
    let mut seed = 0;
    bencher.bench_local(|| {
        seed += 1;
        let field = CorrelatedField::new(&lattice, length);
        Coefficients::draw_correlated(&field, &(0..n), gauss(1.0), gauss(0.5), seed)
    });
}

/// All steps of a run, to which the cost of its coefficients adds.
#[divan::bench(args = DRAWN, sample_count = 10)]
fn all_steps(bencher: Bencher, n: usize) {
    let model = baseline(n);
    bencher.bench_local(|| {
        let mut simulation = Simulation::new(model.clone(), 0.1, None, Execution::default());
        (0..2667).for_each(|_| simulation.step());
    });
}
