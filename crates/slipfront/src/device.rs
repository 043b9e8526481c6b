//! Plain lattices with steps that are computed on a device other than this processor, such as a GPU. The
//! results have the same bits as those of the fused kernel.
//!
//! A [`Device`] computes some steps of many lattices at once and records the totals of each step. A
//! [`Simulation`](crate::Simulation) that [replays](crate::Simulation::replay) the records finds peaks,
//! instants and means by the code that is used for every run.

use std::collections::VecDeque;
use std::fmt;
use std::sync::Arc;

use slipfront_kernel::MotionBounds;
use thiserror::Error;

use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::state::State;
use crate::totals::{StoredEnergy, Totals};

/// First-slip step of a block that has not slipped in contact.
pub use slipfront_kernel::NEVER;

/// Computes the steps of lattices.
pub trait Device: fmt::Debug + Send + Sync {
    /// Name of the device, for a manifest.
    fn name(&self) -> String;

    /// Largest number of blocks of a lattice that the device accepts.
    fn most_blocks(&self) -> usize;

    /// Computes `steps` steps of each lattice, and adds the records of these steps to the lattice.
    ///
    /// # Errors
    /// When the device fails. The lattices cannot continue then.
    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError>;
}

/// Failure of a device, as a sentence.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{0}")]
pub struct DeviceError(pub String);

/// Reason why a model can be computed only on the CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{0} computed on the CPU alone")]
pub struct CpuOnly(pub(crate) &'static str);

/// Numbers that all blocks and steps of a plain lattice share.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Equations {
    /// Time step `dt*`.
    pub dt_star: f64,
    /// Stiffness of the drive springs.
    pub k_drive: f64,
    /// Dead load on every block.
    pub dead_load: [f64; 2],
    /// The load's strain `eps`.
    pub epsilon: f64,
    /// Factor by which damping reduces a velocity in a step.
    pub velocity_decay: f64,
    /// Change of velocity per force.
    pub force_to_velocity: f64,
    /// Force per change of velocity.
    pub velocity_to_force: f64,
    /// Stiffness of straight and of diagonal springs between blocks.
    pub stiffness: [f64; 2],
    /// Coefficients of the series for the forces of straight and of diagonal springs. The short series has
    /// the first four of them.
    pub series: [[f64; 8]; 2],
    /// Largest strains for the short and for the long series; the forces of springs with larger strains are
    /// computed with a square root.
    pub strain_limits: [f64; 2],
    /// Number of blocks.
    pub n_blocks: f64,
    /// Slip `D_c` over which [strength falls](FallingStrength); negative if it does not fall.
    pub fall_length: f64,
    /// Inverse of the slip over which strength falls.
    pub inverse_fall_length: f64,
    /// Time t* after which a stuck block has its full strength again; infinite if no block heals.
    pub healing_time: f64,
}

/// Values of a lattice that change from step to step, in addition to those of its blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Motion {
    /// Largest u_x, -u_x, u_y, -u_y at the latest measurement of displacements, largest differences of u_x
    /// and u_y between the ends of a spring, distance by which displacements may have moved apart since,
    /// highest speed, centre and limit of the windows for u_x and for u_y, limit of the stretch of springs.
    pub bounds: [f64; MotionBounds::LEN],
    /// Sum of the velocities half a step after the latest step.
    pub velocity_after: [f64; 2],
    /// Largest square of a contact stress so far.
    pub stress_square_max: f64,
    /// Number of steps in which the drive has moved by the next step: all of them, unless it is held.
    pub drive_steps: u64,
    /// Whether the drive moves up to the next step: 1, or 0 for a held drive that waits. A held drive moves
    /// if no block in contact slides at the latest step.
    pub drive_moves: u64,
}

/// Totals of a step, which a device records.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct StepRecord {
    /// Sum of displacements at t_n.
    pub displacement: [f64; 2],
    /// Sum of velocities at `t_n + dt/2`.
    pub velocity_after: [f64; 2],
    /// Sum of squares of velocities at t_n.
    pub velocity_square: f64,
    /// Power of friction at t_n.
    pub friction_power: f64,
    /// Largest square of a contact stress up to this step.
    pub stress_square_max: f64,
    /// Numbers of blocks that slide, and of sliding blocks in contact.
    pub n_sliding: [u32; 2],
    /// Kinetic energy, energy of the springs between blocks, and energy of the drive springs, at the steps at
    /// which they are [needed](EnergySteps).
    pub stored: [f64; 3],
    /// Energy that the fall of strength has dissipated since the start, at these steps; 0 where strength does
    /// not fall.
    pub weakening_energy: f64,
}

/// Steps at which energies are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnergySteps {
    /// Energies are computed at all multiples of this number of a step.
    pub every: u64,
    /// Number of one more step at which they are computed.
    pub last: u64,
}

/// Memory of a law by which the strength of a block falls with its slip.
#[derive(Clone, Debug)]
pub struct FallingStrength {
    /// Force by which strength falls, `max(S - K, 0)`, with the static threshold S and kinetic friction K, of
    /// the blocks.
    pub drops: Arc<[f64]>,
    /// Columns of a checkpoint: the slip of the blocks, and where blocks heal the times t* of their latest
    /// motion and the shares of strength that they lost before they healed.
    pub columns: Vec<Vec<f64>>,
}

/// Counts of the sliding blocks in contact by their position, which a device records.
#[derive(Clone, Debug)]
pub struct SlidingCounts {
    /// The blocks are counted at all multiples of this number of a step.
    pub every: u64,
    /// Bins of the position along the drive.
    pub bins: PositionBins,
    /// Bin of each block.
    pub bin_of: Arc<[u16]>,
    /// Number of blocks in contact in each bin.
    pub in_contact: Arc<[u32]>,
    /// Counts of the latest steps that have not been replayed yet, each with the number of its step.
    pub recorded: VecDeque<(u64, Vec<u32>)>,
}

/// State of a lattice between steps, in the form that a device takes.
#[derive(Clone, Debug)]
pub struct DeviceLattice {
    /// Blocks along x and y.
    pub blocks: [usize; 2],
    /// Numbers that all blocks and steps share.
    pub equations: Equations,
    /// Steps at which energies are computed.
    pub energies: EnergySteps,
    /// Squares of the static thresholds `mu_s F_n` of the blocks, row by row; 0 where [strength
    /// falls](FallingStrength) with slip and is the only threshold.
    pub static_limit_squares: Arc<[f64]>,
    /// Change of velocity by kinetic friction in a step, `q = dt mu_k F_n/c+`, of the blocks.
    pub kinetic_impulses: Arc<[f64]>,
    /// [Flags](flag) of the blocks.
    pub flags: Arc<[u16]>,
    /// Number of steps done: the next one has this number.
    pub steps_done: u64,
    /// Numbers of the lattice after the latest step, or at the start.
    pub motion: Motion,
    /// Displacements at the latest step, velocities half a step later.
    pub state: State,
    /// Step at which each block first slipped in contact, or [`NEVER`].
    pub first_slips: Vec<u32>,
    /// Memory of the law of friction, if strength falls with slip.
    pub strength: Option<FallingStrength>,
    /// Records of the latest steps that have not been replayed yet.
    pub records: VecDeque<StepRecord>,
    /// Counts of sliding blocks, if an observer needs them.
    pub counts: Option<SlidingCounts>,
    /// Sum of velocities half a step before t = 0.
    pub(crate) velocity_at_start: [f64; 2],
    pub(crate) model: Arc<Model>,
}

/// Flags of a block. The springs of a block are numbered east, north, north-east, north-west, west, south,
/// south-west, south-east; a flag is set for each that exists.
pub mod flag {
    /// Number of springs; their flags are the lowest bits.
    pub const SPRINGS: u32 = 8;
    /// The block exists.
    pub const EXISTS: u16 = 1 << 8;
    /// The block is in contact with the substrate.
    pub const IN_CONTACT: u16 = 1 << 9;
    /// The block is in the first column.
    pub const FIRST_COLUMN: u16 = 1 << 10;
    /// The block is in the last column.
    pub const LAST_COLUMN: u16 = 1 << 11;
    /// The block is in the first row.
    pub const FIRST_ROW: u16 = 1 << 12;
    /// The block is in the last row.
    pub const LAST_ROW: u16 = 1 << 13;
}

impl DeviceLattice {
    /// Displacements of the driven ends of the drive springs at the next steps in which the drive moves.
    pub fn drive_positions(&self, steps: u32) -> impl Iterator<Item = [f64; 2]> {
        let first = self.motion.drive_steps;
        (first..first + u64::from(steps))
            .map(|step| self.model.drive.position(step as f64 * self.equations.dt_star))
    }

    /// Whether the drive stands still while a block in contact slides.
    pub fn is_held(&self) -> bool {
        self.model.drive.is_held()
    }

    /// Steps at which sliding blocks are counted, among the next `steps` steps.
    pub fn counted_steps(&self, steps: u32) -> impl Iterator<Item = u64> + use<> {
        let (first, every) = (self.steps_done, self.counts.as_ref().map(|counts| counts.every));
        let end = first + u64::from(steps);
        every.into_iter().flat_map(move |every| {
            (first.div_ceil(every)..)
                .map(move |k| k * every)
                .take_while(move |step| *step < end)
        })
    }

    /// Whether energies are computed at a step.
    pub fn needs_energies(&self, step: u64) -> bool {
        step.is_multiple_of(self.energies.every) || step == self.energies.last
    }
}

impl StepRecord {
    /// Totals of the step, with the sum of velocities `velocity_before` of the step before.
    pub(crate) fn totals(&self, velocity_before: [f64; 2], energies: bool) -> Totals {
        let [before, after] = [velocity_before, self.velocity_after];
        let [kinetic, lattice, drive_springs] = self.stored;
        Totals {
            displacement: self.displacement,
            velocity: [0.5 * (before[0] + after[0]), 0.5 * (before[1] + after[1])],
            velocity_after: after,
            velocity_square: self.velocity_square,
            friction_power: self.friction_power,
            n_sliding: self.n_sliding[0] as usize,
            n_slipping: self.n_sliding[1] as usize,
            stored_energy: energies.then_some(StoredEnergy {
                kinetic,
                lattice,
                drive_springs,
            }),
        }
    }
}
