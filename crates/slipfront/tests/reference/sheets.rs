//! A stack of sheets: lattices above the one in friction, coupled to it block by block. Sheet 0 is the lowest
//! one above the lattice.

use slipfront::{Sheet, State};

use super::springs::{elastic_energy, elastic_force};
use super::step::Motion;
use super::vector::{Vector, difference, dot, sum, times};
use super::{Reference, drive};

/// Motion of the blocks of a sheet at t_n.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    sheet: Sheet,
    displacement: Vec<Vector>,
    /// Velocities half a step before t_n, and half a step after.
    velocity_before: Vec<Vector>,
    velocity: Vec<Vector>,
}

impl Blocks {
    pub(super) fn at_rest(sheet: Sheet, n: usize) -> Self {
        let zeros = vec![[0.0; 2]; n];
        Self {
            sheet,
            displacement: zeros.clone(),
            velocity_before: zeros.clone(),
            velocity: zeros,
        }
    }

    /// Sets the positions and velocities of blocks from a state.
    pub(super) fn move_to(&mut self, state: &State) {
        for b in 0..self.displacement.len() {
            self.displacement[b] = state.displacement.at(b);
            self.velocity[b] = state.velocity.at(b);
        }
    }

    /// Advances from t_n to t_n+1 (Eq. 8).
    pub(super) fn step(&mut self, dt: f64) {
        for (u, v) in self.displacement.iter_mut().zip(&self.velocity) {
            *u = sum(*u, times(dt, *v));
        }
        self.velocity_before.clone_from(&self.velocity);
    }
}

impl Reference<'_> {
    /// Displacement of block `b` of a sheet, or of the lattice.
    fn displacement_in(&self, sheet: Option<usize>, b: usize) -> Vector {
        sheet.map_or(self.displacement[b], |sheet| self.sheets[sheet].displacement[b])
    }

    /// Velocity half a step after t_n of block `b` of the driven blocks: those of the highest sheet.
    pub(super) fn pulled_velocity(&self, b: usize) -> Vector {
        self.sheets
            .last()
            .map_or(self.velocity[b], |highest| highest.velocity[b])
    }

    /// Displacement of block `b` of the driven blocks.
    pub(super) fn pulled_displacement(&self, b: usize) -> Vector {
        self.displacement_in(self.sheets.len().checked_sub(1), b)
    }

    /// Force of the drive spring over block `b` (Eq. 2), and the dead load.
    pub(super) fn drive_force(&self, b: usize) -> Vector {
        let (block, path) = (&self.blocks[b], drive::path(self.model, self.drive_time()));
        let u = self.pulled_displacement(b);
        let spring = drive::spring_force(block.drive_stiffness, path, block.direction, u);
        sum(spring, block.dead_load)
    }

    /// Force from above on block `b` of a sheet, or of the lattice: `g (u_k+1 - u_k)`, or the force of the
    /// drive.
    pub(super) fn pull_on(&self, sheet: Option<usize>, b: usize) -> Vector {
        let above = sheet.map_or(0, |sheet| sheet + 1);
        match self.sheets.get(above) {
            None => self.drive_force(b),
            Some(Blocks { sheet: joint, .. }) => {
                let apart = difference(
                    self.displacement_in(Some(above), b),
                    self.displacement_in(sheet, b),
                );
                times(joint.coupling, apart)
            }
        }
    }

    /// Computes the velocities of all sheets half a step after t_n, from forces at t_n.
    pub(super) fn accelerate_sheets(&mut self) {
        for number in 0..self.sheets.len() {
            let velocities = (0..self.blocks.len()).map(|b| self.accelerated(number, b));
            self.sheets[number].velocity = velocities.collect();
        }
    }

    /// Velocity of block `b` of a sheet half a step after t_n, from the springs to its neighbours, in
    /// proportion to the thickness of the sheet, the pull from above, and the pull on the block below.
    fn accelerated(&self, number: usize, b: usize) -> Vector {
        let blocks = &self.sheets[number];
        let springs = &self.blocks[b].springs;
        let elastic = elastic_force(b, springs, &blocks.displacement, self.model.epsilon);
        let below = number.checked_sub(1);
        let from_sheets = difference(self.pull_on(Some(number), b), self.pull_on(below, b));
        let motion = Motion {
            velocity: blocks.velocity_before[b],
            mass: blocks.sheet.thickness,
            damping: self.model.damping,
            dt: self.dt,
        };
        motion.accelerated(sum(times(blocks.sheet.thickness, elastic), from_sheets))
    }

    /// Sum over the blocks of all sheets of the mass times the square of the speed: at t_n, or the mean of
    /// the squares of the half steps around it.
    pub(super) fn sheets_m_v_squared(&self, at_half_steps: bool) -> f64 {
        let square = |v: Vector| dot(v, v);
        let of_block = |blocks: &Blocks, b: usize| {
            let [before, after] = [blocks.velocity_before[b], blocks.velocity[b]];
            if at_half_steps {
                0.5 * (square(before) + square(after))
            } else {
                square(times(0.5, sum(before, after)))
            }
        };
        let of_sheet = |blocks: &Blocks| blocks.sheet.thickness * self.sum_over(|b| of_block(blocks, b));
        self.sheets.iter().map(of_sheet).sum()
    }

    /// Energy of the springs between the blocks of each sheet, `h_k k_ij (r_ij - d_ij)^2/2`.
    pub(super) fn sheets_lattice_energy(&self) -> f64 {
        let of_sheet = |blocks: &Blocks| {
            let energy = |b: usize| {
                elastic_energy(
                    b,
                    &self.blocks[b].springs,
                    &blocks.displacement,
                    self.model.epsilon,
                )
            };
            blocks.sheet.thickness * self.sum_over(energy)
        };
        self.sheets.iter().map(of_sheet).sum()
    }

    /// Energy of the springs between sheets, `g_k (u_k - u_k-1)^2/2`.
    pub(crate) fn energy_between_sheets(&self) -> f64 {
        let of_sheet = |number: usize| {
            self.sum_over(|b| {
                let above = self.displacement_in(Some(number), b);
                let apart = difference(above, self.displacement_in(number.checked_sub(1), b));
                0.5 * self.sheets[number].sheet.coupling * dot(apart, apart)
            })
        };
        (0..self.sheets.len()).map(of_sheet).sum()
    }
}
