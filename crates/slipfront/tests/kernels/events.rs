//! Slip events are the same, bit by bit, on any number of threads and ranks, and across stops.

use std::sync::Arc;

use slipfront::observe::{Event, Events, Scheduled};
use slipfront::testing::Threads;
use slipfront::{Edges, Execution, Loading, Model, Simulation, Stop};
use test_case::test_matrix;

use crate::common::{Slider, cavity};
use crate::{fused, general, stopped_and_resumed};

const DT_STAR: f64 = 0.2;

/// A rough slider with a cavity, in which some events have few blocks and some all.
fn slider(blocks: [usize; 2]) -> Slider {
    Slider {
        blocks,
        edges: [Edges::Periodic, Edges::Free],
        textures: vec![cavity(blocks, 12.0, 1, 0.3, true)],
        degrees: 25.0,
        v_star: 0.05,
        sigma_static_star: 0.2,
        omega_star: 0.3,
        dt_star: DT_STAR,
        loading: Loading::Held { onset_steps: 1 },
        ..Slider::default()
    }
}

fn start(model: Model, execution: Execution) -> Simulation {
    Simulation::new(model, DT_STAR, None, execution)
}

/// Enough blocks for three bands of either kernel.
const MANY: [usize; 2] = [49, 64];

const DRIVE_STEPS: u64 = 270;

fn recorded(mut simulation: Simulation) -> Vec<Event> {
    let mut events = Events::new(simulation.snapshot().model);
    let seen = &mut [Scheduled::always(&mut events)];
    simulation.run(Stop::at_step(DRIVE_STEPS), seen).unwrap();
    events.events().to_vec()
}

#[test]
fn threads_and_ranks_find_equal_events() {
    for kernel in [fused(), general()] {
        let alone = recorded(start(slider(MANY).model(), kernel.clone()));
        let few = alone.iter().filter(|event| event.blocks < 10).count();
        let largest = alone.iter().map(|event| event.blocks).max();
        assert!(few > 5 && largest > Some(1000), "{few} {largest:?}");
        for (threads, skips) in [(1, true), (3, false), (3, true)] {
            let execution = Execution {
                threads,
                skips,
                ..kernel.clone()
            };
            assert_eq!(recorded(start(slider(MANY).model(), execution)), alone);
        }
        for size in [2, 3] {
            let ranks = Threads::run(size, |rank| {
                let communicator = Arc::new(rank.clone());
                let execution = Execution {
                    communicator,
                    ..kernel.clone()
                };
                recorded(start(slider(MANY).model_of(rank), execution))
            });
            for rank in ranks {
                assert_eq!(rank, alone);
            }
        }
    }
}

/// A run that is stopped and resumed, also within events, has equal events.
#[test_matrix([1, 7, 61], [false, true])]
fn events_go_on_from_checkpoints(every: u64, is_fused: bool) {
    let kernel = || if is_fused { fused() } else { general() };
    let model = slider([20, 16]).model();
    let whole = recorded(start(model.clone(), kernel()));
    let mut simulation = start(model.clone(), kernel());
    let (mut events, mut within) = (Events::new(&model), 0);
    loop {
        let seen = &mut [Scheduled::always(&mut events)];
        let reason = simulation
            .advance(Stop::at_step(DRIVE_STEPS), every, seen)
            .unwrap();
        if reason.is_some() {
            break;
        }
        simulation = stopped_and_resumed(&simulation, &model, DT_STAR, kernel());
        let kept = events.paths_before().map(<[f64]>::to_vec);
        events = postcard::from_bytes(&postcard::to_stdvec(&events).unwrap()).unwrap();
        assert_eq!(events.goes_on(), kept.is_some());
        if let Some(kept) = kept {
            events.resume(&model, kept);
            within += 1;
        }
        assert!(events.is_consistent_with(&Events::new(&model), simulation.time_star()));
    }
    assert!(within > 5, "{within}");
    assert_eq!(events.events(), whole);
}

/// Events beyond the largest number are counted, and nothing else changes, also across a stop.
#[test]
fn a_list_that_is_full_counts_on() {
    let model = slider([20, 16]).model();
    let all = recorded(start(model.clone(), fused()));
    // A run that has listed all but two of the possible number of events.
    let earlier = Event {
        after: Some((0.0, 0.0)),
        from_star: 0.0,
        ..all[0]
    };
    let n_contact = model.surface.n_contact();
    let listed = vec![earlier; Events::MAX - 2];
    let mut events: Events =
        postcard::from_bytes(&postcard::to_stdvec(&(n_contact, listed, 0_u64, false)).unwrap()).unwrap();
    let mut simulation = start(model.clone(), fused());
    while simulation
        .advance(
            Stop::at_step(DRIVE_STEPS),
            500,
            &mut [Scheduled::always(&mut events)],
        )
        .unwrap()
        .is_none()
    {
        let paths = events.paths_before().map(<[f64]>::to_vec);
        events = postcard::from_bytes(&postcard::to_stdvec(&events).unwrap()).unwrap();
        if let Some(paths) = paths {
            events.resume(&model, paths);
        }
        assert!(events.is_consistent_with(&Events::new(&model), simulation.time_star()));
    }
    assert_eq!(events.events().len(), Events::MAX);
    assert_eq!(events.events()[Events::MAX - 2..], all[..2]);
    assert_eq!(events.unlisted(), all.len() as u64 - 2);
    assert!(!events.goes_on() && events.paths_before().is_none());
}
