//! The device on which many runs are computed.

use std::sync::Arc;

use clap::{Args, ValueEnum};
use slipfront::device::{Device, DeviceError};

use crate::failure::Failure;
use crate::print_stderr::print_notes;

/// Option of commands with many runs.
#[derive(Args)]
pub(crate) struct DeviceArgs {
    /// Device for the runs; results do not depend on it
    #[arg(long, value_name = "DEVICE", value_enum, default_value_t)]
    device: DeviceChoice,
}

/// Where runs are computed. Results do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum DeviceChoice {
    /// On the cores of this machine
    #[default]
    Cpu,
    /// On the first NVIDIA GPU; lattices that are not plain or have more than 4000 blocks, on the cores
    Gpu,
    /// On the GPU if there is one
    Auto,
}

impl DeviceArgs {
    /// Opens the device; returns none for the cores of this machine. `refused` says why the device cannot be
    /// used for this work, if it cannot.
    pub(crate) fn open(
        &self,
        refused: Option<&str>,
        quiet: bool,
    ) -> Result<Option<Arc<dyn Device>>, Failure> {
        if self.device == DeviceChoice::Cpu {
            return Ok(None);
        }
        let opened = match refused {
            Some(reason) => Err(DeviceError(reason.to_owned())),
            None => open_gpu(),
        };
        match opened {
            Ok((device, name)) => {
                note(quiet, format!("plain runs are computed on the GPU ({name})"));
                Ok(Some(device))
            }
            Err(reason) if self.device == DeviceChoice::Auto => {
                note(quiet, format!("runs are computed on the CPU: {reason}"));
                Ok(None)
            }
            Err(reason) => Err(Failure::input(reason)),
        }
    }
}

fn note(quiet: bool, sentence: String) {
    if !quiet {
        print_notes([sentence]);
    }
}

#[cfg(feature = "gpu")]
fn open_gpu() -> Result<(Arc<dyn Device>, String), DeviceError> {
    let gpu = slipfront_gpu::Gpu::open()?;
    let name = gpu.name()?;
    Ok((Arc::new(gpu), name))
}

#[cfg(not(feature = "gpu"))]
fn open_gpu() -> Result<(Arc<dyn Device>, String), DeviceError> {
    let message = "this program was built without the feature `gpu`: leave `--device` out; the CPU gives the same results";
    Err(DeviceError(message.to_owned()))
}
