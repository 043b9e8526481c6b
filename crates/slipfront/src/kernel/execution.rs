//! Choice of kernel, threads and ranks for a run.

use std::sync::Arc;

use super::engine::Engine;
use super::fused::Fused;
use super::general::General;
use super::replay::Replay;
use crate::checkpoint::Checkpoint;
use crate::communicator::{Alone, Communicator};
use crate::device::Device;
use crate::friction::Friction;
use crate::model::Model;
use crate::state::State;

/// Kernel that computes the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// The general kernel: one pass over the blocks per equation, for every model.
    General,
    /// The fused kernel: one sweep for all equations. The general kernel replaces it for models that it does
    /// not support: [some laws of friction](crate::Needs::is_fused), internal viscosity, drives that rotate,
    /// and bulk bodies.
    #[default]
    Fused,
}

/// Options of computing a run. Results have the same bits for any `threads`, `skips` and number of ranks. The
/// two kernels agree to rounding up to the first slip; afterwards a difference in rounding can change which
/// block slips first.
///
/// ```
/// use slipfront::{Execution, Kernel};
///
/// let execution = Execution {
///     kernel: Kernel::General,
///     ..Execution::on_threads(2)
/// };
/// assert_eq!((execution.threads, execution.communicator.size()), (2, 1));
/// ```
#[derive(Clone, Debug)]
pub struct Execution {
    /// Kernel that computes the steps.
    pub kernel: Kernel,
    /// Number of threads of the pool that share the blocks; several are useful from some ten thousand blocks
    /// on for the fused kernel, and from some thousand for the general kernel. A thread that steps a
    /// simulation should belong to the pool (see `rayon::scope`): any other thread waits at every step until
    /// it is woken.
    pub threads: usize,
    /// Whether blocks at rest are skipped until they can slip.
    pub skips: bool,
    /// Connection to the other ranks that share the lattice; [`Alone`] by default. Each rank has a model of
    /// its own rows.
    pub communicator: Arc<dyn Communicator>,
    /// Device that computes the steps of the models that it [covers](crate::device::DeviceLattice::check), in
    /// place of the kernel; none by default.
    pub device: Option<Arc<dyn Device>>,
}

impl Kernel {
    /// The kernel that computes a model if this one is requested.
    pub fn for_model(self, model: &Model) -> Self {
        if model.body.is_some() {
            return Self::General;
        }
        let (is_viscous, rotates) = (model.slider.is_viscous(), model.drive.rotation.is_some());
        self.for_law(&model.friction, is_viscous, rotates)
    }

    /// The kernel that computes models with this law of friction, with or without dampers and a rotation, if
    /// this one is requested.
    pub fn for_law(self, friction: &Friction, has_dampers: bool, rotates: bool) -> Self {
        let is_fused = friction.needs().is_fused && !has_dampers && !rotates;
        if is_fused { self } else { Self::General }
    }

    /// Name of the kernel in a manifest.
    pub fn name(self) -> &'static str {
        match self {
            Self::General => "general",
            Self::Fused => "fused",
        }
    }
}

impl Execution {
    /// The default kernel on `threads` threads and one rank.
    pub fn on_threads(threads: usize) -> Self {
        Self {
            kernel: Kernel::default(),
            threads,
            skips: true,
            communicator: Arc::new(Alone),
            device: None,
        }
    }

    /// The engine with steps of the device; none without a device that covers the model. A page has none, and
    /// no code for it.
    fn on_device(&self, model: &Arc<Model>, dt_star: f64, state: Option<&State>) -> Option<Replay> {
        let device = self.device.as_ref()?;
        if cfg!(target_family = "wasm") {
            return None;
        }
        Replay::on_device(device, self.threads, model, dt_star, state)
    }

    /// A kernel that begins in a given state, or at rest.
    pub(crate) fn begin(self, model: &Arc<Model>, dt_star: f64, state: Option<State>) -> Box<dyn Engine> {
        if let Some(replay) = self.on_device(model, dt_star, state.as_ref()) {
            return Box::new(replay);
        }
        let (threads, skips, communicator) = (self.threads, self.skips, self.communicator);
        match self.kernel.for_model(model) {
            Kernel::Fused => {
                let kernel = Fused::new(model, dt_star, state.as_ref(), threads, skips, communicator);
                Box::new(kernel)
            }
            Kernel::General => Box::new(General::new(model, dt_star, state, threads, communicator)),
        }
    }

    /// A kernel that continues from a checkpoint and its columns; none if the checkpoint belongs to another
    /// kernel.
    pub(crate) fn resume<E>(
        self,
        model: &Arc<Model>,
        dt_star: f64,
        checkpoint: &Checkpoint,
        read: impl FnMut(usize, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<Option<Box<dyn Engine>>, E> {
        let replay = self.on_device(model, dt_star, None);
        let (threads, skips, communicator) = (self.threads, self.skips, self.communicator);
        match (self.kernel.for_model(model), checkpoint.motion_bounds) {
            (Kernel::Fused, Some(_)) => {
                let kernel = Fused::resume(model, dt_star, checkpoint, threads, skips, communicator, read)?;
                Ok(Some(match replay {
                    Some(replay) => Box::new(replay.resumed(&kernel, checkpoint)),
                    None => Box::new(kernel),
                }))
            }
            (Kernel::General, None) => {
                let kernel = General::resume(model, dt_star, checkpoint, threads, communicator, read)?;
                Ok(Some(Box::new(kernel)))
            }
            _ => Ok(None),
        }
    }
}

impl Default for Execution {
    fn default() -> Self {
        Self::on_threads(1)
    }
}
