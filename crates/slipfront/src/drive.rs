//! Drive of the slider: the far ends of the drive springs, which move together. Under slow loading
//! ([`Loading`]) they wait until no block in contact slides.

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::communicator::Communicator;
use crate::lattice::{K_DIAGONAL, K_DRIVE, Lattice};
use crate::slider::Slider;
use crate::vector_field::{length, unit_vector};
use slipfront_kernel::fixed_point::sum_over;

/// Drive of the slider.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Dimensionless speed `V*` (Eq. 11a): the largest speed of a program, and for a rotation the speed at
    /// the largest radius.
    pub v_star: f64,
    /// Unit vector of the sliding direction.
    pub direction: [f64; 2],
    /// Stiffness `k_s` of the spring on every block, in units of `E h`; see
    /// [`Slider::drive_springs`](crate::Slider::drive_springs).
    pub k_drive: f64,
    /// Program of speeds; without one the drive moves at `v_star` all the time.
    pub program: Option<Arc<Program>>,
    /// A rotation instead of the translation along `direction`.
    pub rotation: Option<Rotation>,
    /// Whether the drive waits for slip to end.
    pub loading: Loading,
}

/// When the far ends of the drive springs move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loading {
    /// The far ends move in every step, at the speed of the drive.
    #[default]
    Constant,
    /// The far ends move only in steps before which no block in contact slid. This is slow loading, at any
    /// speed of the drive. The time of the drive, which path, program and windows use, is then `dt*` times
    /// the number of steps in which it moved.
    Held {
        /// Number of steps of the drive up to which the largest mu* counts as static friction.
        onset_steps: u64,
    },
}

/// Speed of the drive, constant over each of several segments. The far ends move without a jump.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Program {
    segments: Vec<Segment>,
}

/// A part of a program in which the speed is constant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// Speed, which may be zero or negative.
    pub v_star: f64,
    /// t* at which the segment begins.
    pub from_star: f64,
    /// Displacement of the far ends at the beginning of the segment.
    pub from_position: f64,
}

/// A rotation of the far ends about an axis across the sliding plane, counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// The axis, in units of the block size.
    pub centre: [f64; 2],
    /// Largest distance of a block from the axis, at which the speed is `v_star`.
    pub radius: f64,
    /// `sum r_i/radius` over all blocks that exist.
    pub sum_radii: f64,
    /// `sum w_i (r_i/radius)^2`, with the relative stiffness `w` of the drive springs.
    pub sum_squares: f64,
}

impl Drive {
    /// Screening lengths in blocks, along the drive and across it: the mount, a drive spring on every block,
    /// screens a local change of stress, so that blocks farther away are pulled as before. The stiffness of
    /// the lattice against a strain along the drive is 9/8, 3/4 for a chain:
    ///
    /// ```text
    /// lambda = sqrt(K_el/k_s),   K_el = 9/8 along and 3/8 across
    /// ```
    ///
    /// ```
    /// // The paper's springs are as stiff as diagonal ones, k_s = 3/8.
    /// let [along, across] = slipfront::Drive::along_x(0.03).screening_lengths(&slipfront::Lattice::free(25, 25));
    /// assert!((along - 3_f64.sqrt()).abs() < 1e-15 && across == 1.0);
    /// ```
    pub fn screening_lengths(&self, lattice: &Lattice) -> [f64; 2] {
        [lattice.stiffness_along(), K_DIAGONAL].map(|stiffness| (stiffness / self.k_drive).sqrt())
    }
}

impl Rotation {
    /// A rotation about the centroid of all blocks that exist in the whole lattice. This rank holds some
    /// `rows` of it. All `ranks` must call this together.
    pub fn about_centroid(
        lattice: &Lattice,
        rows: &Range<usize>,
        slider: &Slider,
        ranks: &dyn Communicator,
    ) -> Self {
        let held = lattice.blocks_of(rows);
        // Number of each block in the whole lattice, and on this rank.
        let blocks: Vec<(usize, usize)> = held.zip(0..).filter(|&(_, b)| slider.exists(b)).collect();
        // Twice the coordinates of block centres are odd integers, so that sums are exact in any order.
        let mut sums = blocks.iter().fold([0, 0, 0], |[x, y, n], &(block, _)| {
            let (i, j) = lattice.column_row(block);
            [x + 2 * i as i64 + 1, y + 2 * j as i64 + 1, n + 1]
        });
        ranks.sum(&mut sums);
        let [x, y, n] = sums;
        let about_axis = Self {
            centre: [x, y].map(|sum| sum as f64 / (2 * n) as f64),
            radius: 1.0,
            sum_radii: f64::NAN,
            sum_squares: f64::NAN,
        };
        let radii: Vec<f64> = blocks
            .iter()
            .map(|&(block, _)| length(about_axis.arm(lattice, block)))
            .collect();
        let radius = ranks.largest_of(radii.iter().copied().fold(0.0, f64::max));
        let relative = |k: usize| radii[k] / radius;
        Self {
            radius,
            sum_radii: sum_over(ranks, radii.len(), relative),
            sum_squares: sum_over(ranks, radii.len(), |k| {
                slider.drive_spring(blocks[k].1) * (relative(k) * relative(k))
            }),
            ..about_axis
        }
    }

    /// Displacement of the driven end over block `b` per path at the largest radius: `z x r/r_max`.
    fn arm(&self, lattice: &Lattice, b: usize) -> [f64; 2] {
        let (i, j) = lattice.column_row(b);
        let [x, y] = [i as f64 + 0.5 - self.centre[0], j as f64 + 0.5 - self.centre[1]];
        [-y / self.radius, x / self.radius]
    }
}

impl Program {
    /// A program from the speed of each segment and the t* at which the segment ends; the last segment has no
    /// end.
    pub fn new(segments: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let (mut from_star, mut from_position) = (0.0, 0.0);
        let segment = |(v_star, until_star): (f64, f64)| {
            let segment = Segment {
                v_star,
                from_star,
                from_position,
            };
            from_position += v_star * (until_star - from_star);
            from_star = until_star;
            segment
        };
        Self {
            segments: segments.into_iter().map(segment).collect(),
        }
    }

    /// All segments in order of time.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The segment at `time_star`; where two segments meet, the later one.
    pub fn segment_at(&self, time_star: f64) -> &Segment {
        let after = self
            .segments
            .partition_point(|segment| segment.from_star <= time_star);
        &self.segments[after.saturating_sub(1)]
    }
}

impl Drive {
    /// A drive along x at `v_star`.
    pub fn along_x(v_star: f64) -> Self {
        Self {
            v_star,
            direction: [1.0, 0.0],
            k_drive: K_DRIVE,
            program: None,
            rotation: None,
            loading: Loading::Constant,
        }
    }

    /// A drive at `v_star` in the direction `degrees` from x towards y.
    pub fn at_angle(v_star: f64, degrees: f64) -> Self {
        Self {
            direction: unit_vector(degrees),
            ..Self::along_x(v_star)
        }
    }

    /// Whether the drive stands still while a block in contact slides.
    pub fn is_held(&self) -> bool {
        self.loading != Loading::Constant
    }

    /// Whether the drive moves up to the next step after one in which `n_slipping` blocks in contact slide.
    pub(crate) fn moves_after(&self, n_slipping: usize) -> bool {
        n_slipping == 0 || !self.is_held()
    }

    /// Speed of steady sliding: V*; 0 for a held drive, which stands still while blocks slide.
    pub(crate) fn steady_speed(&self) -> f64 {
        if self.is_held() { 0.0 } else { self.v_star }
    }

    /// Path of the driven ends along the direction at time `time_star` of the drive; for a rotation the path
    /// at the largest radius.
    #[inline]
    pub fn path(&self, time_star: f64) -> f64 {
        match &self.program {
            None => self.v_star * time_star,
            Some(program) => {
                let segment = program.segment_at(time_star);
                segment.from_position + segment.v_star * (time_star - segment.from_star)
            }
        }
    }

    /// Speed of the drive from `time_star` on.
    pub fn speed_after(&self, time_star: f64) -> f64 {
        match &self.program {
            None => self.v_star,
            Some(program) => program.segment_at(time_star).v_star,
        }
    }

    /// The next t* after `time_star` at which the speed changes.
    pub(crate) fn next_change(&self, time_star: f64) -> Option<f64> {
        let segments = self.program.as_ref()?.segments();
        let later = segments.iter().map(|segment| segment.from_star);
        later.filter(|&from_star| from_star > time_star).reduce(f64::min)
    }

    /// Displacement of the driven ends of the drive springs at `time_star`, for a drive that does not rotate.
    #[inline]
    pub fn position(&self, time_star: f64) -> [f64; 2] {
        let along = self.path(time_star);
        [along * self.direction[0], along * self.direction[1]]
    }

    /// Force of the drive spring on a block at displacement `u` (Eq. 2), `F_s = k_s (V t - u)`.
    pub fn force(&self, u: [f64; 2], time_star: f64) -> [f64; 2] {
        let position = self.position(time_star);
        [0, 1].map(|axis| self.k_drive * (position[axis] - u[axis]))
    }

    /// Displacement of the driven end over block `b` of the whole lattice per path of the drive, `g`: the
    /// direction, or `z x r/r_max` for a rotation. Power and work of the drive follow from `sum F_s . g`.
    pub fn direction_at(&self, lattice: &Lattice, b: usize) -> [f64; 2] {
        match &self.rotation {
            None => self.direction,
            Some(rotation) => rotation.arm(lattice, b),
        }
    }

    /// Time of the drive at which the driven ends have first moved by `path`, forwards or backwards; infinite
    /// if they never do.
    pub fn time_of_path(&self, path: f64) -> f64 {
        let Some(program) = &self.program else {
            return path / self.v_star;
        };
        let reached = program.segments.iter().enumerate().find_map(|(number, segment)| {
            let end = program.segments.get(number + 1);
            let target = path.copysign(segment.v_star);
            let time_star = segment.from_star + (target - segment.from_position) / segment.v_star;
            let is_within =
                time_star >= segment.from_star && end.is_none_or(|end| time_star <= end.from_star);
            is_within.then_some(time_star)
        });
        reached.unwrap_or(f64::INFINITY)
    }

    /// Largest distance by which the driven ends have moved up to `time_star`, forwards or backwards.
    pub fn farthest_path(&self, time_star: f64) -> f64 {
        let segments = self.program.iter().flat_map(|program| &program.segments);
        let ends = segments
            .filter(|segment| segment.from_star < time_star)
            .map(|segment| segment.from_position.abs());
        ends.fold(self.path(time_star).abs(), f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_moves_without_jumps() {
        let drive = Drive {
            program: Some(Arc::new(Program::new([
                (0.5, 10.0),
                (0.0, 20.0),
                (-1.0, f64::INFINITY),
            ]))),
            ..Drive::along_x(1.0)
        };
        let paths = [0.0, 4.0, 10.0, 15.0, 20.0, 22.0].map(|t| drive.path(t));
        assert_eq!(paths, [0.0, 2.0, 5.0, 5.0, 5.0, 3.0]);
        let speeds = [0.0, 9.9, 10.0, 20.0].map(|t| drive.speed_after(t));
        assert_eq!(speeds, [0.5, 0.5, 0.0, -1.0]);
        let times = [0.0, 4.0, 5.0, 6.0].map(|path| drive.time_of_path(path));
        // Path 5 is reached before the stop, and -6 eleven units of time after the return begins.
        assert_eq!(times, [0.0, 8.0, 10.0, 31.0]);
        assert_eq!(
            [15.0, 25.0, 31.0].map(|t| drive.farthest_path(t)),
            [5.0, 5.0, 6.0]
        );
    }
}
