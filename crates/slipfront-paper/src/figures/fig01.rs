//! Fig. 1: the lattice of blocks and springs, the forces on a block, and the stiffness of the slider that
//! follows from the springs.

use slipfront_plot::{Sketch, Stroke, StrokeStyle};

use crate::drawing::{Drawing, names, stroke};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::figures::lattice;
use crate::runner::FigureRunner;

/// Number of blocks along a side of the drawn part of the lattice.
const BLOCKS: i32 = 3;
/// Half the edge of a block, over the distance between two blocks.
const HALF: f64 = 0.14;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let mut drawn = Sketch::default();
    from_above(&mut drawn);
    from_the_side(&mut drawn, [3.35, 0.6]);
    data.panel(
        "fig01",
        "The model. Left, top view: springs connect each block to its eight neighbours, k_1 = (3/4) E l along the axes and k_2 = \
         (3/8) E l across them. Right, from the side: the load F_n presses a block on the substrate, the drive at speed V \
         pulls it through k_s = k_2, friction F_f holds it.",
        Drawing::Sketch(drawn),
    );
    lattice::measure(runner, data)
}

/// The lattice; springs first, so that blocks cover their ends.
fn from_above(drawn: &mut Sketch) {
    let place = |i: i32, j: i32| [f64::from(i), f64::from(j)];
    for (i, j) in blocks() {
        for (di, dj, colour) in [(1, 0, 0), (0, 1, 0), (1, 1, 1), (-1, 1, 1)] {
            let (to_i, to_j) = (i + di, j + dj);
            if (0..BLOCKS).contains(&to_i) && (0..BLOCKS).contains(&to_j) {
                // Move the zigzags of diagonals away from the middle, so that they cross at straight parts.
                let middle = if colour == 0 { 0.5 } else { 0.3 };
                let spring = spring(place(i, j), place(to_i, to_j), middle);
                drawn.strokes.push(stroke(StrokeStyle::Line(colour), &spring));
            }
        }
    }
    for (i, j) in blocks() {
        drawn.strokes.push(body(place(i, j), HALF));
    }
    drawn.strokes.extend([
        stroke(StrokeStyle::Thin, &[[0.0, -0.2], [0.0, -0.45]]),
        stroke(StrokeStyle::Thin, &[[1.0, -0.2], [1.0, -0.45]]),
        stroke(StrokeStyle::Arrow, &[[0.5, -0.35], [0.0, -0.35]]),
        stroke(StrokeStyle::Arrow, &[[0.5, -0.35], [1.0, -0.35]]),
    ]);
    drawn.labels.extend(names([
        ("k_1", [0.5, 2.2]),
        ("k_2", [1.5, 1.72]),
        ("l", [0.5, -0.52]),
    ]));
}

fn blocks() -> impl Iterator<Item = (i32, i32)> {
    (0..BLOCKS).flat_map(|j| (0..BLOCKS).map(move |i| (i, j)))
}

/// A block with its load, drive and friction.
fn from_the_side(drawn: &mut Sketch, [x, y]: [f64; 2]) {
    let half = 2.0 * HALF;
    let (floor, top, pulled) = (y - half, y + half, x + 1.15);
    let ground = [[x - 0.75, floor], [x + 1.75, floor]];
    drawn.strokes.push(stroke(StrokeStyle::Thin, &ground));
    for k in 0..25 {
        let at = x - 0.65 + 0.1 * f64::from(k);
        let hatch = [[at, floor], [at - 0.1, floor - 0.12]];
        drawn.strokes.push(stroke(StrokeStyle::Thin, &hatch));
    }
    let friction = [[x - half, floor + 0.07], [x - 0.75, floor + 0.07]];
    drawn.strokes.extend([
        stroke(StrokeStyle::Line(2), &spring([x, y], [pulled, y], 0.6)),
        stroke(StrokeStyle::Arrow, &[[pulled, y], [x + 1.7, y]]),
        body([x, y], half),
        stroke(StrokeStyle::Arrow, &[[x, top + 0.6], [x, top + 0.03]]),
        stroke(StrokeStyle::Arrow, &friction),
    ]);
    drawn.labels.extend(names([
        ("m", [x, y]),
        ("F_n", [x + 0.2, top + 0.4]),
        ("F_f", [x - 0.55, floor + 0.25]),
        ("k_s", [x + 0.69, y + 0.24]),
        ("V", [x + 1.55, y + 0.18]),
    ]));
}

fn body([x, y]: [f64; 2], half: f64) -> Stroke {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corner = |(to_x, to_y): (f64, f64)| [x + half * to_x, y + half * to_y];
    stroke(StrokeStyle::Body, &corners.map(corner))
}

/// A line between two points with a zigzag around the position `middle`, from 0 to 1 along its length.
fn spring([x, y]: [f64; 2], [to_x, to_y]: [f64; 2], middle: f64) -> Vec<[f64; 2]> {
    const TURNS: i32 = 7;
    const AMPLITUDE: f64 = 0.055;
    let distance = libm::hypot(to_x - x, to_y - y);
    let (dx, dy) = ((to_x - x) / distance, (to_y - y) / distance);
    let at = |along: f64, aside: f64| [x + along * dx - aside * dy, y + along * dy + aside * dx];
    let (length, middle) = (0.4, middle * distance);
    let begin = middle - 0.5 * length;
    let turn = |k: i32| {
        let aside = if k % 2 == 0 { AMPLITUDE } else { -AMPLITUDE };
        at(begin + length * (f64::from(k) + 0.5) / f64::from(TURNS), aside)
    };
    let mut points = vec![[x, y], at(begin, 0.0)];
    points.extend((0..TURNS).map(turn));
    points.extend([at(begin + length, 0.0), [to_x, to_y]]);
    points
}
