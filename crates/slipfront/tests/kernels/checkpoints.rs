//! Checkpoints of the general kernel, of observers, and of another lattice. Checkpoints of the fused kernel
//! are tested in `executions.rs`.

use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::observe::frames::Selection;
use slipfront::observe::{
    Curve, Cycles, Field, Instants, KineticHistory, KineticStart, Precursors, Scheduled,
};
use slipfront::{
    AfterBreak, Ageing, ContactSprings, Coulomb, Edge, Execution, Friction, FrictionLaw, Loading, Program,
    RateAndState, Rotation, Simulation, SlipWeakening, Stop, Weakening,
};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, cavity, varied};
use crate::{bits, columns, fused, general, resumed, sliders, stopped_and_resumed};

fn slider(law: FrictionLaw) -> Slider {
    Slider {
        blocks: [12, 10],
        textures: vec![cavity([12, 10], 10.0, 1, 0.3, true)],
        degrees: 25.0,
        v_star: 0.1,
        sigma_static_star: 0.1,
        dt_star: 0.1,
        law,
        ..Slider::default()
    }
}

/// Displacements, velocities, forces and friction of all blocks, first slips, and the largest contact stress.
fn everything(simulation: &Simulation) -> Vec<u64> {
    let now = simulation.snapshot();
    let mut numbers = simulation.snapshot().first_slip_time_star();
    numbers.extend([now.point.mu_star, simulation.contact_stress_max()]);
    for b in 0..now.model.lattice.n_blocks() {
        let block = now.block(b);
        for pair in [
            block.displacement,
            block.velocity,
            block.force_drive,
            block.force_lattice,
            block.force_friction,
        ] {
            numbers.extend(pair);
        }
    }
    bits(&numbers)
}

#[test_matrix([FrictionLaw::Projection, FrictionLaw::Reversal, FrictionLaw::Literal], [1, 7])]
fn the_general_kernel_under_every_law(law: FrictionLaw, every: u64) {
    goes_on_from_checkpoints(&slider(law), every);
}

/// Heterogeneous blocks, with dampers in parallel with their springs.
fn unequal(has_outline: bool) -> slipfront::Slider {
    slipfront::Slider {
        viscosity_time: 0.2,
        ..varied(120, has_outline)
    }
}

/// In a run that is stopped while the drive stands still, the drive stays still after resuming.
#[test_matrix([1, 7])]
fn held_drives(every: u64) {
    let slider = Slider {
        loading: Loading::Held { onset_steps: 300 },
        ..slider(FrictionLaw::Projection)
    };
    goes_on_from_checkpoints(&slider, every);
}

/// A run in which rest is decided by the residual force continues to do so after resuming, on either kernel.
#[test_matrix([1, 7], [false, true])]
fn creep_under_a_held_drive(every: u64, is_fused: bool) {
    let slider = sliders::creeping();
    let (model, dt_star) = (slider.model(), slider.dt_star);
    let execution = || if is_fused { fused() } else { general() };
    let mut plain = Simulation::new(model.clone(), dt_star, None, execution());
    let mut stopped = Simulation::new(model.clone(), dt_star, None, execution());
    for drive_steps in 1..=90 {
        for simulation in [&mut plain, &mut stopped] {
            simulation.run(Stop::at_step(drive_steps), &mut []).unwrap();
        }
        if drive_steps % every == 0 {
            stopped = stopped_and_resumed(&stopped, &model, dt_star, execution());
        }
        assert_eq!(
            everything(&stopped),
            everything(&plain),
            "drive step {drive_steps}"
        );
    }
    let now = plain.snapshot();
    // Exact rest did not come within 1000 times the time of a front across the slider.
    assert!(
        (now.step - now.drive_steps) as f64 > 1000.0 * 12.0 / dt_star,
        "{}",
        now.step
    );
}

#[test_matrix([1, 7], [false, true])]
fn sliders_of_unequal_blocks(every: u64, has_outline: bool) {
    let slider = Slider {
        body: unequal(has_outline),
        ..slider(FrictionLaw::Projection)
    };
    goes_on_from_checkpoints(&slider, every);
}

fn goes_on_from_checkpoints(slider: &Slider, every: u64) {
    let (model, dt_star) = (slider.model(), slider.dt_star);
    let start = || Simulation::new(model.clone(), dt_star, None, general());
    let (mut plain, mut stopped) = (start(), start());
    for step in 0..slider.steps(4.0) {
        if step.is_multiple_of(every) {
            stopped = stopped_and_resumed(&stopped, &model, dt_star, general());
            assert_eq!(everything(&stopped), everything(&plain), "resumed at step {step}");
        }
        plain.step();
        stopped.step();
        assert_eq!(everything(&stopped), everything(&plain), "step {step}");
    }
    assert!(
        plain
            .snapshot()
            .first_slip_time_star()
            .iter()
            .any(|t| !t.is_nan()),
        "nothing ever slips"
    );
}

/// The memory of a law is part of a checkpoint: ages, anchors and breaks with their thresholds, states.
#[test_case(Friction::Coulomb(Coulomb {
    weakening: Some(Weakening { critical_speed: 0.1, ratio: 0.4 }),
    ageing: Some(Ageing { beta: 0.1, time: 1.0 }),
    ..FrictionLaw::Projection.into()
}))]
#[test_case(Friction::Coulomb(Coulomb {
    slip_weakening: Some(SlipWeakening { length: 0.4, healing_time: Some(2.0) }),
    ..FrictionLaw::Projection.into()
}))]
#[test_case(Friction::ContactSprings(ContactSprings { stiffness: 0.5, after_break: AfterBreak::Slides }))]
#[test_case(Friction::ContactSprings(ContactSprings { stiffness: 0.5, after_break: AfterBreak::FormsAgain { redraw: Some(3) }, }))]
#[test_case(Friction::RateAndState(RateAndState {
    a: 0.02, b: 0.05, d_c: 0.2, v_0: 0.1, mu_0: 0.6, theta_0: 2.0, slip_speed: 0.05,
}))]
fn what_a_law_remembers(friction: Friction) {
    for every in [1, 7] {
        is_kept(friction, every);
    }
}

fn is_kept(friction: Friction, every: u64) {
    let slider = slider(FrictionLaw::Projection);
    let (mut model, dt_star) = (slider.model(), slider.dt_star);
    model.friction = friction;
    let start = || Simulation::new(model.clone(), dt_star, None, general());
    let (mut plain, mut stopped) = (start(), start());
    let mut have_differed = vec![false; friction.n_columns()];
    for step in 0..slider.steps(6.0) {
        if step.is_multiple_of(every) {
            stopped = stopped_and_resumed(&stopped, &model, dt_star, general());
            assert_eq!(everything(&stopped), everything(&plain), "resumed at step {step}");
            assert_eq!(stopped.checkpoint(), plain.checkpoint());
            let saved = |simulation: &Simulation| columns(simulation).concat();
            assert!(
                bits(&saved(&stopped)) == bits(&saved(&plain)),
                "saved at step {step}"
            );
        }
        plain.step();
        stopped.step();
        assert_eq!(everything(&stopped), everything(&plain), "step {step}");
        let remembered = &columns(&plain)[5..];
        assert_eq!(remembered.len(), have_differed.len());
        for (has_differed, column) in have_differed.iter_mut().zip(remembered) {
            *has_differed |= column.iter().any(|value| *value != column[0]);
        }
    }
    assert!(!have_differed.contains(&false), "there is nothing to remember");
}

/// A run without stops and a run in parts, each of which continues from a checkpoint of the run and of its
/// observers. Observers have seen every instant exactly once.
#[test_matrix([general(), fused()], [1, 13, 250], [slipfront::Slider::default(), unequal(false)])]
fn observers_see_every_instant_once(execution: Execution, piece: u64, body: slipfront::Slider) {
    let slider = Slider {
        body,
        ..slider(FrictionLaw::Projection)
    };
    let (model, dt_star) = (slider.model(), slider.dt_star);
    let last_step = slider.steps(6.0);
    let stop = Stop::at_step(last_step);
    let fresh = || {
        let selection = Selection {
            fields: vec![Field::ContactStress, Field::Sliding],
            stride: 2,
        };
        let end_star = last_step as f64 * dt_star;
        (
            Curve::every(7),
            KineticHistory::new(last_step),
            Instants::new(selection, KineticStart::Auto, end_star),
        )
    };
    let start = || Simulation::new(model.clone(), dt_star, None, execution.clone());
    let (mut curve, mut history, mut instants) = fresh();
    let mut whole = start();
    whole
        .run(
            stop,
            &mut [
                Scheduled::always(&mut curve),
                Scheduled::always(&mut history),
                Scheduled::always(&mut instants),
            ],
        )
        .unwrap();
    let mut observers = fresh();
    let mut simulation = start();
    let mut pieces = 0;
    loop {
        let (curve, history, instants) = &mut observers;
        let seen = &mut [
            Scheduled::always(curve),
            Scheduled::always(history),
            Scheduled::always(instants),
        ];
        if simulation.advance(stop, piece, seen).unwrap().is_some() {
            break;
        }
        pieces += 1;
        simulation = stopped_and_resumed(&simulation, &model, dt_star, execution.clone());
        let values: Vec<_> = observers.2.frames().map(|frame| frame.values.clone()).collect();
        observers = postcard::from_bytes(&postcard::to_stdvec(&observers).unwrap()).unwrap();
        for (frame, values) in observers.2.frames_mut().zip(values) {
            assert!(frame.values.is_empty(), "values are written down twice");
            frame.values = values;
        }
    }
    assert!(pieces >= last_step / piece - 1, "{pieces} pieces");
    let whole_observers = (curve, history, instants);
    let written = |observers: &(Curve, KineticHistory, Instants)| postcard::to_stdvec(observers).unwrap();
    assert_eq!(written(&observers), written(&whole_observers));
    assert_eq!(observers.2, whole_observers.2);
    assert_eq!(everything(&simulation), everything(&whole));
}

#[test]
fn a_checkpoint_of_another_kernel_does_not_fit() {
    let slider = slider(FrictionLaw::Projection);
    let (model, dt_star) = (slider.model(), slider.dt_star);
    let simulation = Simulation::new(model.clone(), dt_star, None, fused());
    assert!(resumed(&simulation, &model, dt_star, fused()).is_some());
    assert!(resumed(&simulation, &model, dt_star, general()).is_none());
}

/// Drives at an edge, by a program and in rotation, and observers of them, continue as if they had not been
/// stopped.
#[test_matrix([false, true], [1, 7])]
fn other_drives_and_their_observers(turns: bool, every: u64) {
    let slider = Slider {
        textures: Vec::new(),
        degrees: 0.0,
        ..slider(FrictionLaw::Projection)
    };
    let (lattice, mut body) = (slider.lattice(), slider.body.clone());
    body.attach_edge(&lattice, &(0..lattice.ny), Edge::Left, &Alone);
    let mut model = slider.model().with_slider(body);
    model.drive.k_drive = 2.0;
    let segments = [(0.1, 12.0), (0.0, 20.0), (0.2, f64::INFINITY)];
    model.drive.program = Some(Arc::new(Program::new(segments)));
    if turns {
        let rotation = Rotation::about_centroid(&lattice, &model.rows, model.slider(), &Alone);
        model.drive.rotation = Some(rotation);
    }
    let observers = || (Precursors::new(Edge::Left), Cycles::default(), Curve::every(7));
    let start = || Simulation::new(model.clone(), 0.1, None, general());
    let (mut plain, mut whole) = (start(), observers());
    let stop = Stop::at_step(600);
    let (precursors, cycles, curve) = &mut whole;
    let seen = &mut [
        Scheduled::always(precursors),
        Scheduled::always(cycles),
        Scheduled::always(curve),
    ];
    plain.run(stop, seen).unwrap();
    let (mut stopped, mut parts) = (start(), observers());
    loop {
        let (precursors, cycles, curve) = &mut parts;
        let seen = &mut [
            Scheduled::always(precursors),
            Scheduled::always(cycles),
            Scheduled::always(curve),
        ];
        if stopped.advance(stop, every, seen).unwrap().is_some() {
            break;
        }
        stopped = stopped_and_resumed(&stopped, &model, 0.1, general());
        parts = postcard::from_bytes(&postcard::to_stdvec(&parts).unwrap()).unwrap();
        let now = stopped.time_star();
        assert!(parts.0.is_consistent_with(&Precursors::new(Edge::Left), now));
        assert!(parts.1.is_consistent_with(now));
    }
    assert_eq!(everything(&stopped), everything(&plain));
    assert_eq!((&parts.0, &parts.1), (&whole.0, &whole.1));
    assert!(!whole.0.events().is_empty() && whole.1.cycles().len() == 2);
    assert_eq!(postcard::to_stdvec(&parts.2), postcard::to_stdvec(&whole.2));
}
