//! Patterns: the positions of the copies of a shape.

use crate::lattice::Lattice;

/// An array of positions around a middle, in columns and rows.
///
/// Odd rows of a staggered array are shifted by half a column relative to even rows, each by a quarter: with
/// rows `sqrt(3)/2` columns apart, every position has six neighbours at equal distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Array {
    /// Numbers of columns and rows.
    pub count: [usize; 2],
    /// Distance between columns and between rows, in blocks.
    pub spacing: [f64; 2],
    /// Whether every second row is shifted.
    pub staggered: bool,
}

impl Array {
    /// A rectangular array that is spread evenly over a lattice.
    pub fn spread(lattice: &Lattice, count: [usize; 2]) -> Self {
        let spacing = |size: usize, count: usize| size as f64 / count as f64;
        Self {
            count,
            spacing: [spacing(lattice.nx, count[0]), spacing(lattice.ny, count[1])],
            staggered: false,
        }
    }

    /// The array with every second row shifted.
    pub fn staggered(self) -> Self {
        Self {
            staggered: true,
            ..self
        }
    }

    /// Distance of a line from the middle of the array.
    fn shift(&self, axis: usize, line: usize) -> f64 {
        self.spacing[axis] * (line as f64 - 0.5 * (self.count[axis] as f64 - 1.0))
    }

    /// Shift of a row, in columns.
    fn aside(&self, row: usize) -> f64 {
        match (self.staggered && self.count[1] > 1, row % 2) {
            (false, _) => 0.0,
            (true, 0) => -0.25,
            (true, _) => 0.25,
        }
    }

    /// A position, as the shift from the middle.
    pub(super) fn place(&self, column: usize, row: usize) -> [f64; 2] {
        let x = self.shift(0, column) + self.aside(row) * self.spacing[0];
        [x, self.shift(1, row)]
    }

    /// Positions of the array as rectangular grids: one, or one of even rows and one of odd rows.
    fn grids(&self) -> Vec<Crossings> {
        let [columns, rows] = self.count;
        let grid = |first_row: usize, rows: &mut dyn Iterator<Item = usize>| {
            let x = |column| self.place(column, first_row)[0];
            [
                (0..columns).map(x).collect(),
                rows.map(|row| self.shift(1, row)).collect(),
            ]
        };
        if !self.staggered || rows == 1 {
            return vec![grid(0, &mut (0..rows))];
        }
        vec![
            grid(0, &mut (0..rows).step_by(2)),
            grid(1, &mut (1..rows).step_by(2)),
        ]
    }
}

/// Positions at every crossing of vertical lines, given first by their x, and horizontal lines, given by
/// their y; both in ascending order, and not empty.
pub(super) type Crossings = [Vec<f64>; 2];

/// The positions of arrays of arrays, as shifts from the middle of all positions.
pub(super) fn grids(arrays: &[Array]) -> Vec<Crossings> {
    let alone = vec![[vec![0.0], vec![0.0]]];
    arrays.iter().fold(alone, |outer, array| {
        let inner = array.grids();
        let pairs = outer
            .iter()
            .flat_map(|outer| inner.iter().map(move |inner| (outer, inner)));
        pairs
            .map(|(outer, inner)| [0, 1].map(|axis| sums(&outer[axis], &inner[axis])))
            .collect()
    })
}

/// Sums of every one of the first lines and every one of the second, in ascending order.
fn sums(outer: &[f64], inner: &[f64]) -> Vec<f64> {
    let sums = outer
        .iter()
        .flat_map(|outer| inner.iter().map(move |inner| outer + inner));
    let mut sums: Vec<f64> = sums.collect();
    sums.sort_by(f64::total_cmp);
    sums
}

/// Number of rows of positions of all grids.
pub(super) fn n_rows(grids: &[Crossings]) -> usize {
    grids.iter().map(|[_, rows]| rows.len()).sum()
}

/// Number of positions of arrays of arrays.
///
/// ```
/// # use slipfront::surface::{Array, n_copies};
/// let array = Array { count: [3, 2], spacing: [10.0, 10.0], staggered: false };
/// assert_eq!((n_copies(&[]), n_copies(&[array, array])), (1, 36));
/// ```
pub fn n_copies(arrays: &[Array]) -> usize {
    arrays
        .iter()
        .map(|array| array.count[0] * array.count[1])
        .product()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(arrays: &[Array]) -> Vec<[f64; 2]> {
        let grids = grids(arrays);
        let pairs = |[x, y]: &Crossings| -> Vec<[f64; 2]> {
            y.iter().flat_map(|&y| x.iter().map(move |&x| [x, y])).collect()
        };
        grids.iter().flat_map(pairs).collect()
    }

    #[test]
    fn a_hexagonal_place_has_six_neighbours_at_one_distance() {
        let pitch = 7.0;
        let hexagonal = Array {
            count: [5, 5],
            spacing: [pitch, pitch * libm::sqrt(0.75)],
            staggered: true,
        };
        let places = places(&[hexagonal]);
        assert_eq!(places.len(), 25);
        let middle = places
            .iter()
            .min_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])))
            .unwrap();
        let mut distances: Vec<f64> = places
            .iter()
            .map(|place| (place[0] - middle[0]).hypot(place[1] - middle[1]))
            .collect();
        distances.sort_by(f64::total_cmp);
        // Rounding of coordinates below 20.
        assert!(
            distances[1..7]
                .iter()
                .all(|distance| (distance - pitch).abs() < 1e-13)
        );
        assert!((distances[7] - pitch * libm::sqrt(3.0)).abs() < 1e-13);
    }

    /// Half a turn about the middle maps positions to positions, for an even number of rows.
    #[test]
    fn patterns_stand_in_the_middle() {
        for (count, staggered) in [([3, 5], false), ([4, 2], true), ([1, 6], true), ([5, 1], true)] {
            let array = Array {
                count,
                spacing: [3.0, 2.0],
                staggered,
            };
            let pair = Array {
                count: [2, 2],
                spacing: [0.5, 0.25],
                staggered,
            };
            for arrays in [&[array][..], &[array, pair]] {
                let places = places(arrays);
                assert_eq!(places.len(), n_copies(arrays));
                for [x, y] in &places {
                    assert!(places.contains(&[-x, -y]), "{arrays:?}: {x} {y}");
                }
            }
        }
    }
}
