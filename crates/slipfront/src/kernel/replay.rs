//! The engine of runs with steps that a device has computed: it returns the records of each step.
//!
//! Values of single blocks are known only at the step at which the device has stopped. There the fused
//! kernel, which gives the same bits, takes the state and reads them.

use std::convert::Infallible;
use std::sync::{Arc, OnceLock};

use super::block::{Block, Field};
use super::engine::{Engine, TakeSliding};
use super::fused::Fused;
use crate::checkpoint::{BlockColumn, MotionBounds};
use crate::clock::Clock;
use crate::communicator::Alone;
use crate::device::{DeviceLattice, NEVER, StepRecord};
use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::state::State;
use crate::totals::Totals;

/// The steps of a lattice that a device has recorded.
#[derive(Debug)]
pub(crate) struct Replay {
    lattice: DeviceLattice,
    /// The present instant, and the record of its step.
    clock: Clock,
    present: StepRecord,
    totals: Totals,
    /// The fused kernel at the present step, if a value of single blocks has been read there.
    blocks: OnceLock<Box<Fused>>,
}

impl Replay {
    /// Replays the recorded steps of a lattice from t = 0 on.
    pub(crate) fn new(lattice: DeviceLattice) -> Self {
        Self {
            clock: Clock::start(lattice.equations.dt_star),
            present: StepRecord::default(),
            totals: Totals {
                velocity_after: lattice.velocity_at_start,
                ..Totals::default()
            },
            lattice,
            blocks: OnceLock::new(),
        }
    }

    /// The fused kernel at the present step.
    fn blocks(&self, model: &Model) -> &Fused {
        self.blocks.get_or_init(|| {
            self.assert_stopped_here();
            let dt_star = self.clock.dt_star;
            let mut kernel = Fused::new(model, dt_star, None, 1, false, Arc::new(Alone));
            for column in BlockColumn::ALL {
                BlockColumn::for_each_part_of_one(model.surface.n_blocks(), |first, values| {
                    self.read_column(column, first, values);
                    kernel.set_column(column, first, values);
                    Ok::<_, Infallible>(())
                })
                .unwrap_or_else(|never| match never {});
            }
            Box::new(kernel.resumed())
        })
    }

    /// # Panics
    /// Unless the device has stopped at the present step.
    fn assert_stopped_here(&self) {
        assert!(
            self.lattice.records.is_empty(),
            "numbers of blocks are known at step {}, where the device has stopped, and not at step {}",
            self.lattice.steps_done - 1,
            self.clock.step
        );
    }

    /// Time of a first slip, if it has happened by now.
    fn first_slip_time_star(&self, step: u32) -> f64 {
        if step == NEVER || u64::from(step) > self.clock.step {
            f64::NAN
        } else {
            f64::from(step) * self.lattice.equations.dt_star
        }
    }
}

impl Engine for Replay {
    /// # Panics
    /// If the step was not recorded, or its energies were not.
    fn step(&mut self, _: &Model, clock: &Clock, energies: bool) -> Totals {
        let record = self.lattice.records.pop_front();
        self.present = record.unwrap_or_else(|| panic!("step {} was not recorded", clock.step));
        assert!(
            !energies || self.lattice.needs_energies(clock.step),
            "energies of step {} were not recorded",
            clock.step
        );
        self.clock = *clock;
        self.blocks = OnceLock::new();
        self.totals = self.present.totals(self.totals.velocity_after, energies);
        self.totals
    }

    fn block(&self, model: &Model, clock: &Clock, b: usize) -> Block {
        self.blocks(model).block(model, clock, b)
    }

    fn read_rows(
        &self,
        model: &Model,
        clock: &Clock,
        field: Field,
        stride: usize,
        write: &mut dyn FnMut(usize, usize, &[f32]),
    ) {
        self.blocks(model).read_rows(model, clock, field, stride, write);
    }

    fn count_in_contact(&self, model: &Model, bins: &PositionBins, sliding: bool, counts: &mut [i64]) {
        self.blocks(model).count_in_contact(model, bins, sliding, counts);
    }

    fn read_sliding(&self, model: &Model, take: TakeSliding) {
        self.blocks(model).read_sliding(model, take);
    }

    fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        let State {
            displacement,
            velocity,
        } = &self.lattice.state;
        [displacement.at(b), velocity.at(b)]
    }

    fn state(&self) -> State {
        self.assert_stopped_here();
        self.lattice.state.clone()
    }

    fn sheets(&self) -> Vec<State> {
        Vec::new()
    }

    fn read_column(&self, column: BlockColumn, first: usize, values: &mut [f64]) {
        let State {
            displacement: u,
            velocity: v,
        } = &self.lattice.state;
        let read = |from: &[f64], values: &mut [f64]| {
            self.assert_stopped_here();
            values.copy_from_slice(&from[first..first + values.len()]);
        };
        match column {
            BlockColumn::DisplacementX => read(&u.x, values),
            BlockColumn::DisplacementY => read(&u.y, values),
            BlockColumn::VelocityX => read(&v.x, values),
            BlockColumn::VelocityY => read(&v.y, values),
            BlockColumn::FirstSlip => {
                for (time_star, &step) in values.iter_mut().zip(&self.lattice.first_slips[first..]) {
                    *time_star = self.first_slip_time_star(step);
                }
            }
        }
    }

    fn into_first_slips(self: Box<Self>) -> Vec<f64> {
        let first_slips = &self.lattice.first_slips;
        first_slips
            .iter()
            .map(|&step| self.first_slip_time_star(step))
            .collect()
    }

    fn stress_square_max(&self, _: &Model, _: &Clock) -> f64 {
        self.present.stress_square_max
    }

    fn motion_bounds(&self) -> Option<MotionBounds> {
        self.assert_stopped_here();
        Some(MotionBounds::of_numbers(self.lattice.motion.bounds))
    }

    fn read_memory(&self, _: f64, column: usize, _: usize, _: &mut [f64]) {
        unreachable!("the law of a plain lattice has no column {column}");
    }

    fn device_lattice(&mut self) -> Option<&mut DeviceLattice> {
        Some(&mut self.lattice)
    }
}
