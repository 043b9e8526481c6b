//! Mean height of every block: the average over the points that it covers, each weighted with its area in the
//! block.

use std::ops::Range;

use super::grid::Line;
use super::quantum::Quantum;

/// Heights that are averaged over blocks, point by point.
///
/// Both grids cover the same rectangle. Along an axis with `p` points and `b` blocks, in common integer
/// units, point k lies between k b and (k + 1) b, and block i between i p and (i + 1) p, so that their shared
/// area is exact. Sums of whole quanta are exact too: blocks over equal heights have equal means, wherever
/// they lie.
pub(super) struct Averages {
    points: [usize; 2],
    blocks: [usize; 2],
    quantum: Quantum,
    /// Sums of quanta times areas, row by row of blocks in rising y: sums of numbers below 2^53 times at most
    /// 2^28 points.
    sums: Vec<i128>,
    /// Sums of the current line, over its blocks along x.
    of_line: Vec<i128>,
    /// Areas of unmeasured points in every block; empty while there are none.
    gaps: Vec<i128>,
}

impl Averages {
    pub(super) fn new(points: [usize; 2], blocks: [usize; 2], quantum: Quantum) -> Self {
        Self {
            points,
            blocks,
            quantum,
            sums: vec![0; blocks[0] * blocks[1]],
            of_line: vec![0; blocks[0]],
            gaps: Vec::new(),
        }
    }

    /// Adds the heights of a line. Rows are counted from the smallest y.
    pub(super) fn add(&mut self, line: &Line) {
        let [points, blocks] = [self.points, self.blocks];
        let touched = |axis: usize, points_of_it: Range<usize>| {
            points_of_it.start * blocks[axis] / points[axis]
                ..(points_of_it.end * blocks[axis]).div_ceil(points[axis])
        };
        let common = |axis: usize, point: usize, block: usize| {
            let from = (point * blocks[axis]).max(block * points[axis]);
            let to = ((point + 1) * blocks[axis]).min((block + 1) * points[axis]);
            (to - from) as i128
        };
        let columns = touched(0, line.column..line.column + line.heights.len());
        self.of_line[columns.clone()].fill(0);
        for (point, &height) in (line.column..).zip(line.heights) {
            if height.is_nan() {
                self.gaps.resize(self.sums.len(), 0);
                for row in touched(1, line.row..line.row + 1) {
                    for column in touched(0, point..point + 1) {
                        self.gaps[row * blocks[0] + column] +=
                            common(0, point, column) * common(1, line.row, row);
                    }
                }
                continue;
            }
            let quanta = i128::from(self.quantum.count(height));
            for block in touched(0, point..point + 1) {
                self.of_line[block] += quanta * common(0, point, block);
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

    /// The means, in rising y; NaN for a block without a measured point.
    pub(super) fn means(self) -> impl Iterator<Item = f64> {
        let area = self.points[0] as i128 * self.points[1] as i128;
        let gaps = self.gaps.into_iter().chain(std::iter::repeat(0));
        self.sums.into_iter().zip(gaps).map(move |(sum, gap)| {
            let area = area - gap;
            if area == 0 {
                return f64::NAN;
            }
            // Quotient and remainder are converted separately, so that the mean of equal heights is exactly
            // this height.
            let (whole, rest) = (sum / area, sum % area);
            self.quantum.height(whole as f64 + rest as f64 / area as f64)
        })
    }
}
