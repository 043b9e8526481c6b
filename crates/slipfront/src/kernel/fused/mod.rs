//! The fast kernel: the equations of [`general`](super::general) in one sweep over the blocks, by the crate
//! [`slipfront_kernel`]. Here are the bands that threads share out, the rows of other ranks ([`neighbours`]),
//! sums over all bands, and what the kernel asks about a model ([`properties`]).
//!
//! The trajectory has the same bits for any number of ranks and threads and any SIMD width, whether vectors
//! are skipped or not: sums are sums of integers, and the choice between series and square root is made for
//! the whole lattice.

mod columns;
mod fields;
pub(crate) mod for_tests;
mod neighbours;
mod properties;

use std::convert::Infallible;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicU32;

use fearless_simd::Level;
use slipfront_kernel::fixed_point::{FixedPoint, join, split};
use slipfront_kernel::{
    Band, Integrator, LANES, LargestFactors, Layout, MotionBounds, NEVER, Quanta, Springs, Step, Sums,
    SweepConditions, TILE, Vectors, halo, measure_displacements,
};

use self::neighbours::Neighbours;
use self::properties::ModelBlocks;
pub(crate) use self::properties::{blocks_differ, largest_factors};
use crate::checkpoint::{BlockColumn, Checkpoint};
use crate::clock::Clock;
use crate::communicator::{Alone, Communicator};
use crate::device::{DeviceLattice, Motion};
use crate::kernel::bands::for_each_band;
use crate::kernel::block::{Block, Field};
use crate::kernel::engine::{Engine, TakeSliding};
use crate::kernel::vectors;
use crate::lattice::K_STRAIGHT;
use crate::model::Model;
use crate::moduli::Moduli;
use crate::parallel::*;
use crate::position_bins::PositionBins;
use crate::state::State;
use crate::totals::{StoredEnergy, Totals};

/// Number of steps between two measurements of displacements and their differences; in between, bounds are
/// used.
const MEASUREMENT_INTERVAL: u64 = 16;

/// The state of the blocks of a rank and the data to step them.
#[derive(Debug)]
pub(crate) struct Fused {
    layout: Layout,
    dt_star: f64,
    bands: Vec<Band>,
    /// Bands that need no data from other ranks.
    inner: Range<usize>,
    /// Number of threads that share the bands.
    threads: usize,
    level: Level,
    /// Whether tiles at rest are skipped.
    skips: bool,
    /// For every tile, the mask of the vectors that have a moving block or a neighbour of one.
    touched: Vec<AtomicU32>,
    /// The first step at which a block may slip, if nothing moves.
    active_from_step: u64,
    /// Step of the latest sweep.
    swept_step: Option<u64>,
    /// Formula by which the latest sweep computed springs.
    springs: Option<Springs>,
    /// Whether the first step has begun, since the start or since a checkpoint.
    has_begun: bool,
    /// Sums of the latest sweep, and their quanta.
    sums: Option<(Sums<i128, f64, u64>, Quanta)>,
    /// `sums` as floating-point totals.
    totals: Totals,
    motion_bounds: MotionBounds,
    /// Largest strains for the short and for the long series.
    strain_limits: [f64; 2],
    stress_square_max: f64,
    /// The rows below and above the rows of this rank.
    neighbours: Neighbours,
    largest: LargestFactors,
    /// Sum of the relative stiffness of all drive springs: the number of blocks if all are equal.
    drive_springs: f64,
}

impl Fused {
    /// Begins in a given state, or at rest; the blocks are divided among `threads`.
    pub(crate) fn new(
        model: &Model,
        dt_star: f64,
        state: Option<&State>,
        threads: usize,
        skips: bool,
        communicator: Arc<dyn Communicator>,
    ) -> Self {
        let layout = Layout::new(&model.lattice, &model.rows);
        let (tiles, inner) = bands_of(&layout, threads);
        let neighbours = Neighbours::new(communicator, &layout);
        let moduli = Moduli::new(
            &model.slider,
            &model.lattice,
            &model.rows,
            &*neighbours.communicator,
        );
        let largest = largest_factors(model, &*neighbours.communicator);
        let differ = blocks_differ(model, &largest);
        let blocks = ModelBlocks {
            model,
            moduli: &moduli,
            state,
        };
        let properties = blocks.properties(differ, dt_star);
        let band = |tiles| Band::new(&layout, &properties, tiles);
        let bands: Vec<Band> = match threads {
            1 => tiles.into_iter().map(band).collect(),
            _ => tiles.into_par_iter().map(band).collect(),
        };
        let speed_square = bands
            .iter()
            .flat_map(|band| &band.tiles)
            .map(|tile| tile.sums.speed_square)
            .fold(0.0, f64::max);
        let mut kernel = Self {
            layout,
            dt_star,
            bands,
            inner,
            threads,
            level: vectors::level(),
            // Nothing rests in an upright sheet, which moves freely along y.
            skips: skips && model.friction.interface().is_none(),
            touched: (0..layout.n_tiles()).map(|_| AtomicU32::new(0)).collect(),
            active_from_step: 0,
            swept_step: None,
            springs: None,
            has_begun: false,
            sums: None,
            totals: Totals::default(),
            motion_bounds: MotionBounds {
                speed: speed_square.sqrt(),
                ..MotionBounds::default()
            },
            strain_limits: Springs::strain_limits(),
            stress_square_max: 0.0,
            largest,
            drive_springs: model.slider.sum_of_drive_springs(&model.lattice),
            neighbours,
        };
        // Later, ghosts and halos are updated where blocks move; at rest they must be set once.
        kernel.copy_ghosts(true);
        kernel.fill_halos(0.0, true);
        kernel
    }

    /// Bounds and the sum of velocities at the start of a run of a whole lattice, in a given state or at
    /// rest.
    pub(crate) fn begun(model: &Model, dt_star: f64, state: Option<&State>) -> (MotionBounds, [f64; 2]) {
        let Some(state) = state else {
            return (MotionBounds::default(), [0.0; 2]);
        };
        let mut kernel = Self::new(model, dt_star, Some(state), 1, false, Arc::new(Alone));
        kernel.begin(model);
        (kernel.motion_bounds, kernel.totals.velocity_after)
    }

    /// Continues a lattice after the latest of its steps, or begins it, on `threads` threads.
    pub(crate) fn of_device(lattice: &DeviceLattice, threads: usize) -> Self {
        let (model, dt_star) = (&*lattice.model, lattice.equations.dt_star);
        let Some(latest) = lattice.steps_done.checked_sub(1) else {
            return Self::new(
                model,
                dt_star,
                Some(&lattice.state),
                threads,
                true,
                Arc::new(Alone),
            );
        };
        let mut kernel = Self::new(model, dt_star, None, threads, true, Arc::new(Alone));
        let Ok(()) = BlockColumn::for_each_part::<Infallible>(model, |_, column, first, values| {
            lattice.read_column(column, first, values);
            kernel.set_column(column, first, values);
            Ok(())
        });
        let mut kernel = kernel.resumed();
        kernel.swept_step = Some(latest);
        kernel.motion_bounds = MotionBounds::from_numbers(lattice.motion.bounds);
        kernel.totals.velocity_after = lattice.motion.velocity_after;
        kernel.stress_square_max = lattice.motion.stress_square_max;
        kernel
    }

    /// Numbers of the lattice after the latest step, at the instant `clock`, before the instant `next`.
    pub(crate) fn motion_of_device(&self, model: &Model, clock: &Clock, next: &Clock) -> Motion {
        Motion {
            bounds: self.motion_bounds.to_numbers(),
            velocity_after: self.totals.velocity_after,
            // With the tiles that were skipped.
            stress_square_max: self.stress_square_max(model, clock),
            drive_steps: next.drive_steps,
            drive_moves: next.drive_moved().into(),
        }
    }

    /// Continues from a checkpoint. Every tile is swept at the next step, including those that could be
    /// skipped: both give the same bits. The step of the checkpoint counts as one in which all tiles were
    /// swept.
    pub(crate) fn resume<E>(
        model: &Model,
        dt_star: f64,
        checkpoint: &Checkpoint,
        threads: usize,
        skips: bool,
        communicator: Arc<dyn Communicator>,
        mut read: impl FnMut(usize, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut kernel = Self::new(model, dt_star, None, threads, skips, communicator);
        BlockColumn::for_each_part(model, |number, column, first, values| {
            read(number, first, values)?;
            kernel.set_column(column, first, values);
            Ok(())
        })?;
        Ok(Self {
            totals: checkpoint.totals,
            stress_square_max: checkpoint.stress_square_max,
            swept_step: Some(checkpoint.step),
            motion_bounds: checkpoint.motion_bounds.unwrap_or_default(),
            ..kernel.resumed()
        })
    }

    /// Sets a column of the blocks from `first` on.
    pub(crate) fn set_column(&mut self, column: BlockColumn, first: usize, values: &[f64]) {
        for band in &mut self.bands {
            columns::set_column(band, &self.layout, self.dt_star, column, first, values);
        }
    }

    /// Completes the kernel with everything that follows from the columns set.
    pub(crate) fn resumed(mut self) -> Self {
        for band in &mut self.bands {
            columns::resume(band);
        }
        self.copy_ghosts(true);
        self.fill_halos(0.0, true);
        self
    }

    /// Chooses the formula for springs in a step from the bound on all strains; returns it, and whether sums
    /// have other quanta than before. Must be called at every step, swept or not, so that skipping does not
    /// change the choice.
    fn choose_springs(&mut self, model: &Model, step: &Step) -> (Springs, bool) {
        let bounds = &mut self.motion_bounds;
        if step.number.is_multiple_of(MEASUREMENT_INTERVAL) {
            let level = self.level;
            for_each_band(self.threads, &mut self.bands, &|band| {
                measure_displacements(level, band);
            });
            let mut largest = [f64::NEG_INFINITY; 6];
            for band in &self.bands {
                let ([right, left, up, down], [along_x, along_y]) = (band.extent, band.difference);
                for (most, value) in largest.iter_mut().zip([right, left, up, down, along_x, along_y]) {
                    *most = most.max(value);
                }
            }
            self.neighbours.communicator.largest(&mut largest);
            let [right, left, up, down, along_x, along_y] = largest;
            (bounds.extent, bounds.difference) = ([right, left, up, down], [along_x, along_y]);
            bounds.growth = 0.0;
        }
        // Between measurements the ends of a spring move apart by at most twice the highest speed.
        bounds.growth += 2.0 * step.move_dt * bounds.speed;
        let strain = self.motion_bounds.max_strain(model.epsilon);
        let springs = Springs::up_to(strain, self.strain_limits);
        (springs, self.motion_bounds.move_ranges())
    }

    /// Sweeps all bands to a step. Bands that need no data from other ranks are swept while the rows next to
    /// those of this rank are being received.
    fn sweep(&mut self, model: &Model, step: Step, springs: Springs, renews_sums: bool, energies: bool) {
        let schedule = SweepConditions {
            number: step.number,
            skips: self.skips,
            renews_sums,
            is_first: self.swept_step.is_none(),
            is_next: self.swept_step.is_some_and(|swept| swept + 1 == step.number),
        };
        let (level, quanta) = (self.level, Quanta::new(&step, &self.motion_bounds, &self.largest));
        let (threads, layout) = (self.threads, self.layout);
        let touched = self.touched.as_slice();
        for_each_band(threads, &mut self.bands, &|band| {
            band.mark_touched(&layout, touched);
        });
        // Displacements after the coming move: no band of the sweep then reads what another writes.
        self.fill_halos(step.move_dt, false);
        self.write_own_rows(step.move_dt);

        let touched = self.touched.as_slice();
        let sweep = |band: &mut Band| {
            band.schedule(&schedule, touched);
            slipfront_kernel::sweep(level, band, springs, model.epsilon, step, &quanta, energies);
        };
        // Bands at the ends of the rank wait for the rows of other ranks. Blocks that move there are marked
        // when they are received, which affects tiles of these bands alone.
        let (first, others) = self.bands.split_at_mut(self.inner.start);
        let (inner, last) = others.split_at_mut(self.inner.len());
        self.neighbours
            .exchange(&layout, &mut || for_each_band(threads, inner, &sweep));
        for &element in &self.neighbours.moved {
            layout.mark_around(element, element, touched);
        }
        for bands in [first, last] {
            fill_from_neighbours(bands, &layout, &self.neighbours);
            for_each_band(threads, bands, &sweep);
        }
        self.copy_ghosts(false);
        (self.swept_step, self.springs) = (Some(step.number), Some(springs));
        self.sum_bands(&quanta);
    }

    /// Sets the displacements beyond the ends of every band to their values after moving by `move_dt`: for
    /// `all` elements of this rank, or for those that move. Displacements beyond a free edge stay zero: no
    /// spring leads there.
    fn fill_halos(&mut self, move_dt: f64, all: bool) {
        if self.bands.len() == 1 && !self.layout.wraps_along_y() {
            return;
        }
        for b in 0..self.bands.len() {
            let (layout, halos) = (self.layout, self.bands[b].halos(&self.layout));
            for elements in halos {
                for (start, piece) in layout.pieces(elements.start, elements.end - 1) {
                    self.fill_halo(b, self.bands[b].halo_index(start), piece, move_dt, all);
                }
            }
        }
    }

    /// Exchanges with other ranks the values that the first step needs, also after a checkpoint.
    fn begin(&mut self, model: &Model) {
        self.has_begun = true;
        self.write_own_rows(0.0);
        self.neighbours.exchange(&self.layout, &mut || ());
        fill_from_neighbours(&mut self.bands, &self.layout, &self.neighbours);
        if self.swept_step.is_some() {
            return;
        }
        let communicator = &*self.neighbours.communicator;
        let speed = communicator.largest_of(self.motion_bounds.speed);
        self.motion_bounds.speed = speed;
        if speed == 0.0 {
            return;
        }
        let fixed_point = FixedPoint::new(self.largest.drive_spring * speed);
        for axis in 0..2 {
            let mut sum = 0;
            for b in 0..self.layout.n_own_blocks() {
                let velocity = model.slider.drive_spring(b) * self.motion(b)[1][axis];
                sum += i128::from(fixed_point.integer(velocity));
            }
            let mut words = split(sum);
            communicator.sum(&mut words);
            self.totals.velocity_after[axis] = fixed_point.value(join(words));
        }
    }

    /// Writes the displacements of the first and the last row of this rank after moving by `move_dt`, for the
    /// neighbouring ranks.
    fn write_own_rows(&mut self, move_dt: f64) {
        let (stride, len) = (self.layout.stride, self.layout.n_elements());
        for (end, first) in [0, len - stride].into_iter().enumerate() {
            // Nothing beyond a free edge.
            for k in 0..self.neighbours.own[end].len() {
                let (band, at) = self.locate(first + k);
                self.neighbours.own[end][k] = self.bands[band].advanced(at, move_dt);
            }
        }
    }

    /// Copies displacements of some elements to band `b`, from index `k` on.
    fn fill_halo(&mut self, b: usize, mut k: usize, elements: Range<usize>, move_dt: f64, all: bool) {
        let mut element = elements.start;
        while element < elements.end {
            let (other, at) = self.locate(element);
            let n = (LANES - at % LANES).min(elements.end - element);
            // Elements at rest were copied when they last moved.
            if all || self.bands[other].moving[at / LANES] != 0 {
                for offset in 0..n {
                    let u = self.bands[other].advanced(at + offset, move_dt);
                    self.bands[b].displacement.set(k + offset, u);
                }
            }
            (element, k) = (element + n, k + n);
        }
    }

    /// Kinetic friction of block `b` at the latest sweep.
    fn kinetic_force(&self, model: &Model, b: usize) -> f64 {
        let (band, k) = self.locate(self.layout.element_of(b));
        let velocity_to_force = Integrator::new(model.damping, self.dt_star).velocity_to_force;
        self.bands[band].kinetic_force(k, model.surface.kinetic_force(b), velocity_to_force)
    }

    /// Band of an element, and the index of the element in it.
    fn locate(&self, element: usize) -> (usize, usize) {
        let band = self.bands.partition_point(|band| band.first <= element) - 1;
        (band, element - self.bands[band].first)
    }

    /// Copies displacements and velocities from blocks to their ghosts: from `all` blocks, or from those that
    /// were swept.
    fn copy_ghosts(&mut self, all: bool) {
        if !self.layout.has_ghosts() {
            return;
        }
        for j in 0..self.layout.rows {
            for (ghost, copied) in self.layout.ghosts_of_row(j) {
                let (from, at) = self.locate(copied);
                let band = &self.bands[from];
                if !all && band.tasks[at / TILE].active >> (at % TILE / LANES) & 1 == 0 {
                    continue;
                }
                let (to, k) = self.locate(ghost);
                let (u, v) = (band.displacement.at(band.halo + at), band.velocity.at(at));
                let band = &mut self.bands[to];
                band.displacement.set(band.halo + k, u);
                band.velocity.set(k, v);
                band.set_moving(k, v != [0.0, 0.0]);
            }
        }
    }

    /// Adds up the sums of all bands after a sweep to the sums over the lattice.
    fn sum_bands(&mut self, quanta: &Quanta) {
        let (mut sums, mut active_from_step) = (Sums::<i128, f64, u64>::default(), u64::MAX);
        for band in &self.bands {
            sums.include(&band.sums);
            active_from_step = active_from_step.min(band.next_active_step);
        }
        if !self.neighbours.is_alone() {
            sums.over_ranks(&mut active_from_step, &*self.neighbours.communicator);
        }
        self.stress_square_max = self.stress_square_max.max(sums.stress_square);
        self.active_from_step = active_from_step;
        self.motion_bounds.speed = sums.speed_square.sqrt();
        let (before, after) = (
            self.totals.velocity_after,
            sums.velocity.map(|sum| quanta.velocity.value(sum)),
        );
        // Sums use differences from the centre of the window, so that a slider that has moved far loses no
        // digits.
        let displacement = |axis: usize| {
            let differences = quanta.weighted_displacement[axis].value(sums.displacement[axis]);
            self.drive_springs * quanta.displacement[axis].centre() + differences
        };
        self.totals = Totals {
            displacement: [displacement(0), displacement(1)],
            velocity: [0.5 * (before[0] + after[0]), 0.5 * (before[1] + after[1])],
            velocity_after: after,
            velocity_square: 0.25 * quanta.motion_square.value(sums.motion_square),
            friction_power: -0.5 * quanta.friction_work.value(sums.friction_work),
            n_sliding: sums.sliding as usize,
            n_slipping: sums.slipping as usize,
            stored_energy: None,
        };
        self.sums = Some((sums, *quanta));
    }

    /// Energies stored at the present step, if there was a sweep.
    fn stored_energy(&self, step: Step) -> Option<StoredEnergy> {
        let (sums, quanta) = self.sums.as_ref()?;
        // sum w (V t - u)^2 over both axes, from the sums of w (u - c) and of w (u - c)^2.
        let mut stretch_square = quanta.displacement_square.value(sums.displacement_square);
        for (axis, window) in quanta.displacement.iter().enumerate() {
            let position = step.drive_position[axis] - window.centre();
            let mean = quanta.weighted_displacement[axis].value(sums.displacement[axis]) / self.drive_springs;
            stretch_square += self.drive_springs * position * (position - 2.0 * mean);
        }
        Some(StoredEnergy {
            kinetic: 0.25 * quanta.motion_square.value(sums.velocity_squares),
            lattice: quanta.lattice_energy.value(sums.lattice_energy) / (2.0 * K_STRAIGHT),
            drive_springs: 0.5 * step.k_drive * stretch_square.max(0.0),
        })
    }
}

impl Engine for Fused {
    fn step(&mut self, model: &Model, clock: &Clock, energies: bool) -> Totals {
        let number = clock.step;
        assert!(
            number < u64::from(NEVER),
            "step {number}: runs end before step {NEVER}"
        );
        let mut step = properties::step(model, clock);
        if self.swept_step.is_none() {
            // At the start, displacements already belong to t_0.
            step.move_dt = 0.0;
        }
        if !self.has_begun {
            self.begin(model);
        }
        let (springs, windows_moved) = self.choose_springs(model, &step);
        // Skipped tiles keep their sums and the energy of their springs. After a change of quanta or formula
        // both must be computed again, to have the same bits.
        let springs_changed = windows_moved || self.springs != Some(springs);
        if !self.skips || springs_changed || number >= self.active_from_step {
            self.sweep(model, step, springs, springs_changed, energies);
        }
        let stored_energy = if energies { self.stored_energy(step) } else { None };
        Totals {
            stored_energy,
            ..self.totals
        }
    }

    fn block(&self, model: &Model, clock: &Clock, b: usize) -> Block {
        let kinetic_force = self.kinetic_force(model, b);
        fields::block(model, clock.drive_time_star(), b, kinetic_force, |b| {
            self.motion(b)
        })
    }

    fn read_rows(
        &self,
        model: &Model,
        clock: &Clock,
        field: Field,
        stride: usize,
        write: &mut dyn FnMut(usize, usize, &[f32]),
    ) {
        let how = (self.level, properties::step(model, clock));
        fields::read_rows(model, how, (field, stride), (&self.layout, &self.bands), write);
    }

    fn count_in_contact(&self, _: &Model, bins: &PositionBins, sliding: bool, counts: &mut [i64]) {
        let layout = &self.layout;
        if self.threads == 1 {
            for band in &self.bands {
                band.for_each_in_contact(layout, sliding, |i, j| counts[bins.bin(i, j)] += 1);
            }
            return;
        }
        // Each band counts in bins of its own, so that threads share none.
        let of_band = |band: &Band| {
            let mut counts = vec![0; bins.count];
            band.for_each_in_contact(layout, sliding, |i, j| counts[bins.bin(i, j)] += 1);
            counts
        };
        let of_bands: Vec<Vec<i64>> = self.bands.par_iter().map(of_band).collect();
        for of_band in of_bands {
            counts
                .iter_mut()
                .zip(of_band)
                .for_each(|(count, more)| *count += more);
        }
    }

    fn read_sliding(&self, model: &Model, take: TakeSliding) {
        fields::read_sliding(model, &self.layout, &self.bands, take);
    }

    fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        let (band, k) = self.locate(self.layout.element_of(b));
        let band = &self.bands[band];
        [band.displacement.at(band.halo + k), band.velocity.at(k)]
    }

    fn read_column(&self, time_star: f64, column: BlockColumn, first: usize, values: &mut [f64]) {
        let times = [self.dt_star, time_star];
        for band in &self.bands {
            columns::read_column(band, &self.layout, times, column, first, values);
        }
    }

    fn into_first_slips(mut self: Box<Self>) -> Vec<f64> {
        for band in &mut self.bands {
            (band.displacement, band.velocity) = (Vectors::default(), Vectors::default());
        }
        let mut first_slips = vec![0.0; self.layout.n_own_blocks()];
        // Only the memory of a law depends on the present time.
        self.read_column(f64::NAN, BlockColumn::FirstSlip, 0, &mut first_slips);
        first_slips
    }

    fn stress_square_max(&self, model: &Model, clock: &Clock) -> f64 {
        let step = properties::step(model, clock);
        let mut square = self.stress_square_max;
        for band in &self.bands {
            for (t, task) in band.tasks.iter().enumerate() {
                let skipped = if self.swept_step == Some(clock.step) {
                    !task.active
                } else {
                    u32::MAX
                };
                if skipped != 0 {
                    square = square.max(band.resting_stress_square(t, skipped, &step));
                }
            }
        }
        self.neighbours.communicator.largest_of(square)
    }

    fn motion_bounds(&self) -> Option<MotionBounds> {
        Some(self.motion_bounds)
    }
}

/// Least number of tiles in a band if there are several: with more bands threads share the work more evenly,
/// but each band computes the springs of the row before it once more.
const MIN_BAND_TILES: usize = 1024;

/// The tiles of every band, and the bands that need no data from other ranks.
fn bands_of(layout: &Layout, threads: usize) -> (Vec<Range<usize>>, Range<usize>) {
    let n_tiles = layout.n_tiles();
    // Tiles within a halo of the rows of other ranks; the last tile may be short.
    let end = halo(layout).div_ceil(TILE) + 1;
    let [first, last] = layout.has_neighbours().map(|has| if has { end } else { 0 });
    let (inner, has_inner) = match n_tiles.checked_sub(first + last) {
        Some(1..) => (first..n_tiles - last, true),
        _ => (0..n_tiles, false),
    };
    // More bands than threads, as long as they stay large: the other threads do the work of a thread that
    // comes late.
    let most = if threads == 1 { 1 } else { 4 * threads };
    let n = (inner.len() / MIN_BAND_TILES)
        .clamp(threads, most)
        .min(inner.len());
    let divided = (0..n).map(|k| inner.start + inner.len() * k / n..inner.start + inner.len() * (k + 1) / n);
    if !has_inner {
        return (divided.collect(), 0..0);
    }
    let ends = [0..first, n_tiles - last..n_tiles].map(|tiles| (!tiles.is_empty()).then_some(tiles));
    let [first, last] = ends;
    let number = usize::from(first.is_some());
    (
        first.into_iter().chain(divided).chain(last).collect(),
        number..number + n,
    )
}

/// Fills the halos of these bands with the displacements that other ranks hold.
fn fill_from_neighbours(bands: &mut [Band], layout: &Layout, neighbours: &Neighbours) {
    for band in bands {
        for element in band.halos(layout).into_iter().flatten() {
            let k = band.halo_index(element);
            if let Some(u) = neighbours.displacement(layout, element) {
                band.displacement.set(k, u);
            }
        }
    }
}
