//! Options that only the general kernel computes have the same bits on
//! several ranks and threads as on one, and continue from a checkpoint on any other number of them.

use slipfront::communicator::Alone;
use slipfront::{
    AfterBreak, Ageing, Body, Communicator, ContactSprings, Coulomb, Edges, Face, Friction, FrictionLaw,
    Model, RateAndState, Rotation,
};
use test_case::test_matrix;

use crate::common::{Slider, cavity, thrown, varied};
use crate::executions::assert_same_bits;
use crate::ranks::{assert_goes_on, assert_same_with};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Variety {
    Law(FrictionLaw),
    Viscous,
    Ages,
    RateAndState,
    Springs,
    Slide,
    Turns,
    /// Moduli and densities that differ, and blocks that do not exist.
    Differ,
    /// A dead load, which differs from block to block if the blocks do.
    Loaded,
}

const BLOCKS: [usize; 2] = [19, 17];

/// Enough blocks for several threads to share them.
const MANY: [usize; 2] = [40, 110];

fn slider(blocks: [usize; 2], edges: Edges, options: &[Variety]) -> Slider {
    let mut slider = Slider {
        blocks,
        edges: [edges; 2],
        textures: vec![cavity(blocks, 3.0, 1, 0.3, true)],
        v_star: 0.1,
        degrees: 20.0,
        ..Slider::default()
    };
    for option in options {
        match *option {
            Law(law) => slider.law = law,
            Differ => slider.body = varied(blocks[0] * blocks[1], true),
            Loaded => slider.dead_load = ([0.3, 0.2], options.contains(&Differ)),
            Viscous => (slider.body.viscosity_time, slider.dt_star) = (0.2, 0.05),
            Ages | RateState | Springs | Slide | Turns => {}
        }
    }
    slider
}

fn change(options: &[Variety], model: &mut Model, ranks: &dyn Communicator) {
    for option in options {
        match option {
            Law(_) | Viscous | Differ | Loaded => {}
            Ages => {
                model.friction = Friction::Coulomb(Coulomb {
                    ageing: Some(Ageing {
                        beta: 0.02,
                        time: 0.5,
                    }),
                    ..FrictionLaw::Projection.into()
                });
            }
            RateState => {
                model.friction = Friction::RateAndState(RateAndState {
                    a: 0.02,
                    b: 0.03,
                    d_c: 0.5,
                    v_0: 0.1,
                    mu_0: 1.0,
                    theta_0: 10.0,
                    slip_speed: 1e-3,
                });
            }
            Springs | Slide => {
                let forms_again = AfterBreak::FormsAgain { redraw: None };
                model.friction = Friction::ContactSprings(ContactSprings {
                    stiffness: 1.5,
                    after_break: if *option == Slide {
                        AfterBreak::Slides
                    } else {
                        forms_again
                    },
                });
            }
            Turns => {
                let turned = Rotation::about_centroid(&model.lattice, &model.rows, model.slider(), ranks);
                model.drive.rotation = Some(turned);
            }
        }
    }
}

use Variety::{Ages, Differ, Law, Loaded, RateAndState as RateState, Slide, Springs, Turns, Viscous};

#[test_matrix(
    [
        &[Law(FrictionLaw::Reversal)], &[Law(FrictionLaw::Literal), Differ], &[Viscous], &[Ages], &[RateState],
        &[Springs], &[Turns], &[Viscous, Differ, Turns], &[Viscous, Differ, RateState],
        &[Springs, Turns, Differ], &[Slide, Differ, Loaded], &[Ages, Loaded], &[Viscous, Differ, Loaded]
    ],
    [Edges::Free, Edges::Periodic]
)]
fn the_same_bits_over_ranks(options: &'static [Variety], edges: Edges) {
    let slider = slider(BLOCKS, edges, options);
    let change = |model: &mut Model, ranks: &dyn Communicator| change(options, model, ranks);
    assert_same_with(&slider, &change, None, slider.steps(6.0));
    let from = thrown(BLOCKS[0] * BLOCKS[1], 1.0, 2);
    assert_same_with(&slider, &change, Some(&from), 100);
}

#[test_matrix([&[Viscous, Differ, Ages, Loaded], &[RateState], &[Springs, Turns], &[Slide, Loaded],])]
fn checkpoints_go_on_on_any_number_of_ranks(options: &'static [Variety]) {
    let change = |model: &mut Model, ranks: &dyn Communicator| change(options, model, ranks);
    assert_goes_on(&slider(BLOCKS, Edges::Free, options), &change);
}

#[test_matrix(
    [
        &[Law(FrictionLaw::Reversal)], &[Ages], &[RateState], &[Springs], &[Slide, Loaded],
        &[Viscous, Differ, Turns],
        &[Viscous, Differ, RateState, Loaded], &[Springs, Turns, Differ], &[Ages, Loaded]
    ],
    [Edges::Free, Edges::Periodic]
)]
fn the_same_bits_over_threads(options: &'static [Variety], edges: Edges) {
    let slider = slider(MANY, edges, options);
    let mut model = slider.model();
    change(options, &mut model, &Alone);
    let from = thrown(MANY[0] * MANY[1], 1.0, 2);
    assert_same_bits(&model, slider.dt_star, Some(&from), 30);
}

#[test_matrix([&[Viscous, Differ, Turns], &[RateState]], [Edges::Free, Edges::Periodic])]
fn the_same_bits_over_threads_of_ranks(options: &'static [Variety], edges: Edges) {
    // Three bands on each of the three ranks, which have two threads each: the middle band has only bands of
    // its own rank as neighbours.
    let blocks = [40, 240];
    let slider = slider(blocks, edges, options);
    let change = |model: &mut Model, ranks: &dyn Communicator| change(options, model, ranks);
    let from = thrown(blocks[0] * blocks[1], 1.0, 2);
    assert_same_with(&slider, &change, Some(&from), 50);
}

/// The threshold of a spring that is drawn anew may come from a block far away.
#[test]
fn springs_drawn_anew_on_threads() {
    let mut model = slider(MANY, Edges::Free, &[Springs]).model();
    model.friction = Friction::ContactSprings(ContactSprings {
        stiffness: 1.5,
        after_break: AfterBreak::FormsAgain { redraw: Some(3) },
    });
    let from = thrown(MANY[0] * MANY[1], 1.0, 2);
    assert_same_bits(&model, 0.1, Some(&from), 30);
}

/// A bulk body, on enough blocks for several bands, and on few.
#[test_matrix([[40, 120], [24, 15]])]
fn a_body_has_the_same_bits_over_threads(blocks: [usize; 2]) {
    let slider = slider(blocks, Edges::Periodic, &[Loaded]);
    let model = slider.model().with_body(Body {
        height: 12.0,
        poisson: 0.3,
        face: Face::Pressure,
    });
    let from = thrown(blocks[0] * blocks[1], 1.0, 2);
    assert_same_bits(&model, slider.dt_star, Some(&from), 30);
}
