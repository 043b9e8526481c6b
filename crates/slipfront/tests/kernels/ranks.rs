//! A lattice that several ranks share has the same bits as on one rank, for any number of ranks and threads,
//! with and without skipping, and continues from a checkpoint on any other number of ranks.

use std::convert::Infallible;
use std::ops::Range;
use std::sync::Arc;

use slipfront::checkpoint::Checkpoint;
use slipfront::communicator::Alone;
use slipfront::observe::frames::Selection;
use slipfront::observe::{Field, Frame};
use slipfront::surface::{Orientation, Texture};
use slipfront::testing::Threads;
use slipfront::{Communicator, Edges, Execution, Model, RunError, Simulation, State, Stop, VectorField};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, cavity, groove};
use crate::executions::{shown, state};
use crate::{bits, columns, fused, go, has_room, sliders};

/// Results of a rank: at every step the values that all ranks know, its own state at some steps, and at the
/// end its first slips and fields.
struct Shown {
    steps: Vec<Vec<u64>>,
    states: Vec<Vec<Vec<u64>>>,
    first_slip: Vec<u64>,
    fields: Vec<Vec<Vec<f32>>>,
}

/// Frames of every block, of every second, and of every fifth row.
fn frames(simulation: &Simulation) -> Vec<Frame> {
    let capture = |stride| {
        let fields = vec![Field::ContactStress, Field::Traction, Field::DisplacementX];
        Selection { fields, stride }.capture(&simulation.snapshot())
    };
    [1, 2, 5].map(capture).into()
}

fn watch(simulation: &mut Simulation, steps: Range<u64>, shown_before: Option<Shown>) -> Shown {
    let mut seen = shown_before.unwrap_or_else(|| Shown {
        steps: vec![shown(simulation)],
        states: Vec::new(),
        first_slip: Vec::new(),
        fields: Vec::new(),
    });
    for step in steps {
        go(simulation, step % 5 == 0);
        seen.steps.push(shown(simulation));
        if step % 7 == 0 {
            seen.states.push(state(simulation));
        }
    }
    seen.states.push(state(simulation));
    seen.first_slip = bits(&simulation.snapshot().first_slip_time_star());
    seen.fields = frames(simulation).into_iter().map(|frame| frame.values).collect();
    seen
}

/// The part of a state that belongs to the blocks of a rank.
fn part(from: &State, blocks: Range<usize>) -> State {
    let of = |field: &VectorField| VectorField {
        x: field.x[blocks.clone()].to_vec(),
        y: field.y[blocks.clone()].to_vec(),
    };
    State {
        displacement: of(&from.displacement),
        velocity: of(&from.velocity),
    }
}

/// A change of a model beyond the options of [`Slider`]; all ranks make it together.
pub(crate) type Change = dyn Fn(&mut Model, &dyn Communicator) + Sync;

fn with(mut model: Model, change: &Change, ranks: &dyn Communicator) -> Model {
    change(&mut model, ranks);
    model
}

pub(crate) fn assert_same(slider: &Slider, from: Option<&State>, steps: u64) {
    assert_same_with(slider, &|_, _| (), from, steps);
}

pub(crate) fn assert_same_with(slider: &Slider, change: &Change, from: Option<&State>, steps: u64) {
    let dt_star = slider.dt_star;
    let model = with(slider.model(), change, &Alone);
    let mut alone = Simulation::new(model, dt_star, from.cloned(), fused());
    let alone = watch(&mut alone, 1..steps + 1, None);
    assert!(
        alone.first_slip.iter().any(|&t| !f64::from_bits(t).is_nan()),
        "nothing ever slips"
    );
    let ways = [
        (2, 1, true),
        (3, 2, true),
        (4, 1, false),
        (7, 1, true),
        (slider.blocks[1], 1, true),
    ];
    for (size, threads, skips) in ways
        .into_iter()
        .filter(|(size, ..)| (2..=slider.blocks[1].min(9)).contains(size))
    {
        let execution = Execution {
            threads,
            skips,
            ..fused()
        };
        let ranks = Threads::run(size, |rank| {
            let model = with(slider.model_of(rank), change, rank);
            let own = from.map(|from| part(from, model.lattice.blocks_of(&model.rows)));
            let mut simulation = Simulation::new(
                model,
                dt_star,
                own,
                Execution {
                    communicator: Arc::new(rank.clone()),
                    ..execution.clone()
                },
            );
            watch(&mut simulation, 1..steps + 1, None)
        });
        assert_joined(&ranks, &alone, &format!("{size} ranks, {execution:?}"));
    }
}

/// Asserts that the results of the ranks, row after row, are those of one rank.
fn assert_joined(ranks: &[Shown], alone: &Shown, of: &str) {
    for rank in ranks {
        for (step, (here, expected)) in rank.steps.iter().zip(&alone.steps).enumerate() {
            assert!(
                here == expected,
                "{of}: step {step} {:?}",
                (floats(here), floats(expected))
            );
        }
    }
    for (k, expected) in alone.states.iter().enumerate() {
        for (axis, expected) in expected.iter().enumerate() {
            let joined: Vec<u64> = ranks
                .iter()
                .flat_map(|rank| &rank.states[k][axis])
                .copied()
                .collect();
            assert!(joined == *expected, "{of}: state {k}");
        }
    }
    let first_slip: Vec<u64> = ranks.iter().flat_map(|rank| &rank.first_slip).copied().collect();
    assert!(first_slip == alone.first_slip, "{of}: first slips");
    for (k, fields) in alone.fields.iter().enumerate() {
        for (field, expected) in fields.iter().enumerate() {
            let joined: Vec<f32> = ranks
                .iter()
                .flat_map(|rank| &rank.fields[k][field])
                .copied()
                .collect();
            let [joined, expected] = [&joined, expected].map(|values| values.iter().map(|x| x.to_bits()));
            assert!(
                joined.eq(expected),
                "{of}: field {field} at every n-th row, case {k}"
            );
        }
    }
}

fn floats(bits: &[u64]) -> Vec<f64> {
    bits.iter().copied().map(f64::from_bits).collect()
}

#[test_matrix(
    [[1, 5], [25, 25], [64, 40], [3, 400], [300, 5], [700, 3]],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ]
)]
fn lattices_of_every_shape(blocks: [usize; 2], edges: [Edges; 2]) {
    if !has_room(blocks, edges) {
        return;
    }
    let slider = sliders::shaped(blocks, edges);
    assert_same(&slider, None, slider.steps(4.0));
}

#[test_matrix(
    [None, Some(cavity([40, 40], 5.0, 1, 0.3, true)), Some(groove(Orientation::Across, 2.0))],
    [0.0, 1e-3, 5e-3]
)]
fn textures_and_strains(texture: Option<Texture>, epsilon: f64) {
    let slider = sliders::textured(texture, epsilon);
    assert_same(&slider, None, slider.steps(4.0));
}

/// While some blocks slip, others are at rest: on some ranks all of them.
#[test_matrix(
    [([40, 24], Edges::Free), ([40, 24], Edges::Periodic), ([3, 200], Edges::Periodic)],
    [(0.0, 1e-6), (65.0, 4e-3)]
)]
fn slow_drives((blocks, edges): ([usize; 2], Edges), (degrees, epsilon): (f64, f64)) {
    let slider = sliders::slow(blocks, edges, degrees, epsilon);
    assert_same(&slider, None, slider.steps(2.6));
}

/// All ranks agree whether the drive stands still.
#[test_matrix([0.0, 65.0], [false, true])]
fn held_drives(degrees: f64, has_program: bool) {
    let slider = sliders::held([40, 24], Edges::Free, degrees, has_program);
    assert_same(&slider, None, 2 * slider.steps(3.0));
    assert_goes_on(&slider, &|_, _| ());
}

/// All ranks agree that the residual force is negligible.
#[test]
fn creep_under_a_held_drive() {
    let slider = sliders::creeping();
    assert_same(&slider, None, 90);
    assert_goes_on(&slider, &|_, _| ());
}

#[test_matrix([[Edges::Free, Edges::Free], [Edges::Periodic, Edges::Periodic]], [1e-6, 1e-2])]
fn a_state_in_motion(edges: [Edges; 2], epsilon: f64) {
    let (slider, from) = sliders::in_motion(edges, epsilon);
    assert_same(&slider, Some(&from), 200);
}

/// All ranks name the same block as one rank: where all blocks move equally, the first.
#[test_case(Slider { dt_star: 4.0, ..Slider::default() }.uniform(); "alike")]
#[test_case(Slider { dt_star: 1.0, ..Slider::default() }; "apart")]
fn a_run_that_diverges_says_the_same(slider: Slider) {
    let slider = Slider {
        blocks: [12, 9],
        ..slider
    };
    let dt_star = slider.dt_star;
    let diverge = |mut simulation: Simulation| simulation.run(Stop::at_step(100_000), &mut []).unwrap_err();
    let alone = diverge(Simulation::new(slider.model(), dt_star, None, fused()));
    let RunError::NotFinite { i, j, .. } = alone else {
        panic!("{alone}")
    };
    assert_eq!((i, j) == (0, 0), slider.sigma_static_star == 0.0, "{alone}");
    for size in [2, 3, 9] {
        let ranks = Threads::run(size, |rank| {
            let communicator = Arc::new(rank.clone());
            diverge(Simulation::new(
                slider.model_of(rank),
                dt_star,
                None,
                Execution {
                    communicator,
                    ..fused()
                },
            ))
        });
        assert_eq!(ranks, vec![alone.clone(); size]);
    }
}

#[test]
#[should_panic(expected = "one rank holds the whole lattice")]
fn one_of_several_ranks_reads_no_single_block() {
    let slider = Slider::default();
    Threads::run(2, |rank| {
        let communicator = Arc::new(rank.clone());
        let model = slider.model_of(rank);
        Simulation::new(
            model,
            slider.dt_star,
            None,
            Execution {
                communicator,
                ..fused()
            },
        )
        .snapshot()
        .block(0)
    });
}

/// The checkpoint and the columns of each rank.
type Saved = (Checkpoint, Vec<Vec<f64>>);

fn save(simulation: &Simulation) -> Saved {
    (simulation.checkpoint(), columns(simulation))
}

#[test_matrix([0.1, 0.01])]
fn checkpoints_go_on_on_any_number_of_ranks(v_star: f64) {
    let slider = Slider {
        blocks: [33, 21],
        edges: [Edges::Free, Edges::Periodic],
        v_star,
        dt_star: 0.2,
        sigma_static_star: 0.1,
        ..Slider::default()
    };
    assert_goes_on(&slider, &|_, _| ());
}

/// Asserts that runs continue on one number of ranks after the other, from the columns of all ranks before.
pub(crate) fn assert_goes_on(slider: &Slider, change: &Change) {
    let steps = slider.steps(4.0);
    let model = with(slider.model(), change, &Alone);
    let mut simulation = Simulation::new(model, slider.dt_star, None, fused());
    let alone = watch(&mut simulation, 1..steps + 1, None);
    let sizes = [1, 3, 2, 7, 1, 4];
    let length = steps / sizes.len() as u64 + 1;
    let mut saved: Option<Saved> = None;
    for (k, &size) in sizes.iter().enumerate() {
        let steps = 1 + k as u64 * length..(1 + (k as u64 + 1) * length).min(steps + 1);
        let parts = Threads::run(size, |rank| {
            let model = with(slider.model_of(rank), change, rank);
            let blocks = model.lattice.blocks_of(&model.rows);
            let communicator = Arc::new(rank.clone());
            let mut simulation = match &saved {
                None => Simulation::new(
                    model,
                    slider.dt_star,
                    None,
                    Execution {
                        communicator,
                        ..fused()
                    },
                ),
                Some((checkpoint, columns)) => {
                    let read = |column: usize, first: usize, values: &mut [f64]| {
                        let first = blocks.start + first;
                        values.copy_from_slice(&columns[column][first..][..values.len()]);
                        Ok::<(), Infallible>(())
                    };
                    let execution = Execution {
                        skips: true,
                        ..fused()
                    };
                    let Ok(resumed) = Simulation::resume(
                        model,
                        slider.dt_star,
                        checkpoint,
                        Execution {
                            communicator,
                            ..execution
                        },
                        read,
                    );
                    resumed.unwrap()
                }
            };
            for step in steps.clone() {
                go(&mut simulation, step % 5 == 0);
                assert!(
                    shown(&simulation) == alone.steps[step as usize],
                    "step {step} on {size} ranks"
                );
            }
            save(&simulation)
        });
        let mut columns = vec![Vec::new(); parts[0].1.len()];
        for (checkpoint, part) in &parts {
            assert_eq!(checkpoint, &parts[0].0, "of {size} ranks");
            for (whole, part) in columns.iter_mut().zip(part) {
                whole.extend(part);
            }
        }
        saved = Some((parts[0].0, columns));
    }
    let last = saved.map(|(_, columns)| bits(&columns[0])).unwrap();
    assert!(last == alone.states.last().unwrap()[0]);
}
