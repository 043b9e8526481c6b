//! The reference kernel: one pass over the blocks per equation, to be read along with the paper.
//!
//! The passes go over one part of the blocks after the other, so that what one has found is in the cache for the next.
//! A step moves the blocks (Eq. 8), finds the forces on them (Eqs. 2, 3) and lets friction and damping act (Eqs. 4-7).
//! Forces of opposite neighbours are summed in pairs, straight ones before diagonal ones, so that the trajectory of a rotated
//! or mirrored problem is the rotated or mirrored trajectory, with the same bits.

mod contact;
mod contact_springs;
mod drive;
mod forces;
mod rate_and_state;
mod rows;
mod springs;
mod thresholds;
mod weighted;

use std::ops::Range;
use std::sync::Arc;

use fearless_simd::{Level, dispatch};

use self::contact::Contact;
use self::drive::DrivenBlocks;
use self::forces::{Forces, part, part_mut};
use self::rows::Rows;
use self::springs::{damper_forces, lattice_energy, lattice_forces};
use self::weighted::{Scratch, add_weighted, dot_products};
use super::block::{Block, Field};
use super::engine::Engine;
use super::totals::{ContactTotals, StoredEnergy, Totals};
use crate::checkpoint::{BlockColumn, Checkpoint, MotionBounds};
use crate::communicator::Communicator;
use crate::fixed_point::RunningSum;
use crate::friction::{BlockState, FrictionLaw, Integrator, Law, Literal, Projection, Reversal};
use crate::lattice::Bond;
use crate::model::Model;
use crate::moduli::Moduli;
use crate::position_bins::PositionBins;
use crate::reductions;
use crate::state::State;
use crate::vector_field::VectorField;

/// Blocks of a part, unless a row has more.
const PART: usize = 512;

/// Blocks of each part but the last. A part has whole rows, so that no neighbour in the row of a block lies in a later part.
fn part_len(model: &Model) -> usize {
    let nx = model.lattice.nx;
    (PART / nx).max(1) * nx
}

/// All blocks of this rank, part by part.
fn parts(model: &Model) -> impl Iterator<Item = Range<usize>> + use<> {
    let (n, len) = (model.surface.n_blocks(), part_len(model));
    (0..n).step_by(len).map(move |first| first..n.min(first + len))
}

/// Dampers beside the springs between blocks.
#[derive(Debug)]
struct Dampers {
    force: VectorField,
    /// Of the damper along each bond.
    bonds: [VectorField; 4],
}

/// Sums over blocks that every step finds.
type Sums = [RunningSum; 12];

/// The state of the blocks of this rank, and the forces of the latest step.
pub(crate) struct Reference {
    rows: Rows,
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
    /// Relative stiffness of the spring of every block of the rows along each bond, if they are not all alike.
    relative_springs: Option<[Vec<f64>; 4]>,
    dampers: Option<Dampers>,
    sums: Sums,
    /// Those of energies: kinetic half a step before and after, and of the drive springs.
    energy_sums: [RunningSum; 3],
    scratch: Scratch,
    /// Power that the dampers take.
    viscous_power: f64,
    contact_totals: ContactTotals,
    first_slip: Vec<f64>,
    stress_square_max: f64,
}

impl Reference {
    /// All `ranks` of a lattice must call this together, and then the same functions.
    pub(crate) fn new(model: &Model, dt_star: f64, state: State, ranks: Arc<dyn Communicator>) -> Self {
        let n = model.surface.n_blocks();
        let rows = Rows::new(model, ranks);
        let zeros = || VectorField::zeros(n);
        let bonds = || [(); 4].map(|()| VectorField::zeros(rows.lattice.n_blocks()));
        let slider = &model.slider;
        let moduli = Moduli::new(slider, &model.lattice, &model.rows, rows.ranks());
        let relative = || Bond::ALL.map(|bond| rows.springs_along(&moduli, &bond));
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
                springs: bonds(),
            },
            static_limit: (0..n).map(|b| model.surface.static_limit(b)).collect(),
            kinetic_force: (0..n).map(|b| model.surface.kinetic_force(b)).collect(),
            driven: DrivenBlocks::of(model),
            contact: Contact::new(model),
            relative_springs: (!slider.has_equal_springs()).then(relative),
            dampers: slider.is_viscous().then(|| Dampers {
                force: zeros(),
                bonds: bonds(),
            }),
            sums: Sums::default(),
            energy_sums: Default::default(),
            scratch: Scratch::new(part_len(model).min(n)),
            viscous_power: 0.0,
            contact_totals: ContactTotals::default(),
            first_slip: vec![f64::NAN; n],
            stress_square_max: 0.0,
            rows,
        }
    }

    /// Continues from a checkpoint: its instant is evaluated again to find forces, friction and velocities.
    pub(crate) fn resume<E>(
        model: &Model,
        dt_star: f64,
        checkpoint: &Checkpoint,
        ranks: Arc<dyn Communicator>,
        mut read: impl FnMut(usize, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let n = model.surface.n_blocks();
        let mut kernel = Self {
            stress_square_max: checkpoint.stress_square_max,
            ..Self::new(model, dt_star, State::at_rest(n), ranks)
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

    /// Moves the blocks, unless it is the first step, and finds the forces on them, their next velocities, and the sums over them.
    #[inline(always)]
    fn advance(&mut self, model: &Model, time_star: f64, energies: bool) -> Totals {
        if std::mem::replace(&mut self.started, true) {
            for blocks in parts(model) {
                self.move_blocks(model, &blocks);
            }
        }
        self.rows.exchange(&self.state);
        let (mut counts, mut is_evaluated) = ([0; 2], false);
        let found = loop {
            for blocks in parts(model) {
                if !is_evaluated {
                    self.evaluate(model, &blocks, time_star);
                    self.count(model, &blocks, time_star, &mut counts);
                }
                self.add_up(model, &blocks);
            }
            is_evaluated = true;
            if let Some(found) = RunningSum::finish(self.rows.ranks(), &mut self.sums) {
                break found;
            }
        };
        let [
            ux,
            uy,
            vx,
            vy,
            ax,
            ay,
            square,
            friction,
            viscous,
            held,
            broken,
            states,
        ] = found;
        self.rows.ranks().sum(&mut counts);
        let [n_sliding, n_slipping] = counts.map(|count| count as usize);
        self.viscous_power = 0.0 - viscous;
        self.contact_totals = ContactTotals {
            spring_energy: held,
            broken_energy: broken,
            mean_state: states / model.surface.n_contact() as f64,
        };
        let stored_energy = energies.then(|| self.stored_energy(model, time_star));
        std::mem::swap(&mut self.state.velocity, &mut self.forces.velocity);
        Totals {
            displacement: [ux, uy],
            velocity: [vx, vy],
            velocity_after: [ax, ay],
            velocity_square: square,
            friction_power: friction,
            n_sliding,
            n_slipping,
            stored_energy,
        }
    }

    /// Lets the law of friction remember what some blocks did in the step before, and moves them.
    #[inline(always)]
    fn move_blocks(&mut self, model: &Model, blocks: &Range<usize>) {
        let State {
            displacement,
            velocity,
        } = &mut self.state;
        match &mut self.contact {
            Contact::Coulomb(_) => {}
            Contact::RateAndState(contact) => contact.evolve(blocks, velocity, self.dt_star),
            Contact::Springs(springs) => {
                let (breaks, threshold) = (&self.forces.slides, &mut self.static_limit);
                springs.form_again(model, blocks, displacement, breaks, threshold);
            }
        }
        move_blocks(displacement, velocity, blocks, self.dt_star);
    }

    /// Finds the forces on some blocks, and their next velocities.
    #[inline(always)]
    fn evaluate(&mut self, model: &Model, blocks: &Range<usize>, time_star: f64) {
        let displacement = &self.state.displacement;
        let drive = &mut self.forces.drive;
        self.driven.forces(model, blocks, displacement, time_star, drive);
        let Forces { lattice, springs, .. } = &mut self.forces;
        let (rows, relative) = (&self.rows, self.relative_springs.as_ref());
        let state = rows.state(&self.state);
        lattice_forces(model, rows, blocks, state, relative, lattice, springs);
        if let Some(Dampers { force, bonds }) = &mut self.dampers {
            damper_forces(model, rows, blocks, state, relative, force, bonds);
            add_to(lattice, force, blocks);
        }
        let integrator = Integrator::new(model.damping, self.dt_star);
        match &model.slider.density {
            None => self.apply_friction(blocks, |_| integrator, time_star, model),
            Some(masses) => {
                let masses = &masses[blocks.clone()];
                self.apply_friction(blocks, |k| integrator.of_mass(masses[k]), time_star, model);
            }
        }
    }

    /// Eqs. 4-7: friction and damping, and the velocity half a step later, of some blocks. `integrator`: of the first, the second
    /// and so on of them.
    #[inline(always)]
    fn apply_friction(
        &mut self,
        blocks: &Range<usize>,
        integrator: impl Fn(usize) -> Integrator,
        time_star: f64,
        model: &Model,
    ) {
        let (state, forces) = (&self.state, &mut self.forces);
        match &mut self.contact {
            Contact::Coulomb(thresholds) => {
                let (young, at_rest) = (&self.static_limit, &self.kinetic_force);
                thresholds.update(blocks, young, at_rest, state, forces, time_star);
                let now = thresholds.now(young, at_rest);
                match thresholds.law {
                    FrictionLaw::Projection => {
                        friction_forces(&Projection, integrator, blocks, now, state, forces);
                    }
                    FrictionLaw::Reversal => {
                        friction_forces(&Reversal, integrator, blocks, now, state, forces);
                    }
                    FrictionLaw::Literal => {
                        friction_forces(&Literal, integrator, blocks, now, state, forces);
                    }
                }
                thresholds.note_stops(blocks, state, forces, time_star);
            }
            Contact::RateAndState(contact) => contact.apply(blocks, state, integrator, forces),
            Contact::Springs(springs) => {
                springs.apply(model, blocks, state, &self.static_limit, integrator, forces);
            }
        }
    }

    /// Counts which of some blocks slide, and which of these are in contact; notes the first slips of these.
    #[inline(always)]
    fn count(&mut self, model: &Model, blocks: &Range<usize>, time_star: f64, counts: &mut [i64; 2]) {
        let n = blocks.len();
        let textured = &model.surface.textured[blocks.clone()][..n];
        let slides = &self.forces.slides[blocks.clone()][..n];
        let first_slip = &mut self.first_slip[blocks.clone()][..n];
        let (mut n_sliding, mut n_slipping) = (0_u32, 0_u32);
        for k in 0..n {
            let slips = slides[k] & !textured[k];
            n_sliding += u32::from(slides[k]);
            n_slipping += u32::from(slips);
            let is_first = slips & first_slip[k].is_nan();
            first_slip[k] = if is_first { time_star } else { first_slip[k] };
        }
        counts[0] += i64::from(n_sliding);
        counts[1] += i64::from(n_slipping);
    }

    /// Adds up what every step sums over blocks, after their next velocities are known.
    #[inline(always)]
    fn add_up(&mut self, model: &Model, blocks: &Range<usize>) {
        let (n, scratch) = (blocks.len(), &mut self.scratch);
        let ([bx, by], [ax, ay]) = (
            part(&self.state.velocity, blocks),
            part(&self.forces.velocity, blocks),
        );
        let (bx, by, ax, ay) = (&bx[..n], &by[..n], &ax[..n], &ay[..n]);
        let mut velocity = std::mem::take(&mut scratch.velocity);
        let (vx, vy) = (&mut velocity.x[..n], &mut velocity.y[..n]);
        for k in 0..n {
            vx[k] = 0.5 * (bx[k] + ax[k]);
            vy[k] = 0.5 * (by[k] + ay[k]);
        }
        let now = [&*vx, &*vy];
        let [
            ux,
            uy,
            vx,
            vy,
            wx,
            wy,
            square,
            friction,
            viscous,
            held,
            broken,
            states,
        ] = &mut self.sums;
        let (driven, displacement) = (&self.driven, &self.state.displacement);
        driven.add(model, blocks, part(displacement, blocks), [ux, uy], scratch);
        driven.add(model, blocks, now, [vx, vy], scratch);
        driven.add(model, blocks, [ax, ay], [wx, wy], scratch);
        let masses = model
            .slider
            .density
            .as_ref()
            .map(|masses| &masses[blocks.clone()]);
        dot_products(now, now, &mut scratch.terms[..n]);
        add_weighted(square, &scratch.terms[..n], masses, &mut scratch.products);
        match &self.contact {
            Contact::Coulomb(_) => {}
            Contact::RateAndState(contact) => contact.add_states(model, blocks, states, scratch),
            Contact::Springs(springs) => {
                let breaks = &self.forces.slides;
                springs.add_energies(model, blocks, displacement, breaks, [held, broken], scratch);
            }
        }
        let terms = &mut scratch.terms[..n];
        // What springs to the substrate take is stored, or lost where they break.
        if !matches!(self.contact, Contact::Springs(_)) {
            dot_products(part(&self.forces.friction, blocks), now, terms);
            friction.add(terms);
        }
        if let Some(dampers) = &self.dampers {
            dot_products(part(&dampers.force, blocks), now, terms);
            viscous.add(terms);
        }
        scratch.velocity = velocity;
        self.find_largest_stress(model, blocks);
    }

    /// Eq. 10: the largest contact stress of a block in contact at any step.
    #[inline(always)]
    fn find_largest_stress(&mut self, model: &Model, blocks: &Range<usize>) {
        let (n, squares) = (blocks.len(), &mut self.scratch.terms);
        let ([fx, fy], [lx, ly]) = (
            part(&self.forces.friction, blocks),
            part(&self.forces.lattice, blocks),
        );
        let (fx, fy, lx, ly, squares) = (&fx[..n], &fy[..n], &lx[..n], &ly[..n], &mut squares[..n]);
        let textured = &model.surface.textured[blocks.clone()][..n];
        for k in 0..n {
            let (x, y) = (fx[k] + lx[k], fy[k] + ly[k]);
            squares[k] = if textured[k] { 0.0 } else { x * x + y * y };
        }
        let largest = reductions::largest(n, |k| squares[k]);
        self.stress_square_max = self.stress_square_max.max(largest);
    }

    /// Energies of all blocks, after their next velocities are known.
    #[inline(always)]
    fn stored_energy(&mut self, model: &Model, time_star: f64) -> StoredEnergy {
        let displacement = &self.state.displacement;
        let [before, after, drive_springs] = loop {
            let [before, after, drive_springs] = &mut self.energy_sums;
            for blocks in parts(model) {
                let (n, scratch) = (blocks.len(), &mut self.scratch);
                let masses = model
                    .slider
                    .density
                    .as_ref()
                    .map(|masses| &masses[blocks.clone()]);
                for (velocity, sum) in [
                    (&self.state.velocity, &mut *before),
                    (&self.forces.velocity, &mut *after),
                ] {
                    let velocity = part(velocity, &blocks);
                    dot_products(velocity, velocity, &mut scratch.terms[..n]);
                    add_weighted(sum, &scratch.terms[..n], masses, &mut scratch.products);
                }
                self.driven
                    .add_squares(model, &blocks, displacement, time_star, drive_springs, scratch);
            }
            if let Some(found) = RunningSum::finish(self.rows.ranks(), &mut self.energy_sums) {
                break found;
            }
        };
        let relative = self.relative_springs.as_ref();
        StoredEnergy {
            kinetic: 0.25 * (before + after),
            lattice: lattice_energy(
                &self.rows,
                &self.rows.state(&self.state).displacement,
                relative,
                model.epsilon,
                &mut self.scratch.terms,
            ),
            drive_springs: 0.5 * model.drive.k_drive * drive_springs,
        }
    }
}

impl Engine for Reference {
    fn step(&mut self, model: &Model, number: u64, energies: bool) -> Totals {
        let time_star = number as f64 * self.dt_star;
        dispatch!(Level::new(), _ => self.advance(model, time_star, energies))
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
        let is_read = |j: &usize| (model.rows.start + j).is_multiple_of(stride);
        for j in (0..model.rows.len()).filter(is_read) {
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
        let mut largest = [self.stress_square_max];
        self.rows.ranks().largest(&mut largest);
        largest[0]
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

    fn memory(&self) -> Vec<&[f64]> {
        self.contact.columns()
    }

    /// Half a step before the present instant, which is evaluated again when it resumes.
    fn checkpoint_velocity(&self, b: usize) -> [f64; 2] {
        self.forces.velocity.at(b)
    }
}

#[inline(always)]
fn add_to(field: &mut VectorField, other: &VectorField, blocks: &Range<usize>) {
    for (values, others) in part_mut(field, blocks).into_iter().zip(part(other, blocks)) {
        values
            .iter_mut()
            .zip(others)
            .for_each(|(value, other)| *value += other);
    }
}

/// Eq. 8: `u(t + dt) = u(t) + dt v(t + dt/2)`.
#[inline(always)]
fn move_blocks(displacement: &mut VectorField, velocity: &VectorField, blocks: &Range<usize>, dt_star: f64) {
    for (u, v) in part_mut(displacement, blocks)
        .into_iter()
        .zip(part(velocity, blocks))
    {
        u.iter_mut().zip(v).for_each(|(u, v)| *u += dt_star * v);
    }
}

/// Applies the friction law to some blocks: finds friction, velocities and which slide from thresholds, velocities and forces.
#[inline(always)]
fn friction_forces<L: Law>(
    law: &L,
    integrator: impl Fn(usize) -> Integrator,
    blocks: &Range<usize>,
    thresholds: [&[f64]; 2],
    state: &State,
    forces: &mut Forces,
) {
    apply_friction(
        law,
        integrator,
        thresholds.map(|array| &array[blocks.clone()]),
        part(&state.velocity, blocks),
        [part(&forces.drive, blocks), part(&forces.lattice, blocks)],
        part_mut(&mut forces.friction, blocks),
        part_mut(&mut forces.velocity, blocks),
        &mut forces.slides[blocks.clone()],
    );
}

/// The same, given separate slices.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // Separate slices are known not to overlap, so that the loop is vectorised.
fn apply_friction<L: Law>(
    law: &L,
    integrator: impl Fn(usize) -> Integrator,
    thresholds: [&[f64]; 2],
    velocity: [&[f64]; 2],
    forces: [[&[f64]; 2]; 2],
    friction: [&mut [f64]; 2],
    after: [&mut [f64]; 2],
    slides: &mut [bool],
) {
    let n = slides.len();
    let [static_limit, kinetic_force] = thresholds.map(|array| &array[..n]);
    let [vx, vy] = velocity.map(|array| &array[..n]);
    let [[drive_x, drive_y], [lattice_x, lattice_y]] = forces.map(|force| force.map(|array| &array[..n]));
    let [friction_x, friction_y] = friction.map(|array| &mut array[..n]);
    let [after_x, after_y] = after.map(|array| &mut array[..n]);
    for k in 0..n {
        let update = law.update(
            &BlockState {
                velocity: [vx[k], vy[k]],
                force: [drive_x[k] + lattice_x[k], drive_y[k] + lattice_y[k]],
                static_limit: static_limit[k],
                kinetic_force: kinetic_force[k],
            },
            &integrator(k),
        );
        [friction_x[k], friction_y[k]] = update.friction;
        [after_x[k], after_y[k]] = update.velocity;
        slides[k] = update.slides;
    }
}
