//! What the reference kernel alone computes has the same bits on several ranks as on one, and goes on from a checkpoint on any other
//! number of ranks.

use rstest::rstest;
use slipfront::{
    Ageing, Communicator, ContactSprings, Coulomb, Edges, Friction, FrictionLaw, Model, RateAndState,
    Rotation,
};

use crate::common::{Slider, cavity, thrown, varied};
use crate::ranks::{assert_goes_on, assert_same_with};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Variety {
    Law(FrictionLaw),
    Viscous,
    Ages,
    RateAndState,
    Springs,
    Turns,
    /// Moduli and densities that differ, and blocks that do not exist.
    Differ,
}

const BLOCKS: [usize; 2] = [19, 17];

fn slider(edges: Edges, options: &[Variety]) -> Slider {
    let mut slider = Slider {
        blocks: BLOCKS,
        edges: [edges; 2],
        textures: vec![cavity(BLOCKS, 3.0, 1, 0.3, true)],
        v_star: 0.1,
        degrees: 20.0,
        ..Slider::default()
    };
    for option in options {
        match *option {
            Law(law) => slider.law = law,
            Differ => slider.body = varied(BLOCKS[0] * BLOCKS[1], true),
            Viscous => (slider.body.viscosity_time, slider.dt_star) = (0.2, 0.05),
            Ages | RateState | Springs | Turns => {}
        }
    }
    slider
}

fn change(options: &[Variety], model: &mut Model, ranks: &dyn Communicator) {
    for option in options {
        match option {
            Law(_) | Viscous | Differ => {}
            Ages => {
                model.friction = Friction::Coulomb(Coulomb {
                    law: FrictionLaw::Projection,
                    weakening: None,
                    ageing: Some(Ageing {
                        beta: 0.02,
                        time: 0.5,
                    }),
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
            Springs => {
                model.friction = Friction::ContactSprings(ContactSprings {
                    stiffness: 1.5,
                    redraw: None,
                });
            }
            Turns => {
                let turned = Rotation::about_centroid(&model.lattice, &model.rows, model.slider(), ranks);
                model.drive.rotation = Some(turned);
            }
        }
    }
}

use Variety::{Ages, Differ, Law, RateAndState as RateState, Springs, Turns, Viscous};

#[rstest]
fn the_same_bits_over_ranks(
    #[values(
        &[Law(FrictionLaw::Reversal)], &[Law(FrictionLaw::Literal), Differ], &[Viscous], &[Ages], &[RateState],
        &[Springs], &[Turns], &[Viscous, Differ, Turns], &[Viscous, Differ, RateState], &[Springs, Turns, Differ]
    )]
    options: &'static [Variety],
    #[values(Edges::Free, Edges::Periodic)] edges: Edges,
) {
    let slider = slider(edges, options);
    let change = |model: &mut Model, ranks: &dyn Communicator| change(options, model, ranks);
    assert_same_with(&slider, &change, None, slider.steps(6.0));
    let from = thrown(BLOCKS[0] * BLOCKS[1], 1.0, 2);
    assert_same_with(&slider, &change, Some(&from), 100);
}

#[rstest]
fn checkpoints_go_on_on_any_number_of_ranks(
    #[values(&[Viscous, Differ, Ages], &[RateState], &[Springs, Turns])] options: &'static [Variety],
) {
    let change = |model: &mut Model, ranks: &dyn Communicator| change(options, model, ranks);
    assert_goes_on(&slider(Edges::Free, options), &change);
}
