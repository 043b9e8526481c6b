//! A run with steps that a device has recorded equals the run of the fused kernel, to the last bit.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use slipfront::checkpoint::BlockColumn;
use slipfront::communicator::Alone;
use slipfront::device::{Device, DeviceError, DeviceLattice, EnergySteps};
use slipfront::observe::frames::Selection;
use slipfront::observe::{Curve, Field, Frames, Instants, KineticStart, Kymograph, Schedule, Scheduled};
use slipfront::surface::{Load, Texture};
use slipfront::testing::FusedDevice;
use slipfront::{
    Ageing, Body, Coulomb, Edges, Execution, Face, Friction, Interface, Loading, Model, Rotation, Simulation,
    SlipWeakening, State, Stop,
};
use test_case::test_matrix;

use crate::common::{Slider, cavity, thrown, varied};
use crate::executions::{shown, state};
use crate::fields::assert_fields_match_blocks;
use crate::{bits, columns, fused, go, stopped_and_resumed};

const EVERY: EnergySteps = EnergySteps { every: 1, last: 0 };

fn lattice(model: &Model, dt_star: f64, from: Option<&State>) -> DeviceLattice {
    DeviceLattice::new(model.clone(), dt_star, from, EVERY).unwrap()
}

/// Advances a lattice by some steps.
fn record(lattice: &mut DeviceLattice, steps: u32) {
    FusedDevice.run(&mut [lattice], steps).unwrap();
}

/// Recorded in parts; 16 steps are the interval between two measurements.
#[test_matrix(
    [Edges::Free, Edges::Periodic],
    [None, Some(cavity([17, 12], 10.0, 1, 0.3, true))],
    [1e-6, 5e-3],
    [1, 16, 35]
)]
fn a_replay_has_the_same_bits(edges: Edges, texture: Option<Texture>, epsilon: f64, part: u32) {
    let slider = Slider {
        blocks: [17, 12],
        edges: [edges, Edges::Free],
        textures: texture.into_iter().collect(),
        epsilon,
        degrees: 25.0,
        v_star: 0.1,
        dt_star: 0.2,
        load: Load::Kept,
        dead_load: ([0.02, -0.03], false),
        ..Slider::default()
    };
    for from in [None, Some(thrown(17 * 12, 0.1, 40))] {
        let (model, dt_star) = (slider.model(), slider.dt_star);
        let mut begun = lattice(&model, dt_star, from.as_ref());
        record(&mut begun, 1);
        let mut replayed = Simulation::replay(begun);
        let mut direct = Simulation::new(model.clone(), dt_star, from.clone(), fused());
        assert_eq!(shown(&replayed), shown(&direct));
        for step in 1..=slider.steps(4.0) {
            if (step - 1).is_multiple_of(u64::from(part)) {
                record(replayed.device_lattice().unwrap(), part);
            }
            go(&mut direct, step % 5 == 0);
            go(&mut replayed, step % 5 == 0);
            assert_eq!(shown(&replayed), shown(&direct), "step {step}");
            let first_slips = [&direct, &replayed].map(|run| bits(&run.snapshot().first_slip_time_star()));
            assert_eq!(first_slips[0], first_slips[1], "step {step}");
            if step.is_multiple_of(u64::from(part)) && step.is_multiple_of(7) {
                assert_eq!(state(&replayed), state(&direct), "step {step}");
                assert_fields_match_blocks(&replayed);
                let [one, other] =
                    [&direct, &replayed].map(|run| postcard::to_stdvec(&run.checkpoint()).unwrap());
                assert_eq!(one, other, "step {step}");
                let [one, other] = [&direct, &replayed].map(columns);
                let bits_of =
                    |columns: Vec<Vec<f64>>| columns.iter().map(|column| bits(column)).collect::<Vec<_>>();
                assert_eq!(bits_of(one), bits_of(other), "step {step}");
            }
        }
    }
}

/// A device whose last bit is wrong in one number of one block of a slider of this size: in the last of the
/// numbers that the law remembers, if there are any, else in a velocity.
#[derive(Debug)]
struct Wrong(usize);

impl Device for Wrong {
    fn name(&self) -> String {
        "a wrong device".to_owned()
    }

    fn most_blocks(&self) -> usize {
        usize::MAX
    }

    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        FusedDevice.run(lattices, steps)?;
        if let [lattice] = lattices
            && lattice.blocks == [self.0; 2]
        {
            let of_law = lattice
                .strength
                .as_mut()
                .and_then(|strength| strength.columns.last_mut());
            let one = &mut of_law.unwrap_or(&mut lattice.state.velocity.x)[self.0];
            *one = f64::from_bits(one.to_bits() ^ 1);
        }
        Ok(())
    }
}

#[test]
fn a_device_with_other_bits_is_not_used() {
    (&FusedDevice as &dyn Device).test_bits().unwrap();
    for size in [60, 100] {
        let refused = (&Wrong(size) as &dyn Device).test_bits().unwrap_err();
        let sentence = format!(
            "a wrong device must not be used, since a test with {size} x {size} blocks differs from the CPU"
        );
        assert_eq!(refused.to_string(), sentence);
    }
}

/// A device that fails from some call on, having changed the lattices.
#[derive(Debug)]
struct Failing {
    calls: AtomicU32,
    good: u32,
}

impl Device for Failing {
    fn name(&self) -> String {
        "failing".to_owned()
    }

    fn most_blocks(&self) -> usize {
        usize::MAX
    }

    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        FusedDevice.run(lattices, steps)?;
        if self.calls.fetch_add(1, Ordering::Relaxed) < self.good {
            return Ok(());
        }
        Err(DeviceError("broken".to_owned()))
    }
}

/// A run passes between a device and the CPU, and its observers read fields and energies at any step: frames,
/// instants, energies, the kymograph, and the state at a checkpoint.
#[test_matrix(
    [None, Some(cavity([17, 12], 10.0, 1, 0.3, true))],
    [Loading::Constant, Loading::Held { onset_steps: 100 }],
    [u32::MAX, 0, 5],
    [1, 61, u64::MAX]
)]
fn a_run_on_a_device_has_the_same_bits(texture: Option<Texture>, loading: Loading, good: u32, part: u64) {
    let slider = Slider {
        loading,
        textures: texture.into_iter().collect(),
        ..observed_slider()
    };
    assert_same_on_device(&slider, good, part);
}

/// Strength that falls with slip, with blocks that heal and without: the memory of the law, which checkpoints
/// keep and energies read, passes between a device and the CPU.
#[test_matrix([None, Some(2.0)], [Loading::Constant, Loading::Held { onset_steps: 100 }], [u32::MAX, 5])]
fn a_run_in_which_strength_falls_has_the_same_bits(healing_time: Option<f64>, loading: Loading, good: u32) {
    let slider = Slider {
        loading,
        textures: vec![cavity([17, 12], 10.0, 1, 0.3, true)],
        slip_weakening: Some(SlipWeakening {
            length: 0.4,
            healing_time,
        }),
        ..observed_slider()
    };
    assert_same_on_device(&slider, good, 61);
    let mut run = Simulation::new(slider.model(), slider.dt_star, None, fused());
    run.run(Stop::at_step(slider.steps(4.0)), &mut []).unwrap();
    assert!(run.snapshot().weakening_energy() > 0.0, "strength falls");
    let of_law = &columns(&run)[BlockColumn::ALL.len()..];
    let has_healed = of_law
        .get(2)
        .is_some_and(|lost| lost.iter().any(|share| *share > 0.0));
    assert_eq!(has_healed, healing_time.is_some());
}

fn observed_slider() -> Slider {
    Slider {
        blocks: [17, 12],
        degrees: 25.0,
        v_star: 0.1,
        dt_star: 0.2,
        load: Load::Kept,
        ..Slider::default()
    }
}

/// Compares runs on a device that fails at call `good`, on the CPU and on both in turn. They are taken up at
/// checkpoints between parts of `part` steps.
fn assert_same_on_device(slider: &Slider, good: u32, part: u64) {
    let (model, dt_star, stop) = (slider.model(), slider.dt_star, Stop::at_step(slider.steps(4.0)));
    let device = Arc::new(Failing {
        calls: AtomicU32::new(0),
        good,
    });
    let on_device = Execution {
        device: Some(device),
        ..fused()
    };
    for from in [None, Some(thrown(17 * 12, 0.1, 40))] {
        let observed = |executions: [&Execution; 2]| {
            let selection = Selection {
                fields: vec![Field::DisplacementX, Field::ContactStress, Field::Sliding],
                stride: 1,
            };
            let mut instants = Instants::new(selection.clone(), KineticStart::Auto, 1e9);
            let (mut frames, mut kymograph) = (Frames::new(selection), Kymograph::default());
            let (mut curve, mut energies) = (Curve::every(3), Curve::every(14));
            let mut run = Simulation::new(model.clone(), dt_star, from.clone(), executions[0].clone());
            for parts in 1.. {
                let mut observers = [
                    Scheduled::always(&mut instants),
                    Scheduled::new(Schedule::Every(37), &mut frames),
                    kymograph.scheduled(),
                    Scheduled::always(&mut curve),
                    Scheduled::always(&mut energies),
                ];
                if run.advance(stop, part, &mut observers).unwrap().is_some() {
                    break;
                }
                if parts % 7 == 0 {
                    let next = executions[parts / 7 % 2].clone();
                    run = stopped_and_resumed(&run, &model, dt_star, next);
                }
            }
            assert_fields_match_blocks(&run);
            let found = (
                shown(&run),
                state(&run),
                bits(&run.snapshot().first_slip_time_star()),
            );
            (found, instants, frames, kymograph, curve.rows, energies.rows)
        };
        let cpu = fused();
        let expected = format!("{:?}", observed([&cpu, &cpu]));
        assert!(expected == format!("{:?}", observed([&on_device, &on_device])));
        assert!(expected == format!("{:?}", observed([&on_device, &cpu])));
    }
    let mut run = Simulation::new(model, dt_star, None, on_device);
    run.step();
    assert_eq!(run.device_failure().is_some(), good != u32::MAX);
}

/// The device computes where readings are far apart, many steps at once, and the fused kernel where they are
/// close together; after it the device goes on.
#[test]
fn a_device_is_called_where_readings_are_apart() {
    let slider = Slider {
        blocks: [17, 12],
        v_star: 0.1,
        ..Slider::default()
    };
    let device = Arc::new(Failing {
        calls: AtomicU32::new(0),
        good: u32::MAX,
    });
    let on_device = Execution {
        device: Some(Arc::clone(&device) as Arc<dyn Device>),
        ..fused()
    };
    let close = (900..1000).step_by(5);
    let read: Vec<u64> = (0..=800).step_by(40).chain(close).chain([1500, 1600]).collect();
    let observed = |execution: Execution| {
        let mut frames = Frames::new(Selection {
            fields: vec![Field::ContactStress],
            stride: 1,
        });
        let mut run = Simulation::new(slider.model(), 0.1, None, execution);
        let mut calls = Vec::new();
        for end in [800, 890, 990, 1050, 2000] {
            let mut observers = [Scheduled::new(Schedule::At(read.clone()), &mut frames)];
            run.run(Stop::at_step(end), &mut observers).unwrap();
            calls.push(device.calls.swap(0, Ordering::Relaxed));
        }
        ((shown(&run), state(&run), frames), calls)
    };
    let (on_cpu, none) = observed(fused());
    let (found, calls) = observed(on_device);
    assert_eq!(none, [0; 5]);
    assert!(format!("{found:?}") == format!("{on_cpu:?}"));
    // One call from reading to reading; more where a reading was not foreseen, and at an end, which needs
    // energies.
    let [until_800, until_890, close, after, until_2000] = calls[..] else {
        panic!()
    };
    assert!((20..=25).contains(&until_800), "{calls:?}");
    assert!(until_890 <= 4 && close <= 4 && after == 0, "{calls:?}");
    assert!((5..=25).contains(&until_2000), "{calls:?}");
}

/// A device records the weakening energy of every row of a series: rows are no readings of single blocks.
#[test]
fn weakening_energies_are_recorded_on_the_device() {
    let slider = Slider {
        blocks: [30, 20],
        v_star: 0.1,
        slip_weakening: Some(SlipWeakening {
            length: 0.4,
            healing_time: None,
        }),
        ..Slider::default()
    };
    let device = Arc::new(Failing {
        calls: AtomicU32::new(0),
        good: u32::MAX,
    });
    let observed = |execution: Execution| {
        let mut curve = Curve::every(3);
        let mut run = Simulation::new(slider.model(), 0.1, None, execution);
        let mut observers = [Scheduled::always(&mut curve)];
        run.run(Stop::at_step(900), &mut observers).unwrap();
        (shown(&run), state(&run), curve)
    };
    let on_cpu = format!("{:?}", observed(fused()));
    let (found, state, curve) = observed(Execution {
        device: Some(Arc::clone(&device) as Arc<dyn Device>),
        ..fused()
    });
    assert!(curve.rows[290].energies.weakening_loss > 0.0);
    assert!(format!("{:?}", (found, state, curve)) == on_cpu);
    // 16, 32, ... 512 steps at once; one call more for the energies that were not foreseen, and one for the
    // state at the end.
    assert_eq!(device.calls.load(Ordering::Relaxed), 8);
}

/// The device counts blocks by their position, after the fused kernel has found that they are counted: it
/// computes the steps of a transition.
#[test]
fn a_kymograph_is_counted_on_the_device() {
    let slider = Slider {
        blocks: [30, 20],
        v_star: 0.1,
        ..Slider::default()
    };
    let device = Arc::new(Failing {
        calls: AtomicU32::new(0),
        good: u32::MAX,
    });
    let observed = |execution: Execution| {
        let mut kymograph = Kymograph::default();
        let mut run = Simulation::new(slider.model(), 0.1, None, execution);
        let mut calls = Vec::new();
        for end in [500, 900] {
            run.run(Stop::at_step(end), &mut [kymograph.scheduled()]).unwrap();
            let sliding = run.snapshot().totals.n_slipping;
            assert!(0 < sliding && sliding < 600, "{sliding} blocks slide");
            calls.push(device.calls.swap(0, Ordering::Relaxed));
        }
        ((kymograph, shown(&run), state(&run)), calls)
    };
    let (expected, _) = observed(fused());
    let (found, calls) = observed(Execution {
        device: Some(Arc::clone(&device) as Arc<dyn Device>),
        ..fused()
    });
    assert!(format!("{found:?}") == format!("{expected:?}"));
    // Readings at every eighth step would leave all of these steps to the fused kernel.
    assert!((1..10).contains(&calls[1]), "{calls:?}");
}

/// Several lattices at once, of different shapes, up to their onsets, which come at different steps: the
/// device goes beyond the onset of some of them.
#[test]
fn several_lattices_stop_each_at_its_onset() {
    let sliders: Vec<_> = (1..6_u64)
        .map(|seed| Slider {
            blocks: [9 + seed as usize, 8],
            v_star: 0.1,
            seed,
            ..Slider::default()
        })
        .collect();
    let models: Vec<_> = sliders.iter().map(Slider::model).collect();
    let stop = Stop::after_onset(sliders[0].steps(8.0));
    let mut lattices: Vec<_> = models.iter().map(|model| lattice(model, 0.1, None)).collect();
    let mut all: Vec<_> = lattices.iter_mut().collect();
    FusedDevice.run(&mut all, 500).unwrap();
    let mut onsets = Vec::new();
    for (model, lattice) in models.into_iter().zip(lattices) {
        let (mut curve, mut directly) = (Curve::every(40), Curve::every(40));
        let mut replayed = Simulation::replay(lattice);
        let mut direct = Simulation::new(model, 0.1, None, Execution::default());
        replayed.run(stop, &mut [Scheduled::always(&mut curve)]).unwrap();
        direct.run(stop, &mut [Scheduled::always(&mut directly)]).unwrap();
        assert_eq!(curve.rows, directly.rows);
        assert_eq!(shown(&replayed), shown(&direct));
        onsets.push(replayed.snapshot().step);
        let first_slips = [direct, replayed].map(|run| bits(&run.into_first_slip_time_star()));
        assert_eq!(first_slips[0], first_slips[1]);
    }
    onsets.dedup();
    assert!(
        onsets.len() > 1 && onsets.iter().all(|step| *step < 499),
        "{onsets:?}"
    );
}

#[test]
#[should_panic(expected = "where the device has stopped, and not at step 3")]
fn blocks_are_known_where_the_device_has_stopped() {
    let model = Slider::default().model();
    let mut lattice = lattice(&model, 0.1, None);
    record(&mut lattice, 8);
    let mut replayed = Simulation::replay(lattice);
    for _ in 0..3 {
        replayed.step();
    }
    let mut values = vec![0.0; 625];
    replayed.snapshot().read_field(Field::DisplacementX, &mut values);
}

#[test]
#[should_panic(expected = "step 2 was not recorded")]
fn a_replay_ends_with_what_is_recorded() {
    let model = Slider::default().model();
    let mut lattice = lattice(&model, 0.1, None);
    record(&mut lattice, 2);
    let mut replayed = Simulation::replay(lattice);
    replayed.step();
    replayed.step();
}

/// Models with anything that the equations of a device do not cover are refused.
#[test]
fn models_that_are_not_plain_are_refused() {
    let plain = || Slider {
        blocks: [8, 6],
        ..Slider::default()
    };
    let n = 48;
    let body = Body {
        height: 5.0,
        poisson: 0.3,
        face: Face::Pressure,
    };
    let mut turning = plain().model();
    turning.drive.rotation = Some(Rotation::about_centroid(
        &turning.lattice,
        &turning.rows,
        turning.slider(),
        &Alone,
    ));
    let ageing = Friction::Coulomb(Coulomb {
        ageing: Some(Ageing {
            beta: 0.02,
            time: 1.0,
        }),
        ..plain().law.into()
    });
    let mut aged = plain().model();
    aged.friction = ageing;
    let cases = [
        (
            Slider {
                edges: [Edges::Periodic; 2],
                ..plain()
            }
            .model()
            .with_body(body),
            "a bulk body is",
        ),
        (
            Slider {
                interface: Some(Interface { foundation: 0.0 }),
                ..plain()
            }
            .model(),
            "an upright sheet is",
        ),
        (aged, "friction other than Coulomb's"),
        (turning, "a drive that rotates is"),
        (
            Slider {
                body: varied(n, false),
                ..plain()
            }
            .model(),
            "sliders whose blocks",
        ),
    ];
    for (model, what) in cases {
        let refused = DeviceLattice::new(model, 0.1, None, EVERY)
            .unwrap_err()
            .to_string();
        assert!(
            refused.starts_with(what) && refused.ends_with("computed on the CPU alone"),
            "{refused}"
        );
    }
}
