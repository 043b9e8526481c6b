//! Bins of blocks by their position along the drive.

use crate::drive::Drive;
use crate::lattice::Lattice;

/// Bins of blocks by `r . d`, with the position r of a block and the direction d of the drive; for a rotation
/// by their distance from the axis. A bin is one block wide, or several if there would be more than
/// [`PositionBins::MAX`] bins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionBins {
    /// Number of bins.
    pub count: usize,
    /// Width of each bin, in blocks.
    pub width: usize,
    /// Position `r . d` at which the first bin begins, in blocks.
    pub start: f64,
    measure: Coordinate,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Coordinate {
    Along([f64; 2]),
    From([f64; 2]),
}

impl PositionBins {
    /// Largest number of bins.
    pub const MAX: usize = 1024;

    /// The bins of a lattice under the given drive.
    ///
    /// ```
    /// use slipfront::{Drive, Lattice, PositionBins};
    /// let lattice = Lattice::free(4, 3);
    /// let along_x = PositionBins::new(&lattice, &Drive::along_x(0.1));
    /// assert_eq!((along_x.count, along_x.start, along_x.bin(2, 1)), (4, 0.0, 2));
    /// let along_y = PositionBins::new(&lattice, &Drive::at_angle(0.1, 90.0));
    /// assert_eq!((along_y.count, along_y.start, along_y.bin(2, 1)), (3, 0.0, 1));
    /// let against_x = PositionBins::new(&lattice, &Drive::at_angle(0.1, 180.0));
    /// assert_eq!((against_x.count, against_x.start, against_x.bin(3, 1)), (4, -4.0, 0));
    /// ```
    pub fn new(lattice: &Lattice, drive: &Drive) -> Self {
        let sides = [lattice.nx, lattice.ny].map(|count| count as f64);
        let (measure, start, blocks) = match &drive.rotation {
            None => {
                let direction = drive.direction;
                // The centres of the blocks at the corners.
                let end = |axis: usize, at: f64| direction[axis] * at;
                let [from, to] = [f64::min, f64::max].map(|choose: fn(f64, f64) -> f64| {
                    let ends = [0, 1].map(|axis| choose(end(axis, 0.5), end(axis, sides[axis] - 0.5)));
                    ends[0] + ends[1]
                });
                (
                    Coordinate::Along(direction),
                    from - 0.5,
                    (to - from + 0.5).floor(),
                )
            }
            Some(rotation) => {
                let centre = rotation.centre;
                let farthest = [0, 1].map(|axis| {
                    let ends = [centre[axis] - 0.5, sides[axis] - 0.5 - centre[axis]];
                    ends[0].abs().max(ends[1].abs())
                });
                let radius = (farthest[0] * farthest[0] + farthest[1] * farthest[1]).sqrt();
                (Coordinate::From(centre), 0.0, radius.floor())
            }
        };
        let n = blocks as usize + 1;
        let width = n.div_ceil(Self::MAX);
        Self {
            count: n.div_ceil(width),
            width,
            start,
            measure,
        }
    }

    /// The bin of block (i, j) of the lattice.
    #[inline]
    pub fn bin(&self, i: usize, j: usize) -> usize {
        let (x, y) = (i as f64 + 0.5, j as f64 + 0.5);
        let place = match self.measure {
            Coordinate::Along([dx, dy]) => dx * x + dy * y,
            Coordinate::From([cx, cy]) => ((x - cx) * (x - cx) + (y - cy) * (y - cy)).sqrt(),
        };
        // Rounding may put the outermost block beyond an end.
        ((place - self.start) / self.width as f64)
            .max(0.0)
            .min((self.count - 1) as f64) as usize
    }

    /// The middle of a bin, in blocks.
    pub fn middle(&self, bin: usize) -> f64 {
        self.start + self.width as f64 * (bin as f64 + 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::communicator::Alone;
    use crate::slider::Slider;

    /// Bins one block wide have no gap and miss no block, for any direction.
    #[test]
    fn every_bin_has_blocks_whose_place_lies_within_it() {
        for degrees in [0.0, 30.0, 45.0, 90.0, 137.0, 180.0, 250.0, 359.0] {
            for (nx, ny) in [(1, 1), (9, 1), (1, 9), (12, 7), (40, 40)] {
                let lattice = Lattice::free(nx, ny);
                let drive = Drive::at_angle(0.1, degrees);
                let bins = PositionBins::new(&lattice, &drive);
                let mut found = vec![0; bins.count];
                for b in 0..lattice.n_blocks() {
                    let (i, j) = lattice.column_row(b);
                    let [dx, dy] = drive.direction;
                    let place = (i as f64 + 0.5) * dx + (j as f64 + 0.5) * dy;
                    let bin = bins.bin(i, j);
                    assert!(
                        (place - bins.middle(bin)).abs() < 0.5 + 1e-9,
                        "{degrees} {nx} {ny}"
                    );
                    found[bin] += 1;
                }
                // In a narrow slider driven at an angle, centres are farther apart than one block width.
                let is_dense = nx.min(ny) > 6 || degrees % 90.0 == 0.0;
                assert!(!is_dense || found.iter().all(|n| *n > 0), "{degrees} {nx} {ny}");
            }
        }
    }

    #[test]
    fn long_sliders_have_wider_bins_and_rotations_radial_ones() {
        let bins = PositionBins::new(&Lattice::free(2050, 1), &Drive::along_x(0.1));
        assert_eq!((bins.count, bins.width, bins.bin(2049, 0)), (684, 3, 683));
        let lattice = Lattice::free(9, 9);
        let rotation =
            crate::drive::Rotation::about_centroid(&lattice, &(0..lattice.ny), &Slider::default(), &Alone);
        let drive = Drive {
            rotation: Some(rotation),
            ..Drive::along_x(0.1)
        };
        let bins = PositionBins::new(&lattice, &drive);
        // The corners are 4 sqrt(2) = 5.7 blocks from the middle.
        assert_eq!(
            (bins.count, bins.bin(4, 4), bins.bin(0, 4), bins.bin(8, 8)),
            (6, 0, 4, 5)
        );
    }
}
