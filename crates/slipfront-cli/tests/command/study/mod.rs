//! The command `slipfront study` from outside: its answers, interruptions and refusals.

mod answers;
mod files;
mod folders;
mod interrupted;
mod refusals;
pub(crate) mod results;
mod shards;
mod verify;
