//! The fast kernel: the equations of [`reference`](super::reference) in one sweep over the blocks.
//!
//! Blocks stand in one long line ([`layout`]), cut into tiles of 256 elements. A sweep takes tile after tile through a
//! step ([`band`]): displacements, springs, friction and all sums, eight blocks at a time ([`blocks`]), each spring once.
//! Springs come from a series where that is as exact as the square root ([`springs`]). A tile at rest, with nothing moving
//! around it, is left alone until a block of it can break ([`rest`]). Bands of tiles are shared out among threads.
//!
//! A step must read displacement, velocity and two thresholds of every block and write displacement and velocity: 80 bytes,
//! which is what a lattice larger than the cache costs at best (`examples/large_step.rs`). Springs pass through a ring that
//! stays in the cache.
//!
//! The trajectory has the same bits for any number of threads and any SIMD width, whether work is skipped or not: sums are
//! sums over tiles, and the choice between series and square root is made for the whole lattice.

mod aligned;
mod band;
mod blocks;
mod layout;
mod rest;
mod springs;
mod vector;

#[cfg(test)]
mod tests;

use fearless_simd::{Level, dispatch};

use self::band::Band;
use self::blocks::Step;
use self::layout::Layout;
use self::springs::{Series, SquareRoot};
use super::{StoredEnergy, Totals};
use crate::checkpoint::{Checkpoint, StrainBound};
use crate::lattice::K_STRAIGHT;
use crate::{Model, State};

/// Steps from one exact look at the largest differences of displacement to the next; between, they are bounded.
const EXTENT_INTERVAL: u64 = 16;

/// How springs are computed in a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Springs {
    /// Small strains: 1e-4 and less.
    ShortSeries,
    /// Up to 1e-2.
    LongSeries,
    /// Any.
    SquareRoot,
}

/// The state of all blocks and the way to step them.
#[derive(Debug)]
pub(crate) struct Fused {
    layout: Layout,
    dt_star: f64,
    bands: Vec<Band>,
    level: Level,
    /// Whether tiles at rest are left alone.
    skips: bool,
    /// For every tile: whether a block of it, or beside one of it, moves; whether a tile in the sweep needs its springs.
    has_moving_neighbour: Vec<bool>,
    needs_springs: Vec<bool>,
    /// If nothing moves: the first step at which a block may break.
    active_from_step: u64,
    /// Step of the latest sweep, how it computed springs, and what it found.
    swept: Option<u64>,
    springs: Option<Springs>,
    latest: Totals,
    /// Largest u_x, -u_x, u_y, -u_y at the latest look, and how much they may have grown since.
    extent: [f64; 4],
    growth: f64,
    /// Largest strains of the short and of the long series.
    strain_limits: [f64; 2],
    /// Highest speed after the latest sweep.
    speed: f64,
    stress_square_max: f64,
}

impl Fused {
    /// Takes over a state, or begins at rest; the blocks are shared out among `threads`.
    pub(crate) fn new(
        model: &Model,
        dt_star: f64,
        state: Option<&State>,
        threads: usize,
        skips: bool,
    ) -> Self {
        Self::at_level(model, dt_star, state, threads, skips, Level::new())
    }

    /// From a checkpoint. Every tile is swept at the next step, whether it could have been left alone or not: both give
    /// the same bits. The step of the checkpoint counts as one in which all were.
    pub(crate) fn resume(
        model: &Model,
        dt_star: f64,
        checkpoint: Checkpoint,
        strains: StrainBound,
        threads: usize,
        skips: bool,
    ) -> Self {
        let state = State {
            displacement: checkpoint.displacement.map(|read| read.0).into(),
            velocity: checkpoint.velocity.map(|read| read.0).into(),
        };
        let mut kernel = Self::new(model, dt_star, Some(&state), threads, skips);
        drop(state);
        for band in &mut kernel.bands {
            band.resume(&kernel.layout, &checkpoint.first_slip.0);
        }
        Self {
            latest: checkpoint.totals,
            stress_square_max: checkpoint.stress_square_max,
            swept: Some(checkpoint.step),
            extent: strains.extent,
            growth: strains.growth,
            speed: strains.speed,
            ..kernel
        }
    }

    /// What the choice of springs goes by.
    pub(crate) fn strains(&self) -> StrainBound {
        StrainBound {
            extent: self.extent,
            growth: self.growth,
            speed: self.speed,
        }
    }

    fn at_level(
        model: &Model,
        dt_star: f64,
        state: Option<&State>,
        threads: usize,
        skips: bool,
        level: Level,
    ) -> Self {
        let layout = Layout::new(&model.lattice);
        let n_tiles = layout.n_tiles();
        let n_bands = threads.clamp(1, n_tiles);
        let bands: Vec<Band> = (0..n_bands)
            .map(|k| n_tiles * k / n_bands..n_tiles * (k + 1) / n_bands)
            .map(|tiles| Band::new(&layout, model, state, dt_star, tiles))
            .collect();
        let speed_square = bands
            .iter()
            .flat_map(|band| &band.tiles)
            .map(|tile| tile.sums.speed_square)
            .fold(0.0, f64::max);
        let sum = |v: &[f64]| v.iter().sum();
        let latest = Totals {
            velocity_after: state.map_or([0.0; 2], |state| [sum(&state.velocity.x), sum(&state.velocity.y)]),
            ..Totals::default()
        };
        let mut kernel = Self {
            layout,
            dt_star,
            bands,
            level,
            skips,
            has_moving_neighbour: vec![false; n_tiles],
            needs_springs: vec![false; n_tiles],
            active_from_step: 0,
            swept: None,
            springs: None,
            latest,
            extent: [f64::NEG_INFINITY; 4],
            growth: 0.0,
            strain_limits: [Series::<3>::strain_limit(), Series::<7>::strain_limit()],
            speed: speed_square.sqrt(),
            stress_square_max: 0.0,
        };
        kernel.copy_ghosts();
        kernel
    }

    /// Goes to step `number`: the next one, or 0 to begin with.
    pub(crate) fn step(&mut self, model: &Model, number: u64, energies: bool) -> Totals {
        let mut step = Step::new(model, number, self.dt_star);
        if self.swept.is_none() {
            // At the start displacements are those of t_0 already.
            step.moves = 0.0;
        }
        let springs = self.choose_springs(model, &step);
        // A tile at rest keeps the energy of its springs, which is to be that of the springs of today, to the last bit.
        let anew = self.springs != Some(springs);
        if !self.skips || anew || number >= self.active_from_step {
            self.schedule_tiles(number, anew);
            self.record_skipped_stress_maxima(model, number);
            self.fill_halos(step.moves);
            let level = self.level;
            for_each(&mut self.bands, &|band| {
                sweep(level, band, model, step, springs, energies);
            });
            self.copy_ghosts();
            (self.swept, self.springs) = (Some(number), Some(springs));
            self.add_up();
        }
        Totals {
            stored_energy: energies.then(|| self.stored_energy(step)),
            ..self.latest
        }
    }

    /// Springs of a step: by a bound on all differences of displacement, from their extent at the latest look and the
    /// highest speeds since. To be asked at every step, swept or not, so that skipping does not change the answer.
    fn choose_springs(&mut self, model: &Model, step: &Step) -> Springs {
        if step.number.is_multiple_of(EXTENT_INTERVAL) {
            let mut extent = [f64::NEG_INFINITY; 4];
            for_each(&mut self.bands, &Band::measure_extents);
            for tile in self.bands.iter().flat_map(|band| &band.tiles) {
                for (most, value) in extent.iter_mut().zip(tile.extent) {
                    *most = most.max(value);
                }
            }
            (self.extent, self.growth) = (extent, 0.0);
        }
        self.growth += 2.0 * step.moves * self.speed;
        let [right, left, top, bottom] = self.extent;
        let (ex, ey) = (right + left + self.growth, top + bottom + self.growth);
        // |eps s|/d^2 of any spring.
        let strain = model.epsilon * (2.0 * (ex + ey) + model.epsilon * (ex * ex + ey * ey));
        if strain <= self.strain_limits[0] {
            Springs::ShortSeries
        } else if strain <= self.strain_limits[1] {
            Springs::LongSeries
        } else {
            Springs::SquareRoot
        }
    }

    /// Tells every tile what to do in the sweep to step `number`: all are swept `anew` where springs are no longer computed
    /// as before.
    fn schedule_tiles(&mut self, number: u64, anew: bool) {
        let begins = self.swept.is_none();
        let follows = self.swept.is_some_and(|swept| swept + 1 == number);
        let Self {
            layout,
            bands,
            has_moving_neighbour,
            needs_springs,
            ..
        } = self;
        has_moving_neighbour.fill(false);
        needs_springs.fill(false);
        for band in bands.iter() {
            band.mark_moving_neighbours(layout, has_moving_neighbour);
        }
        for band in bands.iter_mut() {
            for t in 0..band.tiles.len() {
                let moved = has_moving_neighbour[band.first_tile + t];
                let (tile, task) = (&band.tiles[t], &mut band.tasks[t]);
                let rested = !(begins || follows && task.active);
                task.active = !self.skips || anew || moved || tile.active_from_step <= number;
                task.was_skipped = task.active && rested;
                task.newly_resting = self.skips && task.active && !moved;
                if task.active {
                    let elements = band.elements(t);
                    let (first, last) = (band.first + elements.start, band.first + elements.end - 1);
                    needs_springs[band.first_tile + t] = true;
                    layout
                        .tiles_below(first, last)
                        .for_each(|tile| needs_springs[tile] = true);
                }
            }
        }
        for band in bands.iter_mut() {
            for (task, &needs_springs) in band.tasks.iter_mut().zip(&needs_springs[band.first_tile..]) {
                task.needs_springs = needs_springs;
            }
        }
    }

    /// Contact stresses of the tiles that were left alone up to the step before `number`. They are largest at the beginning,
    /// which a sweep has seen, or at the end: at the next step the block that bears most may slide already.
    fn record_skipped_stress_maxima(&mut self, model: &Model, number: u64) {
        for band in &self.bands {
            for t in (0..band.tiles.len()).filter(|&t| band.tasks[t].was_skipped) {
                let step = Step::new(model, number - 1, self.dt_star);
                self.stress_square_max = self.stress_square_max.max(band.resting_stress_square(t, &step));
            }
        }
    }

    /// Displacements beyond the ends of every band, as they will be in the coming step. Those beyond a free edge stay zero:
    /// no spring leads there.
    fn fill_halos(&mut self, moves: f64) {
        if self.bands.len() == 1 && !self.layout.is_periodic_along_y() {
            return;
        }
        let (n, halo) = (self.layout.len() as isize, self.bands[0].halo);
        for b in 0..self.bands.len() {
            let (first, len) = (self.bands[b].first as isize, self.bands[b].len);
            // Behind the last row stand elements of the band's last vector already.
            let rows = len.min(self.layout.len() - self.bands[b].first);
            for k in (0..halo).chain(halo + rows..halo + len + halo) {
                let element = first + k as isize - halo as isize;
                let wrapped = element.rem_euclid(n);
                if wrapped == element || self.layout.is_periodic_along_y() {
                    let (other, at) = self.find(wrapped as usize);
                    let u = self.bands[other].advanced(at, moves);
                    self.bands[b].displacement.set(k, u);
                }
            }
        }
    }

    /// Band of an element, and its place there.
    fn find(&self, element: usize) -> (usize, usize) {
        let band = self.bands.partition_point(|band| band.first <= element) - 1;
        (band, element - self.bands[band].first)
    }

    /// Ghosts move as the blocks that they copy.
    fn copy_ghosts(&mut self) {
        if !self.layout.has_ghosts() {
            return;
        }
        for j in 0..self.layout.rows() {
            for (ghost, copied) in self.layout.ghosts_of_row(j) {
                let ((from, at), (to, k)) = (self.find(copied), self.find(ghost));
                let band = &self.bands[from];
                let (u, v) = (band.displacement.at(band.halo + at), band.velocity.at(at));
                let band = &mut self.bands[to];
                band.displacement.set(band.halo + k, u);
                band.velocity.set(k, v);
                band.set_moving(k, v != [0.0, 0.0]);
            }
        }
    }

    /// Sums over the lattice of what the tiles know after a sweep.
    fn add_up(&mut self) {
        let before = self.latest.velocity_after;
        let (mut totals, mut speed_square, mut active_from_step) = (Totals::default(), 0.0_f64, u64::MAX);
        for tile in self.bands.iter().flat_map(|band| &band.tiles) {
            let sums = &tile.sums;
            for axis in 0..2 {
                totals.displacement[axis] += sums.displacement[axis];
                totals.velocity_after[axis] += sums.velocity[axis];
            }
            totals.velocity_square += 0.25 * sums.motion_square;
            totals.friction_power += 0.5 * sums.friction_work;
            totals.n_sliding += sums.sliding as usize;
            totals.n_slipping += sums.slipping as usize;
            speed_square = speed_square.max(sums.speed_square);
            self.stress_square_max = self.stress_square_max.max(sums.stress_square);
            active_from_step = active_from_step.min(if tile.moving { 0 } else { tile.active_from_step });
        }
        let after = totals.velocity_after;
        totals.velocity = [0.5 * (before[0] + after[0]), 0.5 * (before[1] + after[1])];
        (self.latest, self.speed, self.active_from_step) = (totals, speed_square.sqrt(), active_from_step);
    }

    /// Energies held at the present step.
    fn stored_energy(&mut self, step: Step) -> StoredEnergy {
        // The springs of the drive stretch on while a tile is left alone.
        let (level, swept) = (self.level, self.swept == Some(step.number));
        for_each(&mut self.bands, &|band| {
            dispatch!(level, simd => band.stretch_at_rest(simd, step, swept));
        });
        let (mut velocity_squares, mut lattice, mut stretch_square) = (0.0, 0.0, 0.0);
        for tile in self.bands.iter().flat_map(|band| &band.tiles) {
            velocity_squares += tile.sums.velocity_squares;
            lattice += tile.sums.lattice_energy;
            stretch_square += tile.sums.stretch_square;
        }
        StoredEnergy {
            kinetic: 0.25 * velocity_squares,
            lattice: lattice / (2.0 * K_STRAIGHT),
            drive_springs: 0.5 * step.k_drive * stretch_square,
        }
    }

    /// Largest square of a contact stress of a block in contact up to step `number`, the present one.
    pub(crate) fn stress_square_max(&self, model: &Model, number: u64) -> f64 {
        let step = Step::new(model, number, self.dt_star);
        let mut square = self.stress_square_max;
        for band in &self.bands {
            let rests = |&t: &usize| self.swept != Some(number) || !band.tasks[t].active;
            for t in (0..band.tiles.len()).filter(rests) {
                square = square.max(band.resting_stress_square(t, &step));
            }
        }
        square
    }

    /// Displacement now and velocity half a step later of block `b`.
    pub(crate) fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        let (band, k) = self.find(self.layout.element_of(b));
        let band = &self.bands[band];
        [band.displacement.at(band.halo + k), band.velocity.at(k)]
    }

    /// When block `b` first slid while in contact; not a number if it never has.
    pub(crate) fn first_slip(&self, b: usize) -> f64 {
        let (band, k) = self.find(self.layout.element_of(b));
        self.bands[band].first_slip[k]
    }
}

/// The same work for every band, shared out among the threads of the pool.
fn for_each(bands: &mut [Band], work: &(impl Fn(&mut Band) + Sync)) {
    match bands {
        [] => {}
        [band] => work(band),
        _ => {
            let (one, other) = bands.split_at_mut(bands.len() / 2);
            rayon::join(|| for_each(one, work), || for_each(other, work));
        }
    }
}

/// One band through a step, with the widest instructions at hand.
fn sweep(level: Level, band: &mut Band, model: &Model, step: Step, springs: Springs, energies: bool) {
    let epsilon = model.epsilon;
    match springs {
        Springs::ShortSeries => {
            let geometry = Series::<3> { epsilon };
            dispatch!(level, simd => band.sweep(simd, geometry, model, step, energies));
        }
        Springs::LongSeries => {
            let geometry = Series::<7> { epsilon };
            dispatch!(level, simd => band.sweep(simd, geometry, model, step, energies));
        }
        Springs::SquareRoot => {
            let geometry = SquareRoot { epsilon };
            dispatch!(level, simd => band.sweep(simd, geometry, model, step, energies));
        }
    }
}
