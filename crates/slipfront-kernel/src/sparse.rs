//! Tiles in which few blocks move: vectors of eight blocks are swept one by one, with the same bits as in a
//! sweep of the whole tile.
//!
//! A vector is swept if one of its blocks or a neighbour of one moves, or if one of its blocks may slip. It
//! computes all eight springs of its blocks itself. Sums over the tile are integers, so that they can be
//! updated by differences.

use fearless_simd::{Simd, SimdBase};

use super::aligned::{chunks, chunks_mut};
use super::band::Band;
use super::blocks::{Sums, displacement_sums, friction, spring, times_factor, vector_energy};
use super::layout::{TILE, VECTORS};
use super::quanta::Quanta;
use super::scratch::Scratch;
use super::springs::Geometry;
use super::step::Step;
use super::vector::{Chunks, LANES, Vec2x8, add, load, load_vec2, splat, subtract};
use crate::lattice::Bond;

/// Positions of the bonds in [`Bond::ALL`].
pub(crate) const EAST: usize = 0;
const NORTH: usize = 1;
const NORTH_EAST: usize = 2;
const NORTH_WEST: usize = 3;

impl Band {
    /// The vectors of a settled tile with blocks that may slip at step `number`.
    pub(crate) fn vectors_that_may_slip(&self, t: usize, number: u64) -> u32 {
        let steps = self.active_from_step[self.vectors(t)].iter();
        steps
            .enumerate()
            .fold(0, |mask, (v, &step)| mask | u32::from(step <= number) << v)
    }

    /// Moves the blocks of the moving vectors of a tile (Eq. 8).
    #[inline(always)]
    pub(crate) fn advance_vectors<S: Simd>(&mut self, simd: S, step: Step, quanta: &Quanta, t: usize) {
        let dt = splat(simd, step.move_dt);
        for v in self.vectors(t) {
            if self.moving[v] == 0 {
                continue;
            }
            let k = v * LANES;
            let velocity = load_vec2(simd, chunks(&self.velocity, k, LANES), 0);
            let [x, y] = chunks_mut(&mut self.displacement, self.halo + k, LANES);
            let before = [load(simd, &x[0]), load(simd, &y[0])];
            let after = [before[0] + dt * velocity[0], before[1] + dt * velocity[1]];
            after[0].store_array(&mut x[0]);
            after[1].store_array(&mut y[0]);
            // The old integers are subtracted from the sums and the new ones added: exact, and without
            // reading blocks at rest.
            let blocks = self.blocks[v];
            let [(old, old_square), (new, new_square)] = match &self.variations {
                Some(variations) => {
                    let springs = variations.drive_springs[k..k + LANES].as_chunks().0;
                    let sums = |u| displacement_sums::<S, true>(simd, u, blocks, springs, quanta);
                    [sums(before), sums(after)]
                }
                None => {
                    let sums = |u| displacement_sums::<S, false>(simd, u, blocks, &[], quanta);
                    [sums(before), sums(after)]
                }
            };
            let sums = &mut self.tiles[t].sums;
            for axis in 0..2 {
                sums.displacement[axis] += new[axis] - old[axis];
            }
            sums.displacement_square += new_square - old_square;
        }
    }

    /// Forces and velocities of the active vectors of a settled tile.
    #[inline(always)]
    pub(crate) fn sparse_tile<S: Simd, G: Geometry>(
        &mut self,
        simd: S,
        geometry: G,
        (step, quanta): (&Step, &Quanta),
        t: usize,
        scratch: &mut Scratch,
    ) {
        // With energies at every step, needed or not: a vector may come to rest at any step, and keeps its
        // part of the sum from then on.
        let mut lattice_energy = self.tiles[t].sums.lattice_energy;
        for (place, v) in self.active_vectors(t).enumerate() {
            let energy = self.vector_forces(simd, geometry, quanta, v, (scratch, place * LANES));
            lattice_energy += energy - std::mem::replace(&mut self.lattice_energy[v], energy);
        }
        if G::BLOCKS_DIFFER {
            self.friction_of_vectors::<S, true>(simd, step, quanta, t, scratch);
        } else {
            self.friction_of_vectors::<S, false>(simd, step, quanta, t, scratch);
        }
        self.tiles[t].sums.lattice_energy = lattice_energy;
    }

    /// The vectors of a tile that are swept one by one.
    fn active_vectors(&self, t: usize) -> impl Iterator<Item = usize> + use<> {
        let mut active = self.tasks[t].active;
        std::iter::from_fn(move || {
            let first = active.trailing_zeros();
            active &= active.wrapping_sub(1);
            (first < u32::BITS).then_some(t * VECTORS + first as usize)
        })
    }

    /// Drive, friction and damping (Eqs. 2 and 4-7) in the active vectors of a settled tile, with their
    /// lattice forces in sequence in the scratch array. A separate function, compiled once for all spring
    /// formulas.
    #[inline(never)]
    fn friction_of_vectors<S: Simd, const DIFFER: bool>(
        &mut self,
        simd: S,
        step: &Step,
        quanta: &Quanta,
        t: usize,
        scratch: &mut Scratch,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let task = self.tasks[t];
                let mut sums = Sums::zero(simd);
                for (number, v) in self.active_vectors(t).enumerate() {
                    let (elements, place) = (v * LANES..(v + 1) * LANES, number * LANES);
                    let next = [1, 1 + self.tiles_ahead()].map(|tiles| elements.start + tiles * TILE);
                    let arrays =
                        self.friction_loop::<S, DIFFER>(simd, *step, (elements, next), scratch, place, None);
                    friction::<S, true, DIFFER>(simd, *step, quanta, arrays, &mut sums);
                    let rests = task.touched >> (v % VECTORS) & 1 == 0 && self.moving[v] == 0;
                    self.active_from_step[v] = self.first_active_step(simd, step, v, scratch, place, rests);
                }
                let soonest = self.soonest_active_step(t);
                let tile = &mut self.tiles[t];
                // Skipped vectors rest, and add nothing to sums over velocities; the sums already contain
                // their displacements, since only moves change these sums. Their stress is checked when they
                // are swept again.
                tile.sums = Sums {
                    displacement: tile.sums.displacement,
                    displacement_square: tile.sums.displacement_square,
                    ..sums.totals::<true>(quanta, task.active.count_ones() as usize)
                };
                tile.moving = tile.sums.sliding > 0;
                tile.active_from_step = soonest;
            },
        );
    }

    /// Finds the values for sweeping the vectors of a tile one by one, after a sweep of the whole tile with
    /// its energies. A separate function, compiled once for all spring formulas.
    #[inline(never)]
    pub(crate) fn settle<S: Simd>(&mut self, simd: S, step: &Step, t: usize, scratch: &Scratch) {
        simd.vectorize(
            #[inline(always)]
            || {
                let touched = self.tasks[t].touched;
                for (number, v) in self.vectors(t).enumerate() {
                    let rests = touched >> number & 1 == 0 && self.moving[v] == 0;
                    self.active_from_step[v] =
                        self.first_active_step(simd, step, v, scratch, number * LANES, rests);
                }
                self.tiles[t].active_from_step = self.soonest_active_step(t);
                self.tiles[t].settled = true;
            },
        );
    }

    /// The first step after this one at which a block of vector `v` may slip, or 0 if the vector does not
    /// rest.
    #[inline(always)]
    fn first_active_step<S: Simd>(
        &self,
        simd: S,
        step: &Step,
        v: usize,
        scratch: &Scratch,
        place: usize,
        rests: bool,
    ) -> u64 {
        if !rests {
            return 0;
        }
        let steps = self.steps_until_slip(simd, *step, v, scratch, place);
        // Valid only up to the next change of speed.
        step.number.saturating_add(steps.max(1)).min(step.next_change)
    }

    fn soonest_active_step(&self, t: usize) -> u64 {
        let steps = self.active_from_step[self.vectors(t)].iter().copied();
        steps.min().unwrap_or(u64::MAX)
    }

    /// Displacements of the eight elements from `first` on, counted from the front halo.
    #[inline(always)]
    pub(crate) fn displacement_at<S: Simd>(&self, simd: S, first: usize) -> Vec2x8<S> {
        load_vec2(simd, chunks(&self.displacement, first, LANES), 0)
    }

    /// Force of the springs along `bond` of the eight elements from `first` on, with their other ends from
    /// `there` on.
    #[inline(always)]
    pub(crate) fn springs_between<S: Simd, G: Geometry>(
        &self,
        simd: S,
        geometry: G,
        bond: usize,
        (present, there): (u8, usize),
        first: usize,
    ) -> Vec2x8<S> {
        let (here, there) = (
            self.displacement_at(simd, first),
            self.displacement_at(simd, there),
        );
        let force = spring(simd, geometry, &Bond::ALL[bond], present, here, there);
        times_factor::<S, G>(simd, force, self.spring_factors::<G>(bond, first, LANES), 0)
    }

    /// Factors of the springs of vector `v` to the east, north, north-east and north-west.
    #[inline(always)]
    pub(crate) fn factors_of<G: Geometry>(&self, v: usize) -> [Chunks<'_>; 4] {
        [0, 1, 2, 3].map(|bond| self.spring_factors::<G>(bond, self.halo + v * LANES, LANES))
    }

    /// Computes the lattice forces (Eq. 3) on eight blocks, into a place in the scratch array; returns the
    /// energy of their springs.
    #[inline(always)]
    fn vector_forces<S: Simd, G: Geometry>(
        &self,
        simd: S,
        geometry: G,
        quanta: &Quanta,
        v: usize,
        (scratch, place): (&mut Scratch, usize),
    ) -> i64 {
        let here = self.halo + v * LANES;
        let [east, north, north_east, north_west] = self.springs_of(v);
        let own = [
            self.springs_between(simd, geometry, EAST, east, here),
            self.springs_between(simd, geometry, NORTH, north, here),
            self.springs_between(simd, geometry, NORTH_EAST, north_east, here),
            self.springs_between(simd, geometry, NORTH_WEST, north_west, here),
        ];
        let below = here - self.stride;
        let [east, north, north_east, north_west] = &self.masks;
        // The springs from below and from the west belong to other vectors, at places that are no whole
        // vectors. They are computed again here, since skipped neighbours have stored none.
        let (west, south) = (bits_from(east, here - 1), bits_from(north, below));
        let (south_west, south_east) = (bits_from(north_east, below - 1), bits_from(north_west, below + 1));
        let west = self.springs_between(simd, geometry, EAST, (west, here), here - 1);
        let south = self.springs_between(simd, geometry, NORTH, (south, here), below);
        let south_west = self.springs_between(simd, geometry, NORTH_EAST, (south_west, here), below - 1);
        let south_east = self.springs_between(simd, geometry, NORTH_WEST, (south_east, here), below + 1);
        let [east, north, north_east, north_west] = own;
        // In the order of [`lattice_forces`](super::blocks::lattice_forces), for the same bits.
        let [x, y] = add(
            add(subtract(east, west), subtract(north, south)),
            add(subtract(north_east, south_west), subtract(north_west, south_east)),
        );
        let [fx, fy] = chunks_mut(&mut scratch.lattice, place, LANES);
        x.store_array(&mut fx[0]);
        y.store_array(&mut fy[0]);
        let (factors, quantum) = (self.factors_of::<G>(v), quanta.lattice_energy);
        vector_energy::<S, G>(simd, own, self.blocks[v], factors, quantum)
    }
}

/// Bits of a mask for the eight elements from `element` on.
#[inline(always)]
fn bits_from(mask: &[u8], element: usize) -> u8 {
    let v = element / LANES;
    let next = mask.get(v + 1).copied().unwrap_or(0);
    (u16::from_le_bytes([mask[v], next]) >> (element % LANES)) as u8
}
