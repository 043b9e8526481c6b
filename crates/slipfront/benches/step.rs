//! Cost of a step of either kernel, in block-steps per second, and of reading a field of all blocks, on the baseline of Fig. 3
//! once it slides; cost of drawing its coefficients, beside that of all steps of a run.

#![allow(missing_docs)] // Criterion's macros make public functions without a word.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
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

fn step(criterion: &mut Criterion, group: &str, kernel: Kernel) {
    let mut group = criterion.benchmark_group(group);
    for n in [25, 50, 200, 512] {
        let mut simulation = sliding(n, kernel);
        group.throughput(Throughput::Elements((n * n) as u64));
        group.bench_function(BenchmarkId::from_parameter(format!("{n}x{n}")), |bencher| {
            bencher.iter(|| simulation.step());
        });
    }
    group.finish();
}

fn read_field(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("read_field");
    for (n, kernel) in [(256, Kernel::Fused), (512, Kernel::Fused), (256, Kernel::General)] {
        group.throughput(Throughput::Elements((n * n) as u64));
        let simulation = sliding(n, kernel);
        let mut values = vec![0.0; n * n];
        for field in [
            Field::ContactStress,
            Field::Traction,
            Field::DisplacementX,
            Field::VelocityX,
            Field::Sliding,
        ] {
            let name = format!("{} {n}x{n} {field:?}", kernel.name());
            group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
                bencher.iter(|| simulation.snapshot().read_field(field, &mut values));
            });
        }
        let mut times = vec![0.0; n * n];
        let name = format!("{} {n}x{n} first slips", kernel.name());
        group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
            bencher.iter(|| simulation.snapshot().read_first_slips(&mut times));
        });
    }
    group.finish();
}

fn draw(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("draw");
    group.sample_size(10);
    for n in [25, 50, 200] {
        let lattice = Lattice::free(n, n);
        for length in [0.25, 1.0, 5.0] {
            // Each time of another seed, as the runs of a study do.
            let mut seed = 0;
            let name = format!("{n}x{n} alike over {length} blocks");
            group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
                bencher.iter(|| {
                    seed += 1;
                    let field = CorrelatedField::new(&lattice, length);
                    Coefficients::draw_correlated(&field, &(0..n), gauss(1.0), gauss(0.5), seed)
                });
            });
        }
        let model = baseline(n);
        group.bench_function(
            BenchmarkId::from_parameter(format!("{n}x{n} all steps")),
            |bencher| {
                bencher.iter(|| {
                    let mut simulation = Simulation::new(model.clone(), 0.1, None, Execution::default());
                    (0..2667).for_each(|_| simulation.step());
                });
            },
        );
    }
    group.finish();
}

fn general(criterion: &mut Criterion) {
    step(criterion, "general_step", Kernel::General);
}

fn fused(criterion: &mut Criterion) {
    step(criterion, "fused_step", Kernel::Fused);
}

criterion_group!(benches, general, fused, read_field, draw);
criterion_main!(benches);
