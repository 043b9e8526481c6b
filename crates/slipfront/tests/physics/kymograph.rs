//! The kymograph agrees with the fields, on any kernel and any number of threads and ranks.

use std::sync::Arc;

use slipfront::observe::{Field, Kymograph, Observer, Schedule, Scheduled};
use slipfront::testing::Threads;
use slipfront::{Edges, Execution, PositionBins, RunError, Simulation, Snapshot, Stop};
use test_case::test_matrix;

use crate::common::{Slider, cavity, fused, general, varied};

/// The share of sliding blocks among those in contact, read from the field.
#[derive(Default)]
struct FromField {
    rows: Vec<Vec<f64>>,
    blocks: Vec<f64>,
}

impl Observer for FromField {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let model = now.model;
        let bins = PositionBins::new(&model.lattice, &model.drive);
        let mut field = vec![0.0; model.surface.n_blocks()];
        now.read_field(Field::Sliding, &mut field);
        let (mut sliding, mut blocks) = (vec![0.0; bins.count], vec![0.0; bins.count]);
        for (b, slides) in field.into_iter().enumerate() {
            let (i, j) = model.lattice.column_row(b);
            if !model.surface.textured[b] {
                sliding[bins.bin(i, j)] += f64::from(slides);
                blocks[bins.bin(i, j)] += 1.0;
            }
        }
        self.rows.push(sliding);
        self.blocks = blocks;
        Ok(())
    }
}

fn sliders() -> [Slider; 4] {
    let slider = |blocks, edges, degrees| Slider {
        blocks,
        edges,
        degrees,
        v_star: 0.1,
        sigma_static_star: 0.2,
        dt_star: 0.2,
        ..Slider::default()
    };
    let free = [Edges::Free; 2];
    [
        Slider {
            textures: vec![cavity([23, 31], 12.0, 1, 0.3, true)],
            ..slider([23, 31], [Edges::Periodic, Edges::Free], 25.0)
        },
        Slider {
            body: varied(24 * 18, true),
            ..slider([24, 18], free, 180.0)
        },
        slider([300, 3], free, 0.0),
        slider([2, 60], free, 90.0),
    ]
}

#[test_matrix([0, 1, 2, 3])]
fn what_slides_is_counted(which: usize) {
    let slider = &sliders()[which];
    let steps = slider.steps(4.0);
    let mut from_field = FromField::default();
    let mut alone = Kymograph::default();
    let schedule = Schedule::Every(Kymograph::INTERVAL);
    let mut simulation = Simulation::new(slider.model(), slider.dt_star, None, fused());
    let mut observers = [Scheduled::new(schedule, &mut from_field), alone.scheduled()];
    simulation.run(Stop::at_step(steps), &mut observers).unwrap();

    assert_eq!(alone.rows().count() as u64, steps / Kymograph::INTERVAL + 1);
    let (mut some, mut most) = (0, 0);
    for (row, ((step, shares), sliding)) in alone.rows().zip(&from_field.rows).enumerate() {
        assert_eq!(step, (row as u64 * Kymograph::INTERVAL) as f64);
        for ((share, sliding), blocks) in shares.into_iter().zip(sliding).zip(&from_field.blocks) {
            let expected = (sliding / blocks) as f32;
            assert_eq!(share.to_bits(), expected.to_bits(), "row {row}");
        }
        let share = sliding.iter().sum::<f64>() / from_field.blocks.iter().sum::<f64>();
        some += usize::from((1e-9..0.5).contains(&share));
        most += usize::from((0.5..1.0).contains(&share));
    }
    // With an outline, blocks that differ never slide together.
    assert!(some > 1 && (most > 1 || which == 1), "{some} {most}");

    let record = |mut simulation: Simulation| {
        let mut kymograph = Kymograph::default();
        let stop = Stop::at_step(steps);
        simulation.run(stop, &mut [kymograph.scheduled()]).unwrap();
        kymograph
    };
    for threads in [1, 3] {
        let execution = Execution {
            threads,
            skips: true,
            ..fused()
        };
        let simulation = Simulation::new(slider.model(), slider.dt_star, None, execution);
        assert_eq!(record(simulation), alone);
    }
    if which != 1 {
        let ranks = Threads::run(3, |rank| {
            let (model, communicator) = (slider.model_of(rank), Arc::new(rank.clone()));
            record(Simulation::new(
                model,
                slider.dt_star,
                None,
                Execution {
                    communicator,
                    ..fused()
                },
            ))
        });
        assert!(ranks.iter().all(|rank| *rank == alone));
    }
    // The trajectory of the general kernel differs by rounding, and its first slips are the same.
    let mut simulation = Simulation::new(slider.model(), slider.dt_star, None, general());
    let mut general = Kymograph::default();
    let until_half = Stop::at_step(steps / 2);
    simulation.run(until_half, &mut [general.scheduled()]).unwrap();
    let both = general.rows().zip(alone.rows()).take(from_field.rows.len() / 2);
    for ((step, shares), (_, expected)) in both {
        let bits = |shares: Vec<f32>| shares.into_iter().map(f32::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(shares), bits(expected), "step {step}");
    }
}

/// Rows are added up in pairs when there is no room for more, whenever the recording was stopped in between.
#[test]
fn memory_does_not_grow_with_the_run() {
    let slider = Slider {
        blocks: [4, 3],
        v_star: 0.1,
        ..Slider::default()
    };
    let model = slider.model();
    let interval = Kymograph::INTERVAL;
    let run = |until: &[u64]| {
        let mut simulation = Simulation::new(slider.model(), slider.dt_star, None, fused());
        let mut kymograph = Kymograph::default();
        for &step in until {
            simulation
                .run(Stop::at_step(step), &mut [kymograph.scheduled()])
                .unwrap();
            assert!(kymograph.is_consistent_with(&model, step));
            assert!(!kymograph.is_consistent_with(&model, step + interval));
            let bytes = postcard::to_stdvec(&kymograph).unwrap();
            kymograph = postcard::from_bytes(&bytes).unwrap();
        }
        kymograph
    };
    let full = Kymograph::MAX_ROWS as u64 * interval;
    let whole = run(&[full - 1]);
    assert_eq!(whole.rows().count(), Kymograph::MAX_ROWS);
    let halved = run(&[full]);
    // The last row has a single instant.
    assert_eq!(halved.rows().count(), Kymograph::MAX_ROWS / 2 + 1);
    let pairs: Vec<_> = whole.rows().collect();
    for ((step, shares), pair) in halved.rows().zip(pairs.chunks(2)) {
        assert_eq!(step, 0.5 * (pair[0].0 + pair[1].0));
        for (bin, share) in shares.into_iter().enumerate() {
            let mean = 0.5 * (f64::from(pair[0].1[bin]) + f64::from(pair[1].1[bin]));
            // Thirds, which are rounded once or twice.
            assert!((f64::from(share) - mean).abs() < 1e-7);
        }
    }
    let (step, shares) = halved.rows().last().unwrap();
    assert_eq!(step, full as f64);
    // Each bin has three blocks, which slide or not.
    assert!(
        shares
            .iter()
            .all(|share| (3.0 * share - (3.0 * share).round()).abs() < 1e-6)
    );
    assert!(shares.iter().sum::<f32>() > 0.3, "{shares:?}");
    let long = run(&[5 * full + 3]);
    assert_eq!(long.rows().count(), 5 * Kymograph::MAX_ROWS / 8 + 1);
    assert_eq!(run(&[17, full - 1, full, 3 * full + 1, 5 * full + 3]), long);
    assert_eq!(long.in_contact(), [3; 4]);
}
