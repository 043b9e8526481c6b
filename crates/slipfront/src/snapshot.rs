//! The view of a run that observers receive.

use crate::checkpoint::BlockColumn;
use crate::clock::{Clock, Rest};
use crate::communicator::Communicator;
use crate::friction::ContactTotals;
use crate::kernel::block::{Block, Field};
use crate::kernel::engine::Engine;
use crate::measure::{CurvePoint, Peak};
use crate::model::Model;
use crate::totals::{StoredEnergy, Totals};
use crate::vector_field::dot;
use slipfront_kernel::fixed_point::sums_by_parts;

/// A run at one instant t_n. Forces, friction and contact are those of the update that starts at t_n.
pub struct Snapshot<'a> {
    /// Lattice, surface and drive, which never change in a run.
    pub model: &'a Model,
    /// Number of the step, n.
    pub step: u64,
    /// Number of steps in which the drive has moved: n, unless the drive is held.
    pub drive_steps: u64,
    /// Time `t* = n dt*`.
    pub time_star: f64,
    /// Time of the drive, `drive_steps dt*`, on which its path depends.
    pub drive_time_star: f64,
    /// Time step.
    pub dt_star: f64,
    /// Sums over all blocks.
    pub totals: Totals,
    /// Sums that belong to the law of friction.
    pub contact: ContactTotals,
    /// Friction coefficient mu* and percentage N*.
    pub point: CurvePoint,
    /// The first peak of mu* found up to t_n.
    pub peak: Peak,
    /// Whether the run ends here.
    pub last: bool,
    pub(crate) clock: Clock,
    pub(crate) engine: &'a dyn Engine,
    pub(crate) communicator: &'a dyn Communicator,
}

/// Changes of mu* below this count as rounding errors.
pub(crate) const MU_STAR_ROUNDING: f64 = 1e-9;

impl Snapshot<'_> {
    /// Displacement, velocity and forces of block `b`. The fused kernel keeps no forces, so that they are
    /// recomputed: to read all blocks, use [`read_field`](Self::read_field).
    ///
    /// # Panics
    /// If several ranks share the lattice: one of them does not hold all neighbours of its blocks.
    pub fn block(&self, b: usize) -> Block {
        assert_eq!(
            self.communicator.size(),
            1,
            "a block is read where one rank holds the whole lattice"
        );
        self.engine.block(self.model, &self.clock, b)
    }

    /// Writes `field` of every block, row by row from y = 0, into `values`: the same values as
    /// [`Field::value`] of every [`block`](Self::block), rounded to `f32`; NaN where no block exists.
    ///
    /// # Panics
    /// If there is not one value per block.
    pub fn read_field(&self, field: Field, values: &mut [f32]) {
        let lattice = &self.model.lattice;
        assert_eq!(values.len(), self.model.surface.n_blocks(), "one value per block");
        self.read_rows(field, 1, |j, i, part| {
            let first = lattice.block(i, j);
            values[first..first + part.len()].copy_from_slice(part);
        });
    }

    /// Reads `field` in every `stride`-th row, several blocks of a row at a time: `write` receives the row,
    /// the column of the first value, and the values.
    pub(crate) fn read_rows(&self, field: Field, stride: usize, mut write: impl FnMut(usize, usize, &[f32])) {
        let Some(outline) = &self.model.slider.outline else {
            return self
                .engine
                .read_rows(self.model, &self.clock, field, stride, &mut write);
        };
        // NaN where there is no block.
        const WIDTH: usize = 128;
        let mut leave_out = |j: usize, i: usize, part: &[f32]| {
            for (first, part) in (i..).step_by(WIDTH).zip(part.chunks(WIDTH)) {
                let exists = &outline.exists[self.model.lattice.block(first, j)..];
                let mut values = [f32::NAN; WIDTH];
                for ((value, read), _) in values
                    .iter_mut()
                    .zip(part)
                    .zip(exists)
                    .filter(|(_, exists)| **exists)
                {
                    *value = *read;
                }
                write(j, first, &values[..part.len()]);
            }
        };
        self.engine
            .read_rows(self.model, &self.clock, field, stride, &mut leave_out);
    }

    /// Energies stored now.
    ///
    /// # Panics
    /// If no observer needed them at this step: see
    /// [`Observer::needs_energies`](crate::observe::Observer::needs_energies).
    pub fn stored_energy(&self) -> StoredEnergy {
        self.totals
            .stored_energy
            .expect("an observer needs the energies of this step")
    }

    /// Work of the dead load from the rest sites to the displacements now, `sum F_0,i . u_i`. All ranks must
    /// call this together.
    pub fn dead_load_work(&self) -> f64 {
        let (load, slider) = (&self.model.dead_load, &self.model.slider);
        if !load.acts() {
            return 0.0;
        }
        // The sum over equal blocks is known already.
        if load.field.is_none() && slider.drive_springs.is_none() {
            return dot(load.force, self.totals.displacement);
        }
        let axes = [BlockColumn::DisplacementX, BlockColumn::DisplacementY];
        let n_blocks = self.model.surface.n_blocks();
        let sums = sums_by_parts(self.communicator, n_blocks, |axis, first, values| {
            self.engine.read_column(self.time_star, axes[axis], first, values);
            for (b, value) in (first..).zip(values) {
                *value *= if slider.exists(b) { load.relative(b) } else { 0.0 };
            }
        });
        dot(load.force, sums)
    }

    /// Energy of the foundation under an interface and of the load on it, relative to rest; 0 without an
    /// interface. All ranks must call this together.
    pub fn foundation_energy(&self) -> f64 {
        let Some(interface) = self.model.friction.interface() else {
            return 0.0;
        };
        let surface = &self.model.surface;
        let [energy] = sums_by_parts(self.communicator, surface.n_blocks(), |_, first, terms| {
            self.engine
                .read_column(self.time_star, BlockColumn::DisplacementY, first, terms);
            for (b, term) in (first..).zip(terms) {
                *term = if surface.textured[b] {
                    0.0
                } else {
                    interface.energy(surface.load(b), *term)
                };
            }
        });
        energy
    }

    /// Energy dissipated by the fall of strength since the start, a part of the friction loss: for each block
    /// the integral of `f - K` over its slip; 0 where strength does not fall. All ranks must call this
    /// together. On a device this reads all blocks, unless an observer needs energies at this step.
    pub fn weakening_energy(&self) -> f64 {
        self.engine
            .weakening_energy(self.model, self.time_star, self.communicator)
    }

    /// First-slip times t* of the blocks of this rank while in contact; NaN for blocks that have not slipped.
    pub fn first_slip_time_star(&self) -> Vec<f64> {
        let mut times = vec![0.0; self.model.surface.n_blocks()];
        self.read_first_slips(&mut times);
        times
    }

    /// Writes the first-slip times t* of the blocks of this rank into `values`.
    ///
    /// # Panics
    /// If there is not one value per block.
    pub fn read_first_slips(&self, values: &mut [f64]) {
        assert_eq!(values.len(), self.model.surface.n_blocks(), "one value per block");
        self.engine
            .read_column(self.time_star, BlockColumn::FirstSlip, 0, values);
    }

    /// The next instant: whether a held drive moves until then is known now.
    pub(crate) fn next_clock(&self) -> Clock {
        let rests_by_force = self.clock.rest == Rest::ByForce { at_rest: true };
        let moves = match self.clock.rest {
            Rest::ByForce { .. } if self.model.rests_by_excess() => rests_by_force,
            _ => rests_by_force || self.model.drive.moves_after(self.totals.n_slipping),
        };
        self.clock.next(moves)
    }

    /// Time of the drive at the next step.
    pub fn next_drive_time_star(&self) -> f64 {
        self.next_clock().drive_time_star()
    }

    /// Path of the drive at the next step, along the direction; for a rotation the path at the largest
    /// radius.
    pub fn next_path(&self) -> f64 {
        self.model.drive.path(self.next_drive_time_star())
    }

    /// mu* at the next step; the velocities of the blocks already determine it, up to rounding.
    pub(crate) fn mu_star_next(&self) -> f64 {
        let mut totals = self.totals;
        for axis in 0..2 {
            totals.displacement[axis] += self.dt_star * totals.velocity_after[axis];
        }
        CurvePoint::measure(self.model, &totals, self.next_drive_time_star()).mu_star
    }

    /// Whether mu* will be higher at the next step.
    pub(crate) fn mu_star_rises(&self) -> bool {
        self.mu_star_next() > self.point.mu_star + MU_STAR_ROUNDING
    }

    /// Whether mu* will be lower at the next step.
    pub(crate) fn mu_star_falls(&self) -> bool {
        self.mu_star_next() < self.point.mu_star - MU_STAR_ROUNDING
    }
}
