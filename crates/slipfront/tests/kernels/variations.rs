//! Heterogeneous sliders, dead loads, kinetic friction that weakens and drives by a program on the fused
//! kernel: it agrees with the general kernel to rounding, and has the same bits in every way to execute it.

use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::{DriveSprings, Edges, Interface, Outline, Program, SlipWeakening, Weakening};
use test_case::test_matrix;

use crate::common::{Slider, cavity, varied};
use crate::{against_general, executions, ranks, sliders};

/// A departure from the paper's slider.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Variety {
    /// Drive springs only at the left edge.
    EdgeDrive,
    /// Moduli and densities, and drive springs as stiff as their blocks.
    Grading,
    /// One block in nine does not exist.
    Outline,
    Weakening,
    /// Strength falls with slip, and either recovers at rest or not.
    SlipWeakening {
        heals: bool,
    },
    /// A program with a stop and a return.
    Program,
    /// A dead load that is uniform, or differs from block to block.
    Load {
        differs: bool,
    },
    /// Friction along x alone, on a foundation along y.
    Interface,
    /// Springs along free edges half as stiff.
    HalvedEdges,
}

const BLOCKS: [usize; 2] = [40, 31];

fn with(slider: Slider, options: &[Variety]) -> Slider {
    let [nx, ny] = slider.blocks;
    let mut slider = slider;
    for option in options {
        match option {
            Variety::EdgeDrive => {
                let left = (0..nx * ny).map(|b| f64::from(u8::from(b % nx == 0)));
                slider.body.drive_springs = Some(DriveSprings::new(left.collect(), &Alone));
            }
            Variety::Grading => slider.body = varied(nx * ny, false),
            Variety::Outline => {
                let exists = (0..nx * ny).map(|b| b * b % 9 != 4).collect();
                slider.body.outline = Some(Outline::new(exists, &Alone));
                // Blocks outside the outline have no drive springs.
                let relative = (0..nx * ny).map(|b| slider.body.drive_spring(b)).collect();
                slider.body.drive_springs = Some(DriveSprings::new(relative, &Alone));
            }
            Variety::Weakening => {
                slider.weakening = Some(Weakening {
                    critical_speed: 0.2,
                    ratio: 0.4,
                });
            }
            Variety::SlipWeakening { heals } => {
                slider.slip_weakening = Some(SlipWeakening {
                    length: 0.4,
                    healing_time: heals.then_some(3.0),
                });
            }
            Variety::Load { differs } => slider.dead_load = ([0.5, -0.2], *differs),
            Variety::Interface => slider.interface = Some(Interface { foundation: 0.3 }),
            Variety::HalvedEdges => slider.body.halves_edge_springs = true,
            Variety::Program => {
                let v_star = slider.v_star;
                let until = |turns: f64| (turns / v_star / slider.dt_star).round() * slider.dt_star;
                let segments = [
                    (v_star, until(2.0)),
                    (0.0, until(2.5)),
                    (v_star, until(4.0)),
                    (-0.5 * v_star, f64::INFINITY),
                ];
                slider.program = Some(Arc::new(Program::new(segments)));
            }
        }
    }
    slider
}

fn base(epsilon: f64, edges: Edges) -> Slider {
    Slider {
        textures: vec![cavity(BLOCKS, 6.0, 1, 0.3, true)],
        epsilon,
        blocks: BLOCKS,
        edges: [edges; 2],
        ..sliders::shaped(BLOCKS, [edges; 2])
    }
}

use Variety::{EdgeDrive, Grading, Outline as Cut, Program as Changes, Weakening as Weakens};

/// An upright sheet.
const UPRIGHT: Variety = Variety::Interface;
const HALVED: Variety = Variety::HalvedEdges;
const SLIPS: Variety = Variety::SlipWeakening { heals: false };
const HEALS: Variety = Variety::SlipWeakening { heals: true };
const LOADED: Variety = Variety::Load { differs: false };
const LOADS: Variety = Variety::Load { differs: true };

#[test_matrix(
    [
        &[EdgeDrive], &[Grading], &[Cut], &[Weakens], &[Changes], &[Grading, Cut], &[EdgeDrive, Cut, Weakens],
        &[Grading, Cut, Weakens, Changes], &[SLIPS], &[HEALS], &[Grading, Cut, SLIPS], &[LOADED], &[LOADS],
        &[LOADED, EdgeDrive, Cut], &[LOADS, Grading, Cut, SLIPS], &[UPRIGHT], &[UPRIGHT, HALVED, Weakens],
        &[UPRIGHT, LOADS, Grading, Cut, HEALS]
    ],
    [0.0, 1e-6, 1e-2],
    [Edges::Free, Edges::Periodic]
)]
fn the_general_kernel_agrees(options: &[Variety], epsilon: f64, edges: Edges) {
    let slider = with(base(epsilon, edges), options);
    against_general::assert_same(&slider.model(), slider.dt_star, None, slider.steps(5.0));
}

#[test_matrix(
    [
        &[EdgeDrive], &[Grading], &[Cut], &[Weakens], &[Changes], &[EdgeDrive, Cut, Weakens],
        &[Grading, Cut, Weakens, Changes], &[SLIPS], &[HEALS], &[Grading, Cut, HEALS], &[LOADED], &[LOADS],
        &[LOADS, EdgeDrive, Cut, Changes], &[UPRIGHT], &[HALVED], &[UPRIGHT, LOADED, HALVED, Weakens],
        &[UPRIGHT, LOADS, Grading, Cut, HEALS]
    ],
    [1e-6, 2e-3],
    [Edges::Free, Edges::Periodic]
)]
fn the_same_bits_however_executed(options: &[Variety], epsilon: f64, edges: Edges) {
    let slider = with(base(epsilon, edges), options);
    executions::assert_same_bits(&slider.model(), slider.dt_star, None, slider.steps(5.0));
}

/// Between slips most of a slow slider is skipped.
#[test_matrix([
    &[EdgeDrive], &[Grading, Cut, Weakens], &[Changes], &[SLIPS], &[HEALS], &[LOADED], &[LOADS], &[LOADS, EdgeDrive, Cut]
])]
fn slow_sliders_have_the_same_bits(options: &[Variety]) {
    let slider = with(sliders::slow(BLOCKS, Edges::Free, 0.0, 1e-6), options);
    executions::assert_same_bits(&slider.model(), slider.dt_star, None, slider.steps(4.0));
}

#[test_matrix(
    [
        &[EdgeDrive], &[Grading], &[Cut], &[Weakens, Changes], &[Grading, Cut, Weakens, Changes], &[SLIPS],
        &[HEALS], &[LOADED, Cut], &[LOADS], &[HALVED], &[UPRIGHT, HALVED, LOADS, SLIPS]
    ],
    [Edges::Free, Edges::Periodic]
)]
fn the_same_bits_over_ranks(options: &[Variety], edges: Edges) {
    let slider = with(base(1e-6, edges), options);
    ranks::assert_same(&slider, None, slider.steps(4.0));
}
