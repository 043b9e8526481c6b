//! The option `--force` of commands that write a folder of results.

use clap::Args;

/// The permission to replace an earlier result.
#[derive(Args)]
pub(crate) struct ForceArg {
    /// Replace slipfront's own files of an earlier result in this folder, but no other files
    #[arg(id = "force", long = "force")]
    pub(crate) given: bool,
}
