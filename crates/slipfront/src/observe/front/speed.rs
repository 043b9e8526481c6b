//! How fast the front runs: planes through the times of the blocks around each.

use crate::lattice::{Edges, Lattice};

/// Blocks from the middle of a window to its edge.
const REACH: usize = 3;
/// Fewest blocks of a window that have slipped, of each of the rows that it has, up to five of them.
const LEAST_PER_ROW: usize = 5;

/// The speed of the front around every block where it is known, in blocks per unit of time.
pub(super) fn speeds(lattice: &Lattice, times: &[f64], nucleations: &[usize]) -> Vec<f64> {
    let axes = [0, 1].map(|axis| Axis::of(lattice, axis));
    let mut is_left_out = vec![false; times.len()];
    for &block in nucleations {
        let (i, j) = lattice.column_row(block);
        for (_, row) in axes[1].around(j) {
            for (_, column) in axes[0].around(i) {
                is_left_out[lattice.block(column, row)] = true;
            }
        }
    }
    let rows = axes[0].window().min(axes[1].window());
    let least = LEAST_PER_ROW * rows.min(LEAST_PER_ROW);
    let mut speeds = Vec::new();
    for j in 0..lattice.ny {
        for i in 0..lattice.nx {
            let block = lattice.block(i, j);
            if times[block].is_nan() || is_left_out[block] {
                continue;
            }
            let mut sums = Sums::default();
            for (y, row) in axes[1].around(j) {
                for (x, column) in axes[0].around(i) {
                    let time = times[lattice.block(column, row)];
                    if !time.is_nan() {
                        // Of blocks that slip at once the differences are exactly zero.
                        sums.add(x, y, time - times[block]);
                    }
                }
            }
            if sums.n as usize >= least {
                let speed = 1.0 / sums.slope();
                speeds.extend(Some(speed).filter(|speed| speed.is_finite()));
            }
        }
    }
    speeds
}

/// One axis of the lattice.
struct Axis {
    count: usize,
    is_periodic: bool,
    /// Of a periodic axis, blocks from the middle of a window to its edge: none stands in it twice.
    reach: usize,
}

impl Axis {
    fn of(lattice: &Lattice, axis: usize) -> Self {
        let count = [lattice.nx, lattice.ny][axis];
        Self {
            count,
            is_periodic: lattice.edges[axis] == Edges::Periodic,
            reach: REACH.min((count - 1) / 2),
        }
    }

    /// Most places of a window.
    fn window(&self) -> usize {
        let all = 2 * REACH + 1;
        match self.is_periodic {
            true => 2 * self.reach + 1,
            false => all.min(self.count),
        }
    }

    /// The places of a window around a place, each with how far it lies from the middle.
    fn around(&self, middle: usize) -> impl Iterator<Item = (i32, usize)> + use<> {
        let (count, is_periodic) = (self.count, self.is_periodic);
        let reach = if is_periodic { self.reach } else { REACH } as i32;
        (-reach..=reach).filter_map(move |offset| {
            let place = middle as isize + offset as isize;
            let wrapped = match is_periodic {
                true => place.rem_euclid(count as isize) as usize,
                false => usize::try_from(place).ok().filter(|place| *place < count)?,
            };
            Some((offset, wrapped))
        })
    }
}

/// Sums over the blocks of a window at (x, y) from its middle, with the time t after that of the middle.
#[derive(Default)]
struct Sums {
    n: i32,
    x: i32,
    y: i32,
    xx: i32,
    xy: i32,
    yy: i32,
    t: f64,
    xt: f64,
    yt: f64,
}

impl Sums {
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
    }

    /// `|g|` of the plane `t = a + g . r` of least squares; of blocks in a row that along it.
    fn slope(&self) -> f64 {
        let n = f64::from(self.n);
        // n^2 times the variances and covariances.
        let [xx, xy, yy] = [
            self.n * self.xx - self.x * self.x,
            self.n * self.xy - self.x * self.y,
            self.n * self.yy - self.y * self.y,
        ]
        .map(f64::from);
        let (xt, yt) = (
            n * self.xt - f64::from(self.x) * self.t,
            n * self.yt - f64::from(self.y) * self.t,
        );
        let determinant = xx * yy - xy * xy;
        if determinant > 0.0 {
            let [gx, gy] = [xt * yy - yt * xy, yt * xx - xt * xy].map(|g| g / determinant);
            return (gx * gx + gy * gy).sqrt();
        }
        // A chain along one of the axes.
        (xt + yt).abs() / (xx + yy)
    }
}
