//! The values of a plain model that a device needs.

use std::collections::VecDeque;
use std::sync::Arc;

use slipfront_kernel::{Springs, series_coefficients};

use super::engine::Engine;
use super::fused::{Fused, blocks_differ, largest_factors};
use crate::checkpoint::BlockColumn;
use crate::clock::Clock;
use crate::communicator::Alone;
use crate::device::{
    CpuOnly, DeviceLattice, EnergySteps, Equations, FallingStrength, Motion, NEVER, SlidingCounts,
    StepRecord, flag,
};
use crate::lattice::{Bond, K_DIAGONAL, K_STRAIGHT};
use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::state::State;
use slipfront_kernel::Integrator;

impl DeviceLattice {
    /// Checks that the equations of a device cover a model.
    ///
    /// # Errors
    /// [`CpuOnly`] for a model that is not plain.
    pub fn check(model: &Model) -> Result<(), CpuOnly> {
        let needs = model.friction.needs();
        let remembers_slip_alone = needs.columns == 0 || needs.weakens_with_slip;
        let is_common_law = needs.is_fused && !needs.varies && remembers_slip_alone;
        let reasons = [
            (model.body.is_some(), "a bulk body is"),
            (model.friction.interface().is_some(), "an upright sheet is"),
            (
                !is_common_law,
                "friction other than Coulomb's with constant coefficients or a strength that falls with slip is",
            ),
            (model.slider.is_viscous(), "internal viscosity is"),
            (model.drive.rotation.is_some(), "a drive that rotates is"),
            (
                blocks_differ(model, &largest_factors(model, &Alone)),
                "sliders whose blocks, drive springs or dead loads differ are",
            ),
        ];
        match reasons.into_iter().find(|(is_true, _)| *is_true) {
            Some((_, what)) => Err(CpuOnly(what)),
            None => Ok(()),
        }
    }

    /// A lattice at t = 0 in a given state, or at rest.
    ///
    /// # Errors
    /// [`CpuOnly`] for a model that is not plain.
    ///
    /// # Panics
    /// If this process holds only a part of the lattice.
    pub fn new(
        model: impl Into<Arc<Model>>,
        dt_star: f64,
        state: Option<&State>,
        energies: EnergySteps,
    ) -> Result<Self, CpuOnly> {
        let model = model.into();
        let lattice = &model.lattice;
        assert_eq!(model.rows, 0..lattice.ny, "a device takes whole lattices");
        Self::check(&model)?;
        let (surface, slider, n) = (&model.surface, &model.slider, lattice.n_blocks());
        let integrator = Integrator::new(model.damping, dt_star);
        let law = model.friction.strength_over_slip();
        let drops = (0..n).map(|b| (surface.static_limit(b) - surface.kinetic_force(b)).max(0.0));
        let impulse = |force: f64| integrator.force_to_velocity * force;
        let limit_square = |b: usize| {
            let limit = surface.static_limit(b);
            let falls = law.is_some() && limit > surface.kinetic_force(b);
            if falls { 0.0 } else { limit * limit }
        };
        let (bounds, velocity_after) = Fused::begun(&model, dt_star, state);
        Ok(Self {
            blocks: [lattice.nx, lattice.ny],
            equations: Equations {
                dt_star,
                k_drive: model.drive.k_drive,
                dead_load: model.dead_load.force,
                epsilon: model.epsilon,
                velocity_decay: integrator.velocity_decay,
                force_to_velocity: integrator.force_to_velocity,
                velocity_to_force: integrator.velocity_to_force,
                stiffness: [K_STRAIGHT, K_DIAGONAL],
                series: series_coefficients(model.epsilon),
                strain_limits: Springs::strain_limits(),
                n_blocks: slider.sum_of_drive_springs(lattice),
                fall_length: law.map_or(-1.0, |law| law.length),
                inverse_fall_length: law.map_or(-1.0, |law| 1.0 / law.length),
                healing_time: law.and_then(|law| law.healing_time).unwrap_or(f64::INFINITY),
            },
            energies,
            static_limit_squares: (0..n).map(limit_square).collect(),
            kinetic_impulses: (0..n).map(|b| impulse(surface.kinetic_force(b))).collect(),
            strength: law.map(|_| FallingStrength {
                drops: drops.collect(),
                columns: vec![vec![0.0; n]; model.friction.n_columns()],
            }),
            flags: (0..n).map(|b| flags(&model, b)).collect(),
            steps_done: 0,
            motion: Motion {
                bounds: bounds.to_numbers(),
                velocity_after,
                stress_square_max: 0.0,
                drive_steps: 0,
                drive_moves: 1,
            },
            state: state.cloned().unwrap_or_else(|| State::at_rest(n)),
            first_slips: vec![NEVER; n],
            records: VecDeque::new(),
            counts: None,
            velocity_at_start: velocity_after,
            model,
        })
    }

    /// The instant of the next step.
    fn next_clock(&self) -> Clock {
        Clock {
            step: self.steps_done,
            drive_steps: self.motion.drive_steps,
            standing: u64::from(self.motion.drive_moves == 0),
            ..Clock::start(self.equations.dt_star)
        }
    }

    /// Computes some steps with the fused kernel, which gives the same bits as any device.
    ///
    /// # Panics
    /// Without a step.
    pub(crate) fn run_on_cpu(&mut self, steps: u32) {
        let model = Arc::clone(&self.model);
        let mut kernel = Fused::of_device(self, 1);
        let (mut latest, mut next) = (None, self.next_clock());
        for _ in 0..steps {
            let clock = next;
            let energies = self.needs_energies(clock.step);
            let totals = kernel.step(&model, &clock, energies);
            let stored = totals.stored_energy.unwrap_or_default();
            self.records.push_back(StepRecord {
                displacement: totals.displacement,
                velocity_after: totals.velocity_after,
                velocity_square: totals.velocity_square,
                friction_power: totals.friction_power,
                stress_square_max: kernel.stress_square_max(&model, &clock),
                n_sliding: [totals.n_sliding, totals.n_slipping].map(|count| count as u32),
                stored: [stored.kinetic, stored.lattice, stored.drive_springs],
                weakening_energy: if energies {
                    kernel.weakening_energy(&model, clock.time_star(), &Alone)
                } else {
                    0.0
                },
            });
            if let Some(counts) = &mut self.counts
                && clock.step.is_multiple_of(counts.every)
            {
                let mut sliding = vec![0; counts.bins.count];
                kernel.count_in_contact(&model, &counts.bins, true, &mut sliding);
                let sliding = sliding.into_iter().map(|count| count as u32).collect();
                counts.recorded.push_back((clock.step, sliding));
            }
            (latest, next) = (
                Some(clock),
                clock.next(model.drive.moves_after(totals.n_slipping)),
            );
        }
        let latest = latest.expect("a device computes at least one step");
        self.take_state(&kernel, &latest, &next);
    }

    /// Takes the state of a kernel after its latest step, at the instant `latest`, before the instant `next`.
    pub(crate) fn take_state(&mut self, kernel: &Fused, latest: &Clock, next: &Clock) {
        self.steps_done = next.step;
        self.motion = kernel.motion_of_device(&self.model, latest, next);
        self.state = kernel.state(self.model.surface.n_blocks());
        let time_star = latest.time_star();
        let of_law = self
            .strength
            .iter_mut()
            .flat_map(|strength| &mut strength.columns);
        for (number, values) in of_law.enumerate() {
            kernel.read_column(time_star, BlockColumn::Memory(number), 0, values);
        }
        let mut times_star = vec![0.0; self.first_slips.len()];
        kernel.read_column(time_star, BlockColumn::FirstSlip, 0, &mut times_star);
        for (step, time_star) in self.first_slips.iter_mut().zip(times_star) {
            *step = if time_star.is_nan() {
                NEVER
            } else {
                (time_star / self.equations.dt_star).round() as u32
            };
        }
    }

    /// Time of the first slip of a block, NaN if it has not slipped.
    pub(crate) fn first_slip_time_star(&self, b: usize) -> f64 {
        match self.first_slips[b] {
            NEVER => f64::NAN,
            step => f64::from(step) * self.equations.dt_star,
        }
    }

    /// Reads a column of a checkpoint for the blocks from `first` on.
    pub(crate) fn read_column(&self, column: BlockColumn, first: usize, values: &mut [f64]) {
        let State {
            displacement,
            velocity,
        } = &self.state;
        let from = match column {
            BlockColumn::DisplacementX => &displacement.x,
            BlockColumn::DisplacementY => &displacement.y,
            BlockColumn::VelocityX => &velocity.x,
            BlockColumn::VelocityY => &velocity.y,
            BlockColumn::FirstSlip => {
                for (b, time_star) in (first..).zip(values) {
                    *time_star = self.first_slip_time_star(b);
                }
                return;
            }
            BlockColumn::Memory(number) => match &self.strength {
                Some(strength) => &strength.columns[number],
                None => return,
            },
        };
        values.copy_from_slice(&from[first..first + values.len()]);
    }

    /// Lets a device count the sliding blocks at a step and at others as far apart: at the multiples of the
    /// greatest common divisor of all such steps.
    ///
    /// # Panics
    /// At step 0, which has no others as far apart.
    pub fn add_counts(&mut self, step: u64, bins: &PositionBins) {
        assert_ne!(
            step, 0,
            "blocks are counted at the multiples of a step after the first"
        );
        match &mut self.counts {
            Some(counts) if counts.bins == *bins => counts.every = gcd(counts.every, step),
            counts => *counts = Some(sliding_counts(&self.model, &self.flags, step, bins)),
        }
    }

    /// Adds the blocks in contact to `counts`, each in its bin, if the device has counted them at a step:
    /// those that slide if `sliding` is true, else those that do not. Returns whether it has.
    pub(crate) fn recorded_in_contact(
        &self,
        step: u64,
        bins: &PositionBins,
        sliding: bool,
        counts: &mut [i64],
    ) -> bool {
        let of_bins = self.counts.as_ref().filter(|recorded| recorded.bins == *bins);
        let Some(of_bins) = of_bins else { return false };
        let Some((_, slide)) = of_bins.recorded.iter().find(|(counted, _)| *counted == step) else {
            return false;
        };
        for ((count, slide), in_contact) in counts.iter_mut().zip(slide).zip(&*of_bins.in_contact) {
            *count += i64::from(if sliding { *slide } else { in_contact - slide });
        }
        true
    }

    /// Forgets the records of all steps.
    pub(crate) fn clear_records(&mut self) {
        self.records.clear();
        if let Some(counts) = &mut self.counts {
            counts.recorded.clear();
        }
    }

    /// Forgets the records of some steps, the earliest of those that are recorded.
    pub(crate) fn forget_records(&mut self, steps: usize) {
        self.records.drain(..steps);
        let first = self.steps_done - self.records.len() as u64;
        if let Some(counts) = &mut self.counts {
            counts.recorded.retain(|(step, _)| *step >= first);
        }
    }

    /// Adds the blocks in contact to `counts`, each in its bin: those that slide if `sliding` is true, else
    /// those that do not. A block slides in the present step if it moves after it.
    pub(crate) fn count_in_contact(&self, bins: &PositionBins, sliding: bool, counts: &mut [i64]) {
        let v = &self.state.velocity;
        for (b, flags) in self.flags.iter().enumerate() {
            let slides = v.x[b] != 0.0 || v.y[b] != 0.0;
            if flags & flag::IN_CONTACT != 0 && slides == sliding {
                let (i, j) = self.model.lattice.column_row(b);
                counts[bins.bin(i, j)] += 1;
            }
        }
    }
}

/// The greatest common divisor.
pub(crate) fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Counts of blocks at the multiples of a step, of which none are recorded yet.
fn sliding_counts(model: &Model, flags: &[u16], every: u64, bins: &PositionBins) -> SlidingCounts {
    let bin = |b: usize| {
        let (i, j) = model.lattice.column_row(b);
        bins.bin(i, j) as u16
    };
    let bin_of: Arc<[u16]> = (0..flags.len()).map(bin).collect();
    let mut in_contact = vec![0; bins.count];
    for (bin, flags) in bin_of.iter().zip(flags) {
        in_contact[usize::from(*bin)] += u32::from(flags & flag::IN_CONTACT != 0);
    }
    SlidingCounts {
        every,
        bins: *bins,
        bin_of,
        in_contact: in_contact.into(),
        recorded: VecDeque::new(),
    }
}

/// The [flags](flag) of block `b`.
fn flags(model: &Model, b: usize) -> u16 {
    let (lattice, slider) = (&model.lattice, &model.slider);
    if !slider.exists(b) {
        return 0;
    }
    let (i, j) = lattice.column_row(b);
    let upward = Bond::ALL.map(|bond| bond.offset);
    let offsets = upward.into_iter().chain(upward.map(|offset| offset.map(|d| -d)));
    let mut flags = flag::EXISTS;
    for (k, offset) in offsets.enumerate() {
        let neighbour = lattice.neighbour(i, j, offset);
        flags |= u16::from(neighbour.is_some_and(|b| slider.exists(b))) << k;
    }
    let more = [
        (!model.surface.textured[b], flag::IN_CONTACT),
        (i == 0, flag::FIRST_COLUMN),
        (i + 1 == lattice.nx, flag::LAST_COLUMN),
        (j == 0, flag::FIRST_ROW),
        (j + 1 == lattice.ny, flag::LAST_ROW),
    ];
    more.into_iter()
        .filter(|(is_set, _)| *is_set)
        .fold(flags, |flags, (_, flag)| flags | flag)
}
