//! The slider's blocks, their neighbours and the springs between them.
//!
//! Block (i, j) has index `j nx + i`: i runs along x, and row 0 lies at y = 0. Its centre is at ((i + 1/2),
//! (j + 1/2)) in units of the block size. The kernels take the springs from here.

use std::f64::consts::SQRT_2;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::communicator::Communicator;

/// Stiffness of a spring to a straight neighbour, `k_1 = (3/4) E h`, in units of `E h` with the thickness `h`
/// of a block.
pub const K_STRAIGHT: f64 = 0.75;
/// Stiffness of a spring to a diagonal neighbour, `k_2 = k_1/2`, in units of `E h`.
pub const K_DIAGONAL: f64 = 0.375;
/// Stiffness of the spring that drives a block, `k_s = k_2`, in units of `E h`.
pub const K_DRIVE: f64 = 0.375;
/// Poisson's ratio of this lattice, which follows from its springs.
pub const POISSON_RATIO: f64 = 1.0 / 3.0;
/// Square of the lattice's highest frequency, `omega_max^2 = 6.5 k_1/m`.
pub const OMEGA_MAX_SQUARED: f64 = 6.5 * K_STRAIGHT;

/// Largest stable time step, `dt* < 2/omega_max = 0.9058`, at any damping (D7, D11).
pub fn dt_star_limit() -> f64 {
    2.0 / OMEGA_MAX_SQUARED.sqrt()
}

/// Force on a block that is held alone in a large sheet of free blocks, over the force of its drive spring,
/// with drive springs of stiffness `k_drive`: the lattice transmits the pull on its neighbours. The response
/// of the free sheet, an integral over the waves of the lattice, gives
///
/// ```text
/// 1/G_xx(0)/k_s     G(0) = mean over q of [k_s + D(q)]^-1
/// D_xx = 2 k_1 (1 - cos q_x) + 2 k_2 (1 - cos q_x cos q_y)     D_xy = 2 k_2 sin q_x sin q_y
/// ```
pub fn springs_on_a_lone_block(k_drive: f64) -> f64 {
    /// Number of waves along each axis with q between 0 and pi, enough for four digits down to a tenth of
    /// [`K_DRIVE`]. Waves of -q contribute the same.
    const WAVES: usize = 32;
    let wave = |n: usize| (n as f64 + 0.5) / WAVES as f64 * std::f64::consts::PI;
    // Each cosine occurs in many terms of the sum.
    let cosines: [f64; WAVES] = std::array::from_fn(|n| libm::cos(wave(n)));
    let sines: [f64; WAVES] = std::array::from_fn(|n| libm::sin(wave(n)));
    let response = |n: usize| {
        let (x, y) = (n % WAVES, n / WAVES);
        let both = 2.0 * K_DIAGONAL * (1.0 - cosines[x] * cosines[y]);
        let [xx, yy] = [x, y].map(|wave| k_drive + 2.0 * K_STRAIGHT * (1.0 - cosines[wave]) + both);
        let xy = 2.0 * K_DIAGONAL * sines[x] * sines[y];
        yy / (xx * yy - xy * xy)
    };
    let n_waves = WAVES * WAVES;
    n_waves as f64 / ((0..n_waves).map(response).sum::<f64>() * k_drive)
}

/// Speed of long shear waves along an axis, `c_S = sqrt(k_2)`, in blocks per unit of t*, of a slider with
/// equal blocks.
pub fn shear_wave_speed() -> f64 {
    K_DIAGONAL.sqrt()
}

/// Boundary of the lattice at both ends of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edges {
    /// The neighbours beyond the edge are absent.
    Free,
    /// The last block is the neighbour of the first.
    Periodic,
}

/// One of the four edges of the lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// The edge at x = 0.
    Left,
    /// The edge at the largest x.
    Right,
    /// The edge at y = 0.
    Bottom,
    /// The edge at the largest y.
    Top,
}

impl Edge {
    /// The axis across the edge: 0 for x, 1 for y.
    pub fn axis(self) -> usize {
        match self {
            Self::Left | Self::Right => 0,
            Self::Bottom | Self::Top => 1,
        }
    }

    /// Number of blocks from the edge to the opposite edge.
    pub fn n_across(self, lattice: &Lattice) -> usize {
        [lattice.nx, lattice.ny][self.axis()]
    }

    /// Number of blocks between the edge and block `b`.
    pub fn distance(self, lattice: &Lattice, b: usize) -> usize {
        let (i, j) = lattice.column_row(b);
        match self {
            Self::Left => i,
            Self::Right => lattice.nx - 1 - i,
            Self::Bottom => j,
            Self::Top => lattice.ny - 1 - j,
        }
    }
}

/// The blocks and their arrangement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lattice {
    /// Number of blocks along x.
    pub nx: usize,
    /// Number of blocks along y.
    pub ny: usize,
    /// Boundaries along x and along y.
    pub edges: [Edges; 2],
}

impl Lattice {
    /// A lattice with free edges all around.
    pub fn free(nx: usize, ny: usize) -> Self {
        Self {
            nx,
            ny,
            edges: [Edges::Free; 2],
        }
    }

    /// A lattice with the given boundaries along x and along y.
    ///
    /// # Panics
    /// If a periodic axis has fewer than [`Lattice::MIN_PERIODIC`] blocks: two springs would join the same
    /// pair of blocks.
    pub fn with_edges(nx: usize, ny: usize, edges: [Edges; 2]) -> Self {
        for (count, edges) in [nx, ny].into_iter().zip(edges) {
            assert!(
                edges == Edges::Free || count >= Self::MIN_PERIODIC,
                "{count} blocks along a periodic axis"
            );
        }
        Self { nx, ny, edges }
    }

    /// Fewest blocks along a periodic axis.
    pub const MIN_PERIODIC: usize = 3;

    /// Stiffness against a strain along an axis, uniform in the other direction, in units of `E h`:
    /// `k_1 + k_2 = 9/8` for a sheet, `k_1` for a chain.
    pub fn stiffness_along(&self) -> f64 {
        if self.nx == 1 || self.ny == 1 {
            K_STRAIGHT
        } else {
            K_STRAIGHT + K_DIAGONAL
        }
    }

    /// Number of blocks, `N = nx ny`.
    pub fn n_blocks(&self) -> usize {
        self.nx * self.ny
    }

    /// Index of block (i, j).
    pub fn block(&self, i: usize, j: usize) -> usize {
        j * self.nx + i
    }

    /// The consecutive rows that a rank holds: as many as the other ranks hold or one more; rank 0 holds the
    /// lowest.
    ///
    /// ```
    /// use slipfront_kernel::lattice::Lattice;
    /// use slipfront_kernel::communicator::Alone;
    /// assert_eq!(Lattice::free(5, 7).rows_of(&Alone), 0..7);
    /// ```
    pub fn rows_of(&self, rank: &dyn Communicator) -> Range<usize> {
        let first = |rank_number: usize| self.ny * rank_number / rank.size();
        first(rank.rank())..first(rank.rank() + 1)
    }

    /// Indices of the blocks of some rows.
    pub fn blocks_of(&self, rows: &Range<usize>) -> Range<usize> {
        rows.start * self.nx..rows.end * self.nx
    }

    /// Column and row of the block with index `b`.
    pub fn column_row(&self, b: usize) -> (usize, usize) {
        (b % self.nx, b / self.nx)
    }

    /// Index of the neighbour along `bond` less the index of the block, away from the ends of rows.
    pub fn shift(&self, bond: &Bond) -> usize {
        (bond.offset[1] as usize * self.nx).wrapping_add_signed(bond.offset[0])
    }

    /// The block `[di, dj]` away from block (i, j), with offsets of -1, 0 or 1, or none beyond a free edge.
    pub fn neighbour(&self, i: usize, j: usize, offset: [isize; 2]) -> Option<usize> {
        let i = neighbour_coordinate(i, offset[0], self.nx, self.edges[0])?;
        let j = neighbour_coordinate(j, offset[1], self.ny, self.edges[1])?;
        Some(self.block(i, j))
    }

    /// Whether the spring from block (i, j) to the block `offset` away runs along a free edge.
    pub fn is_along_edge(&self, [i, j]: [usize; 2], offset: [isize; 2]) -> bool {
        let is_at_end = |coordinate: usize, count: usize, edges: Edges| {
            edges == Edges::Free && (coordinate == 0 || coordinate + 1 == count)
        };
        match offset {
            [_, 0] => is_at_end(j, self.ny, self.edges[1]),
            [0, _] => is_at_end(i, self.nx, self.edges[0]),
            _ => false,
        }
    }
}

/// Coordinate along one axis of the neighbour `offset` away; none beyond a free edge.
fn neighbour_coordinate(coordinate: usize, offset: isize, count: usize, edges: Edges) -> Option<usize> {
    let neighbour = coordinate as isize + offset;
    match edges {
        Edges::Periodic => Some(neighbour.rem_euclid(count as isize) as usize),
        Edges::Free => (0..count as isize)
            .contains(&neighbour)
            .then_some(neighbour as usize),
    }
}

/// Stiffness of two springs in series, each half as long as a whole spring of the same modulus:
/// `2 a b/(a + b)`; 0 if both are 0.
#[inline(always)]
pub fn harmonic_mean(a: f64, b: f64) -> f64 {
    if a + b > 0.0 { 2.0 * a * b / (a + b) } else { 0.0 }
}

/// A spring between a block and one of its eight neighbours. Four bonds per block give all springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bond {
    /// Columns and rows from the block to its neighbour.
    pub offset: [isize; 2],
    /// Stiffness in units of `E h`.
    pub stiffness: f64,
    /// Rest vector **d** from the block to its neighbour, in units of the block size.
    pub rest: [f64; 2],
    /// Rest length `d`.
    pub rest_length: f64,
}

impl Bond {
    /// The bond to the neighbour at x + 1.
    pub const EAST: Bond = Bond::new([1, 0], K_STRAIGHT, 1.0);
    /// The bond to the neighbour at y + 1.
    pub const NORTH: Bond = Bond::new([0, 1], K_STRAIGHT, 1.0);
    /// The bond to the neighbour at (x + 1, y + 1).
    pub const NORTH_EAST: Bond = Bond::new([1, 1], K_DIAGONAL, SQRT_2);
    /// The bond to the neighbour at (x - 1, y + 1).
    pub const NORTH_WEST: Bond = Bond::new([-1, 1], K_DIAGONAL, SQRT_2);
    /// The four bonds per block that together give every spring once.
    pub const ALL: [Bond; 4] = [Bond::EAST, Bond::NORTH, Bond::NORTH_EAST, Bond::NORTH_WEST];

    const fn new(offset: [isize; 2], stiffness: f64, rest_length: f64) -> Self {
        let rest = [offset[0] as f64, offset[1] as f64];
        Self {
            offset,
            stiffness,
            rest,
            rest_length,
        }
    }

    /// Force on the block from this spring (one term of Eq. 3), exact at any strain:
    ///
    /// ```text
    /// F = k (r - d)/eps  r/|r|,   r = d + eps e,   (r - d)/eps = (2 d.e + eps e^2)/(r + d)
    /// ```
    ///
    /// `e`: displacement of the neighbour less that of the block, in units of `P mu_s l^2/(E h)`; `epsilon`:
    /// the strain `P mu_s l/(E h)`, the ratio of this unit to the block size. The formula never subtracts two
    /// nearly equal lengths, so that small displacements lose no digits.
    ///
    /// ```
    /// use slipfront_kernel::lattice::Bond;
    /// // Small strain: only the part of e along the spring counts.
    /// assert_eq!(Bond::EAST.force([2.0, 5.0], 0.0), [0.75 * 2.0, 0.0]);
    /// ```
    #[inline(always)]
    pub fn force(&self, e: [f64; 2], epsilon: f64) -> [f64; 2] {
        let [dx, dy] = self.rest;
        let (rx, ry) = (dx + epsilon * e[0], dy + epsilon * e[1]);
        let r = (rx * rx + ry * ry).sqrt();
        let tension = self.stiffness * self.stretch(e, epsilon) / (r * (r + self.rest_length));
        [tension * rx, tension * ry]
    }

    /// Force on the block from a damper in parallel with this spring, over the time `tau_v` of its damping
    /// constant `eta = tau_v k`:
    ///
    /// ```text
    /// F_v/tau_v = k (r/|r| . w) r/|r|,   r = d + eps e
    /// ```
    ///
    /// `e`, `epsilon`: as for [`Bond::force`]; `w`: velocity of the neighbour less that of the block.
    ///
    /// ```
    /// use slipfront_kernel::lattice::Bond;
    /// // Only the part of the velocity along the spring counts.
    /// assert_eq!(Bond::NORTH.damper_force([0.0, 0.0], [5.0, 2.0], 0.0), [0.0, 0.75 * 2.0]);
    /// ```
    #[inline(always)]
    pub fn damper_force(&self, e: [f64; 2], w: [f64; 2], epsilon: f64) -> [f64; 2] {
        let [dx, dy] = self.rest;
        let (rx, ry) = (dx + epsilon * e[0], dy + epsilon * e[1]);
        let pull = self.stiffness * (rx * w[0] + ry * w[1]) / (rx * rx + ry * ry);
        [pull * rx, pull * ry]
    }

    /// Energy of this spring, `(k/2) ((r - d)/eps)^2`, for the same `e` and `epsilon` as [`Bond::force`].
    #[inline(always)]
    pub fn energy(&self, e: [f64; 2], epsilon: f64) -> f64 {
        let [dx, dy] = self.rest;
        let (rx, ry) = (dx + epsilon * e[0], dy + epsilon * e[1]);
        let r = (rx * rx + ry * ry).sqrt();
        let extension = self.stretch(e, epsilon) / (r + self.rest_length);
        0.5 * self.stiffness * extension * extension
    }

    /// Stretch of the spring, `(r^2 - d^2)/eps = 2 d.e + eps e^2`.
    #[inline(always)]
    fn stretch(&self, e: [f64; 2], epsilon: f64) -> f64 {
        2.0 * (self.rest[0] * e[0] + self.rest[1] * e[1]) + epsilon * (e[0] * e[0] + e[1] * e[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_stop_at_free_edges_and_wrap_at_periodic_ones() {
        let lattice = Lattice::with_edges(4, 3, [Edges::Periodic, Edges::Free]);
        assert_eq!(lattice.neighbour(3, 0, [1, 1]), Some(lattice.block(0, 1)));
        assert_eq!(lattice.neighbour(0, 2, [-1, 1]), None);
        assert_eq!(lattice.column_row(lattice.block(3, 1)), (3, 1));
    }

    #[test]
    fn a_spring_is_exact_where_lengths_would_cancel() {
        // At a strain of 1e-9 the direct difference r - d keeps 7 digits; the small-strain limit is known.
        let force = Bond::NORTH_EAST.force([1e-6, 3e-6], 1e-9);
        assert!((force[0] / (K_DIAGONAL * 2e-6) - 1.0).abs() < 1e-14, "{force:?}");
    }

    #[test]
    fn a_large_strain_matches_the_plain_formula() {
        let (e, epsilon): ([f64; 2], f64) = ([0.3, -0.7], 0.2);
        let r = [1.0 + epsilon * e[0], 1.0 + epsilon * e[1]];
        let length = (r[0] * r[0] + r[1] * r[1]).sqrt();
        let tension = K_DIAGONAL * (length - std::f64::consts::SQRT_2) / epsilon / length;
        let force = Bond::NORTH_EAST.force(e, epsilon);
        assert!((force[0] - tension * r[0]).abs() < 1e-14 && (force[1] - tension * r[1]).abs() < 1e-14);
    }
}
