//! The mean height of every block: of the points that it covers, each by the area that lies in it.

use std::ops::Range;

use super::grid::Line;

/// Heights that are averaged over blocks, point after point.
///
/// Both grids are stretched over the same rectangle, so that along an axis with `p` points and `b` blocks, point k lies between
/// k b and (k + 1) b, and block i between i p and (i + 1) p of the same whole units: what they have in common is exact.
pub(super) struct Averages {
    points: [usize; 2],
    blocks: [usize; 2],
    /// Sums of heights times areas, row after row of blocks in rising y.
    sums: Vec<f64>,
    /// Those of the present line, of its blocks along x.
    of_line: Vec<f64>,
}

impl Averages {
    pub(super) fn new(points: [usize; 2], blocks: [usize; 2]) -> Self {
        Self {
            points,
            blocks,
            sums: vec![0.0; blocks[0] * blocks[1]],
            of_line: vec![0.0; blocks[0]],
        }
    }

    /// Adds the heights of a line whose row is counted from the smallest y.
    pub(super) fn add(&mut self, line: &Line) {
        let [points, blocks] = [self.points, self.blocks];
        let touched = |axis: usize, points_of_it: Range<usize>| {
            points_of_it.start * blocks[axis] / points[axis]
                ..(points_of_it.end * blocks[axis]).div_ceil(points[axis])
        };
        let common = |axis: usize, point: usize, block: usize| {
            let from = (point * blocks[axis]).max(block * points[axis]);
            let to = ((point + 1) * blocks[axis]).min((block + 1) * points[axis]);
            (to - from) as f64
        };
        let columns = touched(0, line.column..line.column + line.heights.len());
        self.of_line[columns.clone()].fill(0.0);
        for (point, height) in (line.column..).zip(line.heights) {
            for block in touched(0, point..point + 1) {
                self.of_line[block] += height * common(0, point, block);
            }
        }
        for row in touched(1, line.row..line.row + 1) {
            let breadth = common(1, line.row, row);
            let sums = &mut self.sums[row * blocks[0]..][..blocks[0]];
            for column in columns.clone() {
                sums[column] += breadth * self.of_line[column];
            }
        }
    }

    /// The means, in rising y.
    pub(super) fn means(mut self) -> Vec<f64> {
        let area = self.points[0] as f64 * self.points[1] as f64;
        for sum in &mut self.sums {
            *sum /= area;
        }
        self.sums
    }
}
