//! Some rows of the blocks of a rank, which one thread advances by a step.

use std::ops::Range;

use super::drive::DrivenBlocks;
use super::rows::Rows;
use super::springs::{Damper, Spring, row_energies, sum_connections};
use super::weighted::{WeightedScratch, add_weighted, dot_products};
use crate::checkpoint::BlockColumn;
use crate::clock::Clock;
use crate::forces::{Forces, part, part_mut, values_of, values_of_mut};
use slipfront_kernel::Integrator;
use slipfront_kernel::fixed_point::RunningSum;

use crate::friction::BandContact;
use crate::kernel::block::Block;
use crate::lattice::Bond;
use crate::model::Model;
use crate::moduli::Moduli;
use crate::state::State;
use crate::vector_field::VectorField;
use slipfront_kernel::reductions;

// So few that the results of one pass are still in the cache when the next pass needs them.
/// Number of blocks of a part, unless a row has more.
const PART: usize = 512;

/// Number of blocks of each part but the last. A part has whole rows, so that no neighbour in the row of a
/// block lies in a later part.
fn part_len(model: &Model) -> usize {
    let nx = model.lattice.nx;
    (PART / nx).max(1) * nx
}

/// All blocks of these rows, part by part.
fn parts(model: &Model) -> impl Iterator<Item = Range<usize>> + use<> {
    let (n, len) = (model.surface.n_blocks(), part_len(model));
    (0..n).step_by(len).map(move |first| first..n.min(first + len))
}

/// Sums over blocks that every step computes; [`Summed`] names them.
pub(super) type BandSums = [RunningSum; 12];

/// One value for each of the [`BandSums`]. The first three are sums over the drive springs.
pub(super) struct Summed<T> {
    pub(super) displacement: [T; 2],
    pub(super) velocity: [T; 2],
    pub(super) velocity_after: [T; 2],
    pub(super) velocity_square: T,
    /// Power of friction, `F_f . v`.
    pub(super) friction_power: T,
    /// Power of the dampers, `F_v . v`.
    pub(super) viscous_power: T,
    /// Sums of the law of friction, see [`BandContact::add_up`].
    pub(super) contact: [T; 3],
}

impl<T> From<[T; 12]> for Summed<T> {
    fn from(values: [T; 12]) -> Self {
        let [ux, uy, vx, vy, ax, ay, others @ ..] = values;
        let [velocity_square, friction_power, viscous_power, contact @ ..] = others;
        Self {
            displacement: [ux, uy],
            velocity: [vx, vy],
            velocity_after: [ax, ay],
            velocity_square,
            friction_power,
            viscous_power,
            contact,
        }
    }
}

/// Forces of a body on the blocks of a band.
#[derive(Clone, Copy)]
pub(super) struct BodyForces<'a> {
    /// Force on every block of the band along x and y.
    pub(super) force: [&'a [f64]; 2],
    /// Mean displacement of all blocks, by which the drive springs pull.
    pub(super) mean: [f64; 2],
}

/// Dampers in parallel with the springs between blocks.
#[derive(Debug)]
struct Dampers {
    force: VectorField,
    /// Force of the damper along each bond.
    bonds: [VectorField; 4],
}

/// The state of the blocks of some rows, the forces of the latest step, and the sums over them.
pub(super) struct Band {
    pub(super) rows: Rows,
    dt_star: f64,
    /// Displacements at t_n, velocities half a step later.
    pub(super) state: State,
    pub(super) forces: Forces,
    /// Static thresholds `mu_s F_n`, changed by the law of friction since a block last slipped.
    static_limit: Vec<f64>,
    /// Kinetic friction `mu_k F_n`.
    kinetic_force: Vec<f64>,
    driven: DrivenBlocks,
    pub(super) contact: BandContact,
    /// Relative stiffness of the spring of every block of the rows along each bond, for a heterogeneous
    /// slider.
    relative_springs: Option<[Vec<f64>; 4]>,
    dampers: Option<Dampers>,
    pub(super) sums: BandSums,
    /// Sums of energies: kinetic half a step before and after, of the drive springs, and of a body.
    pub(super) energy_sums: [RunningSum; 4],
    /// Energies of the springs between blocks along each bond, one number per row; none of a body.
    pub(super) row_energies: [Vec<f64>; 4],
    /// Number of sliding blocks, and of sliding blocks in contact.
    pub(super) counts: [i64; 2],
    scratch: WeightedScratch,
    pub(super) first_slip: Vec<f64>,
    pub(super) stress_square_max: f64,
    /// Largest square of a speed after the latest step, for a bulk body.
    pub(super) speed_square_max: f64,
}

impl Band {
    /// The band of the rows of a model. `moduli`: moduli of the whole rank.
    pub(super) fn new(model: &Model, moduli: &Moduli, dt_star: f64, state: State) -> Self {
        let n = model.surface.n_blocks();
        let rows = Rows::new(model);
        let zeros = || VectorField::zeros(n);
        let bonds = || [(); 4].map(|()| VectorField::zeros(rows.lattice.n_blocks()));
        let (slider, first_block) = (&model.slider, model.first_block());
        let relative = || Bond::ALL.map(|bond| rows.springs_along(moduli, &bond));
        Self {
            dt_star,
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
            driven: DrivenBlocks::new(model),
            contact: BandContact::new(&model.friction, &model.surface, &model.dead_load, first_block),
            relative_springs: (!slider.has_equal_springs()).then(relative),
            dampers: slider.is_viscous().then(|| Dampers {
                force: zeros(),
                bonds: bonds(),
            }),
            sums: BandSums::default(),
            energy_sums: Default::default(),
            row_energies: Default::default(),
            counts: [0; 2],
            scratch: WeightedScratch::new(part_len(model).min(n)),
            first_slip: vec![f64::NAN; n],
            stress_square_max: 0.0,
            speed_square_max: 0.0,
            rows,
        }
    }

    /// A column of a checkpoint. Velocities are those half a step before the present instant, which a resumed
    /// run evaluates again.
    pub(super) fn column(&self, column: BlockColumn) -> &[f64] {
        match column {
            BlockColumn::DisplacementX => &self.state.displacement.x,
            BlockColumn::DisplacementY => &self.state.displacement.y,
            BlockColumn::VelocityX => &self.forces.velocity.x,
            BlockColumn::VelocityY => &self.forces.velocity.y,
            BlockColumn::FirstSlip => &self.first_slip,
            BlockColumn::Memory(number) => self.contact.columns().swap_remove(number),
        }
    }

    /// A column of a checkpoint, to be filled before its instant is evaluated again.
    pub(super) fn column_mut(&mut self, column: BlockColumn) -> &mut [f64] {
        match column {
            BlockColumn::DisplacementX => &mut self.state.displacement.x,
            BlockColumn::DisplacementY => &mut self.state.displacement.y,
            BlockColumn::VelocityX => &mut self.state.velocity.x,
            BlockColumn::VelocityY => &mut self.state.velocity.y,
            BlockColumn::FirstSlip => &mut self.first_slip,
            BlockColumn::Memory(number) => self.contact.columns_mut().swap_remove(number),
        }
    }

    /// Computes the values that follow from the memory of the law of friction, after a checkpoint has
    /// restored it.
    pub(super) fn resume(&mut self, model: &Model) {
        self.contact.resume(&model.surface, &mut self.static_limit);
    }

    /// Moves the blocks, unless it is the first step.
    #[inline(always)]
    pub(super) fn begin_step(&mut self, model: &Model, moves: bool) {
        for blocks in parts(model) {
            // The first instant is evaluated in the given state.
            if moves {
                self.move_blocks(model, &blocks);
            }
            self.rows.take_over(&self.state, &blocks);
        }
    }

    /// The motion of the first and the last row of this band, see [`Rows::read_ends`].
    pub(super) fn read_ends(&self, ends: &mut [Vec<f64>; 2]) {
        ends.iter_mut().for_each(Vec::clear);
        self.rows.read_ends(&self.state, ends);
    }

    /// Sets the motion of the row below and of the row above, see [`read_ends`](Self::read_ends).
    pub(super) fn set_beside(&mut self, ends: [&[f64]; 2]) {
        self.rows.set_beside(ends);
    }

    /// Computes the forces on the blocks and their next velocities, unless these are known, and adds up the
    /// `sums` over them.
    #[inline(always)]
    pub(super) fn evaluate(
        &mut self,
        model: &Model,
        clock: &Clock,
        is_known: bool,
        sums: BandSums,
        body: Option<BodyForces>,
    ) {
        self.sums = sums;
        if !is_known {
            (self.counts, self.speed_square_max) = ([0; 2], 0.0);
        }
        for blocks in parts(model) {
            // Sums may be needed a second time, if a term has exceeded its bound. Forces and memory stay as
            // they are then.
            if !is_known {
                self.find_forces(model, &blocks, clock, body);
                self.count(model, &blocks, clock.time_star());
                if body.is_some() {
                    let (n, terms) = (blocks.len(), &mut self.scratch.terms);
                    let after = part(&self.forces.velocity, &blocks);
                    dot_products(after, after, &mut terms[..n]);
                    let largest = reductions::largest(n, |k| terms[k]);
                    self.speed_square_max = self.speed_square_max.max(largest);
                }
            }
            self.add_up(model, &blocks);
        }
    }

    /// Adds up the energies of the blocks and the drive springs, and computes those of the springs between
    /// blocks row by row, after the next velocities are known.
    #[inline(always)]
    pub(super) fn add_energies(
        &mut self,
        model: &Model,
        drive_time_star: f64,
        sums: [RunningSum; 4],
        body: Option<BodyForces>,
    ) {
        self.energy_sums = sums;
        let [before, after, drive_springs, of_body] = &mut self.energy_sums;
        let (displacement, mean) = (&self.state.displacement, body.map(|body| body.mean));
        for blocks in parts(model) {
            let (n, scratch) = (blocks.len(), &mut self.scratch);
            let masses = masses(model, &blocks);
            for (velocity, sum) in [
                (&self.state.velocity, &mut *before),
                (&self.forces.velocity, &mut *after),
            ] {
                let velocity = part(velocity, &blocks);
                dot_products(velocity, velocity, &mut scratch.terms[..n]);
                add_weighted(sum, &scratch.terms[..n], masses, &mut scratch.products);
            }
            if body.is_some() {
                let (u, force) = (part(displacement, &blocks), part(&self.forces.lattice, &blocks));
                dot_products(u, force, &mut scratch.terms[..n]);
                of_body.add(&scratch.terms[..n]);
            }
            self.driven.add_squares(
                model,
                &blocks,
                (displacement, mean),
                drive_time_star,
                drive_springs,
                scratch,
            );
        }
        if body.is_none() {
            let relative = self.relative_springs.as_ref();
            let u = &self.rows.state(&self.state).displacement;
            self.row_energies = row_energies(model, &self.rows, u, relative, &mut self.scratch.terms);
        }
    }

    /// Makes the velocities of this step those of the step before, for the next step.
    pub(super) fn end_step(&mut self) {
        // Not earlier: sums and energies need the velocities on both sides of the instant.
        std::mem::swap(&mut self.state.velocity, &mut self.forces.velocity);
    }

    /// Block `b` of these rows with the forces on it.
    pub(super) fn block(&self, b: usize) -> Block {
        Block {
            displacement: self.state.displacement.at(b),
            velocity: self.state.velocity.at(b),
            force_drive: self.forces.drive.at(b),
            force_lattice: self.forces.lattice.at(b),
            force_friction: self.forces.friction.at(b),
            slides: self.forces.slides[b],
        }
    }

    /// Updates the memory of the law of friction with the motion of some blocks in the step before, and moves
    /// them.
    #[inline(always)]
    fn move_blocks(&mut self, model: &Model, blocks: &Range<usize>) {
        let (state, limit) = (&self.state, &mut self.static_limit);
        // Before displacements change: the law reads the state of the step that ends here.
        self.contact
            .remember(&model.surface, blocks, state, &self.forces, limit, self.dt_star);
        let State {
            displacement,
            velocity,
        } = &mut self.state;
        move_blocks(displacement, velocity, blocks, self.dt_star);
    }

    /// Computes the forces on some blocks, and their next velocities.
    #[inline(always)]
    fn find_forces(&mut self, model: &Model, blocks: &Range<usize>, clock: &Clock, body: Option<BodyForces>) {
        let (time_star, drive_time_star) = (clock.time_star(), clock.drive_time_star());
        let displacement = &self.state.displacement;
        let (drive, mean) = (&mut self.forces.drive, body.map(|body| body.mean));
        self.driven
            .forces(model, blocks, (displacement, mean), drive_time_star, drive);
        if let Some(interface) = model.friction.interface() {
            interface.add_reactions(&model.surface, blocks, displacement, drive);
        }
        let Forces { lattice, springs, .. } = &mut self.forces;
        let (rows, relative) = (&self.rows, self.relative_springs.as_ref());
        let (
            State {
                displacement: u,
                velocity: v,
            },
            epsilon,
        ) = (rows.state(&self.state), model.epsilon);
        match body {
            Some(BodyForces { force, .. }) => {
                for (own, force) in part_mut(lattice, blocks).into_iter().zip(force) {
                    own.copy_from_slice(&force[blocks.clone()]);
                }
            }
            None => sum_connections(rows, blocks, &Spring { u, epsilon }, relative, lattice, springs),
        }
        if let Some(Dampers { force, bonds }) = &mut self.dampers {
            let time = model.slider.viscosity_time;
            let damper = Damper { u, v, epsilon, time };
            sum_connections(rows, blocks, &damper, relative, force, bonds);
            add_to(lattice, force, blocks);
        }
        // Chosen outside of the loop: equal masses share one integrator, without a division per block.
        let integrator = Integrator::new(model.damping, self.dt_star);
        match masses(model, blocks) {
            None => self.apply_friction(blocks, |_| integrator, time_star, model),
            Some(masses) => {
                self.apply_friction(blocks, |k| integrator.of_mass(masses[k]), time_star, model);
            }
        }
    }

    /// Friction and damping of some blocks, and their velocities half a step later (Eqs. 4-7). `integrator`:
    /// one for each of these blocks.
    #[inline(always)]
    fn apply_friction(
        &mut self,
        blocks: &Range<usize>,
        integrator: impl Fn(usize) -> Integrator,
        time_star: f64,
        model: &Model,
    ) {
        let limits = [&*self.static_limit, &self.kinetic_force];
        let (now, forces) = ((&self.state, time_star), &mut self.forces);
        self.contact
            .apply(&model.surface, blocks, limits, now, integrator, forces);
    }

    /// Counts the sliding blocks among some blocks, and those of them in contact; records the first slips of
    /// the latter.
    #[inline(always)]
    fn count(&mut self, model: &Model, blocks: &Range<usize>, time_star: f64) {
        let n = blocks.len();
        let textured = values_of(&model.surface.textured, blocks);
        let slides = values_of(&self.forces.slides, blocks);
        let first_slip = values_of_mut(&mut self.first_slip, blocks);
        let (mut n_sliding, mut n_slipping) = (0_u32, 0_u32);
        for k in 0..n {
            n_sliding += u32::from(slides[k]);
            n_slipping += u32::from(slides[k] & !textured[k]);
        }
        // Usually no block slips, or all have slipped before.
        if n_slipping > 0 {
            for k in 0..n {
                let is_first = slides[k] & !textured[k] & first_slip[k].is_nan();
                first_slip[k] = if is_first { time_star } else { first_slip[k] };
            }
        }
        self.counts[0] += i64::from(n_sliding);
        self.counts[1] += i64::from(n_slipping);
    }

    /// Adds up the sums of every step over blocks, after their next velocities are known.
    #[inline(always)]
    fn add_up(&mut self, model: &Model, blocks: &Range<usize>) {
        let (n, scratch) = (blocks.len(), &mut self.scratch);
        let own = [&self.state.velocity, &self.forces.velocity].map(|v| part(v, blocks));
        // Moved out while sums use the rest of the scratch arrays.
        let mut velocity = std::mem::take(&mut scratch.velocity);
        let sums = Summed::from(self.sums.each_mut());
        let now = mean(own, &mut velocity, n);
        let (driven, displacement) = (&self.driven, part(&self.state.displacement, blocks));
        driven.add(model, blocks, displacement, sums.displacement, scratch);
        driven.add(model, blocks, now, sums.velocity, scratch);
        driven.add(model, blocks, own[1], sums.velocity_after, scratch);
        let masses = masses(model, blocks);
        dot_products(now, now, &mut scratch.terms[..n]);
        add_weighted(
            sums.velocity_square,
            &scratch.terms[..n],
            masses,
            &mut scratch.products,
        );
        let (surface, room) = (&model.surface, [&mut scratch.terms[..], &mut scratch.products]);
        let slides = &self.forces.slides;
        self.contact
            .add_up(surface, blocks, &self.state, slides, sums.contact, room);
        let terms = &mut scratch.terms[..n];
        // Contacts that store energy lose it when they break.
        if !model.friction.needs().stores_energy {
            dot_products(part(&self.forces.friction, blocks), now, terms);
            sums.friction_power.add(terms);
        }
        if let Some(dampers) = &self.dampers {
            dot_products(part(&dampers.force, blocks), now, terms);
            sums.viscous_power.add(terms);
        }
        scratch.velocity = velocity;
        self.find_largest_stress(model, blocks);
    }

    /// Finds the largest contact stress (Eq. 10) of a block in contact at any step.
    #[inline(always)]
    fn find_largest_stress(&mut self, model: &Model, blocks: &Range<usize>) {
        let (n, squares) = (blocks.len(), &mut self.scratch.terms);
        let ([fx, fy], [lx, ly]) = (
            part(&self.forces.friction, blocks),
            part(&self.forces.lattice, blocks),
        );
        let (squares, textured) = (&mut squares[..n], values_of(&model.surface.textured, blocks));
        for k in 0..n {
            let (x, y) = (fx[k] + lx[k], fy[k] + ly[k]);
            squares[k] = if textured[k] { 0.0 } else { x * x + y * y };
        }
        let largest = reductions::largest(n, |k| squares[k]);
        self.stress_square_max = self.stress_square_max.max(largest);
    }
}

/// Velocities of `n` blocks at t_n: means of the velocities half a step before and after.
#[inline(always)]
fn mean<'a>([before, after]: [[&[f64]; 2]; 2], velocity: &'a mut VectorField, n: usize) -> [&'a [f64]; 2] {
    let ([bx, by], [ax, ay]) = (before.map(|v| &v[..n]), after.map(|v| &v[..n]));
    let (vx, vy) = (&mut velocity.x[..n], &mut velocity.y[..n]);
    for k in 0..n {
        vx[k] = 0.5 * (bx[k] + ax[k]);
        vy[k] = 0.5 * (by[k] + ay[k]);
    }
    [vx, vy]
}

/// Masses of some blocks, for a heterogeneous slider.
#[inline(always)]
fn masses<'a>(model: &'a Model, blocks: &Range<usize>) -> Option<&'a [f64]> {
    let masses = model.slider.density.as_ref()?;
    Some(values_of(masses, blocks))
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

/// Moves some blocks over a step (Eq. 8), `u(t + dt) = u(t) + dt v(t + dt/2)`.
#[inline(always)]
fn move_blocks(displacement: &mut VectorField, velocity: &VectorField, blocks: &Range<usize>, dt_star: f64) {
    for (u, v) in part_mut(displacement, blocks)
        .into_iter()
        .zip(part(velocity, blocks))
    {
        u.iter_mut().zip(v).for_each(|(u, v)| *u += dt_star * v);
    }
}
