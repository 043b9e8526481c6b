//! Answers to the vector kernel about a model: the properties of its blocks, their largest factors, a step.

use slipfront_kernel::{
    Block, Blocks, ChangingLaw, FallWithSpeed, Integrator, LargestFactors, Properties, Step,
};

use crate::clock::Clock;
use crate::communicator::Communicator;
use crate::model::Model;
use crate::moduli::Moduli;
use crate::state::State;

/// The blocks of a model in a state, or at rest.
pub(super) struct ModelBlocks<'a> {
    pub(super) model: &'a Model,
    pub(super) moduli: &'a Moduli<'a>,
    pub(super) state: Option<&'a State>,
}

impl Blocks for ModelBlocks<'_> {
    fn block(&self, b: usize) -> Block {
        let Model { slider, surface, .. } = self.model;
        Block {
            exists: slider.exists(b),
            is_textured: surface.textured[b],
            static_limit: surface.static_limit(b),
            kinetic_force: surface.kinetic_force(b),
            normal_force: surface.load(b),
            mass: slider.mass(b),
            drive_spring: slider.drive_spring(b),
            relative_dead_load: self.model.dead_load.relative(b),
            motion: self
                .state
                .map(|state| [state.displacement.at(b), state.velocity.at(b)]),
        }
    }

    fn spring(&self, column_row: [usize; 2], offset: [isize; 2]) -> f64 {
        self.moduli.spring(column_row, offset)
    }
}

impl<'a> ModelBlocks<'a> {
    /// Properties of the slider; `blocks_differ` says whether its blocks do.
    pub(super) fn properties(&'a self, blocks_differ: bool, dt_star: f64) -> Properties<'a> {
        let model = self.model;
        Properties {
            blocks: self,
            blocks_differ,
            dead_loads_differ: model.dead_load.field.is_some(),
            has_gaps: model.slider.outline.is_some(),
            changing: changing_law(model),
            foundation: model.friction.interface().map(|law| law.foundation),
            force_to_velocity: Integrator::new(model.damping, dt_star).force_to_velocity,
        }
    }
}

/// Law by which the thresholds of a model change; none for other models.
fn changing_law(model: &Model) -> Option<ChangingLaw> {
    let coulomb = model.friction.coulomb()?;
    match (coulomb.weakening, coulomb.slip_weakening) {
        (Some(law), _) => Some(ChangingLaw::Speed(FallWithSpeed {
            critical_speed: law.critical_speed,
            ratio: law.ratio,
            adhesion: model.surface.adhesion().of_kinetic,
        })),
        (None, Some(law)) => Some(ChangingLaw::Slip(law)),
        (None, None) => None,
    }
}

/// Whether springs, masses or loads of a model differ from block to block.
pub(crate) fn blocks_differ(model: &Model, largest: &LargestFactors) -> bool {
    let slider = &model.slider;
    // Drive springs of 1 on every existing block are those of a plain slider.
    let drive_springs_differ = slider
        .drive_springs
        .as_ref()
        .is_some_and(|springs| largest.drive_spring > 1.0 || springs.sum != model.n_blocks() as f64);
    slider.stiffness.is_some()
        || slider.halves_edge_springs
        || slider.density.is_some()
        || drive_springs_differ
        || model.dead_load.field.is_some()
        || model.friction.needs().varies
}

/// Largest factors of all blocks of all ranks, which must call this together.
pub(crate) fn largest_factors(model: &Model, communicator: &dyn Communicator) -> LargestFactors {
    let slider = &model.slider;
    let largest = |differs: bool, value: &dyn Fn(usize) -> f64| {
        if differs {
            (0..model.surface.n_blocks()).map(value).fold(0.0, f64::max)
        } else {
            1.0
        }
    };
    let mut found = [
        largest(slider.stiffness.is_some(), &|b| slider.modulus(b)),
        largest(slider.drive_springs.is_some(), &|b| slider.drive_spring(b)),
        largest(slider.density.is_some(), &|b| slider.mass(b)),
        largest(slider.density.is_some(), &|b| 1.0 / slider.mass(b)),
        largest(model.dead_load.field.is_some(), &|b| {
            model.dead_load.relative(b).abs()
        }),
    ];
    communicator.largest(&mut found);
    let [modulus, drive_spring, mass, inverse_mass, load] = found;
    LargestFactors {
        foundation: model
            .friction
            .interface()
            .map_or(0.0, |interface| interface.foundation),
        modulus,
        drive_spring,
        mass,
        inverse_mass,
        load,
    }
}

/// The step to an instant of a model.
pub(super) fn step(model: &Model, clock: &Clock) -> Step {
    let (drive, dt_star) = (&model.drive, clock.dt_star);
    let (time_star, before) = (clock.drive_time_star(), clock.drive_time_before());
    // The drive moves at most once per step.
    let steps_until = |t: f64| (t / dt_star).round() as u64 - clock.drive_steps;
    Step {
        number: clock.step,
        dt_star,
        move_dt: dt_star,
        k_drive: drive.k_drive,
        drive_position: drive.position(time_star),
        position_before: drive.position(before),
        next_change: drive
            .next_change(time_star)
            .map_or(u64::MAX, |t| clock.step + steps_until(t)),
        force_growth: drive
            .direction
            .map(|d| drive.k_drive * drive.speed_after(time_star) * d),
        dead_load: model.dead_load.force,
        integrator: Integrator::new(model.damping, dt_star),
    }
}
