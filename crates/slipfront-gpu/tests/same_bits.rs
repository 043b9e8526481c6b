//! The GPU kernels have the same bits as the fused kernel: in every number of every step, in the state, and
//! in the bounds that a checkpoint keeps, for random plain models.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

use std::sync::Arc;

use proptest::prelude::*;
use slipfront::communicator::Alone;
use slipfront::device::{Device, DeviceLattice, EnergySteps};
use slipfront::surface::{Adhesion, Coefficients, Contact, Distribution, Load};
use slipfront::testing::FusedDevice;
use slipfront::{
    Coulomb, DeadLoad, Drive, Edges, Execution, Friction, FrictionLaw, Lattice, Loading, Model, Outline,
    PositionBins, Program, Simulation, Slider, SlipWeakening, State, Stop, Surface, VectorField,
};
use slipfront_gpu::Emulated;

/// Numbers as bits, so that NaN equals itself.
fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| x.to_bits()).collect()
}

/// All results of a device for a lattice.
fn left(lattice: &DeviceLattice) -> (Vec<Vec<u64>>, Vec<u32>) {
    let State {
        displacement: u,
        velocity: v,
    } = &lattice.state;
    let motion = &lattice.motion;
    let mut numbers = [&u.x, &u.y, &v.x, &v.y].map(|field| bits(field)).to_vec();
    numbers.push(bits(&motion.bounds));
    numbers.push(bits(&motion.velocity_after));
    numbers.push(bits(&[motion.stress_square_max]));
    numbers.push(vec![motion.drive_steps, motion.drive_moves]);
    let of_law = lattice.strength.iter().flat_map(|strength| &strength.columns);
    numbers.extend(of_law.map(|column| bits(column)));
    (numbers, lattice.first_slips.clone())
}

fn assert_same(emulated: &mut DeviceLattice, fused: &mut DeviceLattice) {
    for (k, (one, other)) in emulated
        .records
        .drain(..)
        .zip(fused.records.drain(..))
        .enumerate()
    {
        assert_eq!(format!("{one:?}"), format!("{other:?}"), "record {k}");
        assert_eq!(bits(&one.stored), bits(&other.stored), "record {k}");
    }
    assert_eq!(left(emulated), left(fused));
    let counts = |lattice: &DeviceLattice| format!("{:?}", lattice.counts);
    assert_eq!(counts(emulated), counts(fused));
}

/// Runs a model on both devices in two batches of steps, and compares the results.
fn compare(
    model: &Model,
    dt_star: f64,
    from: Option<&State>,
    device: Emulated,
    [first, second, every]: [u32; 3],
) {
    let energies = EnergySteps {
        every: u64::from(every),
        last: u64::from(first + second - 1),
    };
    let mut fused = DeviceLattice::new(model.clone(), dt_star, from, energies).unwrap();
    if every % 2 == 1 {
        fused.add_counts(u64::from(every), &PositionBins::new(&model.lattice, &model.drive));
    }
    let mut emulated = fused.clone();
    for steps in [first, second] {
        FusedDevice.run(&mut [&mut fused], steps).unwrap();
        device.run(&mut [&mut emulated], steps).unwrap();
        assert_same(&mut emulated, &mut fused);
    }
}

fn edges() -> impl Strategy<Value = Edges> {
    prop_oneof![Just(Edges::Free), Just(Edges::Periodic)]
}

prop_compose! {
    /// A plain model, its time step and an initial state.
    fn models()(
        // Two tiles along x and y, or one.
        (nx, ny) in (3_usize..40, 3_usize..20),
        edges in (edges(), edges()),
        (degrees, speed) in (prop_oneof![Just(0.0), -180.0..180.0], prop_oneof![Just(0.1), 0.01..2.0]),
        (goes_back, is_held) in (any::<bool>(), any::<bool>()),
        // Strains for which the short series, the long series or the square root is needed.
        epsilon in prop_oneof![Just(0.0), Just(1e-6), 1e-5..1e-2, 1e-2..0.3],
        (damping, k_drive) in (0.0..2.0, 0.01..1.0),
        (r_star, deviation, seed) in (0.0..1.2, 0.0..0.3, any::<u64>()),
        (texture, hole) in (prop::option::of(2_usize..7), prop::option::of(2_usize..5)),
        (load, adhesion) in (prop_oneof![Just(Load::Redistributed), Just(Load::Kept)], 0.0..0.5),
        dead_load in prop_oneof![Just([0.0; 2]), (-0.3..0.3, -0.3..0.3).prop_map(|(x, y)| [x, y])],
        fall in prop::option::of((0.01..2.0, prop::option::of(0.2..3.0))),
        thrown in prop::option::of(0.001..2.0),
        dt_star in 0.05..0.3,
    ) -> (Model, f64, Option<State>) {
        let lattice = Lattice::with_edges(nx, ny, [edges.0, edges.1]);
        let n = lattice.n_blocks();
        let gauss = |mean: f64| Distribution { mean, deviation: deviation * mean };
        let coefficients = Coefficients::draw_blocks(0..n, gauss(1.0), gauss(r_star), seed);
        let textured = (0..n).map(|b| texture.is_some_and(|each| b % each == 0)).collect();
        let exists: Vec<bool> = (0..n).map(|b| hole.is_none_or(|hole| lattice.column_row(b).0.max(lattice.column_row(b).1) >= hole)).collect();
        let is_whole = exists.iter().all(|exists| *exists);
        let outline = (!is_whole && exists.contains(&true)).then(|| Outline::new(exists, &Alone));
        let slider = Slider::new(None, None, outline, &Alone);
        let contact = Contact {
            adhesion: Adhesion { of_static: adhesion, of_kinetic: 0.5 * adhesion },
            ..Contact::new(load, 1.0)
        };
        let surface = Surface::of_ranks(coefficients, textured, contact, &slider, &Alone).unwrap();
        let program = goes_back.then(|| Arc::new(Program::new([(speed, 3.0), (-speed, 5.0), (speed, f64::INFINITY)])));
        let loading = if is_held { Loading::Held { onset_steps: 9 } } else { Loading::Constant };
        let drive = Drive { program, k_drive, loading, ..Drive::at_angle(speed, degrees) };
        let slip_weakening = fall.map(|(length, healing_time)| SlipWeakening { length, healing_time });
        let friction = Friction::Coulomb(Coulomb { slip_weakening, ..FrictionLaw::Projection.into() });
        let model = Model::new(lattice, surface, drive, damping, epsilon, friction)
            .with_slider(slider.clone())
            .with_dead_load(DeadLoad::uniform(dead_load));
        let wave = |k: f64, apart: usize, size: f64| -> Vec<f64> {
            let one = |b: usize| if slider.exists(b) && b.is_multiple_of(apart) { size * (k * b as f64 + 1.0).sin() } else { 0.0 };
            (0..n).map(one).collect()
        };
        let state = thrown.map(|size| State {
            displacement: VectorField { x: wave(1.7, 1, size), y: wave(2.9, 1, size) },
            velocity: VectorField { x: wave(0.7, 4, 0.1 * size), y: wave(1.3, 4, 0.1 * size) },
        });
        (model, dt_star, state)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_plain_models(
        (model, dt_star, state) in models(),
        threads in prop_oneof![Just(32_u32), Just(64), Just(128)],
        half_stride in 0..16_u32,
        groups in prop::option::of(1..4_u32),
        (first, second) in (1..40_u32, 1..60_u32),
        every in 1..9_u32,
    ) {
        let mut simulation = Simulation::new(model.clone(), dt_star, state.clone(), Execution::default());
        prop_assume!(simulation.run(Stop::at_step(u64::from(first + second)), &mut []).is_ok(), "diverges");
        compare(&model, dt_star, state.as_ref(), Emulated { threads, stride: 2 * half_stride + 1, groups }, [first, second, every]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 30, failure_persistence: None, ..ProptestConfig::default() })]

    /// Several models in one call, some with strength that falls or with counts, each at its place in the
    /// arrays.
    #[test]
    fn several_models_at_once(
        models in prop::collection::vec(models(), 3),
        counted in prop::collection::vec(any::<bool>(), 3),
        groups in prop::option::of(1..4_u32),
        steps in 1..40_u32,
    ) {
        let energies = EnergySteps { every: 3, last: 0 };
        let mut fused = Vec::new();
        for ((model, dt_star, state), counted) in models.into_iter().zip(counted) {
            let mut simulation = Simulation::new(model.clone(), dt_star, state.clone(), Execution::default());
            prop_assume!(simulation.run(Stop::at_step(u64::from(2 * steps)), &mut []).is_ok(), "diverges");
            let bins = PositionBins::new(&model.lattice, &model.drive);
            let mut lattice = DeviceLattice::new(model, dt_star, state.as_ref(), energies).unwrap();
            if counted {
                lattice.add_counts(5, &bins);
            }
            fused.push(lattice);
        }
        let mut emulated = fused.clone();
        let device = Emulated { threads: 64, stride: 1, groups };
        for _ in 0..2 {
            FusedDevice.run(&mut fused.iter_mut().collect::<Vec<_>>(), steps).unwrap();
            device.run(&mut emulated.iter_mut().collect::<Vec<_>>(), steps).unwrap();
            for (one, other) in emulated.iter_mut().zip(&mut fused) {
                assert_same(one, other);
            }
        }
    }
}

/// Each kernel on a few blocks that move from the start, with strength that falls and without. This test is
/// short under a sanitizer, too. Three groups of threads share four tiles.
#[test]
fn few_blocks() {
    let (nx, ny) = (33, 17);
    let n = nx * ny;
    let wave = |k: f64, size: f64| -> Vec<f64> { (0..n).map(|b| size * (k * b as f64).sin()).collect() };
    let moving = State {
        displacement: VectorField {
            x: wave(1.7, 0.5),
            y: wave(2.9, 0.5),
        },
        velocity: VectorField {
            x: wave(0.7, 0.1),
            y: wave(1.3, 0.1),
        },
    };
    for (epsilon, groups) in [(1e-6, None), (1e-3, None), (0.1, Some(3)), (1e-6, Some(3))] {
        let lattice = Lattice::with_edges(nx, ny, [Edges::Periodic, Edges::Free]);
        let mut surface = Surface::uniform(&lattice, 1.0, 0.5);
        surface.textured[30] = true;
        let slip_weakening = (epsilon == 1e-6).then_some(SlipWeakening {
            length: 0.1,
            healing_time: Some(0.5),
        });
        let friction = Friction::Coulomb(Coulomb {
            slip_weakening,
            ..FrictionLaw::Projection.into()
        });
        let model = Model::new(lattice, surface, Drive::along_x(0.1), 0.1, epsilon, friction);
        let device = Emulated {
            threads: 64,
            stride: 1,
            groups,
        };
        compare(&model, 0.2, Some(&moving), device, [5, 16, 3]);
    }
}

/// The test that every device must pass before it is used.
#[test]
fn the_test_of_a_device_is_passed() {
    for groups in [None, Some(3)] {
        let device = Emulated {
            threads: 256,
            stride: 1,
            groups,
        };
        (&device as &dyn Device).test_bits().unwrap();
    }
}

/// The baseline of the paper through its onset.
#[test]
fn the_baseline_slips() {
    for groups in [None, Some(2)] {
        compare_baseline(groups);
    }
}

fn compare_baseline(groups: Option<u32>) {
    let lattice = Lattice::free(25, 25);
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let coefficients = Coefficients::draw_blocks(0..625, gauss(1.0), gauss(0.5), 1);
    let textured = (0..625)
        .map(|b| b % 25 > 9 && b % 25 < 15 && b / 25 > 9 && b / 25 < 15)
        .collect();
    let surface = Surface::of_ranks(
        coefficients,
        textured,
        Contact::new(Load::Redistributed, 1.0),
        &Slider::default(),
        &Alone,
    )
    .unwrap();
    let model = Model::new(
        lattice,
        surface,
        Drive::along_x(0.1),
        0.1 * 0.75_f64.sqrt(),
        1e-6,
        FrictionLaw::Projection,
    );
    let device = Emulated {
        threads: 128,
        stride: 1,
        groups,
    };
    compare(&model, 0.2, None, device, [100, 60, 7]);
    let mut lattice = DeviceLattice::new(model, 0.2, None, EnergySteps { every: 1, last: 0 }).unwrap();
    device.run(&mut [&mut lattice], 160).unwrap();
    assert!(
        lattice.records.iter().any(|record| record.n_sliding[1] > 500),
        "the slider slips"
    );
}
