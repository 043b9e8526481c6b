//! `slipfront study` from outside: what it answers, how it survives, what it refuses.

mod answers;
mod bench;
mod files;
mod folders;
mod interrupted;
mod refusals;
mod shards;
