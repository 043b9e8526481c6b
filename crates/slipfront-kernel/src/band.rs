//! The arrays of a band of tiles, and the sweep that advances the band by a step.

use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use fearless_simd::{Simd, SimdBase};

use super::aligned::{Aligned, Vectors, chunks, chunks_mut};
use super::blocks::{
    FrictionLoop, LatticeLoop, Sums, friction, lattice_forces, or_else, upward_springs, vector_energy,
    zero_missing,
};
use super::interface::Interface;
use super::layout::{Layout, TILE};
use super::quanta::Quanta;
use super::rest::{RestingVector, steps_until_slip};
use super::scratch::{MIRROR, Scratch, whole_vectors};
use super::sparse::EAST;
use super::springs::Geometry;
use super::step::Step;
use super::thresholds::Thresholds;
use super::variations::{Variation, Variations};
use super::vector::{Chunks, LANES, Vec2x8, lane_max, load, load_vec2, splat, subtract};
use crate::properties::Properties;

/// The step of a slip that has not come.
pub const NEVER: u32 = u32::MAX;

/// A tile after its latest sweep.
#[derive(Clone, Copy, Debug, Default)]
pub struct TileState {
    /// Sums over the blocks of the tile.
    pub sums: Sums<i64, f64>,
    /// Whether an element of the tile moves, ghosts included.
    pub moving: bool,
    /// Whether the first active steps and energies of the tile's vectors are known, so that they can be swept
    /// one by one.
    pub settled: bool,
    /// The first step at which a block of the tile may slip if nothing around it moves; 0 if unknown.
    pub active_from_step: u64,
    /// Largest u_x, -u_x, u_y, -u_y of the tile's blocks at the latest measurement.
    pub extent: [f64; 4],
    /// Largest difference of u_x and of u_y between the tile's blocks and their neighbours at the latest
    /// measurement.
    pub difference: [f64; 2],
    /// Whether a block of the tile has moved since the latest measurement.
    pub displacements_are_old: bool,
}

/// Work to be done on a tile in a sweep. A mask has one bit per vector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileTask {
    /// The vectors that are swept: one of their blocks or a neighbour moves, or one of their blocks may slip.
    pub active: u32,
    /// Active vectors that were skipped at the previous step.
    pub was_skipped: u32,
    /// Vectors with a moving block or a neighbour of one.
    pub touched: u32,
    /// Whether the active vectors are few, and are swept one by one.
    pub sparse: bool,
    /// Whether all vectors are swept and few are touched, so that from now on they can be swept one by one,
    /// or not at all.
    pub settles: bool,
    /// Whether the tile's springs to the next row are needed, by the tile itself or by a tile to the north.
    pub needs_springs: bool,
}

/// Consecutive tiles, with the arrays that one thread uses to advance them by a step.
///
/// Indices of arrays with halos count from the first element of the front halo, other indices from the first
/// element of the band.
#[derive(Debug)]
pub struct Band {
    /// Index of the first tile.
    pub first_tile: usize,
    /// Index of the first element.
    pub first: usize,
    /// Number of elements, in whole vectors.
    pub len: usize,
    /// The tiles after their latest sweeps.
    pub tiles: Vec<TileState>,
    /// Work of the latest sweep on each tile.
    pub tasks: Vec<TileTask>,
    /// Sums over the band's tiles after the latest sweep.
    pub sums: Sums<i128, f64, u64>,
    /// The first step at which a block of the band may slip if nothing around it moves; 0 if unknown or
    /// something moves.
    pub next_active_step: u64,
    /// Largest [`TileState::extent`] of the band's tiles at the latest measurement.
    pub extent: [f64; 4],
    /// Largest [`TileState::difference`] of the band's tiles at the latest measurement.
    pub difference: [f64; 2],
    /// Number of elements before and after the band with displacements that the band keeps, see [`halo`].
    pub halo: usize,
    // If all blocks are equal, a step moves only two vectors and two thresholds per block through memory. All
    // other data are bits, or are in the scratch arrays, which stay in the cache.
    /// Displacements at t_n, with halos.
    pub displacement: Vectors,
    /// Velocities at t_n + dt/2.
    pub velocity: Vectors,
    /// Squares of the static thresholds `mu_s F_n`.
    static_limit_squares: Aligned,
    /// Change of velocity by kinetic friction in a step, `dt mu_k F_n/(m c+)`.
    kinetic_impulses: Aligned,
    /// The step of the first slip in contact, or [`NEVER`].
    pub first_slip: Vec<u32>,
    // One byte per vector shows at once whether all eight elements have a spring, or whether none moves.
    /// Masks of the elements that have a spring to the east, north, north-east and north-west; with the front
    /// halo.
    pub(crate) masks: [Vec<u8>; 4],
    /// Mask of the elements that are blocks.
    pub(crate) blocks: Vec<u8>,
    /// Mask of the elements that are blocks in contact.
    in_contact: Vec<u8>,
    /// Mask of the elements that move, ghosts included.
    pub moving: Vec<u8>,
    // Repeats information of `first_slip`, so that the 32 bytes of a vector there are accessed only when a
    // block slips for the first time.
    /// Mask of the blocks in contact that have ever slid.
    pub slipped: Vec<u8>,
    // These two arrays make it unnecessary to look at the resting vectors of a settled tile. They say when
    // each vector must be swept, and its share of the tile's sum of energies, which is replaced then.
    /// The first step at which a block of each vector may slip; 0 for a touched vector. Known in settled
    /// tiles.
    pub(crate) active_from_step: Vec<u64>,
    /// Energy of the springs of each vector, as in [`Sums`]. Known in settled tiles.
    pub(crate) lattice_energy: Vec<i64>,
    /// Springs, drive springs and masses of a heterogeneous slider.
    pub(crate) variations: Option<Variations>,
    /// Thresholds under a law of friction that changes them.
    pub thresholds: Option<Thresholds>,
    /// The interface of an upright sheet, along which friction acts.
    pub(crate) interface: Option<Interface>,
    /// Arrays of intermediate results. The lock is held while fields are read; a sweep, which runs alone,
    /// uses the arrays without it.
    scratch: Mutex<Scratch>,
    /// Number of elements from one row to the next.
    pub stride: usize,
}

/// Number of elements before and after a band with displacements that the band keeps.
pub fn halo(layout: &Layout) -> usize {
    whole_vectors(layout.stride + 1 + LANES)
}

/// Masks of the existing springs of each element along the four bonds: for the `halo` of elements before
/// `first`, and for `len` elements from there on.
fn spring_masks(
    layout: &Layout,
    properties: &Properties,
    first: usize,
    halo: usize,
    len: usize,
) -> [Vec<u8>; 4] {
    let mut masks = [(); 4].map(|()| vec![0; (halo + len) / LANES]);
    for k in 0..halo + len {
        let springs = properties.has_springs(layout, (first + k) as isize - halo as isize);
        for (masks, present) in masks.iter_mut().zip(springs) {
            masks[k / LANES] |= u8::from(present) << (k % LANES);
        }
    }
    masks
}

impl Band {
    /// The band of the given tiles of a lattice.
    pub fn new(layout: &Layout, properties: &Properties, tiles: Range<usize>) -> Self {
        let first = tiles.start * TILE;
        let len = whole_vectors((tiles.end * TILE).min(layout.n_elements()) - first);
        let halo = halo(layout);
        let bytes = || vec![0; len / LANES];
        let mut band = Self {
            first_tile: tiles.start,
            first,
            len,
            tiles: vec![TileState::default(); tiles.len()],
            tasks: vec![TileTask::default(); tiles.len()],
            sums: Sums::default(),
            next_active_step: 0,
            extent: [f64::NEG_INFINITY; 4],
            difference: [0.0; 2],
            halo,
            displacement: Vectors::zeros(halo + len + halo),
            velocity: Vectors::zeros(len),
            static_limit_squares: Aligned::filled(len, f64::INFINITY),
            // A ghost has the velocity of its block: infinite friction keeps it from moving by itself.
            kinetic_impulses: Aligned::filled(len, f64::INFINITY),
            first_slip: vec![NEVER; len],
            masks: spring_masks(layout, properties, first, halo, len),
            blocks: bytes(),
            in_contact: bytes(),
            moving: bytes(),
            slipped: bytes(),
            active_from_step: vec![0; len / LANES],
            lattice_energy: vec![0; len / LANES],
            variations: properties
                .blocks_differ
                .then(|| Variations::new(layout, properties, halo, first..first + len)),
            thresholds: properties.changing.map(|law| Thresholds::new(law, len)),
            interface: Interface::new(layout, properties, first, len),
            scratch: Mutex::new(Scratch::new(layout.stride)),
            stride: layout.stride,
        };
        let force_to_velocity = properties.force_to_velocity;
        for k in 0..len {
            let block = layout.block(first + k).map(|b| properties.blocks.block(b));
            let Some(block) = block.filter(|block| block.exists) else {
                continue;
            };
            let (static_limit, kinetic_force) = (block.static_limit, block.kinetic_force);
            band.static_limit_squares[k] = static_limit * static_limit;
            band.kinetic_impulses[k] = force_to_velocity * kinetic_force / block.mass;
            if let Some(thresholds) = &mut band.thresholds {
                let drop = (static_limit - kinetic_force).max(0.0);
                thresholds.set_drop(k, force_to_velocity * drop / block.mass);
                if drop > 0.0 && thresholds.follow_slip() {
                    // The strength at the present slip is the only threshold.
                    band.static_limit_squares[k] = 0.0;
                }
            }
            let bit = 1 << (k % LANES);
            band.blocks[k / LANES] |= bit;
            if !block.is_textured {
                band.in_contact[k / LANES] |= bit;
            }
            band.tiles[k / TILE].displacements_are_old = true;
            if let Some([u, v]) = block.motion {
                band.displacement.set(halo + k, u);
                band.velocity.set(k, v);
                band.set_moving(k, v != [0.0, 0.0]);
                let speed_square = &mut band.tiles[k / TILE].sums.speed_square;
                *speed_square = speed_square.max(v[0] * v[0] + v[1] * v[1]);
            }
        }
        band.begin_thresholds();
        band
    }

    /// Finds thresholds that change before the first sweep.
    pub fn begin_thresholds(&mut self) {
        if let Some(thresholds) = &mut self.thresholds {
            thresholds.begin(&self.kinetic_impulses);
        }
    }

    /// Locks the arrays of intermediate results while fields are read.
    pub(crate) fn lock_scratch(&self) -> MutexGuard<'_, Scratch> {
        self.scratch.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn scratch(&mut self) -> &mut Scratch {
        self.scratch.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    /// The elements before and after the band with displacements that the band keeps. The last vector may
    /// extend beyond the last row.
    pub fn halos(&self, layout: &Layout) -> [Range<isize>; 2] {
        let (first, halo) = (self.first as isize, self.halo as isize);
        let end = first + self.len.min(layout.n_elements() - self.first) as isize;
        [first - halo..first, end..first + self.len as isize + halo]
    }

    /// Index in the displacements of an element, which may belong to a halo.
    pub fn halo_index(&self, element: isize) -> usize {
        (element - self.first as isize + self.halo as isize) as usize
    }

    /// Elements of the band's tile `t`, counted from the band's first.
    pub fn elements(&self, t: usize) -> Range<usize> {
        t * TILE..((t + 1) * TILE).min(self.len)
    }

    /// Vectors of the band's tile `t`.
    pub fn vectors(&self, t: usize) -> Range<usize> {
        let elements = self.elements(t);
        elements.start / LANES..elements.end / LANES
    }

    /// Records whether an element moves.
    pub fn set_moving(&mut self, k: usize, moves: bool) {
        let bit = 1 << (k % LANES);
        if moves {
            self.moving[k / LANES] |= bit;
            self.tiles[k / TILE].moving = true;
        } else {
            self.moving[k / LANES] &= !bit;
        }
    }

    /// Passes column and row of the blocks in contact of the band to `take`: of those that slide, or of those
    /// that do not.
    pub fn for_each_in_contact(&self, layout: &Layout, sliding: bool, mut take: impl FnMut(usize, usize)) {
        for (v, contact) in self.in_contact.iter().enumerate() {
            let slides = self.sliding(v);
            let mut counted = contact & if sliding { slides } else { !slides };
            if counted == 0 {
                continue;
            }
            let (row, column) = layout.row_column((self.first + v * LANES) as isize);
            while counted != 0 {
                let (i, j) = layout.place_after(row as usize, column, counted.trailing_zeros() as usize);
                take(i, j);
                counted &= counted - 1;
            }
        }
    }

    /// Displacement that an element will have after moving by `move_dt`.
    pub fn advanced(&self, k: usize, move_dt: f64) -> [f64; 2] {
        let ([ux, uy], [vx, vy]) = (self.displacement.at(self.halo + k), self.velocity.at(k));
        [ux + move_dt * vx, uy + move_dt * vy]
    }

    /// One step of the scheduled tiles: displacements to t_n, forces there, velocities to t_n + dt/2. The
    /// halos contain the displacements at t_n of the elements around the band.
    #[inline(always)]
    pub(crate) fn sweep<S: Simd, G: Geometry>(
        &mut self,
        simd: S,
        geometry: G,
        step: Step,
        quanta: &Quanta,
        energies: bool,
    ) {
        // Springs join elements with elements up to a row and a block ahead, which must have moved before.
        let n_tiles = self.tiles.len();
        let ahead = self.tiles_ahead().min(n_tiles);
        for t in 0..ahead {
            self.advance_tile(simd, &step, quanta, t);
        }
        // Moved out, so that the band and its scratch arrays can be changed at the same time.
        let mut scratch = std::mem::take(self.scratch());
        if self.tasks[..ahead].iter().any(|task| task.needs_springs) {
            // The springs below the band also belong to another band, or to the other end of this one.
            // Computing them twice avoids that a thread waits for another.
            let from = self.below(self.halo);
            self.upward(simd, geometry, &mut scratch, from, self.halo);
        }
        for t in 0..n_tiles {
            // As late as springs allow, so that the tile is still in the cache at its own turn. Until then
            // its velocity is that of the step before: friction replaces it last.
            if t + ahead < n_tiles {
                self.advance_tile(simd, &step, quanta, t + ahead);
            }
            let (task, elements) = (self.tasks[t], self.elements(t));
            if task.needs_springs {
                let (from, to) = (self.halo + elements.start, self.halo + elements.end);
                self.upward(simd, geometry, &mut scratch, from, to);
            }
            if task.active == 0 {
                continue;
            }
            if task.sparse {
                self.sparse_tile(simd, geometry, (&step, quanta), t, &mut scratch);
            } else {
                self.tile(
                    simd,
                    geometry,
                    (&step, quanta),
                    // The energy of a settled tile is updated by differences of single vectors, which
                    // requires the energy of each.
                    energies || task.settles,
                    t,
                    &mut scratch,
                );
            }
            if task.settles {
                self.settle(simd, &step, t, &scratch);
            }
            if task.was_skipped != 0 {
                // The stress was largest at the last skipped step, or at the first, which the previous sweep
                // has measured. At the present step the block may slide already.
                let before = self.resting_stress_square(t, task.was_skipped, &step.before());
                let stress_square = &mut self.tiles[t].sums.stress_square;
                *stress_square = stress_square.max(before);
            }
        }
        *self.scratch() = scratch;
        self.add_up();
    }

    /// Adds up the sums over the tiles; skipped tiles keep their sums.
    fn add_up(&mut self) {
        // From all tiles at every step, not by differences as within a tile: the largest stress may have
        // fallen.
        (self.sums, self.next_active_step) = (Sums::default(), u64::MAX);
        for tile in &self.tiles {
            self.sums.include(&tile.sums);
            let step = if tile.moving { 0 } else { tile.active_from_step };
            self.next_active_step = self.next_active_step.min(step);
        }
    }

    /// First element below element `k` with springs to the next row that element `k` needs.
    #[inline(always)]
    pub(crate) fn below(&self, k: usize) -> usize {
        k - whole_vectors(self.stride + 1)
    }

    /// Number of tiles after the present one that must have moved before its forces are computed.
    #[inline(always)]
    pub(crate) fn tiles_ahead(&self) -> usize {
        (self.stride + MIRROR).div_ceil(TILE)
    }

    /// Moves the blocks of a tile (Eq. 8), `u += dt v`, if the tile moves. A separate function, compiled once
    /// for all spring formulas.
    #[inline(never)]
    fn advance_tile<S: Simd>(&mut self, simd: S, step: &Step, quanta: &Quanta, t: usize) {
        if !self.tiles[t].moving {
            return;
        }
        simd.vectorize(
            #[inline(always)]
            || {
                if self.tasks[t].sparse {
                    self.advance_vectors(simd, *step, quanta, t);
                    return;
                }
                let elements = self.elements(t);
                let (start, n) = (self.halo + elements.start, elements.len());
                let [ux, uy] = chunks_mut(&mut self.displacement, start, n);
                let [vx, vy] = chunks(&self.velocity, elements.start, n);
                let dt = splat(simd, step.move_dt);
                for (((ux, uy), vx), vy) in ux.iter_mut().zip(uy).zip(vx).zip(vy) {
                    (load(simd, ux) + dt * load(simd, vx)).store_array(ux);
                    (load(simd, uy) + dt * load(simd, vy)).store_array(uy);
                }
            },
        );
    }

    /// Forces of the springs to the next row of the elements `from..to`, into the ring buffer. A separate
    /// function, compiled once for all callers.
    #[inline(never)]
    pub(crate) fn upward<S: Simd, G: Geometry>(
        &self,
        simd: S,
        geometry: G,
        scratch: &mut Scratch,
        from: usize,
        to: usize,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                for (first, end, own, _) in scratch.ring_segments(self.stride, from, to) {
                    let n = end - first;
                    let north = first + self.stride;
                    let vectors = first / LANES..end / LANES;
                    let here = chunks(&self.displacement, first, n);
                    // Written out: an array's `map` costs more than its elements here.
                    let at = |k| chunks(&self.displacement, k, n);
                    let there = [at(north), at(north + 1), at(north - 1)];
                    let [_, north_masks, north_east_masks, north_west_masks] = &self.masks;
                    let masks = [
                        &north_masks[vectors.clone()],
                        &north_east_masks[vectors.clone()],
                        &north_west_masks[vectors],
                    ];
                    let factors = |bond: usize| self.spring_factors::<G>(bond, first, n);
                    let factors = [factors(1), factors(2), factors(3)];
                    let [north_f, north_east_f, north_west_f] = &mut scratch.upward;
                    let force = [
                        chunks_mut(north_f, own, n),
                        chunks_mut(north_east_f, own, n),
                        chunks_mut(north_west_f, own, n),
                    ];
                    upward_springs(simd, geometry, here, there, (masks, factors), force);
                    // Values beyond the end are read a row later, when the mirror is up to date.
                    if own < MIRROR {
                        let ring = scratch.ring_buffer_len();
                        for force in &mut scratch.upward {
                            force.x.copy_within(..MIRROR, ring);
                            force.y.copy_within(..MIRROR, ring);
                        }
                    }
                }
            },
        );
    }

    /// Forces and velocities of a tile, and its energies if they are needed. Its springs to the next row and
    /// those of the row below are in the ring buffer.
    #[inline(always)]
    fn tile<S: Simd, G: Geometry>(
        &mut self,
        simd: S,
        geometry: G,
        (step, quanta): (&Step, &Quanta),
        energies: bool,
        t: usize,
        scratch: &mut Scratch,
    ) {
        self.lattice_forces(simd, geometry, t, scratch);
        let mut lattice_energy = 0;
        if energies {
            for v in self.vectors(t) {
                let energy = self.lattice_energy(simd, geometry, quanta, v, scratch);
                self.lattice_energy[v] = energy;
                lattice_energy += energy;
            }
        }
        match (G::BLOCKS_DIFFER, energies) {
            (true, _) if self.interface.is_some() => self.interface_of_tile(simd, step, quanta, t, scratch),
            // All energies are computed: a version without them would save little.
            (true, _) => self.friction_of_tile::<S, true, true>(simd, step, quanta, t, scratch),
            (false, true) => {
                self.friction_of_tile::<S, true, false>(simd, step, quanta, t, scratch);
            }
            (false, false) => {
                self.friction_of_tile::<S, false, false>(simd, step, quanta, t, scratch);
            }
        }
        self.tiles[t].sums.lattice_energy = lattice_energy;
    }

    /// Eqs. 2 and 4-7 in a tile with known lattice forces. A separate function, compiled once for all spring
    /// formulas.
    #[inline(never)]
    fn friction_of_tile<S: Simd, const ENERGY: bool, const DIFFER: bool>(
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
                let ahead = self.tiles_ahead();
                // Skipped tiles lie between, so that the next data to be read do not follow in memory.
                let next = [t, t + ahead].map(|t| TILE * self.next_whole_tile(t).unwrap_or(t + 1));
                let elements = self.elements(t);
                let arrays = self.friction_loop::<S, DIFFER>(simd, *step, (elements, next), scratch, 0, None);
                let mut sums = Sums::zero(simd);
                friction::<S, ENERGY, DIFFER>(simd, *step, quanta, arrays, &mut sums);
                let sums = sums.totals::<ENERGY>(quanta, self.vectors(t).len());
                self.set_swept(t, sums, sums.sliding > 0);
            },
        );
    }

    /// Sets the sums over a tile that was swept as a whole, and whether an element of it moves.
    #[inline(always)]
    pub(crate) fn set_swept(&mut self, t: usize, sums: Sums<i64, f64>, moving: bool) {
        let tile = &mut self.tiles[t];
        (tile.sums, tile.moving) = (sums, moving);
        // Values known for its single vectors are from before this sweep.
        (tile.settled, tile.active_from_step) = (false, 0);
    }

    /// Eq. 3 in a tile. A separate function, compiled once for all callers.
    #[inline(never)]
    pub(crate) fn lattice_forces<S: Simd, G: Geometry>(
        &self,
        simd: S,
        geometry: G,
        t: usize,
        scratch: &mut Scratch,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let elements = self.elements(t);
                let start = self.halo + elements.start;
                // The eight elements before may belong to a skipped tile, which has stored no springs.
                let mut west = self.east_springs(simd, geometry, start - LANES);
                for (first, end, own, behind) in
                    scratch.ring_segments(self.stride, start, self.halo + elements.end)
                {
                    let n = end - first;
                    let [north, north_east, north_west] = &scratch.upward;
                    let arrays = LatticeLoop {
                        here: chunks(&self.displacement, first, n),
                        east: chunks(&self.displacement, first + 1, n),
                        has_east: &self.masks[0][first / LANES..end / LANES],
                        to_east: self.spring_factors::<G>(0, first, n),
                        own: [
                            chunks(north, own, n),
                            chunks(north_east, own, n),
                            chunks(north_west, own, n),
                        ],
                        behind: [
                            chunks(north, behind + 1, n),
                            chunks(north_east, behind, n),
                            chunks(north_west, behind + 2, n),
                        ],
                        force: chunks_mut(&mut scratch.lattice, first - start, n),
                    };
                    lattice_forces(simd, geometry, arrays, &mut west);
                }
            },
        );
    }

    /// Energy of the springs of a vector, as in [`Sums`].
    #[inline(always)]
    fn lattice_energy<S: Simd, G: Geometry>(
        &self,
        simd: S,
        geometry: G,
        quanta: &Quanta,
        v: usize,
        scratch: &Scratch,
    ) -> i64 {
        let here = self.halo + v * LANES;
        let own = here % scratch.ring_buffer_len();
        let upward = |k: usize| load_vec2(simd, chunks(&scratch.upward[k], own, LANES), 0);
        let east = self.east_springs(simd, geometry, here);
        // Each block accounts for the energy of the four springs that begin at it, so that each spring is
        // counted once.
        let springs = [east, upward(0), upward(1), upward(2)];
        let (factors, quantum) = (self.factors_of::<G>(v), quanta.lattice_energy);
        vector_energy::<S, G>(simd, springs, self.blocks[v], factors, quantum)
    }

    /// Input of [`friction`] (Eqs. 2 and 4-7) for some elements of a tile, with their lattice forces at
    /// `place` in the scratch array. `next`: the elements that need friction next, and those that move next;
    /// `across`: velocities along y for the thresholds, if they are not those of the elements.
    #[inline(always)]
    pub(crate) fn friction_loop<'a, S: Simd, const DIFFER: bool>(
        &'a mut self,
        simd: S,
        step: Step,
        (elements, [next, moving_next]): (Range<usize>, [usize; 2]),
        scratch: &'a mut Scratch,
        place: usize,
        across: Option<Chunks>,
    ) -> FrictionLoop<'a> {
        let (start, n) = (self.halo + elements.start, elements.len());
        let prefetched = [
            self.static_limit_squares.cache_lines(next),
            self.kinetic_impulses.cache_lines(next),
            self.displacement.x.cache_lines(self.halo + moving_next),
            self.displacement.y.cache_lines(self.halo + moving_next),
            self.velocity.x.cache_lines(moving_next),
            self.velocity.y.cache_lines(moving_next),
        ];
        let vectors = elements.start / LANES..elements.end / LANES;
        let mut kinetic_impulses: Chunks = self.kinetic_impulses[elements.clone()].as_chunks().0;
        let mut variation = Variation::default();
        if let Some(variations) = self.variations.as_ref().filter(|_| DIFFER) {
            variation = variations.slice(elements.clone());
        }
        // Here, not in a separate pass: the velocities are about to be read anyway, and skipped blocks do not
        // slip.
        if let Some(thresholds) = &mut self.thresholds {
            let [vx, vy] = chunks(&self.velocity, elements.start, n);
            let velocity = [vx, across.unwrap_or(vy)];
            let at_rest = (kinetic_impulses, variation.inverse_mass);
            thresholds.update(simd, &step, &elements, velocity, at_rest);
            kinetic_impulses = thresholds.kinetic_impulses(elements.clone());
        }
        FrictionLoop {
            displacement: chunks(&self.displacement, start, n),
            lattice: chunks(&scratch.lattice, place, n),
            static_limit_squares: self.static_limit_squares[elements.clone()].as_chunks().0,
            kinetic_impulses,
            blocks: &self.blocks[vectors.clone()],
            in_contact: &self.in_contact[vectors.clone()],
            velocity: chunks_mut(&mut self.velocity, elements.start, n),
            moving: &mut self.moving[vectors.clone()],
            slipped: &mut self.slipped[vectors],
            first_slip: self.first_slip[elements.clone()].as_chunks_mut().0,
            drive: chunks_mut(&mut scratch.drive, 0, n),
            free: chunks_mut(&mut scratch.free, 0, n),
            free_speed: scratch.free_speed[..n].as_chunks_mut().0,
            prefetched,
            variation,
        }
    }

    /// Kinetic friction of an element at the latest sweep, from its friction `at_rest`.
    pub fn kinetic_force(&self, k: usize, at_rest: f64, velocity_to_force: f64) -> f64 {
        let Some(thresholds) = &self.thresholds else {
            return at_rest;
        };
        let mass = self
            .variations
            .as_ref()
            .map_or(1.0, |variations| variations.mass[k]);
        thresholds.kinetic_impulse(k) * mass * velocity_to_force
    }

    /// Springs to the east of the eight elements from `first` on, counted from the front halo.
    #[inline(always)]
    fn east_springs<S: Simd, G: Geometry>(&self, simd: S, geometry: G, first: usize) -> Vec2x8<S> {
        let has_east = self.masks[0][first / LANES];
        self.springs_between(simd, geometry, EAST, (has_east, first + 1), first)
    }

    /// Factors of the springs along a bond of the `n` elements from `first` on, counted from the front halo;
    /// empty where all springs are equal.
    #[inline(always)]
    pub(crate) fn spring_factors<G: Geometry>(&self, bond: usize, first: usize, n: usize) -> Chunks<'_> {
        match &self.variations {
            Some(variations) if G::BLOCKS_DIFFER => variations.springs[bond][first..first + n].as_chunks().0,
            _ => &[],
        }
    }

    /// Number of steps for which vector `v` at rest can be skipped, with its lattice forces at `place` in the
    /// scratch array.
    #[inline(always)]
    pub(crate) fn steps_until_slip<S: Simd>(
        &self,
        simd: S,
        step: Step,
        v: usize,
        scratch: &Scratch,
        place: usize,
    ) -> u64 {
        let k = v * LANES;
        // At rest, friction that falls with speed has its value at speed zero, `kinetic_impulses`; strength
        // that has fallen with slip stays constant.
        let strengths = self
            .thresholds
            .as_ref()
            .filter(|thresholds| thresholds.follow_slip());
        let impulses = match strengths {
            Some(thresholds) => thresholds.kinetic_impulses(k..k + LANES),
            None => self.kinetic_impulses[k..k + LANES].as_chunks().0,
        };
        let of_vector = |values: &Aligned| load(simd, &values[k..].as_chunks().0[0]);
        let variations = self.variations.as_ref();
        let blocks = RestingVector {
            displacement: load_vec2(simd, chunks(&self.displacement, self.halo + k, LANES), 0),
            lattice: load_vec2(simd, chunks(&scratch.lattice, place, LANES), 0),
            static_limit_square: of_vector(&self.static_limit_squares),
            kinetic_impulse: load(simd, &impulses[0]),
            variation: variations
                .map(|variations| [&variations.drive_springs, &variations.mass].map(of_vector)),
            loads: variations
                .and_then(|variations| variations.loads.as_ref())
                .map(of_vector),
        };
        steps_until_slip(simd, &step, &blocks)
    }

    /// Measures displacements and their differences along springs, in tiles in which or next to which
    /// anything has moved since the latest measurement.
    #[inline(always)]
    pub(crate) fn measure_displacements<S: Simd>(&mut self, simd: S) {
        (self.extent, self.difference) = ([f64::NEG_INFINITY; 4], [0.0; 2]);
        for t in 0..self.tiles.len() {
            if self.tiles[t].displacements_are_old {
                self.measure_tile(simd, t);
            }
            for (most, value) in self.extent.iter_mut().zip(self.tiles[t].extent) {
                *most = most.max(value);
            }
            for (most, value) in self.difference.iter_mut().zip(self.tiles[t].difference) {
                *most = most.max(value);
            }
        }
    }

    /// Measures [`TileState::extent`] and [`TileState::difference`] of tile `t`.
    #[inline(always)]
    fn measure_tile<S: Simd>(&mut self, simd: S, t: usize) {
        let none = splat(simd, f64::NEG_INFINITY);
        let (mut extent, mut difference) = ([none; 4], [splat(simd, 0.0); 2]);
        for v in self.vectors(t) {
            let here = self.halo + v * LANES;
            let u = self.displacement_at(simd, here);
            let [x, y] = or_else(simd, self.blocks[v], u, [none; 2]);
            let [left, down] = or_else(simd, self.blocks[v], [-u[0], -u[1]], [none; 2]);
            extent[0] = extent[0].max(x);
            extent[1] = extent[1].max(left);
            extent[2] = extent[2].max(y);
            extent[3] = extent[3].max(down);
            for (present, there) in self.springs_of(v) {
                let there = self.displacement_at(simd, there);
                // For blocks only: elements stored beyond the last row may have neighbours that are no
                // blocks.
                let [x, y] = zero_missing(simd, present & self.blocks[v], subtract(there, u));
                difference[0] = difference[0].max(x.abs());
                difference[1] = difference[1].max(y.abs());
            }
        }
        let [right, left, up, down] = extent;
        let tile = &mut self.tiles[t];
        tile.extent = [lane_max(right), lane_max(left), lane_max(up), lane_max(down)];
        tile.difference = [lane_max(difference[0]), lane_max(difference[1])];
        tile.displacements_are_old = false;
    }

    /// Springs of vector `v` to the east, north, north-east and north-west: masks of the existing ones, and
    /// the positions of their other ends.
    #[inline(always)]
    pub(crate) fn springs_of(&self, v: usize) -> [(u8, usize); 4] {
        let here = self.halo + v * LANES;
        let above = here + self.stride;
        let ends = [here + 1, above, above + 1, above - 1];
        // Written out: an array's `map` costs more than its elements here.
        let present = |bond: usize| self.masks[bond][here / LANES];
        [
            (present(0), ends[0]),
            (present(1), ends[1]),
            (present(2), ends[2]),
            (present(3), ends[3]),
        ]
    }

    /// Largest `tau_c^2` of the blocks in contact in those of the given vectors of a tile in which nothing
    /// moves.
    pub fn resting_stress_square(&self, t: usize, vectors: u32, step: &Step) -> f64 {
        // Block by block, since this is called for a vector only once after many steps of rest. The contact
        // of a stuck block bears the whole drive force, so that its spring forces are not needed.
        let mut most = 0.0_f64;
        for (bit, v) in self.vectors(t).enumerate() {
            if vectors >> bit & 1 == 0 {
                continue;
            }
            for k in v * LANES..(v + 1) * LANES {
                if self.in_contact[v] >> (k % LANES) & 1 == 1 {
                    let u = self.displacement.at(self.halo + k);
                    let variations = self.variations.as_ref();
                    let relative = variations.map_or([1.0; 2], |variations| {
                        let load = variations.loads.as_ref().map_or(1.0, |loads| loads[k]);
                        [variations.drive_springs[k], load]
                    });
                    let [x, y] = step.drive_force(u, relative);
                    most = most.max(x * x + y * y);
                }
            }
        }
        most
    }
}
