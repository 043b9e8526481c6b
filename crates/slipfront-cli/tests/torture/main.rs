//! Torture: the command is killed, its file-system calls fail, and the files that it reads are damaged. It
//! must never give a wrong answer that looks right, never panic, never hang and never take unlimited memory.
//!
//! By default, a sample of the cases is tried. All cases, with the numbers of cases tried:
//!
//! ```console
//! $ SLIPFRONT_TORTURE=long cargo test -p slipfront-long-tests --test torture -- --nocapture
//! ```
//!
//! A number in place of `long`, such as 0.1, takes that share of them. The random choices follow from a seed,
//! `SLIPFRONT_TORTURE_SEED`, which every failure prints.

#![cfg(unix)]
// Clippy does not count helpers of tests as tests.
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
// Memory is counted in the unit of Linux.
#[cfg(target_os = "linux")]
mod soak;
mod tally;
#[cfg(target_os = "linux")]
mod watcher;
