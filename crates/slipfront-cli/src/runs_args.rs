//! Options of commands that compute runs for a folder of results.

use clap::Args;

use crate::device::DeviceArgs;
use crate::threads::count_from_one;

/// Options of commands that compute many runs for a folder of results.
#[derive(Args)]
pub(crate) struct RunsArgs {
    #[command(flatten)]
    pub(crate) force: ForceArg,
    /// Maximum number of runs at a time [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) device: DeviceArgs,
}

/// The permission to replace an earlier result.
#[derive(Args)]
pub(crate) struct ForceArg {
    /// Replace slipfront's own files of an earlier result in this folder, but no other files
    #[arg(id = "force", long = "force")]
    pub(crate) given: bool,
}
