//! Tests of the command `slipfront study`: its results, interruptions and refusals.

mod answers;
mod files;
mod folders;
mod interrupted;
mod refusals;
pub(crate) mod results;
mod shards;
mod verify;
