//! Shared helpers of the command tests: a folder to work in, and processes.

// Every test binary uses only some of these.
#![allow(dead_code)]

pub(crate) mod book;
pub(crate) mod process;
pub(crate) mod workspace;
