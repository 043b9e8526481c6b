//! The reference kernel: one pass over the blocks per equation, to be read along with the paper.
//!
//! A step moves the blocks (Eq. 8), finds the forces on them (Eqs. 2, 3) and lets friction and damping act (Eqs. 4-7).
//! Forces of opposite neighbours are summed in pairs, straight ones before diagonal ones, so that the trajectory of a rotated
//! or mirrored problem is the rotated or mirrored trajectory, with the same bits.

mod contact;
mod contact_springs;
mod drive;
mod forces;
mod rate_and_state;
mod springs;
mod thresholds;
mod weighted;

use fearless_simd::{Level, dispatch};

use self::contact::Contact;
use self::drive::DrivenBlocks;
use self::forces::{Forces, components};
use self::springs::{damper_forces, lattice_energy, lattice_forces};
use self::weighted::weighted_sum;
use super::block::{Block, Field};
use super::engine::Engine;
use super::totals::{ContactTotals, StoredEnergy, Totals};
use crate::checkpoint::{BlockColumn, Checkpoint, MotionBounds};
use crate::fixed_point;
use crate::friction::{BlockState, FrictionLaw, Integrator, Law, Literal, Projection, Reversal};
use crate::lattice::Bond;
use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::reductions;
use crate::state::State;
use crate::vector_field::VectorField;

/// The state of all blocks, and the forces of the latest step.
#[derive(Debug)]
pub(crate) struct Reference {
    dt_star: f64,
    /// Whether the first step has been evaluated, which does not move the blocks.
    started: bool,
    /// Displacements at t_n, velocities half a step later.
    state: State,
    forces: Forces,
    /// `mu_s F_n`; of springs in contact the thresholds that they have since they last broke.
    static_limit: Vec<f64>,
    /// `mu_k F_n`.
    kinetic_force: Vec<f64>,
    driven: DrivenBlocks,
    contact: Contact,
    /// Relative stiffness of the spring of every block along each bond, if they are not all alike.
    relative_springs: Option<[Vec<f64>; 4]>,
    /// Forces of the dampers beside the springs, if there are any.
    dampers: Option<VectorField>,
    /// Power that these take.
    viscous_power: f64,
    first_slip: Vec<f64>,
    stress_square_max: f64,
}

impl Reference {
    pub(crate) fn new(model: &Model, dt_star: f64, state: State) -> Self {
        let n = model.lattice.n_blocks();
        let zeros = || VectorField::zeros(n);
        let slider = &model.slider;
        let springs = || Bond::ALL.map(|bond| slider.springs_along(&model.lattice, &bond));
        Self {
            dt_star,
            started: false,
            state,
            forces: Forces {
                drive: zeros(),
                lattice: zeros(),
                friction: zeros(),
                velocity: zeros(),
                slides: vec![false; n],
                springs: [(); 4].map(|()| zeros()),
            },
            static_limit: (0..n).map(|b| model.surface.static_limit(b)).collect(),
            kinetic_force: (0..n).map(|b| model.surface.kinetic_force(b)).collect(),
            driven: DrivenBlocks::of(model),
            contact: Contact::new(model),
            relative_springs: (!slider.has_equal_springs()).then(springs),
            dampers: slider.is_viscous().then(zeros),
            viscous_power: 0.0,
            first_slip: vec![f64::NAN; n],
            stress_square_max: 0.0,
        }
    }

    /// Continues from a checkpoint: its instant is evaluated again to find forces, friction and velocities.
    pub(crate) fn resume<E>(
        model: &Model,
        dt_star: f64,
        checkpoint: &Checkpoint,
        mut read: impl FnMut(usize, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let n = model.lattice.n_blocks();
        let mut kernel = Self {
            stress_square_max: checkpoint.stress_square_max,
            ..Self::new(model, dt_star, State::at_rest(n))
        };
        BlockColumn::for_each_part(n, |column, first, values| {
            let array = match column {
                BlockColumn::DisplacementX => &mut kernel.state.displacement.x,
                BlockColumn::DisplacementY => &mut kernel.state.displacement.y,
                BlockColumn::VelocityX => &mut kernel.state.velocity.x,
                BlockColumn::VelocityY => &mut kernel.state.velocity.y,
                BlockColumn::FirstSlip => &mut kernel.first_slip,
            };
            read(column as usize, first, values)?;
            array[first..][..values.len()].copy_from_slice(values);
            Ok(())
        })?;
        for (column, values) in (BlockColumn::ALL.len()..).zip(kernel.contact.columns_mut()) {
            for (part, values) in values.chunks_mut(BlockColumn::PART).enumerate() {
                read(column, part * BlockColumn::PART, values)?;
            }
        }
        if let Contact::Springs(springs) = &kernel.contact {
            springs.find_thresholds(model, &mut kernel.static_limit);
        }
        kernel.step(model, checkpoint.step, false);
        Ok(kernel)
    }

    #[inline(always)]
    fn advance_and_evaluate(&mut self, model: &Model, time_star: f64) {
        if std::mem::replace(&mut self.started, true) {
            match &mut self.contact {
                Contact::Coulomb(_) => {}
                Contact::RateAndState(contact) => contact.evolve(&self.state.velocity, self.dt_star),
                Contact::Springs(springs) => springs.form_again(
                    model,
                    &self.state.displacement,
                    &self.forces.slides,
                    &mut self.static_limit,
                ),
            }
            move_blocks(&mut self.state, self.dt_star);
        }
        let displacement = &self.state.displacement;
        self.driven
            .forces(model, displacement, time_star, &mut self.forces.drive);
        let Forces { lattice, springs, .. } = &mut self.forces;
        let relative = self.relative_springs.as_ref();
        lattice_forces(model, &self.state, relative, lattice, springs);
        if let Some(dampers) = &mut self.dampers {
            damper_forces(model, &self.state, relative, dampers, springs);
            add_to(&mut lattice.x, &dampers.x);
            add_to(&mut lattice.y, &dampers.y);
        }
        let integrator = Integrator::new(model.damping, self.dt_star);
        let (state, forces, masses) = (&self.state, &mut self.forces, model.slider.density.as_deref());
        match &mut self.contact {
            Contact::Coulomb(thresholds) => {
                thresholds.update(&self.static_limit, &self.kinetic_force, state, forces, time_star);
                let now = thresholds.now(&self.static_limit, &self.kinetic_force);
                match thresholds.law {
                    FrictionLaw::Projection => {
                        friction_forces(&Projection, &integrator, masses, now, state, forces);
                    }
                    FrictionLaw::Reversal => {
                        friction_forces(&Reversal, &integrator, masses, now, state, forces);
                    }
                    FrictionLaw::Literal => {
                        friction_forces(&Literal, &integrator, masses, now, state, forces);
                    }
                }
                thresholds.note_stops(state, forces, time_star);
            }
            Contact::RateAndState(contact) => contact.apply(model, state, &integrator, forces),
            Contact::Springs(springs) => {
                springs.apply(model, state, &self.static_limit, &integrator, forces);
            }
        }
        std::mem::swap(&mut self.state.velocity, &mut self.forces.velocity);
    }

    fn mark_first_slips(&mut self, model: &Model, time_star: f64) {
        let blocks = self.forces.slides.iter().zip(&model.surface.textured);
        for ((slides, textured), time) in blocks.zip(&mut self.first_slip) {
            if *slides && !textured && time.is_nan() {
                *time = time_star;
            }
        }
    }

    /// Sums over all blocks at the present step.
    #[inline(always)]
    fn measure(&mut self, model: &Model, time_star: f64, energies: bool) -> Totals {
        let n = self.static_limit.len();
        let [ux, uy] = components(&self.state.displacement, n);
        let [bx, by] = components(&self.forces.velocity, n);
        let [ax, ay] = components(&self.state.velocity, n);
        let [lx, ly] = components(&self.forces.lattice, n);
        let [fx, fy] = components(&self.forces.friction, n);
        let (textured, slides) = (&model.surface.textured[..n], &self.forces.slides[..n]);
        let mass = model.slider.density.as_deref();
        let driven = |[x, y]: [&[f64]; 2]| self.driven.sums(model, n, |b| x[b], |b| y[b]);
        let squares = |[x, y]: [&[f64]; 2]| weighted_sum(n, mass, |b| x[b] * x[b] + y[b] * y[b]);
        let (vx, vy) = (|b: usize| 0.5 * (bx[b] + ax[b]), |b: usize| 0.5 * (by[b] + ay[b]));
        let slipping = slides.iter().zip(textured);
        let stress_square = reductions::largest(n, |b| {
            let (x, y) = (fx[b] + lx[b], fy[b] + ly[b]);
            if textured[b] { 0.0 } else { x * x + y * y }
        });
        self.stress_square_max = self.stress_square_max.max(stress_square);
        if let Some(dampers) = &self.dampers {
            let [dx, dy] = components(dampers, n);
            self.viscous_power = -fixed_point::sum(n, |b| dx[b] * vx(b) + dy[b] * vy(b));
        }
        Totals {
            displacement: driven([ux, uy]),
            velocity: self.driven.sums(model, n, vx, vy),
            velocity_after: driven([ax, ay]),
            velocity_square: weighted_sum(n, mass, |b| vx(b) * vx(b) + vy(b) * vy(b)),
            friction_power: match self.contact {
                // What these springs take is stored, or lost where they break.
                Contact::Springs(_) => 0.0,
                _ => fixed_point::sum(n, |b| fx[b] * vx(b) + fy[b] * vy(b)),
            },
            n_sliding: slides.iter().filter(|&&slides| slides).count(),
            n_slipping: slipping
                .filter(|&(slides, textured)| *slides && !textured)
                .count(),
            stored_energy: energies.then(|| {
                let displacement = &self.state.displacement;
                let springs = self.relative_springs.as_ref();
                StoredEnergy {
                    kinetic: 0.25 * (squares([bx, by]) + squares([ax, ay])),
                    lattice: lattice_energy(&model.lattice, displacement, springs, model.epsilon),
                    drive_springs: self.driven.energy(model, [ux, uy], time_star),
                }
            }),
        }
    }
}

impl Engine for Reference {
    fn step(&mut self, model: &Model, number: u64, energies: bool) -> Totals {
        let time_star = number as f64 * self.dt_star;
        let level = Level::new();
        dispatch!(level, _ => self.advance_and_evaluate(model, time_star));
        self.mark_first_slips(model, time_star);
        dispatch!(level, _ => self.measure(model, time_star, energies))
    }

    fn block(&self, _: &Model, _: u64, b: usize) -> Block {
        Block {
            displacement: self.state.displacement.at(b),
            velocity: self.state.velocity.at(b),
            force_drive: self.forces.drive.at(b),
            force_lattice: self.forces.lattice.at(b),
            force_friction: self.forces.friction.at(b),
        }
    }

    fn read_rows(
        &self,
        model: &Model,
        number: u64,
        field: Field,
        stride: usize,
        write: &mut dyn FnMut(usize, usize, &[f32]),
    ) {
        const WIDTH: usize = 128;
        let lattice = &model.lattice;
        let mut values = [0.0; WIDTH];
        for j in (0..lattice.ny).step_by(stride) {
            for i in (0..lattice.nx).step_by(WIDTH) {
                let values = &mut values[..WIDTH.min(lattice.nx - i)];
                for (value, b) in values.iter_mut().zip(lattice.block(i, j)..) {
                    *value = match field {
                        Field::Sliding => f32::from(u8::from(self.forces.slides[b])),
                        _ => field.value(&self.block(model, number, b), model.surface.textured[b]) as f32,
                    };
                }
                write(j, i, values);
            }
        }
    }

    fn count_in_contact(&self, model: &Model, bins: &PositionBins, sliding: bool, counts: &mut [i64]) {
        let first = model.lattice.blocks_of(&model.rows).start;
        let blocks = self.forces.slides.iter().zip(&model.surface.textured);
        for (b, (slides, textured)) in (first..).zip(blocks) {
            if *slides == sliding && !textured {
                let (i, j) = model.lattice.column_row(b);
                counts[bins.bin(i, j)] += 1;
            }
        }
    }

    fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        [self.state.displacement.at(b), self.state.velocity.at(b)]
    }

    fn first_slip(&self, b: usize) -> f64 {
        self.first_slip[b]
    }

    fn into_first_slips(self: Box<Self>) -> Vec<f64> {
        self.first_slip
    }

    fn stress_square_max(&self, _: &Model, _: u64) -> f64 {
        self.stress_square_max
    }

    fn viscous_power(&self) -> f64 {
        self.viscous_power
    }

    fn motion_bounds(&self) -> Option<MotionBounds> {
        None
    }

    fn contact_totals(&self, model: &Model) -> ContactTotals {
        match &self.contact {
            Contact::Coulomb(_) => ContactTotals::default(),
            Contact::RateAndState(contact) => contact.totals(model),
            Contact::Springs(springs) => springs.totals(model, &self.state.displacement, &self.forces.slides),
        }
    }

    fn memory(&self) -> Vec<&[f64]> {
        self.contact.columns()
    }

    /// Half a step before the present instant, which is evaluated again when it resumes.
    fn checkpoint_velocity(&self, b: usize) -> [f64; 2] {
        self.forces.velocity.at(b)
    }
}

#[inline(always)]
fn add_to(values: &mut [f64], others: &[f64]) {
    values
        .iter_mut()
        .zip(others)
        .for_each(|(value, other)| *value += other);
}

/// Eq. 8: `u(t + dt) = u(t) + dt v(t + dt/2)`.
#[inline(always)]
fn move_blocks(state: &mut State, dt_star: f64) {
    let (displacement, velocity) = (&mut state.displacement, &state.velocity);
    for (u, v) in [
        (&mut displacement.x, &velocity.x),
        (&mut displacement.y, &velocity.y),
    ] {
        u.iter_mut().zip(v).for_each(|(u, v)| *u += dt_star * v);
    }
}

/// Eqs. 4-7: friction and damping, and the velocity half a step later, of blocks with these masses; 1 if there are none.
#[inline(always)]
fn friction_forces<L: Law>(
    law: &L,
    integrator: &Integrator,
    masses: Option<&[f64]>,
    thresholds: [&[f64]; 2],
    state: &State,
    forces: &mut Forces,
) {
    match masses {
        None => friction_of_masses(law, |_| *integrator, thresholds, state, forces),
        Some(masses) => {
            friction_of_masses(law, |b| integrator.of_mass(masses[b]), thresholds, state, forces);
        }
    }
}

#[inline(always)]
fn friction_of_masses<L: Law>(
    law: &L,
    integrator: impl Fn(usize) -> Integrator,
    thresholds: [&[f64]; 2],
    state: &State,
    forces: &mut Forces,
) {
    let (drive, lattice, before) = (&forces.drive, &forces.lattice, &state.velocity);
    apply_friction(
        law,
        integrator,
        thresholds,
        [&before.x, &before.y],
        [&drive.x, &drive.y, &lattice.x, &lattice.y],
        [&mut forces.friction.x, &mut forces.friction.y],
        [&mut forces.velocity.x, &mut forces.velocity.y],
        &mut forces.slides,
    );
}

/// Applies the friction law to every block: finds friction, velocities and which slide from thresholds, velocities and forces.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // Separate slices are known not to overlap, so that the loop is vectorised.
fn apply_friction<L: Law>(
    law: &L,
    integrator: impl Fn(usize) -> Integrator,
    thresholds: [&[f64]; 2],
    velocity: [&[f64]; 2],
    forces: [&[f64]; 4],
    friction: [&mut [f64]; 2],
    after: [&mut [f64]; 2],
    slides: &mut [bool],
) {
    let n = slides.len();
    let [static_limit, kinetic_force] = thresholds.map(|array| &array[..n]);
    let [vx, vy] = velocity.map(|array| &array[..n]);
    let [drive_x, drive_y, lattice_x, lattice_y] = forces.map(|array| &array[..n]);
    let [friction_x, friction_y] = friction.map(|array| &mut array[..n]);
    let [after_x, after_y] = after.map(|array| &mut array[..n]);
    for b in 0..n {
        let update = law.update(
            &BlockState {
                velocity: [vx[b], vy[b]],
                force: [drive_x[b] + lattice_x[b], drive_y[b] + lattice_y[b]],
                static_limit: static_limit[b],
                kinetic_force: kinetic_force[b],
            },
            &integrator(b),
        );
        [friction_x[b], friction_y[b]] = update.friction;
        [after_x[b], after_y[b]] = update.velocity;
        slides[b] = update.slides;
    }
}
