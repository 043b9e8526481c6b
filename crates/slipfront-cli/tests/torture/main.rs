//! Torture: the command is killed, its file-system calls fail, and the files that it reads are damaged. It
//! must never give a wrong answer that looks right, never panic, never hang and never take memory without
//! bound.
//!
//! `cargo test` takes a sample of the cases. All of them, with the numbers of cases tried:
//!
//! ```console
//! $ SLIPFRONT_TORTURE=long cargo test --release -p slipfront-cli --test torture -- --nocapture
//! ```
//!
//! A number in place of `long`, such as 0.1, takes that share of them. The random choices follow from a seed,
//! `SLIPFRONT_TORTURE_SEED`, which every failure names.

#![cfg(unix)]
// Helpers of tests are not tests by themselves to clippy.
#![allow(clippy::unwrap_used)]

#[path = "../support/mod.rs"]
mod support;

mod bounded;
mod damage;
#[cfg(target_os = "linux")]
mod faults;
#[cfg(target_os = "linux")]
mod full_disk;
mod jobs;
mod kills;
// Where /proc tells how much memory a process has had.
#[cfg(target_os = "linux")]
mod soak;
mod tally;
#[cfg(target_os = "linux")]
mod watcher;
