//! What advances the state of all blocks by one step.
//!
//! `reference.rs` reads like the paper, one pass per equation; `fused/` computes the same in one fast sweep. The
//! [`Simulation`](crate::Simulation) steps either and shows observers what it found.

mod fused;
mod recompute;
mod reference;

use fearless_simd::Level;
use serde::{Deserialize, Serialize};

use self::fused::Fused;
pub(crate) use self::recompute::CHUNK_BLOCKS;
use self::recompute::read_blocks;
use self::reference::Reference;
use crate::checkpoint::{Checkpoint, Numbers};
use crate::observe::Peak;
use crate::{FrictionLaw, Model, State};

/// Which kernel computes the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// One pass per equation, to be read beside the paper, for every reading of the friction law.
    Reference,
    /// One sweep for all equations, for [`FrictionLaw::Projection`]; another reading is computed by the reference.
    Fused,
}

/// How a run is computed. Results are the same bits for any `threads` and `skips`, and for both kernels to rounding until
/// friction's onset, which tells blocks apart by less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Execution {
    /// What computes the steps.
    pub kernel: Kernel,
    /// Threads that share the blocks of the fused kernel; worth it from some 100 000 blocks.
    pub threads: usize,
    /// Whether blocks at rest are left alone until they can break.
    pub skips: bool,
}

impl Kernel {
    /// The kernel that steps under a friction law when this one is asked for.
    pub fn for_law(self, law: FrictionLaw) -> Self {
        match law {
            FrictionLaw::Projection => self,
            FrictionLaw::Reversal | FrictionLaw::Literal => Self::Reference,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Fused => "fused",
        }
    }
}

impl Default for Execution {
    fn default() -> Self {
        Self {
            kernel: Kernel::Fused,
            threads: 1,
            skips: true,
        }
    }
}

/// The widest vector instructions that the kernels find on this processor; results do not depend on them.
pub fn simd_width() -> &'static str {
    match Level::new() {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(_) => "AVX-512",
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(_) => "AVX2",
        _ => "baseline",
    }
}

/// Sums over all blocks at t_n, in units of this crate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// `sum u`.
    pub displacement: [f64; 2],
    /// `sum v` at t_n, the mean of the half steps around it.
    pub velocity: [f64; 2],
    /// `sum v` at `t_n + dt/2`.
    pub velocity_after: [f64; 2],
    /// `sum v^2` at t_n.
    pub velocity_square: f64,
    /// `sum F_f . v` at t_n: what friction gives, less than zero.
    pub friction_power: f64,
    /// Blocks that slide from t_n on, textured ones included.
    pub n_sliding: usize,
    /// Blocks in contact that do.
    pub n_slipping: usize,
    /// Energies held, if they were asked for.
    pub stored_energy: Option<StoredEnergy>,
}

/// Energies held at t_n.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StoredEnergy {
    /// Kinetic energy, the mean of the half steps before and after.
    pub kinetic: f64,
    /// Of the springs between blocks.
    pub lattice: f64,
    /// Of the drive springs.
    pub drive_springs: f64,
}

/// One block at t_n. Friction and contact are those of the update that starts there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Block {
    /// **u**, in units of `P mu_s l/E`.
    pub displacement: [f64; 2],
    /// Velocity at `t_n + dt/2`.
    pub velocity: [f64; 2],
    /// `F_s` of the drive spring (Eq. 2), with any constant force.
    pub force_drive: [f64; 2],
    /// `F_c` of the lattice springs (Eq. 3).
    pub force_lattice: [f64; 2],
    /// `F_f` of friction (Eq. 4).
    pub force_friction: [f64; 2],
}

impl Block {
    /// Whether the block slides from t_n on (D12).
    pub fn slides(&self) -> bool {
        self.velocity != [0.0, 0.0]
    }
}

/// A kernel with its state.
#[derive(Debug)]
pub(crate) enum Engine {
    Reference(Box<Reference>),
    Fused(Box<Fused>),
}

impl Engine {
    /// From a state, or from rest.
    pub(crate) fn new(model: &Model, dt_star: f64, state: Option<State>, execution: Execution) -> Self {
        match execution.kernel.for_law(model.law) {
            Kernel::Fused => {
                let Execution { threads, skips, .. } = execution;
                Self::Fused(Box::new(Fused::new(
                    model,
                    dt_star,
                    state.as_ref(),
                    threads,
                    skips,
                )))
            }
            Kernel::Reference => {
                let state = state.unwrap_or_else(|| State::at_rest(model.lattice.n_blocks()));
                Self::Reference(Box::new(Reference::new(model, dt_star, state)))
            }
        }
    }

    /// What is needed to go on from step `number`, the present one.
    pub(crate) fn checkpoint(
        &self,
        model: &Model,
        number: u64,
        totals: Totals,
        peak: Peak,
    ) -> Checkpoint<Numbers<'_>> {
        let numbers = |of| Numbers {
            engine: self,
            n_blocks: model.lattice.n_blocks(),
            of,
        };
        Checkpoint {
            step: number,
            totals,
            peak,
            stress_square_max: self.stress_square_max(model, number),
            strains: match self {
                Self::Reference(_) => None,
                Self::Fused(kernel) => Some(kernel.strains()),
            },
            displacement: [
                numbers(|engine, b| engine.motion(b)[0][0]),
                numbers(|engine, b| engine.motion(b)[0][1]),
            ],
            velocity: [
                numbers(|engine, b| engine.kept_velocity(b)[0]),
                numbers(|engine, b| engine.kept_velocity(b)[1]),
            ],
            first_slip: numbers(Self::first_slip),
        }
    }

    /// Velocity of block `b` as a checkpoint keeps it.
    fn kept_velocity(&self, b: usize) -> [f64; 2] {
        match self {
            Self::Reference(kernel) => kernel.velocity_before(b),
            Self::Fused(kernel) => kernel.motion(b)[1],
        }
    }

    /// From a checkpoint; none if it is that of another lattice or kernel.
    pub(crate) fn resume(
        model: &Model,
        dt_star: f64,
        checkpoint: Checkpoint,
        execution: Execution,
    ) -> Option<Self> {
        if !checkpoint.has_blocks(model.lattice.n_blocks()) {
            return None;
        }
        match (execution.kernel.for_law(model.law), checkpoint.strains) {
            (Kernel::Fused, Some(strains)) => {
                let Execution { threads, skips, .. } = execution;
                let kernel = Fused::resume(model, dt_star, checkpoint, strains, threads, skips);
                Some(Self::Fused(Box::new(kernel)))
            }
            (Kernel::Reference, None) => Some(Self::Reference(Box::new(Reference::resume(
                model, dt_star, checkpoint,
            )))),
            _ => None,
        }
    }

    /// Goes to step `number`: the next one, or 0 to begin with.
    pub(crate) fn step(&mut self, model: &Model, number: u64, energies: bool) -> Totals {
        match self {
            Self::Reference(kernel) => kernel.step(model, number, energies),
            Self::Fused(kernel) => kernel.step(model, number, energies),
        }
    }

    /// Blocks `first`, `first + 1`, ... at step `number`, the present one.
    pub(crate) fn read_blocks(
        &self,
        model: &Model,
        number: u64,
        dt_star: f64,
        first: usize,
        blocks: &mut [Block],
    ) {
        match self {
            Self::Reference(kernel) => {
                for (b, block) in (first..).zip(blocks) {
                    *block = kernel.block(b);
                }
            }
            Self::Fused(kernel) => {
                let time_star = number as f64 * dt_star;
                for (first, blocks) in (first..)
                    .step_by(CHUNK_BLOCKS)
                    .zip(blocks.chunks_mut(CHUNK_BLOCKS))
                {
                    read_blocks(model, time_star, first, blocks, |b| kernel.motion(b));
                }
            }
        }
    }

    /// Displacement now and velocity half a step later of block `b`.
    pub(crate) fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        match self {
            Self::Reference(kernel) => kernel.motion(b),
            Self::Fused(kernel) => kernel.motion(b),
        }
    }

    /// When block `b` first slid while in contact; not a number if it never has.
    pub(crate) fn first_slip(&self, b: usize) -> f64 {
        match self {
            Self::Reference(kernel) => kernel.first_slip(b),
            Self::Fused(kernel) => kernel.first_slip(b),
        }
    }

    /// Largest contact stress of a block in contact up to step `number`, the present one.
    pub(crate) fn contact_stress_max(&self, model: &Model, number: u64) -> f64 {
        self.stress_square_max(model, number).sqrt()
    }

    fn stress_square_max(&self, model: &Model, number: u64) -> f64 {
        match self {
            Self::Reference(kernel) => kernel.stress_square_max(),
            Self::Fused(kernel) => kernel.stress_square_max(model, number),
        }
    }
}
