//! Stacks of sheets on the fused kernel agree with the general kernel to rounding, and have the same bits on
//! any number of threads and ranks, whether or not blocks at rest may be skipped, and across checkpoints.

use slipfront::lattice::SpringStiffness;
use slipfront::surface::{Orientation, Texture};
use slipfront::{
    Communicator, Edges, Kernel, Model, RunError, Sheet, Simulation, SlipWeakening, Stop, Weakening,
};
use test_case::test_matrix;

use crate::common::{Slider, cavity, groove, thrown};
use crate::executions::assert_same_bits;
use crate::fields::assert_fields_match_blocks;
use crate::ranks::{assert_goes_on, assert_same_with};
use crate::{against_general, fused, go, has_room, sliders};

/// Two sheets above the lattice, one thinner than the lattice and one much thicker.
pub(crate) const SHEETS: [Sheet; 2] = [
    Sheet {
        thickness: 0.7,
        coupling: 1.5,
    },
    Sheet {
        thickness: 7.0,
        coupling: 0.4,
    },
];

/// Springs of the sheets that are not isotropic.
pub(crate) fn springs() -> SpringStiffness {
    SpringStiffness::with_ratio(2.3)
}

/// A number of sheets from [`SHEETS`].
fn stack(slider: &Slider, n_sheets: usize) -> Model {
    let model = slider.model().with_sheets(SHEETS[..n_sheets].to_vec(), springs());
    assert_eq!(Kernel::Fused.for_model(&model), Kernel::Fused);
    model
}

/// Number of steps until the lowest sheet slips: it is loaded more slowly than a single sheet.
fn steps(slider: &Slider) -> u64 {
    slider.steps(9.0)
}

const SHAPES: [[usize; 2]; 7] = [[1, 1], [1, 20], [14, 9], [25, 25], [3, 400], [300, 5], [700, 3]];

#[test_matrix(
    [1, 2],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ]
)]
fn the_kernels_agree(n_sheets: usize, edges: [Edges; 2]) {
    for blocks in SHAPES.into_iter().filter(|blocks| has_room(*blocks, edges)) {
        let slider = Slider {
            blocks,
            edges,
            degrees: 20.0,
            v_star: 0.1,
            seed: 7,
            ..Slider::default()
        };
        against_general::assert_same(&stack(&slider, n_sheets), slider.dt_star, None, steps(&slider));
    }
}

/// Strains for which spring forces are computed from either series and the square root.
#[test_matrix(
    [1e-6, 1e-3, 1e-2],
    [0.0, 0.5],
    [None, Some(cavity([25, 25], 10.0, 1, 0.3, true)), Some(groove(Orientation::Along, 3.0))]
)]
fn the_kernels_agree_at_any_strain(epsilon: f64, omega_star: f64, texture: Option<Texture>) {
    let slider = Slider {
        epsilon,
        omega_star,
        textures: texture.into_iter().collect(),
        degrees: 30.0,
        v_star: 0.1,
        ..Slider::default()
    };
    against_general::assert_same(&stack(&slider, 2), slider.dt_star, None, steps(&slider));
    let from = thrown(slider.lattice().n_blocks(), 1.0, 3);
    against_general::assert_same(&stack(&slider, 2), slider.dt_star, Some(&from), 100);
}

/// A slider with thresholds that change, which need a separate sweep.
fn changing(law: usize) -> Slider {
    let slider = Slider {
        blocks: [40, 24],
        degrees: 25.0,
        v_star: 0.1,
        ..Slider::default()
    };
    if law == 0 {
        return Slider {
            weakening: Some(Weakening {
                critical_speed: 0.2,
                ratio: 0.5,
            }),
            ..slider
        };
    }
    Slider {
        slip_weakening: Some(SlipWeakening {
            length: 1.0,
            healing_time: (law == 2).then_some(5.0),
        }),
        ..slider
    }
}

#[test_matrix([0, 1, 2])]
fn thresholds_that_change(law: usize) {
    let slider = changing(law);
    let model = stack(&slider, 2);
    against_general::assert_same(&model, slider.dt_star, None, steps(&slider));
    assert_same_bits(&model, slider.dt_star, None, steps(&slider));
    assert_goes_on(&slider, &|model, _| {
        *model = model.clone().with_sheets(SHEETS.to_vec(), springs());
    });
}

#[test_matrix(
    [1, 2],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ]
)]
fn the_same_bits_over_threads(n_sheets: usize, edges: [Edges; 2]) {
    for blocks in [[1, 1], [64, 40], [3, 400], [300, 5]] {
        if has_room(blocks, edges) {
            let slider = sliders::shaped(blocks, edges);
            assert_same_bits(&stack(&slider, n_sheets), slider.dt_star, None, steps(&slider));
        }
    }
    let (slider, from) = sliders::in_motion(edges, 1e-2);
    assert_same_bits(&stack(&slider, n_sheets), slider.dt_star, Some(&from), 100);
}

/// The drive stands still while blocks slip, and the sheets above keep oscillating.
#[test_matrix([false, true])]
fn held_drives(has_program: bool) {
    let slider = sliders::held([40, 24], Edges::Free, 25.0, has_program);
    assert_same_bits(&stack(&slider, 2), slider.dt_star, None, 2 * steps(&slider));
}

#[test_matrix(
    [1, 2],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ]
)]
fn the_same_bits_over_ranks(n_sheets: usize, edges: [Edges; 2]) {
    for blocks in [[1, 5], [64, 40], [3, 400], [300, 5]] {
        if has_room(blocks, edges) {
            let slider = sliders::shaped(blocks, edges);
            let change = move |model: &mut Model, _: &dyn Communicator| {
                *model = model.clone().with_sheets(SHEETS[..n_sheets].to_vec(), springs());
            };
            assert_same_with(&slider, &change, None, steps(&slider));
            // Each of the seven ranks has a row.
            if blocks[1] > 7 {
                assert_goes_on(&slider, &change);
            }
        }
    }
}

/// Fields of the lowest sheet, where the pull of the sheet above replaces the drive.
#[test_matrix([[Edges::Free; 2], [Edges::Periodic; 2]], [1e-6, 1e-2])]
fn fields_are_those_of_single_blocks(edges: [Edges; 2], epsilon: f64) {
    let slider = Slider {
        blocks: [30, 20],
        edges,
        epsilon,
        degrees: 25.0,
        v_star: 0.1,
        ..Slider::default()
    };
    let from = thrown(600, 0.3, 7);
    let mut simulation = Simulation::new(stack(&slider, 2), slider.dt_star, Some(from), fused());
    for _ in 0..5 {
        assert_fields_match_blocks(&simulation);
        (0..20).for_each(|_| go(&mut simulation, false));
    }
}

/// A sheet above that diverges first ends the run in the same way as the sheet in friction.
#[test]
fn a_stack_that_diverges_ends_the_run() {
    let slider = Slider {
        blocks: [12, 9],
        ..Slider::default()
    };
    // Springs to a light sheet, which alone oscillates too fast for the step.
    let light = Sheet {
        thickness: 0.1,
        coupling: 2.0,
    };
    let model = slider.model().with_sheets(vec![light], springs());
    let mut simulation = Simulation::new(model, 0.5, None, fused());
    let error = simulation.run(Stop::at_step(100_000), &mut []).unwrap_err();
    assert!(matches!(error, RunError::NotFinite { .. }), "{error}");
}
