//! `slipfront study` from outside: what it answers, how it survives, what it refuses.

// Clippy knows tests, but not what they share.
#![allow(clippy::unwrap_used)]

mod answers;
mod bench;
mod files;
mod folders;
mod interrupted;
mod refusals;
mod shards;
mod verify;
