//! The interface of every kernel.

use super::block::{Block, Field};
use crate::checkpoint::BlockColumn;
use crate::clock::Clock;
use crate::communicator::Communicator;
use crate::device::{Device, DeviceError, DeviceLattice};
use crate::friction::ContactTotals;
use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::state::State;
use crate::totals::Totals;
use slipfront_kernel::MotionBounds;
use slipfront_kernel::fixed_point::{PART, sums_by_parts};

/// Receives consecutive blocks: the first, whether each slides, and their velocities half a step later.
pub(crate) type TakeSliding<'a> = &'a mut dyn FnMut(usize, &[bool], [&[f64]; 2]);

/// A kernel with the state of all blocks. `clock` is at the present step, except in functions that advance to
/// it.
pub(crate) trait Engine: Send + Sync {
    /// Advances to the step of `clock`: the next step, or the first one.
    fn step(&mut self, model: &Model, clock: &Clock, energies: bool) -> Totals;

    /// Block `b` with the forces on it.
    fn block(&self, model: &Model, clock: &Clock, b: usize) -> Block;

    /// Reads `field` in every `stride`-th row, several blocks of a row at a time. `write` receives the row,
    /// the column of the first value, and the values.
    fn read_rows(
        &self,
        model: &Model,
        clock: &Clock,
        field: Field,
        stride: usize,
        write: &mut dyn FnMut(usize, usize, &[f32]),
    );

    /// Adds the blocks in contact in these rows to `counts`, each in its bin: those that slide if `sliding`
    /// is true, else those that do not.
    fn count_in_contact(&self, model: &Model, bins: &PositionBins, sliding: bool, counts: &mut [i64]);

    /// Passes at least the moving blocks of these rows to `take`, several consecutive blocks at a time: the
    /// first, whether each slides, and their velocities half a step later.
    fn read_sliding(&self, model: &Model, take: TakeSliding);

    /// Displacement now and velocity half a step later of block `b`.
    fn motion(&self, b: usize) -> [[f64; 2]; 2];

    /// Displacements now and velocities half a step later of all blocks.
    fn state(&self, n_blocks: usize) -> State {
        let mut state = State::at_rest(n_blocks);
        for b in 0..n_blocks {
            let [u, v] = self.motion(b);
            [state.displacement.x[b], state.displacement.y[b]] = u;
            [state.velocity.x[b], state.velocity.y[b]] = v;
        }
        state
    }

    /// Reads a column of a checkpoint for the blocks from `first` on, at the present t*.
    fn read_column(&self, time_star: f64, column: BlockColumn, first: usize, values: &mut [f64]);

    /// First-slip times of all blocks. Consumes the kernel, and frees its state before the times are
    /// allocated.
    fn into_first_slips(self: Box<Self>) -> Vec<f64>;

    /// Largest square of a contact stress of a block in contact at any step so far.
    fn stress_square_max(&self, model: &Model, clock: &Clock) -> f64;

    /// Largest square of a speed half a step after the present instant, if the kernel computes bulk bodies.
    fn speed_square_max(&self) -> f64 {
        0.0
    }

    /// Power dissipated by the dampers between blocks at the present step, `-sum F_v . v`; 0 for a kernel
    /// without dampers.
    fn viscous_power(&self) -> f64 {
        0.0
    }

    /// Bounds that a checkpoint keeps, if the kernel has any.
    fn motion_bounds(&self) -> Option<MotionBounds>;

    /// Sums that belong to a law of friction, if the kernel computes such laws.
    fn contact_totals(&self, _model: &Model) -> ContactTotals {
        ContactTotals::default()
    }

    /// Energy dissipated by the fall of strength since the start, a part of the friction loss: for each block
    /// the integral of `f - K` over its slip; 0 where strength does not fall. All ranks must call this
    /// together.
    fn weakening_energy(&self, model: &Model, time_star: f64, ranks: &dyn Communicator) -> f64 {
        let Some(law) = model.friction.strength_over_slip() else {
            return 0.0;
        };
        let surface = &model.surface;
        let mut lost_before = [0.0; PART];
        let [energy] = sums_by_parts(ranks, surface.n_blocks(), |_, first, energies| {
            let lost_before = &mut lost_before[..energies.len()];
            self.read_column(time_star, BlockColumn::Memory(0), first, energies);
            if law.healing_time.is_some() {
                self.read_column(time_star, BlockColumn::Memory(2), first, lost_before);
            }
            // Replaces slips by energies.
            for (b, (energy, lost_before)) in (first..).zip(energies.iter_mut().zip(lost_before)) {
                let drop = (surface.static_limit(b) - surface.kinetic_force(b)).max(0.0);
                *energy = law.energy(drop, *energy, *lost_before);
            }
        });
        energy
    }

    /// The lattice that a device computes, if the kernel replays its steps.
    fn device_lattice(&mut self) -> Option<&mut DeviceLattice> {
        None
    }

    /// The device that computes the steps, or computed them until it failed, if the kernel has one.
    fn device(&self) -> Option<&dyn Device> {
        None
    }

    /// The failure of the device that computed the first steps, if the CPU computes the others.
    fn device_failure(&self) -> Option<&DeviceError> {
        None
    }
}
