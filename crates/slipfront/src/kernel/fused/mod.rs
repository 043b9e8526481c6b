//! The fast kernel: the equations of [`reference`](super::reference) in one sweep over the blocks.
//!
//! Blocks are stored row after row in one array ([`layout`]), divided into tiles of 256 elements. A sweep takes tile after tile
//! through a step ([`band`]): displacements, springs, friction and all sums, eight blocks at a time ([`blocks`]), each spring
//! once. Spring forces come from a series where that is as exact as the square root ([`springs`]). A tile at rest with nothing
//! moving around it is skipped until one of its blocks can slip ([`rest`]). Every thread sweeps a band of tiles.
//!
//! A step must read displacement, velocity and two thresholds of every block and write displacement and velocity: 80 bytes,
//! which bounds the speed on a lattice larger than the cache (`examples/large_step.rs`). Spring forces pass through a ring
//! buffer that stays in the cache.
//!
//! The trajectory has the same bits for any number of threads and any SIMD width, whether tiles are skipped or not: sums are
//! sums over tiles, and the choice between series and square root is made for the whole lattice.

mod aligned;
mod band;
mod blocks;
mod fields;
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
use crate::checkpoint::{BlockColumn, Checkpoint, StrainBound};
use crate::kernel::block::{Block, Field};
use crate::kernel::engine::Engine;
use crate::kernel::totals::{StoredEnergy, Totals};
use crate::lattice::K_STRAIGHT;
use crate::model::Model;
use crate::state::State;

/// Steps between two measurements of the extent of displacements; in between it is bounded.
const EXTENT_INTERVAL: u64 = 16;

/// How spring forces are computed in a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Springs {
    /// Small strains: 1e-4 and less.
    ShortSeries,
    /// Up to 1e-2.
    LongSeries,
    /// At any strain.
    SquareRoot,
}

/// The state of all blocks and the way to step them.
#[derive(Debug)]
pub(crate) struct Fused {
    layout: Layout,
    dt_star: f64,
    bands: Vec<Band>,
    level: Level,
    /// Whether tiles at rest are skipped.
    skips: bool,
    /// For every tile, whether one of its blocks or a neighbour of one moves.
    has_moving_neighbour: Vec<bool>,
    /// For every tile, whether a tile in the sweep needs its springs.
    needs_springs: Vec<bool>,
    /// The first step at which a block may slip, if nothing moves.
    active_from_step: u64,
    /// Step of the latest sweep.
    swept_step: Option<u64>,
    /// How the latest sweep computed springs.
    springs: Option<Springs>,
    /// Sums of the latest sweep.
    totals: Totals,
    strain_bound: StrainBound,
    /// Largest strains for the short and for the long series.
    strain_limits: [f64; 2],
    stress_square_max: f64,
}

impl Fused {
    /// Begins in a given state, or at rest; the blocks are divided among `threads`.
    pub(crate) fn new(
        model: &Model,
        dt_star: f64,
        state: Option<&State>,
        threads: usize,
        skips: bool,
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
        let totals = Totals {
            velocity_after: state.map_or([0.0; 2], |state| [sum(&state.velocity.x), sum(&state.velocity.y)]),
            ..Totals::default()
        };
        let mut kernel = Self {
            layout,
            dt_star,
            bands,
            level: Level::new(),
            skips,
            has_moving_neighbour: vec![false; n_tiles],
            needs_springs: vec![false; n_tiles],
            active_from_step: 0,
            swept_step: None,
            springs: None,
            totals,
            strain_bound: StrainBound {
                extent: [f64::NEG_INFINITY; 4],
                growth: 0.0,
                speed: speed_square.sqrt(),
            },
            strain_limits: [Series::<3>::strain_limit(), Series::<7>::strain_limit()],
            stress_square_max: 0.0,
        };
        kernel.copy_ghosts();
        kernel.fill_halos(0.0);
        kernel
    }

    /// Continues from a checkpoint. Every tile is swept at the next step, also those that could be skipped: both give the same
    /// bits. The step of the checkpoint counts as one in which all tiles were swept.
    pub(crate) fn resume<E>(
        model: &Model,
        dt_star: f64,
        checkpoint: &Checkpoint,
        strain_bound: StrainBound,
        threads: usize,
        skips: bool,
        mut read: impl FnMut(BlockColumn, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut kernel = Self::new(model, dt_star, None, threads, skips);
        BlockColumn::for_each_part(model.lattice.n_blocks(), |column, first, values| {
            read(column, first, values)?;
            for band in &mut kernel.bands {
                band.set_column(&kernel.layout, column, first, values);
            }
            Ok(())
        })?;
        for band in &mut kernel.bands {
            band.resume();
        }
        kernel.copy_ghosts();
        kernel.fill_halos(0.0);
        Ok(Self {
            totals: checkpoint.totals,
            stress_square_max: checkpoint.stress_square_max,
            swept_step: Some(checkpoint.step),
            strain_bound,
            ..kernel
        })
    }

    /// How to compute springs in a step, by the bound on all strains. It must be called at every step, swept or not, so that
    /// skipping does not change the choice.
    fn choose_springs(&mut self, model: &Model, step: &Step) -> Springs {
        if step.number.is_multiple_of(EXTENT_INTERVAL) {
            let mut extent = [f64::NEG_INFINITY; 4];
            for_each_band(&mut self.bands, &Band::measure_extents);
            for tile in self.bands.iter().flat_map(|band| &band.tiles) {
                for (most, value) in extent.iter_mut().zip(tile.extent) {
                    *most = most.max(value);
                }
            }
            (self.strain_bound.extent, self.strain_bound.growth) = (extent, 0.0);
        }
        self.strain_bound.growth += 2.0 * step.move_dt * self.strain_bound.speed;
        let strain = self.strain_bound.max_strain(model.epsilon);
        if strain <= self.strain_limits[0] {
            Springs::ShortSeries
        } else if strain <= self.strain_limits[1] {
            Springs::LongSeries
        } else {
            Springs::SquareRoot
        }
    }

    /// Decides what is done with every tile in the sweep to step `number`. All are swept if the formula of springs has changed.
    fn schedule_tiles(&mut self, number: u64, springs_changed: bool) {
        let begins = self.swept_step.is_none();
        let follows = self.swept_step.is_some_and(|swept| swept + 1 == number);
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
                task.active = !self.skips || springs_changed || moved || tile.active_from_step <= number;
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

    /// Contact stresses of the tiles that were skipped up to the step before `number`. They are largest at the first skipped
    /// step, which the sweep before has measured, or at the last: at the next step the block with the largest may slide
    /// already.
    fn record_skipped_stress_maxima(&mut self, model: &Model, number: u64) {
        for band in &self.bands {
            for t in (0..band.tiles.len()).filter(|&t| band.tasks[t].was_skipped) {
                let step = Step::new(model, number - 1, self.dt_star);
                self.stress_square_max = self.stress_square_max.max(band.resting_stress_square(t, &step));
            }
        }
    }

    /// Displacements beyond the ends of every band, as they will be after moving by `move_dt`. Those beyond a free edge stay
    /// zero: no spring leads there.
    fn fill_halos(&mut self, move_dt: f64) {
        if self.bands.len() == 1 && !self.layout.is_periodic_along_y() {
            return;
        }
        let (n, halo) = (self.layout.len() as isize, self.bands[0].halo);
        for b in 0..self.bands.len() {
            let (first, len) = (self.bands[b].first as isize, self.bands[b].len);
            // The last vector of a band may extend beyond the last row.
            let rows = len.min(self.layout.len() - self.bands[b].first);
            for k in (0..halo).chain(halo + rows..halo + len + halo) {
                let element = first + k as isize - halo as isize;
                let wrapped = element.rem_euclid(n);
                if wrapped == element || self.layout.is_periodic_along_y() {
                    let (other, at) = self.locate(wrapped as usize);
                    let u = self.bands[other].advanced(at, move_dt);
                    self.bands[b].displacement.set(k, u);
                }
            }
        }
    }

    /// Band of an element, and its index there.
    fn locate(&self, element: usize) -> (usize, usize) {
        let band = self.bands.partition_point(|band| band.first <= element) - 1;
        (band, element - self.bands[band].first)
    }

    /// Copies displacements and velocities to the ghosts from their blocks.
    fn copy_ghosts(&mut self) {
        if !self.layout.has_ghosts() {
            return;
        }
        for j in 0..self.layout.rows() {
            for (ghost, copied) in self.layout.ghosts_of_row(j) {
                let ((from, at), (to, k)) = (self.locate(copied), self.locate(ghost));
                let band = &self.bands[from];
                let (u, v) = (band.displacement.at(band.halo + at), band.velocity.at(at));
                let band = &mut self.bands[to];
                band.displacement.set(band.halo + k, u);
                band.velocity.set(k, v);
                band.set_moving(k, v != [0.0, 0.0]);
            }
        }
    }

    /// Sums over the lattice, from those over the tiles after a sweep.
    fn sum_tiles(&mut self) {
        let before = self.totals.velocity_after;
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
        (self.totals, self.strain_bound.speed, self.active_from_step) =
            (totals, speed_square.sqrt(), active_from_step);
    }

    /// Energies stored at the present step.
    fn stored_energy(&mut self, step: Step) -> StoredEnergy {
        // The drive springs of skipped tiles stretch, too.
        let (level, swept) = (self.level, self.swept_step == Some(step.number));
        for_each_band(&mut self.bands, &|band| {
            dispatch!(level, simd => band.update_skipped_stretch(simd, step, swept));
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
            drive_springs: 0.5 * step.drive.k_drive * stretch_square,
        }
    }
}

impl Engine for Fused {
    fn step(&mut self, model: &Model, number: u64, energies: bool) -> Totals {
        let mut step = Step::new(model, number, self.dt_star);
        if self.swept_step.is_none() {
            // At the start displacements are those of t_0 already.
            step.move_dt = 0.0;
        }
        let springs = self.choose_springs(model, &step);
        // Skipped tiles keep the energy of their springs. After a change of formula it must be found anew, to have the same bits.
        let springs_changed = self.springs != Some(springs);
        if !self.skips || springs_changed || number >= self.active_from_step {
            self.schedule_tiles(number, springs_changed);
            self.record_skipped_stress_maxima(model, number);
            self.fill_halos(step.move_dt);
            let level = self.level;
            for_each_band(&mut self.bands, &|band| {
                sweep(level, band, model.epsilon, step, springs, energies);
            });
            self.copy_ghosts();
            (self.swept_step, self.springs) = (Some(number), Some(springs));
            self.sum_tiles();
        }
        Totals {
            stored_energy: energies.then(|| self.stored_energy(step)),
            ..self.totals
        }
    }

    fn block(&self, model: &Model, number: u64, b: usize) -> Block {
        fields::block(model, number as f64 * self.dt_star, b, |b| self.motion(b))
    }

    fn read_rows(
        &self,
        model: &Model,
        number: u64,
        field: Field,
        stride: usize,
        write: &mut dyn FnMut(usize, usize, &[f32]),
    ) {
        let step = Step::new(model, number, self.dt_star);
        let elements = (&self.layout, self.bands.as_slice());
        dispatch!(self.level, simd => fields::read_rows(simd, model, step, field, stride, elements, write));
    }

    fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        let (band, k) = self.locate(self.layout.element_of(b));
        let band = &self.bands[band];
        [band.displacement.at(band.halo + k), band.velocity.at(k)]
    }

    fn first_slip(&self, b: usize) -> f64 {
        let (band, k) = self.locate(self.layout.element_of(b));
        self.bands[band].first_slip[k]
    }

    fn stress_square_max(&self, model: &Model, number: u64) -> f64 {
        let step = Step::new(model, number, self.dt_star);
        let mut square = self.stress_square_max;
        for band in &self.bands {
            let is_skipped = |&t: &usize| self.swept_step != Some(number) || !band.tasks[t].active;
            for t in (0..band.tiles.len()).filter(is_skipped) {
                square = square.max(band.resting_stress_square(t, &step));
            }
        }
        square
    }

    fn strain_bound(&self) -> Option<StrainBound> {
        Some(self.strain_bound)
    }

    fn checkpoint_velocity(&self, b: usize) -> [f64; 2] {
        self.motion(b)[1]
    }
}

/// Runs `work` on every band, on the threads of the pool.
fn for_each_band(bands: &mut [Band], work: &(impl Fn(&mut Band) + Sync)) {
    match bands {
        [] => {}
        [band] => work(band),
        _ => {
            let (one, other) = bands.split_at_mut(bands.len() / 2);
            rayon::join(|| for_each_band(one, work), || for_each_band(other, work));
        }
    }
}

/// Takes a band through a step with the vector instructions of `level`.
fn sweep(level: Level, band: &mut Band, epsilon: f64, step: Step, springs: Springs, energies: bool) {
    match springs {
        Springs::ShortSeries => {
            dispatch!(level, simd => band.sweep(simd, Series::<3> { epsilon }, step, energies));
        }
        Springs::LongSeries => {
            dispatch!(level, simd => band.sweep(simd, Series::<7> { epsilon }, step, energies));
        }
        Springs::SquareRoot => {
            dispatch!(level, simd => band.sweep(simd, SquareRoot { epsilon }, step, energies));
        }
    }
}
