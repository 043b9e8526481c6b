//! `slipfront study` from outside: what it answers, how it survives, what it refuses.

mod answers;
mod files;
mod folders;
mod interrupted;
mod refusals;
mod results;
mod shards;
mod verify;
