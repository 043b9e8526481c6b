//! The values of a plain model that a device needs.

use std::collections::VecDeque;
use std::sync::Arc;

use super::fused::{Fused, LargestFactors, SeriesNumbers, blocks_differ};
use crate::communicator::Alone;
use crate::device::{CpuOnly, DeviceLattice, EnergySteps, Equations, Motion, NEVER, flag};
use crate::friction::Integrator;
use crate::lattice::Bond;
use crate::model::Model;
use crate::state::State;

impl DeviceLattice {
    /// Checks that the equations of a device cover a model.
    ///
    /// # Errors
    /// [`CpuOnly`] for a model that is not plain.
    pub fn check(model: &Model) -> Result<(), CpuOnly> {
        let needs = model.friction.needs();
        let is_common_law = needs.is_fused && !needs.varies && needs.columns == 0;
        let reasons = [
            (!model.sheets.is_empty(), "a stack of sheets is"),
            (model.friction.interface().is_some(), "an upright sheet is"),
            (
                !is_common_law,
                "friction other than Coulomb's with constant coefficients is",
            ),
            (model.slider.is_viscous(), "internal viscosity is"),
            (model.drive.rotation.is_some(), "a drive that rotates is"),
            (model.drive.is_held(), "a drive that is held is"),
            (
                blocks_differ(model, &LargestFactors::of(model, &Alone)),
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
        let series = SeriesNumbers::new(model.epsilon, model.springs);
        let static_limits = (0..n).map(|b| surface.static_limit(b));
        let kinetic_forces = (0..n).map(|b| surface.kinetic_force(b));
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
                stiffness: [model.springs.straight, model.springs.diagonal],
                series: series.coefficients,
                strain_limits: series.strain_limits,
                n_blocks: slider.sum_of_drive_springs(lattice),
            },
            energies,
            static_limit_squares: static_limits.map(|limit| limit * limit).collect(),
            kinetic_impulses: kinetic_forces
                .map(|force| integrator.force_to_velocity * force)
                .collect(),
            flags: (0..n).map(|b| flags(&model, b)).collect(),
            steps_done: 0,
            motion: Motion {
                bounds: bounds.to_numbers(),
                velocity_after,
                stress_square_max: 0.0,
            },
            state: state.cloned().unwrap_or_else(|| State::at_rest(n)),
            first_slips: vec![NEVER; n],
            records: VecDeque::new(),
            velocity_at_start: velocity_after,
            model,
        })
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
