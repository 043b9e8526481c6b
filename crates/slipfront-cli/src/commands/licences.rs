//! `slipfront licences`: under which licences slipfront is, and all that it contains.

use clap::Args;

use crate::failure::Failure;
use crate::print::print;

/// Written by `tests/licences/notices.py`, and held by `.ci/run` to the crates that are locked.
const NOTICES: &str = include_str!("../../THIRD-PARTY-NOTICES.txt");

/// Print the licences of slipfront and of the work of others in it
#[derive(Args)]
#[command(after_help = "Example:
  slipfront licences | less")]
pub(crate) struct LicencesCommand {}

impl LicencesCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        print(NOTICES)
    }
}
