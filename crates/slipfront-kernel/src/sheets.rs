//! The motion of the sheets above the lowest one.
//!
//! A sheet is stored in the same way as the lowest one, with its blocks at the same elements, and its springs
//! are computed by the same loops. In place of friction it has the [pull](pull_from_above) of the sheets
//! above and below. Its tile is advanced together with the tile of the lowest sheet, while both are in the
//! cache.
//!
//! No vector of a stack is left out of a sweep, even if skipping is enabled. In a single sheet, a stuck block
//! with nothing moving around it is loaded by the drive alone, so that the step at which it slips is known.
//! In a stack the drive moves the highest sheet in every step, and this sheet changes the force on every
//! block below. While the drive stands still, the sheets above keep oscillating.

use std::ops::Range;

use fearless_simd::{Simd, SimdBase, i64x8};

use super::aligned::{CacheLines, Vectors, chunks, chunks_mut};
use super::band::{Band, move_blocks};
use super::blocks::{Shifts, Sums, integer_sum, integers, or_else, zero_missing};
use super::layout::TILE;
use super::pull::{Above, coupling_force, pull_from_above};
use super::quanta::Quanta;
use super::springs::Geometry;
use super::step::Step;
use super::upper_sheet::UpperSheet;
use super::vector::{Chunks, ChunksMut, add, load, load_vec2, or_zero_below, scale, splat, square, subtract};
use crate::integrator::SMALLEST_VELOCITY;
use crate::properties::Sheet;

impl Band {
    /// Moves the first tiles of the sheets above, and computes the springs of the row before them; then
    /// [`upper_tiles`](Self::upper_tiles) advances one tile after the other.
    #[inline(always)]
    pub(crate) fn begin_upper<S: Simd, G: Geometry>(
        &self,
        simd: S,
        geometry: G,
        step: &Step,
        ahead: usize,
        upper: &mut [UpperSheet],
    ) {
        for one in upper {
            (one.sums, one.energy_below) = (Sums::default(), 0);
            for t in 0..ahead {
                self.move_tile(simd, step, t, one);
            }
            let from = self.below(self.halo);
            self.upward(
                simd,
                geometry,
                &one.displacement,
                &mut one.scratch,
                from,
                self.halo,
            );
        }
    }

    /// Advances tile `t` of the sheets above by a step, and moves the tile `ahead` of it. A separate
    /// function, so that it is not part of the sweep of a single sheet.
    #[inline(never)]
    pub(crate) fn upper_tiles<S: Simd, G: Geometry>(
        &self,
        simd: S,
        geometry: G,
        (step, quanta): (&Step, &Quanta),
        energies: bool,
        (t, ahead): (usize, usize),
        upper: &mut [UpperSheet],
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                for one in &mut *upper {
                    if t + ahead < self.tiles.len() {
                        self.move_tile(simd, step, t + ahead, one);
                    }
                    self.upper_springs(simd, geometry, quanta, energies, t, one);
                }
                for number in 0..upper.len() {
                    let (at, has_above) = ((t, number), number + 1 < upper.len());
                    match (energies, has_above) {
                        (false, false) => self.accelerate::<S, false, false>(simd, step, quanta, at, upper),
                        (false, true) => self.accelerate::<S, false, true>(simd, step, quanta, at, upper),
                        (true, false) => self.accelerate::<S, true, false>(simd, step, quanta, at, upper),
                        (true, true) => self.accelerate::<S, true, true>(simd, step, quanta, at, upper),
                    }
                }
            },
        );
    }

    /// Moves the blocks of a tile of a sheet (Eq. 8).
    #[inline(never)]
    fn move_tile<S: Simd>(&self, simd: S, step: &Step, t: usize, one: &mut UpperSheet) {
        simd.vectorize(
            #[inline(always)]
            || {
                let (elements, dt) = (self.elements(t), step.move_dt);
                move_blocks(
                    simd,
                    dt,
                    &mut one.displacement,
                    &one.velocity,
                    self.halo,
                    elements,
                );
            },
        );
    }

    /// Forces of the springs in tile `t` of a sheet, over its thickness, and their energies if these are
    /// needed.
    #[inline(always)]
    fn upper_springs<S: Simd, G: Geometry>(
        &self,
        simd: S,
        geometry: G,
        quanta: &Quanta,
        energies: bool,
        t: usize,
        one: &mut UpperSheet,
    ) {
        let elements = self.elements(t);
        let (from, to) = (self.halo + elements.start, self.halo + elements.end);
        let (u, scratch) = (&one.displacement, &mut one.scratch);
        self.upward(simd, geometry, u, scratch, from, to);
        self.lattice_forces(simd, geometry, u, t, scratch);
        if energies {
            for v in self.vectors(t) {
                let energy =
                    self.lattice_energy(simd, geometry, quanta, (u, one.sheet.thickness), v, scratch);
                one.sums.lattice_energy += i128::from(energy);
            }
        }
    }

    /// Velocities half a step later of tile `t` of a sheet with known spring forces, and sums over them.
    #[inline(never)]
    fn accelerate<S: Simd, const ENERGY: bool, const HAS_ABOVE: bool>(
        &self,
        simd: S,
        step: &Step,
        quanta: &Quanta,
        (t, number): (usize, usize),
        upper: &mut [UpperSheet],
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let elements = self.elements(t);
                let (first, n) = (self.halo + elements.start, elements.len());
                let (below, rest) = upper.split_at_mut(number);
                let Some((one, over)) = rest.split_first_mut() else {
                    return;
                };
                let below = below
                    .last()
                    .map_or(&self.displacement, |below| &below.displacement);
                let arrays = FreeLoop {
                    sheet: one.sheet,
                    displacement: chunks(&one.displacement, first, n),
                    below: chunks(below, first, n),
                    above: over
                        .first()
                        .map_or_else(Above::default, |over| over.above(first, n)),
                    lattice: chunks(&one.scratch.lattice, 0, n),
                    blocks: &self.blocks[self.vectors(t)],
                    prefetched: self.prefetched(&one.displacement, &one.velocity, elements.clone()),
                    velocity: chunks_mut(&mut one.velocity, elements.start, n),
                };
                let (sums, energy_below) = accelerate::<S, ENERGY, HAS_ABOVE>(simd, *step, quanta, arrays);
                one.sums.include(&sums);
                one.energy_below += i128::from(energy_below);
            },
        );
    }

    /// Memory of the tile after the next to be moved, which is not in the cache yet.
    #[inline(always)]
    fn prefetched(
        &self,
        displacement: &Vectors,
        velocity: &Vectors,
        elements: Range<usize>,
    ) -> [CacheLines; 4] {
        let next = elements.start + (1 + self.tiles_ahead()) * TILE;
        [
            displacement.x.cache_lines(self.halo + next),
            displacement.y.cache_lines(self.halo + next),
            velocity.x.cache_lines(next),
            velocity.y.cache_lines(next),
        ]
    }

    /// Adds the sums of the sheets above to those of the lowest sheet, which the drive does not pull.
    pub(crate) fn add_upper(&mut self) {
        for one in &self.upper {
            self.sums.include(&one.sums);
        }
    }
}

/// Input and output of [`accelerate`] for some elements of a sheet.
struct FreeLoop<'a> {
    sheet: Sheet,
    displacement: [Chunks<'a>; 2],
    /// Displacements of the blocks below.
    below: [Chunks<'a>; 2],
    above: Above<'a>,
    /// Lattice forces over the thickness of the sheet.
    lattice: [Chunks<'a>; 2],
    /// Mask of the elements that are blocks.
    blocks: &'a [u8],
    /// Velocities at `t - dt/2`, then at `t + dt/2`.
    velocity: [ChunksMut<'a>; 2],
    /// Memory of later tiles, to be fetched ahead.
    prefetched: [CacheLines; 4],
}

/// Eqs. 5-7 without friction, `h m u'' = h F_c + g_above (u_above - u) - g (u - u_below) - h m Omega u'`, in
/// the order of the general kernel. Returns the sums over the blocks, and the sum of the energies
/// `g (u - u_below)^2` if energies are needed.
#[inline(always)]
fn accelerate<S: Simd, const ENERGY: bool, const HAS_ABOVE: bool>(
    simd: S,
    step: Step,
    quanta: &Quanta,
    arrays: FreeLoop,
) -> (Sums<i64, f64>, i64) {
    // Gives all slices one length, so that the loop below needs no bounds checks.
    let [vx, vy] = arrays.velocity;
    let n = vx.len();
    let vy = &mut vy[..n];
    let u = [&arrays.displacement[0][..n], &arrays.displacement[1][..n]];
    let below = [&arrays.below[0][..n], &arrays.below[1][..n]];
    let lattice = [&arrays.lattice[0][..n], &arrays.lattice[1][..n]];
    let (above, blocks) = (arrays.above.first::<HAS_ABOVE>(n), &arrays.blocks[..n]);
    let (Sheet { thickness, coupling }, integrator) =
        (arrays.sheet, step.integrator.of_mass(arrays.sheet.thickness));
    let shifts = Shifts::of(simd, quanta);
    let mut sums = Sums::zero(simd);
    let mut energy_below = i64x8::splat(simd, 0);
    for c in 0..n {
        for lines in arrays.prefetched {
            lines.prefetch(c);
        }
        let here = load_vec2(simd, u, c);
        let to_below = coupling_force(simd, coupling, here, load_vec2(simd, below, c));
        let from_above = pull_from_above::<S, HAS_ABOVE>(simd, step, above, c, here);
        let force = add(
            scale(splat(simd, thickness), load_vec2(simd, lattice, c)),
            subtract(from_above, to_below),
        );
        // Ghosts have the velocity of their blocks, which is copied to them later.
        let before = zero_missing(simd, blocks[c], [load(simd, &vx[c]), load(simd, &vy[c])]);
        let free = add(
            scale(splat(simd, integrator.velocity_decay), before),
            scale(splat(simd, integrator.force_to_velocity), force),
        );
        let after = zero_missing(simd, blocks[c], or_zero_below(simd, SMALLEST_VELOCITY, free));
        after[0].store_array(&mut vx[c]);
        after[1].store_array(&mut vy[c]);
        let motion_square = splat(simd, thickness) * square(add(before, after));
        sums.motion_square += integers(motion_square, shifts.motion_square);
        sums.speed_square = sums.speed_square.max(square(after));
        if !HAS_ABOVE {
            let displacement = or_else(simd, blocks[c], here, shifts.centres);
            sums.add_displacement::<false>(simd, &shifts, displacement, &[], c);
            sums.add_velocity::<false>(simd, &shifts, after, &[], c);
            if ENERGY {
                sums.add_stretch::<false>(simd, quanta, &shifts, displacement, &[], c);
            }
        }
        if ENERGY {
            let motion = splat(simd, thickness) * (square(before) + square(after));
            sums.velocity_squares += integers(motion, shifts.motion_square);
            let apart = zero_missing(simd, blocks[c], subtract(here, load_vec2(simd, below, c)));
            let energy = splat(simd, coupling) * square(apart);
            energy_below += integers(energy, splat(simd, quanta.between_sheets.shift()));
        }
    }
    let mut sums = sums.totals::<ENERGY>(quanta, n);
    sums.friction_work = 0;
    let sums = if HAS_ABOVE { sums.below_others() } else { sums };
    let energy_below = if ENERGY {
        integer_sum(energy_below, quanta.between_sheets, n)
    } else {
        0
    };
    (sums, energy_below)
}
