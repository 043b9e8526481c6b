//! Fields of all blocks, read at once, have the same bits as fields of single blocks.

use slipfront::observe::frames::Selection;
use slipfront::observe::{Field, Frames, Schedule, Scheduled};
use slipfront::surface::{Orientation, Texture};
use slipfront::{Edges, Execution, FrictionLaw, Interface, Simulation, SlipWeakening, Stop};
use test_case::test_matrix;

use crate::common::{Slider, cavity, groove, thrown};
use crate::{fused, general, has_room, stopped_and_resumed};

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Values of the field, block by block; NaN where no block exists.
fn by_block(simulation: &Simulation, field: Field) -> Vec<f32> {
    let now = simulation.snapshot();
    let textured = &now.model.surface.textured;
    (0..textured.len())
        .map(|b| {
            if now.model.slider().exists(b) {
                field.value(&now.block(b), textured[b]) as f32
            } else {
                f32::NAN
            }
        })
        .collect()
}

pub(crate) fn assert_fields_match_blocks(simulation: &Simulation) {
    let now = simulation.snapshot();
    let mut values = vec![0.0; now.model.lattice.n_blocks()];
    for field in Field::ALL {
        now.read_field(field, &mut values);
        let expected = by_block(simulation, field);
        assert_eq!(bits(&values), bits(&expected), "{field:?} at step {}", now.step);
    }
}

/// Rows of one and of several strips, tiles and bands; blocks that stick and slide; every kind of spring. A
/// simulation that has just been resumed is read before its first step.
#[test_matrix(
    [[1, 1], [7, 1], [1, 9], [25, 25], [120, 3], [250, 6], [30, 90]],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ],
    [
        (1e-6, None), (1e-2, None), (1e-6, Some(groove(Orientation::Along, 1.0))),
        (1e-2, Some(cavity([25, 25], 5.0, 1, 0.3, true)))
    ],
    [fused(), Execution { threads: 3, ..fused() }, Execution { skips: true, ..fused() }, general()]
)]
fn all_blocks_have_the_same_bits_as_single_ones(
    blocks: [usize; 2],
    edges: [Edges; 2],
    (epsilon, texture): (f64, Option<Texture>),
    execution: Execution,
) {
    let slider = Slider {
        blocks,
        edges,
        epsilon,
        textures: texture.into_iter().collect(),
        degrees: 25.0,
        v_star: 0.1,
        ..Slider::default()
    };
    let covers_all = blocks[1] == 1 && !slider.textures.is_empty();
    if !has_room(blocks, edges) || covers_all {
        return;
    }
    let model = slider.model();
    let state = thrown(slider.lattice().n_blocks(), 0.3, 5);
    let mut simulation = Simulation::new(model.clone(), 0.1, Some(state), execution.clone());
    assert_fields_match_blocks(&simulation);
    for _ in 0..3 {
        for _ in 0..40 {
            simulation.step();
        }
        assert_fields_match_blocks(&simulation);
        simulation = stopped_and_resumed(&simulation, &model, 0.1, execution.clone());
        assert_fields_match_blocks(&simulation);
    }
}

/// Laws with friction that does not follow from the velocity: the general kernel keeps it.
#[test_matrix([FrictionLaw::Reversal, FrictionLaw::Literal])]
fn every_friction_law(law: FrictionLaw) {
    let slider = Slider {
        law,
        v_star: 0.1,
        ..Slider::default()
    };
    let mut simulation = Simulation::new(slider.model(), 0.1, None, general());
    for _ in 0..slider.steps(4.0) {
        simulation.step();
    }
    assert_fields_match_blocks(&simulation);
}

/// Friction along x alone, on a foundation, with strength that falls with slip.
#[test_matrix([fused(), general()])]
fn upright_sheets(execution: Execution) {
    let slider = Slider {
        blocks: [40, 12],
        interface: Some(Interface { foundation: 0.3 }),
        slip_weakening: Some(SlipWeakening {
            length: 0.4,
            healing_time: None,
        }),
        degrees: 25.0,
        v_star: 0.1,
        ..Slider::default()
    };
    let state = thrown(480, 0.3, 5);
    let mut simulation = Simulation::new(slider.model(), 0.1, Some(state), execution);
    for _ in 0..100 {
        simulation.step();
        assert_fields_match_blocks(&simulation);
    }
}

/// Frames keep every n-th block along each axis, in the order of the lattice.
#[test_matrix([[1, 1], [25, 25], [130, 7], [250, 6]], [1, 2, 3, 7, 64, 121])]
fn frames_keep_every_nth_block(blocks: [usize; 2], stride: usize) {
    let slider = Slider {
        blocks,
        v_star: 0.1,
        ..Slider::default()
    };
    let state = thrown(slider.lattice().n_blocks(), 0.3, 5);
    let mut simulation = Simulation::new(slider.model(), 0.1, Some(state), fused());
    let mut frames = Frames::new(Selection {
        fields: Field::ALL.to_vec(),
        stride,
    });
    let mut observers = [Scheduled::new(Schedule::At(vec![50]), &mut frames)];
    simulation.run(Stop::at_step(50), &mut observers).unwrap();
    for (field, values) in Field::ALL.into_iter().zip(&frames.frames[0].values) {
        let all = by_block(&simulation, field);
        let rows = all.chunks(blocks[0]).step_by(stride);
        let kept: Vec<f32> = rows.flat_map(|row| row.iter().step_by(stride).copied()).collect();
        assert_eq!(bits(values), bits(&kept), "{field:?}");
    }
}
