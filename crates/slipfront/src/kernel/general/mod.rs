//! The general kernel: it computes every option of the model, one pass over the blocks per equation.
//!
//! All passes go over one part of the blocks before the next part, so that the results of a pass are in the
//! cache for the next pass. A step moves the blocks (Eq. 8), computes the forces on them (Eqs. 2, 3) and
//! applies friction and damping (Eqs. 4-7). Forces of opposite neighbours are summed in pairs, straight ones
//! before diagonal ones, so that the trajectory of a rotated or mirrored problem is the rotated or mirrored
//! trajectory, with the same bits.
//!
//! Threads share bands of rows. After the blocks have moved, and before forces are computed, bands exchange
//! the motion of their first and last rows, also with bands of other ranks.

mod band;
mod drive;
mod rows;
mod springs;
mod weighted;

use std::ops::Range;
use std::sync::Arc;

use self::band::{Band, BandSums, BodyForces, Summed};
use super::bands::for_each_band;
use super::block::{Block, Field};
use super::engine::{Engine, TakeSliding};
use super::vectors::level;
use crate::body::Body;
use crate::checkpoint::{BlockColumn, Checkpoint};
use crate::clock::Clock;
use crate::communicator::Communicator;
use crate::forces::{part, part_mut};
use crate::friction::ContactTotals;
use crate::lattice::Lattice;
use crate::model::Model;
use crate::moduli::Moduli;
use crate::parallel::join;
use crate::position_bins::PositionBins;
use crate::state::State;
use crate::totals::{StoredEnergy, Totals};
use crate::vector_field::VectorField;
use slipfront_kernel::fixed_point::RunningSum;
use slipfront_kernel::{MotionBounds, SurfaceResponse, Threads, vectorized};

/// Least number of blocks in a band if there are several: some tens of microseconds of work.
const MIN_BAND_BLOCKS: usize = 1024;

/// Least number of rows in a band if there are several: each band computes the springs of the row before it
/// once more.
const MIN_BAND_ROWS: usize = 8;

/// The blocks of this rank and the data to step them.
pub(crate) struct General {
    threads: usize,
    ranks: Arc<dyn Communicator>,
    /// Whether the first step, which does not move the blocks, has been evaluated.
    started: bool,
    bands: Vec<BandOfRank>,
    /// Motion of the first and the last row of each band, for the neighbouring bands.
    ends: Vec<[Vec<f64>; 2]>,
    /// Motion of the rows below and above this rank.
    beside: [Vec<f64>; 2],
    sums: BandSums,
    energy_sums: [RunningSum; 4],
    body: Option<BodyOfBlocks>,
    /// Power dissipated by the dampers.
    viscous_power: f64,
    contact_totals: ContactTotals,
    /// Largest square of a contact stress before the checkpoint from which the run continues.
    stress_square_before: f64,
}

/// The response of a body with what it acts upon: the displacements of all blocks, and the forces on them.
struct BodyOfBlocks {
    response: SurfaceResponse,
    displacement: VectorField,
    force: VectorField,
    mean: [f64; 2],
}

impl BodyOfBlocks {
    fn new(body: &Body, lattice: &Lattice, threads: usize) -> Self {
        let zeros = || VectorField::zeros(lattice.n_blocks());
        Self {
            response: body.response([lattice.nx, lattice.ny], threads),
            displacement: zeros(),
            force: zeros(),
            mean: [0.0; 2],
        }
    }

    /// Finds the forces at the displacements of all bands.
    fn respond(&mut self, bands: &[BandOfRank]) {
        let Self {
            response,
            displacement,
            force,
            mean,
        } = self;
        for BandOfRank { blocks, band, .. } in bands {
            let [x, y] = part_mut(displacement, blocks);
            x.copy_from_slice(&band.state.displacement.x);
            y.copy_from_slice(&band.state.displacement.y);
        }
        let threads = Threads {
            level: level(),
            join: |one, other| {
                join(one, other);
            },
        };
        *mean = response.forces(
            threads,
            [&displacement.x, &displacement.y],
            [&mut force.x, &mut force.y],
        );
    }

    /// The forces on some blocks.
    fn forces(&self, blocks: &Range<usize>) -> BodyForces<'_> {
        BodyForces {
            force: part(&self.force, blocks),
            mean: self.mean,
        }
    }
}

/// A band of the rows of a rank.
struct BandOfRank {
    /// Blocks of the band among those of this rank.
    blocks: Range<usize>,
    /// Model of the band's rows, unless these are all rows of this rank.
    model: Option<Model>,
    band: Band,
}

impl BandOfRank {
    /// The band and the model of its rows, given the model of the rank.
    fn with_model<'a>(&'a mut self, of_rank: &'a Model) -> (&'a Model, &'a mut Band) {
        (self.model.as_ref().unwrap_or(of_rank), &mut self.band)
    }

    /// Blocks of the band among the `count` blocks of the rank from `first` on: their places in the band, and
    /// their places among the `count` blocks.
    fn common(&self, first: usize, count: usize) -> Option<[Range<usize>; 2]> {
        let both = first.max(self.blocks.start)..(first + count).min(self.blocks.end);
        let from = |start: usize| both.start - start..both.end - start;
        (!both.is_empty()).then(|| [from(self.blocks.start), from(first)])
    }
}

impl General {
    /// Begins in a given state, or at rest; the blocks are divided among `threads`. All `ranks` of a lattice
    /// must call this together, and then the same functions.
    pub(crate) fn new(
        model: &Model,
        dt_star: f64,
        state: Option<State>,
        threads: usize,
        ranks: Arc<dyn Communicator>,
    ) -> Self {
        let moduli = Moduli::new(&model.slider, &model.lattice, &model.rows, &*ranks);
        let bands = match &bands_of(model, threads)[..] {
            [_] => {
                let blocks = 0..model.surface.n_blocks();
                let state = state.unwrap_or_else(|| State::at_rest(blocks.len()));
                let band = Band::new(model, &moduli, dt_star, state);
                vec![BandOfRank {
                    // A single band needs no copy of the model for its rows.
                    blocks,
                    model: None,
                    band,
                }]
            }
            rows => {
                let band = |rows: &Range<usize>| {
                    let first = model.rows.start;
                    let blocks = model.lattice.blocks_of(&(rows.start - first..rows.end - first));
                    let own = model.of_some_rows(rows.clone());
                    let at_rest = || State::at_rest(blocks.len());
                    let state = state
                        .as_ref()
                        .map_or_else(at_rest, |state| part_of(state, &blocks));
                    BandOfRank {
                        band: Band::new(&own, &moduli, dt_star, state),
                        model: Some(own),
                        blocks,
                    }
                };
                rows.iter().map(band).collect()
            }
        };
        Self {
            threads,
            ranks,
            started: false,
            ends: vec![Default::default(); bands.len()],
            beside: Default::default(),
            bands,
            sums: BandSums::default(),
            energy_sums: Default::default(),
            body: model
                .body
                .as_ref()
                .map(|body| BodyOfBlocks::new(body, &model.lattice, threads)),
            viscous_power: 0.0,
            contact_totals: ContactTotals::default(),
            stress_square_before: 0.0,
        }
    }

    /// Continues from a checkpoint: evaluates its instant again to compute forces, friction and velocities.
    pub(crate) fn resume<E>(
        model: &Model,
        dt_star: f64,
        checkpoint: &Checkpoint,
        threads: usize,
        ranks: Arc<dyn Communicator>,
        mut read: impl FnMut(usize, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut kernel = Self {
            stress_square_before: checkpoint.stress_square_max,
            ..Self::new(model, dt_star, None, threads, ranks)
        };
        BlockColumn::for_each_part(model, |number, column, first, values| {
            read(number, first, values)?;
            for one in &mut kernel.bands {
                if let Some([own, of_values]) = one.common(first, values.len()) {
                    one.band.column_mut(column)[own].copy_from_slice(&values[of_values]);
                }
            }
            Ok(())
        })?;
        for one in &mut kernel.bands {
            let (model, band) = one.with_model(model);
            band.resume(model);
        }
        kernel.step(model, &checkpoint.clock(dt_star), false);
        Ok(kernel)
    }

    /// The band of block `b`, and the number of the block in it.
    fn locate(&self, b: usize) -> (&Band, usize) {
        let one = &self.bands[self.bands.partition_point(|one| one.blocks.end <= b)];
        (&one.band, b - one.blocks.start)
    }

    /// Exchanges the motion of the rows next to every band.
    fn exchange(&mut self) {
        for (ends, one) in self.ends.iter_mut().zip(&self.bands) {
            one.band.read_ends(ends);
        }
        let (ends, last) = (&self.ends, self.ends.len() - 1);
        let to = [&*ends[0][0], &*ends[last][1]];
        for (row, to) in self.beside.iter_mut().zip(to) {
            row.resize(to.len(), 0.0);
        }
        let [below, above] = &mut self.beside;
        self.ranks.exchange(to, [below, above], &mut || ());
        let [below, above] = &self.beside;
        for (number, one) in self.bands.iter_mut().enumerate() {
            let below = if number == 0 { below } else { &ends[number - 1][1] };
            let above = if number == last {
                above
            } else {
                &ends[number + 1][0]
            };
            one.band.set_beside([below, above]);
        }
    }

    /// Energies of all blocks, after their next velocities are known.
    fn stored_energy(&mut self, model: &Model, drive_time_star: f64) -> StoredEnergy {
        let body = self.body.as_ref();
        let [before, after, drive_springs, of_body] = loop {
            let sums = self.energy_sums;
            for_each_band(self.threads, &mut self.bands, &|one| {
                let forces = body.map(|body| body.forces(&one.blocks));
                let (model, band) = one.with_model(model);
                vectorized(
                    level(),
                    #[inline(always)]
                    || band.add_energies(model, drive_time_star, sums, forces),
                );
            });
            for one in &self.bands {
                RunningSum::join(&mut self.energy_sums, &one.band.energy_sums);
            }
            if let Some(found) = RunningSum::finish(&*self.ranks, &mut self.energy_sums) {
                break found;
            }
        };
        let lattice = if body.is_some() {
            // Half the work against the forces of the body.
            -0.5 * of_body
        } else {
            let along_bond = |bond: usize| {
                let rows = self.bands.iter();
                self.sum_rows(model, rows.map(|one| &*one.band.row_energies[bond]))
            };
            (0..4).map(along_bond).sum()
        };
        StoredEnergy {
            kinetic: 0.25 * (before + after),
            lattice,
            drive_springs: 0.5 * model.drive.k_drive * drive_springs,
        }
    }

    /// Sum over all rows of the whole lattice, from the values of the rows of every band. The order, and so
    /// the bits, are the same for any number of bands and ranks.
    fn sum_rows<'a>(&self, model: &Model, of_bands: impl Iterator<Item = &'a [f64]>) -> f64 {
        // Every rank has the values of its rows and zeros elsewhere, so that integer sums of the bits bring
        // all values together. Then every rank adds the same numbers in the same order.
        let mut bits = vec![0; model.lattice.ny];
        for (bits, number) in bits[model.rows.clone()].iter_mut().zip(of_bands.flatten()) {
            *bits = number.to_bits() as i64;
        }
        self.ranks.sum(&mut bits);
        bits.into_iter().map(|bits| f64::from_bits(bits as u64)).sum()
    }
}

impl Engine for General {
    fn step(&mut self, model: &Model, clock: &Clock, energies: bool) -> Totals {
        let (threads, level) = (self.threads, level());
        let moves = std::mem::replace(&mut self.started, true);
        for_each_band(threads, &mut self.bands, &|one| {
            let (model, band) = one.with_model(model);
            vectorized(
                level,
                #[inline(always)]
                || band.begin_step(model, moves),
            );
        });
        // Springs join blocks of different bands: all blocks must have moved, and bands exchanged their rows,
        // before any band computes forces.
        self.exchange();
        if let Some(body) = &mut self.body {
            body.respond(&self.bands);
        }
        let body = self.body.as_ref();
        let mut is_known = false;
        let found = Summed::from(loop {
            let sums = self.sums;
            for_each_band(threads, &mut self.bands, &|one| {
                let forces = body.map(|body| body.forces(&one.blocks));
                let (model, band) = one.with_model(model);
                vectorized(
                    level,
                    #[inline(always)]
                    || band.evaluate(model, clock, is_known, sums, forces),
                );
            });
            for one in &self.bands {
                RunningSum::join(&mut self.sums, &one.band.sums);
            }
            if let Some(found) = RunningSum::finish(&*self.ranks, &mut self.sums) {
                break found;
            }
            // A term exceeded the bound, or all terms have become much smaller: once more with the right
            // bound.
            is_known = true;
        });
        let mut counts = [0; 2];
        for one in &self.bands {
            let pairs = counts.iter_mut().zip(one.band.counts);
            pairs.for_each(|(count, more)| *count += more);
        }
        self.ranks.sum(&mut counts);
        let [n_sliding, n_slipping] = counts.map(|count| count as usize);
        // Subtracted from 0, not negated: without dampers negation would give -0.
        self.viscous_power = 0.0 - found.viscous_power;
        self.contact_totals = ContactTotals::from_sums(found.contact, &model.friction, &model.surface);
        let stored_energy = energies.then(|| self.stored_energy(model, clock.drive_time_star()));
        self.bands.iter_mut().for_each(|one| one.band.end_step());
        Totals {
            displacement: found.displacement,
            velocity: found.velocity,
            velocity_after: found.velocity_after,
            velocity_square: found.velocity_square,
            friction_power: found.friction_power,
            n_sliding,
            n_slipping,
            stored_energy,
        }
    }

    fn block(&self, _: &Model, _: &Clock, b: usize) -> Block {
        let (band, b) = self.locate(b);
        band.block(b)
    }

    fn read_rows(
        &self,
        model: &Model,
        _: &Clock,
        field: Field,
        stride: usize,
        write: &mut dyn FnMut(usize, usize, &[f32]),
    ) {
        const WIDTH: usize = 128;
        let lattice = &model.lattice;
        let mut values = [0.0; WIDTH];
        let is_read = |j: &usize| (model.rows.start + j).is_multiple_of(stride);
        for j in (0..model.rows.len()).filter(is_read) {
            let first = lattice.block(0, j);
            let (band, in_band) = self.locate(first);
            for i in (0..lattice.nx).step_by(WIDTH) {
                let values = &mut values[..WIDTH.min(lattice.nx - i)];
                for (value, i) in values.iter_mut().zip(i..) {
                    let (b, block) = (in_band + i, first + i);
                    *value = match field {
                        Field::Sliding => f32::from(u8::from(band.forces.slides[b])),
                        _ => field.value(&band.block(b), model.surface.textured[block]) as f32,
                    };
                }
                write(j, i, values);
            }
        }
    }

    fn count_in_contact(&self, model: &Model, bins: &PositionBins, sliding: bool, counts: &mut [i64]) {
        let slides = self.bands.iter().flat_map(|one| &one.band.forces.slides);
        for (b, (slides, textured)) in (model.first_block()..).zip(slides.zip(&model.surface.textured)) {
            if *slides == sliding && !textured {
                let (i, j) = model.lattice.column_row(b);
                counts[bins.bin(i, j)] += 1;
            }
        }
    }

    fn read_sliding(&self, _: &Model, take: TakeSliding) {
        for BandOfRank { blocks, band, .. } in &self.bands {
            let velocity = &band.state.velocity;
            take(blocks.start, &band.forces.slides, [&velocity.x, &velocity.y]);
        }
    }

    fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        let (Band { state, .. }, b) = self.locate(b);
        [state.displacement.at(b), state.velocity.at(b)]
    }

    fn read_column(&self, _: f64, column: BlockColumn, first: usize, values: &mut [f64]) {
        for one in &self.bands {
            if let Some([own, of_values]) = one.common(first, values.len()) {
                values[of_values].copy_from_slice(&one.band.column(column)[own]);
            }
        }
    }

    fn into_first_slips(self: Box<Self>) -> Vec<f64> {
        let bands = self.bands.into_iter();
        bands.flat_map(|one| one.band.first_slip).collect()
    }

    fn stress_square_max(&self, _: &Model, _: &Clock) -> f64 {
        let squares = self.bands.iter().map(|one| one.band.stress_square_max);
        self.ranks
            .largest_of(squares.fold(self.stress_square_before, f64::max))
    }

    fn speed_square_max(&self) -> f64 {
        let squares = self.bands.iter().map(|one| one.band.speed_square_max);
        squares.fold(0.0, f64::max)
    }

    fn viscous_power(&self) -> f64 {
        self.viscous_power
    }

    fn motion_bounds(&self) -> Option<MotionBounds> {
        None
    }

    fn contact_totals(&self, _: &Model) -> ContactTotals {
        self.contact_totals
    }
}

/// The rows of every band.
fn bands_of(model: &Model, threads: usize) -> Vec<Range<usize>> {
    let (rows, n_blocks) = (&model.rows, model.surface.n_blocks());
    let is_one = threads == 1 || model.friction.lends_thresholds();
    // More bands than threads: the other threads do the work of a thread that comes late. Under a law in
    // which a block takes the threshold of any other block, all blocks are in one band.
    let most = if is_one { 1 } else { 4 * threads };
    let n = most
        .min(n_blocks / MIN_BAND_BLOCKS)
        .min(rows.len() / MIN_BAND_ROWS)
        .max(1);
    (0..n)
        .map(|k| rows.start + rows.len() * k / n..rows.start + rows.len() * (k + 1) / n)
        .collect()
}

/// The state of some blocks.
fn part_of(state: &State, blocks: &Range<usize>) -> State {
    let part = |field: &VectorField| VectorField {
        x: field.x[blocks.clone()].to_vec(),
        y: field.y[blocks.clone()].to_vec(),
    };
    State {
        displacement: part(&state.displacement),
        velocity: part(&state.velocity),
    }
}
