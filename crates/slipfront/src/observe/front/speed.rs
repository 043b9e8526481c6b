//! Speed of the front: planes through the times of the blocks around each block.

use crate::lattice::{Edges, Lattice};
use crate::vector_field::dot;

/// Number of blocks from the middle of a window to its edge.
const REACH: usize = 3;
/// Least number of slipped blocks of a window for each row of the window, or of all slipped blocks, for up to
/// five rows.
const LEAST_PER_ROW: usize = 5;

/// Least share of the variance of the times in a window that the plane of a passing front explains. White
/// noise reaches it in one of ten million windows. In a front with blocks that are early or late by twice the
/// time in which it passes one (rms), half of the windows reach it.
const LEAST_EXPLAINED: f64 = 0.5;
/// Least cosine of the angle by which a front turns from a window to those around it, 60 degrees. The
/// direction turns by more where two fronts meet.
const LEAST_COSINE: f64 = 0.5;

/// Passages of the front through windows.
pub(super) struct Passages {
    /// Speed of the front in every window through which it passes, in blocks per unit of time.
    pub(super) speeds: Vec<f64>,
    /// Number of windows with enough blocks for a plane.
    pub(super) n_windows: usize,
}

/// The windows of all blocks through which a front passes.
pub(super) fn passages(lattice: &Lattice, times: &[f64], nucleations: &[usize]) -> Passages {
    let axes = [0, 1].map(|axis| WindowAxis::new(lattice, axis));
    let mut is_left_out = vec![false; times.len()];
    for &block in nucleations {
        let (i, j) = lattice.column_row(block);
        for (_, row) in axes[1].around(j) {
            for (_, column) in axes[0].around(i) {
                is_left_out[lattice.block(column, row)] = true;
            }
        }
    }
    let slipped = extents(lattice, times);
    let rows = [0, 1].map(|axis| axes[axis].window().min(slipped[axis]));
    let least = LEAST_PER_ROW * rows[0].min(rows[1]).min(LEAST_PER_ROW);
    let mut n_windows = 0;
    let mut slopes = vec![[f64::NAN; 2]; times.len()];
    let mut is_plane = vec![false; times.len()];
    for block in (0..times.len()).filter(|&b| !times[b].is_nan() && !is_left_out[b]) {
        let sums = WindowSums::around(lattice, &axes, times, block);
        if sums.n as usize >= least {
            n_windows += 1;
            slopes[block] = sums.slope();
            is_plane[block] = sums.explained(slopes[block]) >= LEAST_EXPLAINED;
        }
    }
    let passes = |&block: &usize| is_plane[block] && !turns(lattice, &axes, &slopes, block);
    let speed = |block: usize| 1.0 / dot(slopes[block], slopes[block]).sqrt();
    Passages {
        speeds: (0..times.len()).filter(passes).map(speed).collect(),
        n_windows,
    }
}

/// Numbers of columns and rows of the smallest rectangle that contains all slipped blocks; one of them is 1
/// for a line of contacts.
fn extents(lattice: &Lattice, times: &[f64]) -> [usize; 2] {
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    for block in (0..times.len()).filter(|&b| !times[b].is_nan()) {
        let (i, j) = lattice.column_row(block);
        for (axis, place) in [i, j].into_iter().enumerate() {
            low[axis] = low[axis].min(place);
            high[axis] = high[axis].max(place);
        }
    }
    [0, 1].map(|axis| (high[axis] + 1).saturating_sub(low[axis]))
}

/// Whether the front has another direction in one of the windows at the distance of a window's edge from its
/// middle, along either axis.
fn turns(lattice: &Lattice, axes: &[WindowAxis; 2], slopes: &[[f64; 2]], block: usize) -> bool {
    let (i, j) = lattice.column_row(block);
    let [along, across] = axes.each_ref().map(|axis| axis.reach as isize);
    let offsets = [[-along, 0], [along, 0], [0, -across], [0, across]];
    let mut around = offsets
        .into_iter()
        .filter_map(|offset| lattice.neighbour(i, j, offset));
    around.any(|other| {
        let [one, other] = [slopes[block], slopes[other]];
        let lengths = (dot(one, one) * dot(other, other)).sqrt();
        // NaN for a window without a plane, and 0 for a level plane, which has no direction: neither shows
        // that the front turns.
        dot(one, other) < LEAST_COSINE * lengths
    })
}

/// One axis of the lattice.
struct WindowAxis {
    count: usize,
    is_periodic: bool,
    /// Number of blocks from the middle of a window to its edge. It is smaller on a short axis, so that on a
    /// periodic axis no block is in a window twice.
    reach: usize,
}

impl WindowAxis {
    fn new(lattice: &Lattice, axis: usize) -> Self {
        let count = [lattice.nx, lattice.ny][axis];
        Self {
            count,
            is_periodic: lattice.edges[axis] == Edges::Periodic,
            reach: REACH.min((count - 1) / 2),
        }
    }

    /// Largest number of blocks in a window along this axis.
    fn window(&self) -> usize {
        let all = 2 * REACH + 1;
        if self.is_periodic {
            2 * self.reach + 1
        } else {
            all.min(self.count)
        }
    }

    /// The positions of a window around its middle, each with its distance from the middle.
    fn around(&self, middle: usize) -> impl Iterator<Item = (i32, usize)> + use<> {
        let (count, is_periodic) = (self.count, self.is_periodic);
        let reach = if is_periodic { self.reach } else { REACH } as i32;
        (-reach..=reach).filter_map(move |offset| {
            let place = middle as isize + offset as isize;
            let wrapped = if is_periodic {
                place.rem_euclid(count as isize) as usize
            } else {
                usize::try_from(place).ok().filter(|place| *place < count)?
            };
            Some((offset, wrapped))
        })
    }
}

/// Sums over the blocks of a window, with their position (x, y) relative to the middle and their time t after
/// the time of the middle.
#[derive(Default)]
struct WindowSums {
    n: i32,
    x: i32,
    y: i32,
    xx: i32,
    xy: i32,
    yy: i32,
    t: f64,
    xt: f64,
    yt: f64,
    tt: f64,
}

impl WindowSums {
    /// Sums over the slipped blocks around a block.
    fn around(lattice: &Lattice, axes: &[WindowAxis; 2], times: &[f64], block: usize) -> Self {
        let (i, j) = lattice.column_row(block);
        let mut sums = Self::default();
        for (y, row) in axes[1].around(j) {
            for (x, column) in axes[0].around(i) {
                let time = times[lattice.block(column, row)];
                if !time.is_nan() {
                    // Exactly zero differences for blocks that slip at once.
                    sums.add(x, y, time - times[block]);
                }
            }
        }
        sums
    }

    #[inline]
    fn add(&mut self, x: i32, y: i32, t: f64) {
        self.n += 1;
        self.x += x;
        self.y += y;
        self.xx += x * x;
        self.xy += x * y;
        self.yy += y * y;
        self.t += t;
        self.xt += f64::from(x) * t;
        self.yt += f64::from(y) * t;
        self.tt += t * t;
    }

    /// Covariances of position and time, times n^2.
    fn with_time(&self) -> [f64; 2] {
        let n = f64::from(self.n);
        [
            n * self.xt - f64::from(self.x) * self.t,
            n * self.yt - f64::from(self.y) * self.t,
        ]
    }

    /// Slope g of the least-squares plane `t = a + g . r`; for blocks in a row the plane that is level across
    /// it.
    fn slope(&self) -> [f64; 2] {
        // n^2 times the variances and covariances.
        let [xx, xy, yy] = [
            self.n * self.xx - self.x * self.x,
            self.n * self.xy - self.x * self.y,
            self.n * self.yy - self.y * self.y,
        ]
        .map(f64::from);
        let [xt, yt] = self.with_time();
        let determinant = xx * yy - xy * xy;
        if determinant > 0.0 {
            return [xt * yy - yt * xy, yt * xx - xt * xy].map(|g| g / determinant);
        }
        [xt, yt].map(|g| g / (xx + yy))
    }

    /// Share R^2 of the variance of the times that the plane of this slope explains; none for a window in
    /// which all blocks slip at once.
    fn explained(&self, slope: [f64; 2]) -> f64 {
        let variance = f64::from(self.n) * self.tt - self.t * self.t;
        if variance > 0.0 {
            dot(slope, self.with_time()) / variance
        } else {
            0.0
        }
    }
}
