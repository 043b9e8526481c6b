//! The model of `docs/model.md`, to be read next to the paper: one thread, plain loops, one function per
//! equation, every option.
//!
//! Lattices, surfaces and parameters come from the library; every force, threshold, friction and sum is
//! computed here. Units are those of the library (Eq. 11).

mod body;
mod contact_springs;
mod coulomb;
mod drive;
mod interface;
mod lattice;
mod load;
mod measure;
mod rate_and_state;
mod springs;
mod step;
mod vector;

use slipfront::surface::Contact;
use slipfront::{Friction, Interface, Model, State};

use self::lattice::Spring;
use self::load::Threshold;
use self::measure::Losses;
use self::step::{Motion, Update};
use self::vector::{Vector, length, sum, times};

/// Properties of a block that never change.
#[derive(Clone, Debug)]
struct Block {
    exists: bool,
    in_contact: bool,
    mass: f64,
    springs: Vec<Spring>,
    /// Stiffness `k_s,i` of the block's drive spring.
    drive_stiffness: f64,
    /// Direction **g** of the far end of the block's drive spring.
    direction: Vector,
    /// Dead load `F_0,i`, a constant force.
    dead_load: Vector,
    normal_force: f64,
    kinetic: Threshold,
}

/// Memory of a law of friction for a block.
#[derive(Clone, Copy, Debug)]
struct Memory {
    /// Time at which the block last stopped.
    stopped_at: f64,
    /// Slip of the block since it last had its full strength.
    slip: f64,
    /// Time at which the block last moved.
    moved_at: f64,
    /// State of the contact.
    theta: f64,
    /// Displacement at which the contact spring has no force.
    anchor: Vector,
    /// Number of times that this spring has broken; if the block slides after a break, 1 while it does.
    breaks: u64,
}

/// The slider at t_n, with friction and sliding from the update that starts there.
pub(crate) struct Reference<'a> {
    model: &'a Model,
    contact: &'a Contact,
    dt: f64,
    step: u64,
    /// Number of steps in which the drive has moved, and the same a step before.
    pub(crate) drive_steps: u64,
    drive_steps_before: u64,
    blocks: Vec<Block>,
    memory: Vec<Memory>,
    /// **u** at t_n.
    pub(crate) displacement: Vec<Vector>,
    /// Velocities half a step before t_n.
    velocity_before: Vec<Vector>,
    /// Velocities half a step after t_n.
    pub(crate) velocity: Vec<Vector>,
    /// Matrices of a bulk body between two blocks, by their distance.
    body: Option<Vec<[Vector; 2]>>,
    /// Drive forces `F_s` with the dead load and the change of the normal force of an interface.
    pub(crate) force_drive: Vec<Vector>,
    /// Forces `F_v` of the dampers.
    force_dampers: Vec<Vector>,
    /// Lattice forces `F_c` with the dampers.
    pub(crate) force_lattice: Vec<Vector>,
    /// Friction `F_f`.
    pub(crate) force_friction: Vec<Vector>,
    /// Energy lost at present with the spring of each block, and against the friction of blocks that slide
    /// on.
    lost: Vec<[f64; 2]>,
    pub(crate) slides: Vec<bool>,
    /// Times t_n of the first slip of each block in contact; NaN before.
    pub(crate) first_slips: Vec<f64>,
    losses: Losses,
}

impl<'a> Reference<'a> {
    /// The slider at t = 0, with the velocities of the state half a step before.
    pub(crate) fn new(model: &'a Model, contact: &'a Contact, dt: f64, state: &State) -> Self {
        let n = model.lattice.n_blocks();
        let (surface, directions) = (&model.surface, drive::directions(model));
        let exists: Vec<bool> = (0..n).map(|b| lattice::exists(model, b)).collect();
        let normal_forces = load::normal_forces(surface, contact, &exists);
        let block = |b: usize| {
            let (load, in_contact) = (normal_forces[b], !surface.textured[b]);
            let adhesion = contact.adhesion.of_kinetic;
            Block {
                exists: exists[b],
                in_contact,
                mass: lattice::mass(model, b),
                springs: lattice::springs(model, b),
                drive_stiffness: drive::stiffness(model, b),
                direction: directions[b],
                dead_load: drive::dead_load(model, b),
                normal_force: load,
                kinetic: Threshold::new(surface.mu_kinetic[b], contact, load, in_contact, adhesion),
            }
        };
        let theta = match model.friction {
            Friction::RateAndState(law) => law.theta_0,
            Friction::Coulomb(_) | Friction::ContactSprings(_) => 0.0,
        };
        // Springs hold the dead load with the blocks at their sites.
        let anchor = |b: usize| match model.friction {
            Friction::ContactSprings(law) => times(-1.0 / law.stiffness, drive::dead_load(model, b)),
            _ => [0.0, 0.0],
        };
        let memory = |b: usize| Memory {
            stopped_at: 0.0,
            slip: 0.0,
            moved_at: 0.0,
            theta,
            anchor: anchor(b),
            breaks: 0,
        };
        let zeros = vec![[0.0; 2]; n];
        let mut reference = Self {
            model,
            contact,
            dt,
            step: 0,
            drive_steps: 0,
            drive_steps_before: 0,
            blocks: (0..n).map(block).collect(),
            memory: (0..n).map(memory).collect(),
            displacement: zeros.clone(),
            velocity_before: zeros.clone(),
            velocity: zeros.clone(),
            body: body::matrices(model),
            force_drive: zeros.clone(),
            force_dampers: zeros.clone(),
            force_lattice: zeros.clone(),
            force_friction: zeros,
            lost: vec![[0.0; 2]; n],
            slides: vec![false; n],
            first_slips: vec![f64::NAN; n],
            losses: Losses::default(),
        };
        reference.move_to(state);
        reference.velocity_before.clone_from(&reference.velocity);
        reference.evaluate();
        reference
    }

    /// Sets the positions of blocks from a state, and the velocities half a step after t_n. The memory stays
    /// the same.
    pub(crate) fn move_to(&mut self, state: &State) {
        let [u, v] = [&state.displacement, &state.velocity];
        for b in 0..self.blocks.len() {
            self.displacement[b] = [u.x[b], u.y[b]];
            self.velocity[b] = [v.x[b], v.y[b]];
        }
    }

    /// Time t_n, as a product instead of a sum.
    fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// Time of the drive at t_n.
    fn drive_time(&self) -> f64 {
        self.drive_steps as f64 * self.dt
    }

    /// Whether the drive moves from t_n to t_n+1: a held drive only if no block in contact slides, or no
    /// block of a bulk body is faster than an excess of 3e-4 of the largest strength makes it in a step.
    pub(crate) fn drive_moves(&self) -> bool {
        if self.model.drive.is_held() && self.body.is_some() {
            let limits = (0..self.blocks.len()).map(|b| self.model.surface.static_limit(b));
            let strongest = limits.fold(0.0, f64::max);
            let slow = 3e-4 * strongest * self.dt / (1.0 + 0.5 * self.model.damping * self.dt);
            return self.velocity.iter().all(|velocity| length(*velocity) <= slow);
        }
        let slips = |b: usize| self.blocks[b].in_contact && self.slides[b];
        !self.model.drive.is_held() || !(0..self.blocks.len()).any(slips)
    }

    /// Advances from t_n to t_n+1; the drive moves or stands still. Computes the displacements (Eq. 8), the
    /// memory of contacts, and everything at the new instant.
    pub(crate) fn step(&mut self, drive_moves: bool) {
        self.step += 1;
        self.drive_steps_before = self.drive_steps;
        self.drive_steps += u64::from(drive_moves);
        for b in 0..self.blocks.len() {
            let moved = times(self.dt, self.velocity[b]);
            self.displacement[b] = sum(self.displacement[b], moved);
            self.memory[b].slip += self.dt * length(self.slip_velocity(self.velocity[b]));
            if let Friction::RateAndState(law) = &self.model.friction {
                let speed = length(self.velocity[b]);
                self.memory[b].theta = rate_and_state::evolved(law, self.memory[b].theta, speed, self.dt);
            }
        }
        self.losses.work += self.work_of_dead_load();
        self.velocity_before.clone_from(&self.velocity);
        self.evaluate();
    }

    /// Computes forces at t_n (Eqs. 2, 3), friction (Eq. 4), velocities half a step later (Eqs. 5 to 8), and
    /// the measures.
    fn evaluate(&mut self) {
        for b in 0..self.blocks.len() {
            self.force_drive[b] = sum(self.drive_force(b), self.reaction(b));
            self.force_dampers[b] = self.damper_force(b);
            self.force_lattice[b] = sum(self.elastic_force(b), self.force_dampers[b]);
        }
        for b in 0..self.blocks.len() {
            let update = self.friction(b);
            self.velocity[b] = update.velocity;
            self.force_friction[b] = update.friction;
            if self.slides[b] && self.blocks[b].in_contact && self.first_slips[b].is_nan() {
                self.first_slips[b] = self.time();
            }
        }
        self.add_losses();
    }

    /// Force of the springs between blocks (Eq. 3), or of the body above them.
    fn elastic_force(&self, b: usize) -> Vector {
        if let Some(matrices) = &self.body {
            let lattice = &self.model.lattice;
            return body::force(matrices, [lattice.nx, lattice.ny], b, &self.displacement);
        }
        let (springs, epsilon) = (&self.blocks[b].springs, self.model.epsilon);
        springs::elastic_force(b, springs, &self.displacement, epsilon)
    }

    /// Displacement by which the drive spring over block `b` is shorter: that of the block, or the mean of
    /// all blocks of a bulk body, which drive springs pull as a whole.
    fn pulled_displacement(&self, b: usize) -> Vector {
        match &self.body {
            None => self.displacement[b],
            Some(_) => {
                let all = self.displacement.iter().fold([0.0; 2], |all, u| sum(all, *u));
                times(1.0 / self.displacement.len() as f64, all)
            }
        }
    }

    /// Force of the drive spring over block `b` (Eq. 2), and the dead load.
    fn drive_force(&self, b: usize) -> Vector {
        let (block, path) = (&self.blocks[b], drive::path(self.model, self.drive_time()));
        let u = self.pulled_displacement(b);
        let spring = drive::spring_force(block.drive_stiffness, path, block.direction, u);
        sum(spring, block.dead_load)
    }

    /// Force of the dampers between blocks.
    fn damper_force(&self, b: usize) -> Vector {
        let (u, v) = (&self.displacement, &self.velocity_before);
        let (time, epsilon) = (self.model.slider().viscosity_time, self.model.epsilon);
        springs::damper_force(b, &self.blocks[b].springs, u, v, time, epsilon)
    }

    /// The update of block `b` (Eqs. 4 to 8) by the law of friction, and of the memory of the law.
    fn friction(&mut self, b: usize) -> Update {
        let (block, memory, now) = (&self.blocks[b], self.memory[b], self.time());
        let force = sum(self.force_drive[b], self.force_lattice[b]);
        let motion = Motion {
            velocity: self.velocity_before[b],
            mass: block.mass,
            damping: self.model.damping,
            dt: self.dt,
        };
        match &self.model.friction {
            Friction::Coulomb(law) => {
                let velocity = self.slip_velocity(motion.velocity);
                let is_stuck = velocity == [0.0, 0.0];
                let age = now - memory.stopped_at;
                let coefficient = self.model.surface.mu_static[b];
                let holds = self
                    .static_threshold(b, coefficient)
                    .scaled(coulomb::aged(law.ageing, age));
                let slows = block
                    .kinetic
                    .scaled(coulomb::weakened(law.weakening, length(velocity)));
                if !is_stuck {
                    self.memory[b].moved_at = now;
                } else if coulomb::is_whole_again(law.slip_weakening, now - memory.moved_at) {
                    self.memory[b].slip = 0.0;
                }
                let slip = self.memory[b].slip;
                let [holds, slows] = coulomb::after_slip(law.slip_weakening, [holds, slows], slip);
                let update = match law.interface {
                    Some(interface) => {
                        let factor = interface::factor(&interface, self.load(b), self.displacement[b][1]);
                        interface::update(&motion, force, factor * holds, factor * slows)
                    }
                    None => coulomb::update(law.law, &motion, force, holds, slows),
                };
                self.slides[b] = self.slip_velocity(update.velocity) != [0.0, 0.0];
                if !is_stuck && !self.slides[b] {
                    self.memory[b].stopped_at = now;
                }
                update
            }
            Friction::RateAndState(law) => {
                let update = rate_and_state::update(law, &motion, force, block.normal_force, memory.theta);
                self.slides[b] = length(update.velocity) > law.slip_speed;
                update
            }
            Friction::ContactSprings(law) if block.in_contact => {
                let coefficient = contact_springs::coefficient(law, &self.model.surface, b, memory.breaks);
                let holds = self.static_threshold(b, coefficient).scaled(1.0);
                let slid = law.slides() && memory.breaks > 0;
                let places = [self.displacement[b], memory.anchor];
                let limits = [holds, block.kinetic.scaled(1.0)];
                let (update, yields) = contact_springs::update(law, &motion, force, places, limits, slid);
                self.slides[b] = yields.is_some();
                self.lost[b] = [0.0; 2];
                match yields {
                    Some(yielding) => {
                        self.memory[b].anchor = yielding.anchor;
                        self.memory[b].breaks += u64::from(!slid);
                        self.lost[b] = [yielding.lost, yielding.slip_work];
                    }
                    None if slid => self.memory[b].breaks = 0,
                    None => {}
                }
                update
            }
            Friction::ContactSprings(_) => Update {
                velocity: motion.accelerated(force),
                friction: [0.0, 0.0],
            },
        }
    }

    /// The interface of an upright sheet, if friction acts along x alone.
    fn interface(&self) -> Option<Interface> {
        match &self.model.friction {
            Friction::Coulomb(law) => law.interface,
            Friction::RateAndState(_) | Friction::ContactSprings(_) => None,
        }
    }

    /// The part of a velocity that friction acts on: all of it, or the part along an interface.
    fn slip_velocity(&self, velocity: Vector) -> Vector {
        match self.interface() {
            Some(_) => [velocity[0], 0.0],
            None => velocity,
        }
    }

    /// Normal force `F_n,i` of the load in units of `P mu_s l^2`, the unit of all other forces.
    fn load(&self, b: usize) -> f64 {
        self.blocks[b].normal_force / self.contact.mu_static_mean
    }

    /// Force along y: the difference of the normal force from the load.
    fn reaction(&self, b: usize) -> Vector {
        match self.interface() {
            Some(interface) if self.blocks[b].in_contact => [
                0.0,
                interface::reaction(&interface, self.load(b), self.displacement[b][1]),
            ],
            _ => [0.0, 0.0],
        }
    }

    /// Static threshold of block `b` for this coefficient.
    fn static_threshold(&self, b: usize, coefficient: f64) -> Threshold {
        let (block, adhesion) = (&self.blocks[b], self.contact.adhesion.of_static);
        Threshold::new(
            coefficient,
            self.contact,
            block.normal_force,
            block.in_contact,
            adhesion,
        )
    }
}
