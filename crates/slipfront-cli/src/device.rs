//! The device on which runs are computed.

use std::fmt;
use std::sync::Arc;

use clap::{Args, ValueEnum};
use slipfront::device::{Device, DeviceError};
use slipfront_base::machine::available_memory;
use slipfront_base::number_format::byte_size;
use slipfront_case::case::Case;
use slipfront_run::device::refusal_of_run;

use crate::failure::Failure;
use crate::print_stderr::print_notes;

/// Option of commands that run cases.
#[derive(Clone, Copy, Args)]
pub(crate) struct DeviceArgs {
    /// Device that computes the steps; results do not depend on it
    #[arg(long, value_name = "DEVICE", value_enum, default_value_t)]
    device: DeviceChoice,
}

/// Where runs are computed. Results do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum DeviceChoice {
    /// On the cores of this machine
    #[default]
    Cpu,
    /// On the first NVIDIA GPU. Of many runs, those that it does not cover are computed on the cores
    Gpu,
    /// On the GPU if there is one; a single run only if the GPU covers it and it has at least 100 000 blocks
    Auto,
}

/// Least number of blocks of one lattice for which `auto` takes a GPU: an estimate, since its kernels need
/// tens of thousands of threads to be faster than a processor.
const LEAST_BLOCKS: usize = 100_000;

/// Bytes of the machine's memory that a block of a run on a device needs in addition: its state before and
/// after the steps that are computed at once, and on the way to the device. Measured with the fused kernel as
/// device.
const MORE_BYTES_PER_BLOCK: f64 = 180.0;

/// Bytes of the machine's memory that a run on a device needs in addition for each number of a block that the
/// law of friction remembers. Measured with the fused kernel as device.
const MORE_BYTES_PER_MEMORY: f64 = 30.0;

impl DeviceArgs {
    /// Opens the device for many runs; returns none for the cores of this machine. `refused` says why the
    /// device cannot be used for this work, if it cannot.
    pub(crate) fn open(self, refused: Option<&str>, quiet: bool) -> Result<Option<Arc<dyn Device>>, Failure> {
        let open = || match refused {
            Some(reason) => Err(DeviceError(reason.to_owned())),
            None => open_gpu(),
        };
        self.choose(open, "plain runs are", "runs are", quiet)
    }

    /// Opens the device for the run of a case that some ranks share; returns none for the cores of this
    /// machine.
    pub(crate) fn open_for(
        self,
        case: &Case,
        ranks: usize,
        quiet: bool,
    ) -> Result<Option<Arc<dyn Device>>, Failure> {
        let blocks = case.model.lattice.n_blocks();
        let open = || {
            if ranks > 1 {
                let reason = "a lattice that several ranks share is computed on their CPUs alone";
                return Err(DeviceError(reason.to_owned()));
            }
            if self.device == DeviceChoice::Auto && blocks < LEAST_BLOCKS {
                let reason = format!(
                    "{blocks} blocks are too few for a GPU, which is worth it from {LEAST_BLOCKS} on"
                );
                return Err(DeviceError(reason));
            }
            let device = open_gpu()?;
            let refusal = refusal_of_run(case, &*device).or_else(|| memory_refusal(case));
            match refusal {
                Some(reason) => Err(DeviceError(reason)),
                None => Ok(device),
            }
        };
        self.choose(open, "the run is", "the run is", quiet)
    }

    /// Opens the device that was chosen, and says which it is.
    fn choose(
        self,
        open: impl FnOnce() -> Result<Arc<dyn Device>, DeviceError>,
        on_gpu: &str,
        on_cpu: &str,
        quiet: bool,
    ) -> Result<Option<Arc<dyn Device>>, Failure> {
        if self.device == DeviceChoice::Cpu {
            return Ok(None);
        }
        match open() {
            Ok(device) => {
                note(quiet, format!("{on_gpu} computed on the GPU ({})", device.name()));
                Ok(Some(device))
            }
            Err(reason) if self.device == DeviceChoice::Auto => {
                note(quiet, format!("{on_cpu} computed on the CPU: {reason}"));
                Ok(None)
            }
            Err(DeviceError(reason)) => Err(Failure::input(format!(
                "{reason}; `--device cpu` gives the same results"
            ))),
        }
    }
}

impl fmt::Display for DeviceArgs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.device.to_possible_value();
        f.write_str(value.as_ref().map_or("", |value| value.get_name()))
    }
}

/// Reason for which a run on a device has not enough memory beside it; none if it has.
fn memory_refusal(case: &Case) -> Option<String> {
    let model = &case.model;
    let of_block = MORE_BYTES_PER_BLOCK + MORE_BYTES_PER_MEMORY * model.friction.n_columns() as f64;
    let needed = case.budget.memory() + model.lattice.n_blocks() as f64 * of_block;
    let available = available_memory().filter(|available| needed > *available)?;
    Some(format!(
        "with a device the run needs {} of this machine's memory, and {} are available",
        byte_size(needed),
        byte_size(available)
    ))
}

fn note(quiet: bool, sentence: String) {
    if !quiet {
        print_notes([sentence]);
    }
}

/// Opens the first GPU of this machine.
///
/// # Errors
/// A sentence with the remedy, if there is none, if it does not compute the bits of the CPU, or if this
/// program was built without the feature `gpu`.
pub fn open_gpu() -> Result<Arc<dyn Device>, DeviceError> {
    #[cfg(feature = "gpu")]
    {
        let gpu: Arc<dyn Device> = Arc::new(slipfront_gpu::Gpu::open()?);
        // No number of a GPU or driver that computes otherwise is ever shown.
        gpu.test_bits()?;
        Ok(gpu)
    }
    #[cfg(not(feature = "gpu"))]
    {
        let message = "this program was built without the feature `gpu`";
        Err(DeviceError(message.to_owned()))
    }
}
