//! One step of consecutive elements, eight at a time: springs (Eq. 3), then drive, friction and damping (Eqs.
//! 2, 4-7).
//!
//! Each of these is a separate loop: processors overlap more iterations of short loops than of a long one.

use fearless_simd::{Bytes, Simd, SimdBase, SimdFloat, f64x8, i64x8};

use super::aligned::CacheLines;
use super::pull::{pull, pull_of_differing};
use super::quanta::Quanta;
use super::springs::Geometry;
use super::step::Step;
use super::variations::Variation;
use super::vector::{
    Chunks, ChunksMut, LANES, Vec2x8, add, bits, dot, is_zero, lane_max, lane_sum, load, load_vec2, mask,
    or_zero, or_zero_below, scale, select, shift_in, splat, square, subtract,
};
use crate::communicator::Communicator;
use crate::fixed_point::{FixedPoint, join, split};
use crate::integrator::SMALLEST_VELOCITY;
use crate::lattice::{Bond, K_DIAGONAL, K_STRAIGHT};

/// x and y of a quantity of the springs to the next row: north, north-east and north-west.
pub(crate) type Upward<T> = [[T; 2]; 3];

/// Input of [`lattice_forces`], and the arrays in which the sums are stored.
pub(crate) struct LatticeLoop<'a> {
    pub(crate) here: [Chunks<'a>; 2],
    pub(crate) east: [Chunks<'a>; 2],
    pub(crate) has_east: &'a [u8],
    /// Factors of the springs to the east, for a heterogeneous slider.
    pub(crate) to_east: Chunks<'a>,
    /// Upward springs of these blocks.
    pub(crate) own: Upward<Chunks<'a>>,
    /// Upward springs of the blocks to the south, south-west and south-east.
    pub(crate) behind: Upward<Chunks<'a>>,
    /// Lattice forces `F_c`.
    pub(crate) force: [ChunksMut<'a>; 2],
}

/// Force of the spring along `bond` of eight blocks, zero where it is not `present`.
#[inline(always)]
pub(crate) fn spring<S: Simd, G: Geometry>(
    simd: S,
    geometry: G,
    bond: &Bond,
    present: u8,
    here: Vec2x8<S>,
    there: Vec2x8<S>,
) -> Vec2x8<S> {
    zero_missing(simd, present, geometry.force(simd, bond, subtract(there, here)))
}

/// Forces of springs times the factor of each, for a heterogeneous slider.
#[inline(always)]
pub(crate) fn times_factor<S: Simd, G: Geometry>(
    simd: S,
    force: Vec2x8<S>,
    factors: Chunks,
    chunk: usize,
) -> Vec2x8<S> {
    if G::BLOCKS_DIFFER {
        scale(load(simd, &factors[chunk]), force)
    } else {
        force
    }
}

/// Sets the lanes to zero where a bit of `present` is 0.
#[inline(always)]
pub(crate) fn zero_missing<S: Simd>(simd: S, present: u8, a: Vec2x8<S>) -> Vec2x8<S> {
    or_else(simd, present, a, [splat(simd, 0.0); 2])
}

/// Takes `other` in the lanes where a bit of `present` is 0. Such bits are rare, so that without AVX-512
/// testing for them is cheaper than masking.
#[inline(always)]
pub(crate) fn or_else<S: Simd>(simd: S, present: u8, a: Vec2x8<S>, other: Vec2x8<S>) -> Vec2x8<S> {
    if present == u8::MAX {
        a
    } else {
        select(mask(simd, present), a, other)
    }
}

/// Eq. 3: the springs to the next row, each computed once for the blocks at its two ends, from the
/// displacements of the blocks and of their neighbours along the three bonds. `force` is the force on the
/// lower blocks; masks mark the springs that exist.
#[inline(always)]
pub(crate) fn upward_springs<S: Simd, G: Geometry>(
    simd: S,
    geometry: G,
    here: [Chunks; 2],
    there: Upward<Chunks>,
    (masks, factors): ([&[u8]; 3], [Chunks; 3]),
    force: Upward<ChunksMut>,
) {
    // Gives all slices one length, so that the loop below needs no bounds checks.
    let [[nx, ny], [nex, ney], [nwx, nwy]] = force;
    let n = nx.len();
    let (ny, nex, ney) = (&mut ny[..n], &mut nex[..n], &mut ney[..n]);
    let (nwx, nwy) = (&mut nwx[..n], &mut nwy[..n]);
    let here = first_n(here, n);
    let [north, north_east, north_west] = there;
    let (north, north_east, north_west) = (first_n(north, n), first_n(north_east, n), first_n(north_west, n));
    let [has_north, has_north_east, has_north_west] = masks;
    let (has_north, has_north_east) = (&has_north[..n], &has_north_east[..n]);
    let has_north_west = &has_north_west[..n];
    let factors_end = if G::BLOCKS_DIFFER { n } else { 0 };
    let [to_north, to_north_east, to_north_west] = factors;
    let (to_north, to_north_east) = (&to_north[..factors_end], &to_north_east[..factors_end]);
    let to_north_west = &to_north_west[..factors_end];
    for c in 0..n {
        let u = load_vec2(simd, here, c);
        let there = load_vec2(simd, north, c);
        let force = spring(simd, geometry, &Bond::NORTH, has_north[c], u, there);
        let [x, y] = times_factor::<S, G>(simd, force, to_north, c);
        x.store_array(&mut nx[c]);
        y.store_array(&mut ny[c]);
        let there = load_vec2(simd, north_east, c);
        let force = spring(simd, geometry, &Bond::NORTH_EAST, has_north_east[c], u, there);
        let [x, y] = times_factor::<S, G>(simd, force, to_north_east, c);
        x.store_array(&mut nex[c]);
        y.store_array(&mut ney[c]);
        let there = load_vec2(simd, north_west, c);
        let force = spring(simd, geometry, &Bond::NORTH_WEST, has_north_west[c], u, there);
        let [x, y] = times_factor::<S, G>(simd, force, to_north_west, c);
        x.store_array(&mut nwx[c]);
        y.store_array(&mut nwy[c]);
    }
}

/// Eq. 3: the sum of all eight springs of every block. Opposite neighbours are paired, straight ones before
/// diagonal ones, so that the trajectory of a rotated or mirrored problem is the rotated or mirrored
/// trajectory, with the same bits.
///
/// `west`: forces of the springs to the east of the eight elements before these; replaced by those of the
/// last eight elements.
#[inline(always)]
pub(crate) fn lattice_forces<S: Simd, G: Geometry>(
    simd: S,
    geometry: G,
    arrays: LatticeLoop,
    west: &mut Vec2x8<S>,
) {
    let [fx, fy] = arrays.force;
    let n = fx.len();
    let fy = &mut fy[..n];
    let (here, there) = (first_n(arrays.here, n), first_n(arrays.east, n));
    let [north, north_east, north_west] = arrays.own;
    let (north, north_east, north_west) = (first_n(north, n), first_n(north_east, n), first_n(north_west, n));
    let [south, south_west, south_east] = arrays.behind;
    let (south, south_west, south_east) = (first_n(south, n), first_n(south_west, n), first_n(south_east, n));
    let has_east = &arrays.has_east[..n];
    let to_east = &arrays.to_east[..if G::BLOCKS_DIFFER { n } else { 0 }];
    // The spring to the west of a block is the spring to the east of its neighbour: from the last of the
    // eight elements before and the first seven of these, which are in registers.
    let mut before = *west;
    for c in 0..n {
        let u = load_vec2(simd, here, c);
        let v = load_vec2(simd, there, c);
        let east = spring(simd, geometry, &Bond::EAST, has_east[c], u, v);
        let east = times_factor::<S, G>(simd, east, to_east, c);
        let west = shift_in(before, east);
        before = east;
        let north = load_vec2(simd, north, c);
        let north_east = load_vec2(simd, north_east, c);
        let north_west = load_vec2(simd, north_west, c);
        let [x, y] = add(
            add(subtract(east, west), subtract(north, load_vec2(simd, south, c))),
            add(
                subtract(north_east, load_vec2(simd, south_west, c)),
                subtract(north_west, load_vec2(simd, south_east, c)),
            ),
        );
        x.store_array(&mut fx[c]);
        y.store_array(&mut fy[c]);
    }
    *west = before;
}

/// Squared forces of the springs of eight blocks to the east, north, north-east and north-west, over the
/// factors of springs that may differ.
#[inline(always)]
fn squares_over_factors<S: Simd, G: Geometry>(
    simd: S,
    [east, north, north_east, north_west]: [Vec2x8<S>; 4],
    factors: [Chunks; 4],
) -> [f64x8<S>; 4] {
    let squares = [
        square(east),
        square(north),
        square(north_east),
        square(north_west),
    ];
    if !G::BLOCKS_DIFFER {
        return squares;
    }
    // A missing spring has force 0 and factor 0.
    let least = splat(simd, f64::MIN_POSITIVE);
    let over = |k: usize| squares[k] / load(simd, &factors[k][0]).max(least);
    [over(0), over(1), over(2), over(3)]
}

/// Sum of the energies times `2 k_1` of a vector's springs to the east, north, north-east and north-west, in
/// quanta of [`Sums`], from their forces.
#[inline(always)]
pub(crate) fn vector_energy<S: Simd, G: Geometry>(
    simd: S,
    springs: [Vec2x8<S>; 4],
    blocks: u8,
    factors: [Chunks; 4],
    quantum: FixedPoint,
) -> i64 {
    let [east, north, north_east, north_west] = squares_over_factors::<S, G>(simd, springs, factors);
    // (k/2) extension^2 = F^2/(2k).
    let energies = (east + north) + splat(simd, K_STRAIGHT / K_DIAGONAL) * (north_east + north_west);
    let energies = zero_missing(simd, blocks, [energies, energies])[0];
    integer_sum(integers(energies, splat(simd, quantum.shift())), quantum, 1)
}

/// Contribution of eight blocks to the sums of `w (u - c)` and `w (u - c)^2`.
#[inline(always)]
pub(crate) fn displacement_sums<S: Simd, const DIFFER: bool>(
    simd: S,
    u: Vec2x8<S>,
    blocks: u8,
    drive_springs: Chunks,
    quanta: &Quanta,
) -> ([i64; 2], i64) {
    let shifts = Shifts::new(simd, quanta);
    // Elements that are no blocks are set to the centre of the window, and add nothing.
    let u = or_else(simd, blocks, u, shifts.centres);
    let mut sums = Sums::zero(simd);
    sums.add_displacement::<DIFFER>(simd, &shifts, u, drive_springs, 0);
    sums.add_stretch::<DIFFER>(simd, quanta, &shifts, u, drive_springs, 0);
    let sums = sums.totals::<true>(quanta, 1);
    (sums.displacement, sums.displacement_square)
}

#[inline(always)]
fn first_n([x, y]: [Chunks<'_>; 2], n: usize) -> [Chunks<'_>; 2] {
    [&x[..n], &y[..n]]
}

/// Input and output of [`friction`].
pub(crate) struct FrictionLoop<'a> {
    pub(crate) displacement: [Chunks<'a>; 2],
    pub(crate) lattice: [Chunks<'a>; 2],
    /// Squares of the static thresholds `mu_s F_n`.
    pub(crate) static_limit_squares: Chunks<'a>,
    /// Change of velocity by kinetic friction in a step, `q = dt mu_k F_n/(m c+)`.
    pub(crate) kinetic_impulses: Chunks<'a>,
    /// Mask of the elements that are blocks.
    pub(crate) blocks: &'a [u8],
    /// Mask of the elements that are blocks in contact.
    pub(crate) in_contact: &'a [u8],
    /// Velocities at `t - dt/2`, then at `t + dt/2`.
    pub(crate) velocity: [ChunksMut<'a>; 2],
    /// Mask of the blocks that move after the step.
    pub(crate) moving: &'a mut [u8],
    /// Mask of the blocks in contact that have ever slid.
    pub(crate) slipped: &'a mut [u8],
    /// The step at which each block in contact first slid.
    pub(crate) first_slip: &'a mut [[u32; LANES]],
    /// Drive forces `F_s`, computed by [`free_motion`].
    pub(crate) drive: [ChunksMut<'a>; 2],
    /// Velocities that the blocks would have without friction, computed by [`free_motion`].
    pub(crate) free: [ChunksMut<'a>; 2],
    /// Magnitude of the velocity without friction, computed by [`free_motion`].
    pub(crate) free_speed: ChunksMut<'a>,
    /// Memory of later tiles, to be fetched ahead.
    pub(crate) prefetched: [CacheLines; 6],
    /// Drive springs and masses of a heterogeneous slider.
    pub(crate) variation: Variation<'a>,
}

/// Eight blocks that do not rest, in a step with known next velocities.
pub(crate) struct Moved<S: Simd> {
    /// Mask of the elements that are blocks.
    pub(crate) blocks: u8,
    pub(crate) displacement: Vec2x8<S>,
    /// Velocities at `t - dt/2`.
    pub(crate) before: Vec2x8<S>,
    /// Velocities at `t + dt/2`, 0 for elements that are no blocks.
    pub(crate) after: Vec2x8<S>,
    /// Minus the friction force.
    pub(crate) against: Vec2x8<S>,
    /// Contact stress (Eq. 10), with any sign; 0 where there is no contact.
    pub(crate) stress: Vec2x8<S>,
}

/// Sums over the blocks of a tile, as integers of type `I` in their [`Quanta`], and maxima. While the tile is
/// swept, both are one number for each of eight lanes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums<I, M, N = u32> {
    /// Sum of weighted displacements, `sum w (u - c)`, with the relative stiffness w of the drive springs and
    /// the centre c of the window.
    pub displacement: [I; 2],
    /// Sum of weighted velocities, `sum w v(t + dt/2)`.
    pub velocity: [I; 2],
    /// Four times `sum m v^2` at t_n, with v the mean of the half steps:
    /// `sum m (v(t - dt/2) + v(t + dt/2))^2`.
    pub motion_square: I,
    /// Twice the power dissipated by friction at t_n, `sum -F_f . (v(t - dt/2) + v(t + dt/2))`.
    pub friction_work: I,
    /// Energy of the springs times `2 k_1`, at steps at which energies are needed. Summed by vectors, not in
    /// lanes.
    pub lattice_energy: I,
    /// Sum for the kinetic energy, `sum m (v(t - dt/2)^2 + v(t + dt/2)^2)`, at steps at which energies are
    /// needed.
    pub velocity_squares: I,
    /// Sum for the energy of the drive springs, `sum w (u - c)^2`, at steps at which energies are needed.
    pub displacement_square: I,
    /// Largest `tau_c^2` of a block in contact.
    pub stress_square: M,
    /// Square of the highest speed.
    pub speed_square: M,
    /// Number of blocks that slide.
    pub sliding: N,
    /// Number of sliding blocks that are in contact.
    pub slipping: N,
}

/// Constants that [`integers`] adds for the sums of every step, and the centres of the displacements, for
/// each of eight lanes.
#[derive(Clone, Copy)]
pub(crate) struct Shifts<S: Simd> {
    pub(crate) centres: Vec2x8<S>,
    displacement: Vec2x8<S>,
    weighted_displacement: Vec2x8<S>,
    velocity: f64x8<S>,
    pub(crate) motion_square: f64x8<S>,
    friction_work: f64x8<S>,
}

impl<S: Simd> Shifts<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, quanta: &Quanta) -> Self {
        let [x, y] = quanta.displacement;
        let [weighted_x, weighted_y] = quanta.weighted_displacement;
        Self {
            centres: [splat(simd, x.centre()), splat(simd, y.centre())],
            displacement: [splat(simd, x.shift()), splat(simd, y.shift())],
            weighted_displacement: [splat(simd, weighted_x.shift()), splat(simd, weighted_y.shift())],
            velocity: splat(simd, quanta.velocity.shift()),
            motion_square: splat(simd, quanta.motion_square.shift()),
            friction_work: splat(simd, quanta.friction_work.shift()),
        }
    }
}

impl<S: Simd> Sums<i64x8<S>, f64x8<S>> {
    #[inline(always)]
    pub(crate) fn zero(simd: S) -> Self {
        let (zero, none) = (i64x8::splat(simd, 0), splat(simd, 0.0));
        Self {
            displacement: [zero; 2],
            velocity: [zero; 2],
            motion_square: zero,
            friction_work: zero,
            lattice_energy: zero,
            velocity_squares: zero,
            displacement_square: zero,
            stress_square: none,
            speed_square: none,
            sliding: 0,
            slipping: 0,
        }
    }

    /// Adds the contribution of eight blocks to the sum of `w (u - c)`.
    #[inline(always)]
    pub(crate) fn add_displacement<const DIFFER: bool>(
        &mut self,
        simd: S,
        shifts: &Shifts<S>,
        displacement: Vec2x8<S>,
        drive_springs: Chunks,
        chunk: usize,
    ) {
        let [ux, uy] = &mut self.displacement;
        if DIFFER {
            let w = load(simd, &drive_springs[chunk]);
            let differences = subtract(displacement, shifts.centres);
            *ux += integers(w * differences[0], shifts.weighted_displacement[0]);
            *uy += integers(w * differences[1], shifts.weighted_displacement[1]);
        } else {
            *ux += integers(displacement[0], shifts.displacement[0]);
            *uy += integers(displacement[1], shifts.displacement[1]);
        }
    }

    /// Adds the contribution of eight blocks to the sum of `w v(t + dt/2)`.
    #[inline(always)]
    pub(crate) fn add_velocity<const DIFFER: bool>(
        &mut self,
        simd: S,
        shifts: &Shifts<S>,
        velocity: Vec2x8<S>,
        drive_springs: Chunks,
        chunk: usize,
    ) {
        let [vx, vy] = &mut self.velocity;
        let [x, y] = velocity.map(|v| weighted::<S, DIFFER>(simd, v, drive_springs, chunk));
        *vx += integers(x, shifts.velocity);
        *vy += integers(y, shifts.velocity);
    }

    /// Adds the contribution of eight blocks to the sum of `w (u - c)^2`.
    #[inline(always)]
    pub(crate) fn add_stretch<const DIFFER: bool>(
        &mut self,
        simd: S,
        quanta: &Quanta,
        shifts: &Shifts<S>,
        displacement: Vec2x8<S>,
        drive_springs: Chunks,
        chunk: usize,
    ) {
        let stretch = square(subtract(displacement, shifts.centres));
        let stretch = weighted::<S, DIFFER>(simd, stretch, drive_springs, chunk);
        let shift = splat(simd, quanta.displacement_square.shift());
        self.displacement_square += integers(stretch, shift);
    }

    /// Adds eight blocks that do not rest to the sums of every step and to the maxima; `c`: their place in
    /// `variation`.
    #[inline(always)]
    pub(crate) fn add_moved<const ENERGY: bool, const DIFFER: bool>(
        &mut self,
        simd: S,
        quanta: &Quanta,
        shifts: &Shifts<S>,
        moved: &Moved<S>,
        (variation, c): (Variation, usize),
    ) {
        let &Moved {
            blocks,
            displacement,
            before,
            after,
            against,
            stress,
        } = moved;
        // Ghosts have velocities too, but only their blocks count.
        let both = zero_missing(simd, blocks, add(before, after));
        let displacement = or_else(simd, blocks, displacement, shifts.centres);
        let motion_square = weighted::<S, DIFFER>(simd, square(both), variation.mass, c);
        self.add_displacement::<DIFFER>(simd, shifts, displacement, variation.drive_springs, c);
        self.add_velocity::<DIFFER>(simd, shifts, after, variation.drive_springs, c);
        self.motion_square += integers(motion_square, shifts.motion_square);
        self.friction_work += integers(dot(against, both), shifts.friction_work);
        self.speed_square = self.speed_square.max(square(after));
        self.stress_square = self.stress_square.max(square(stress));
        if ENERGY {
            let motion = square(before) + square(after);
            let motion = weighted::<S, DIFFER>(simd, motion, variation.mass, c);
            let motion = zero_missing(simd, blocks, [motion, splat(simd, 0.0)])[0];
            self.velocity_squares += integers(motion, shifts.motion_square);
            self.add_stretch::<DIFFER>(simd, quanta, shifts, displacement, variation.drive_springs, c);
        }
    }

    /// Adds the zeros that `vectors` vectors at rest contribute to the sums over moving blocks.
    #[inline(always)]
    fn add_zeros<const ENERGY: bool>(&mut self, simd: S, quanta: &Quanta, vectors: i64) {
        // A term is the bits of a shift plus a multiple, and [`totals`](Self::totals) subtracts the shift of
        // every vector, including those that are skipped here.
        let zeros =
            |quantum: FixedPoint| i64x8::splat(simd, vectors.wrapping_mul(quantum.shift().to_bits() as i64));
        self.velocity[0] += zeros(quanta.velocity);
        self.velocity[1] += zeros(quanta.velocity);
        self.motion_square += zeros(quanta.motion_square);
        self.friction_work += zeros(quanta.friction_work);
        if ENERGY {
            self.velocity_squares += zeros(quanta.motion_square);
        }
    }

    /// Sums over all lanes after `vectors` vectors.
    #[inline(always)]
    pub(crate) fn totals<const ENERGY: bool>(&self, quanta: &Quanta, vectors: usize) -> Sums<i64, f64> {
        let [x, y] = quanta.weighted_displacement;
        let mut sums = Sums {
            displacement: [
                integer_sum(self.displacement[0], x, vectors),
                integer_sum(self.displacement[1], y, vectors),
            ],
            velocity: [
                integer_sum(self.velocity[0], quanta.velocity, vectors),
                integer_sum(self.velocity[1], quanta.velocity, vectors),
            ],
            motion_square: integer_sum(self.motion_square, quanta.motion_square, vectors),
            friction_work: integer_sum(self.friction_work, quanta.friction_work, vectors),
            lattice_energy: 0,
            velocity_squares: 0,
            displacement_square: 0,
            stress_square: lane_max(self.stress_square),
            speed_square: lane_max(self.speed_square),
            sliding: self.sliding,
            slipping: self.slipping,
        };
        if ENERGY {
            sums.velocity_squares = integer_sum(self.velocity_squares, quanta.motion_square, vectors);
            sums.displacement_square =
                integer_sum(self.displacement_square, quanta.displacement_square, vectors);
        }
        sums
    }
}

impl Sums<i128, f64, u64> {
    /// Adds the sums of a tile or a band.
    pub fn include<I: Copy + Into<i128>, N: Copy + Into<u64>>(&mut self, part: &Sums<I, f64, N>) {
        for axis in 0..2 {
            self.displacement[axis] += part.displacement[axis].into();
            self.velocity[axis] += part.velocity[axis].into();
        }
        self.motion_square += part.motion_square.into();
        self.friction_work += part.friction_work.into();
        self.lattice_energy += part.lattice_energy.into();
        self.velocity_squares += part.velocity_squares.into();
        self.displacement_square += part.displacement_square.into();
        self.stress_square = self.stress_square.max(part.stress_square);
        self.speed_square = self.speed_square.max(part.speed_square);
        self.sliding += part.sliding.into();
        self.slipping += part.slipping.into();
    }

    /// Adds the sums of all ranks, and lowers `step` to the earliest step of any rank.
    pub fn over_ranks(&mut self, step: &mut u64, communicator: &dyn Communicator) {
        let [ux, uy] = &mut self.displacement;
        let [vx, vy] = &mut self.velocity;
        let mut sums = [
            ux,
            uy,
            vx,
            vy,
            &mut self.motion_square,
            &mut self.friction_work,
            &mut self.lattice_energy,
            &mut self.velocity_squares,
            &mut self.displacement_square,
        ];
        // All in one message, since ranks wait for each other at every message.
        let mut words = [[0; 2]; 10];
        for (words, sum) in words.iter_mut().zip(&sums) {
            *words = split(**sum);
        }
        words[9] = [self.sliding as i64, self.slipping as i64];
        communicator.sum(words.as_flattened_mut());
        for (sum, words) in sums.iter_mut().zip(words) {
            **sum = join(words);
        }
        [self.sliding, self.slipping] = words[9].map(|count| count as u64);
        // The earliest step is minus the maximum of the negated steps, so that it is found with the other
        // maxima. No run has steps beyond 2^53.
        let mut largest = [self.stress_square, self.speed_square, -(*step as f64)];
        communicator.largest(&mut largest);
        [self.stress_square, self.speed_square, _] = largest;
        *step = -largest[2] as u64;
    }
}

/// The multiples of a quantum nearest to eight numbers, plus the bits of `shift`: see [`FixedPoint::shift`].
#[inline(always)]
fn integers<S: Simd>(numbers: f64x8<S>, shift: f64x8<S>) -> i64x8<S> {
    (numbers + shift).bitcast()
}

/// Sum of the multiples of a quantum in the [`integers`] of `vectors` vectors.
#[inline(always)]
fn integer_sum<S: Simd>(lanes: i64x8<S>, quantum: FixedPoint, vectors: usize) -> i64 {
    let added = ((vectors * LANES) as i64).wrapping_mul(quantum.shift().to_bits() as i64);
    lane_sum(lanes).wrapping_sub(added)
}

/// Whether all eight blocks stand still and stick.
#[inline(always)]
fn rest<S: Simd>(
    simd: S,
    moving: u8,
    velocity: Vec2x8<S>,
    force: Vec2x8<S>,
    static_limit_squares: &[f64; LANES],
) -> bool {
    // Comparing squares avoids the square root of a magnitude. Where all eight blocks are stuck, this test
    // also avoids the root and the division below. Ghosts have the velocity of their blocks, and do not count
    // as moving.
    moving == 0
        && bits(
            simd,
            is_zero(simd, velocity) & square(force).simd_le(load(simd, static_limit_squares)),
        ) == u8::MAX
}

/// First part of the friction law: drive (Eq. 2), damping (Eq. 5), and the velocity without friction, for
/// vectors that do not [`rest`].
#[inline(always)]
fn free_motion<S: Simd, const DIFFER: bool, const HAS_LOADS: bool>(
    simd: S,
    step: Step,
    arrays: &mut FrictionLoop,
) {
    let n = arrays.free_speed.len();
    let (u, lattice) = (first_n(arrays.displacement, n), first_n(arrays.lattice, n));
    let velocity = [&arrays.velocity[0][..n], &arrays.velocity[1][..n]];
    let static_limit_squares = &arrays.static_limit_squares[..n];
    let moving = &arrays.moving[..n];
    let [dx, dy] = &mut arrays.drive;
    let [fx, fy] = &mut arrays.free;
    let (dx, dy, fx, fy) = (&mut dx[..n], &mut dy[..n], &mut fx[..n], &mut fy[..n]);
    let free_speed = &mut arrays.free_speed[..n];
    let variation = arrays.variation.first::<DIFFER>(n);
    for c in 0..n {
        let u = load_vec2(simd, u, c);
        let drive = if DIFFER {
            let loads = HAS_LOADS.then(|| load(simd, &variation.loads[c]));
            pull_of_differing(simd, step, load(simd, &variation.drive_springs[c]), loads, u)
        } else {
            pull(simd, step, u)
        };
        let mut force_to_velocity = splat(simd, step.integrator.force_to_velocity);
        let before = load_vec2(simd, velocity, c);
        if DIFFER {
            force_to_velocity *= load(simd, &variation.inverse_mass[c]);
        }
        let force = add(drive, load_vec2(simd, lattice, c));
        let free = add(
            scale(splat(simd, step.integrator.velocity_decay), before),
            scale(force_to_velocity, force),
        );
        drive[0].store_array(&mut dx[c]);
        drive[1].store_array(&mut dy[c]);
        if rest(simd, moving[c], before, force, &static_limit_squares[c]) {
            continue;
        }
        let free = or_zero_below(simd, SMALLEST_VELOCITY, free);
        let speed = square(free).sqrt();
        free[0].store_array(&mut fx[c]);
        free[1].store_array(&mut fy[c]);
        speed.store_array(&mut free_speed[c]);
    }
}

/// Eqs. 2 and 4-7 by Moreau's time-stepping: the operations of [`crate::friction::Projection`], eight blocks
/// at a time, and all sums that observers need at every step.
#[inline(always)]
pub(crate) fn friction<S: Simd, const ENERGY: bool, const DIFFER: bool>(
    simd: S,
    step: Step,
    quanta: &Quanta,
    mut arrays: FrictionLoop,
    sums: &mut Sums<i64x8<S>, f64x8<S>>,
) {
    if DIFFER && !arrays.variation.loads.is_empty() {
        free_motion::<S, DIFFER, true>(simd, step, &mut arrays);
    } else {
        free_motion::<S, DIFFER, false>(simd, step, &mut arrays);
    }
    let [vx, vy] = arrays.velocity;
    let n = vx.len();
    let vy = &mut vy[..n];
    let (u, lattice_force) = (first_n(arrays.displacement, n), first_n(arrays.lattice, n));
    let [dx, dy] = arrays.drive;
    let [fx, fy] = arrays.free;
    let (drive_force, free_velocity) = ([&dx[..n], &dy[..n]], [&fx[..n], &fy[..n]]);
    let free_speed = &arrays.free_speed[..n];
    let kinetic_impulses = &arrays.kinetic_impulses[..n];
    let static_limit_squares = &arrays.static_limit_squares[..n];
    let (blocks, in_contact) = (&arrays.blocks[..n], &arrays.in_contact[..n]);
    let (moving, slipped) = (&mut arrays.moving[..n], &mut arrays.slipped[..n]);
    let first_slip = &mut arrays.first_slip[..n];
    let zero = splat(simd, 0.0);
    let shifts = Shifts::new(simd, quanta);
    let variation = arrays.variation.first::<DIFFER>(n);
    let mut resting = 0;
    for c in 0..n {
        for lines in arrays.prefetched {
            lines.prefetch(c);
        }
        let lattice = load_vec2(simd, lattice_force, c);
        let drive = load_vec2(simd, drive_force, c);
        let before = [load(simd, &vx[c]), load(simd, &vy[c])];

        let force = add(drive, lattice);
        if rest(simd, moving[c], before, force, &static_limit_squares[c]) {
            let displacement = or_else(simd, blocks[c], load_vec2(simd, u, c), shifts.centres);
            sums.add_displacement::<DIFFER>(simd, &shifts, displacement, variation.drive_springs, c);
            let stress = zero_missing(simd, in_contact[c], drive);
            sums.stress_square = sums.stress_square.max(square(stress));
            if ENERGY {
                sums.add_stretch::<DIFFER>(simd, quanta, &shifts, displacement, variation.drive_springs, c);
            }
            // Velocities, power and motion are zero: all these zeros are added to their sums at once at the
            // end.
            resting += 1;
            continue;
        }
        let free = load_vec2(simd, free_velocity, c);
        // Friction removes this share of the free velocity. From 1 on it stops the block instead of reversing
        // it. The share is infinite for elements that are no blocks, and NaN from 0/0, which compares as no
        // motion.
        let removed_fraction = load(simd, &kinetic_impulses[c]) / load(simd, &free_speed[c]);
        let sticks = is_zero(simd, before) & square(force).simd_le(load(simd, &static_limit_squares[c]));
        let remaining = splat(simd, 1.0) - removed_fraction;
        let slides = !sticks & remaining.simd_gt(zero);
        let sliding = bits(simd, slides);
        moving[c] = sliding;
        let slips = sliding & in_contact[c];
        sums.sliding += sliding.count_ones();
        sums.slipping += slips.count_ones();
        let after = or_zero(simd, slides, scale(remaining, free));
        after[0].store_array(&mut vx[c]);
        after[1].store_array(&mut vy[c]);

        // Minus the friction force: kinetic friction of a sliding block, else the sum of the other forces.
        let velocity_to_force = splat(simd, step.integrator.velocity_to_force);
        let velocity_to_force = weighted::<S, DIFFER>(simd, velocity_to_force, variation.mass, c);
        let kinetic = scale(removed_fraction * velocity_to_force, free);
        let against = select(slides, kinetic, force);
        let moved = Moved {
            blocks: blocks[c],
            displacement: load_vec2(simd, u, c),
            before,
            after,
            against,
            // Eq. 10; for a stuck block F_f + F_c = -F_s to the last bit.
            stress: zero_missing(
                simd,
                in_contact[c],
                select(slides, subtract(lattice, kinetic), drive),
            ),
        };
        sums.add_moved::<ENERGY, DIFFER>(simd, quanta, &shifts, &moved, (variation, c));
        mark_first_slips(slips, &mut slipped[c], &mut first_slip[c], step.number as u32);
    }
    sums.add_zeros::<ENERGY>(simd, quanta, resting);
}

/// Values of eight blocks, times the weight of each block for a heterogeneous slider.
#[inline(always)]
fn weighted<S: Simd, const DIFFER: bool>(
    simd: S,
    numbers: f64x8<S>,
    weights: Chunks,
    chunk: usize,
) -> f64x8<S> {
    if DIFFER {
        load(simd, &weights[chunk]) * numbers
    } else {
        numbers
    }
}

/// Records the step for those of eight blocks that slip for the first time.
#[inline(always)]
pub(crate) fn mark_first_slips(slips: u8, slipped: &mut u8, first_slip: &mut [u32; LANES], number: u32) {
    let new = slips & !*slipped;
    // Rarely true: at most once per block in a run.
    if new != 0 {
        *slipped |= new;
        for (lane, step) in first_slip.iter_mut().enumerate() {
            if new >> lane & 1 == 1 {
                *step = number;
            }
        }
    }
}
