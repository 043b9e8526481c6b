//! Command `slipfront licences`: the licences of slipfront and of its parts.

use clap::Args;

use crate::failure::Failure;
use crate::print::print;

/// Text written by `tests/licences/notices.py`; `.ci/run` compares it with the locked crates.
pub(crate) const NOTICES: &str = include_str!("../../THIRD-PARTY-NOTICES.txt");

/// Print the licences of slipfront and of its dependencies
#[derive(Args)]
#[command(after_help = "Example:
  slipfront licences | less")]
pub(crate) struct LicencesCommand {}

impl LicencesCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        print(NOTICES)
    }
}
