//! Shared parts of the tests of the command: a folder to work in, and the processes that work there.

// Every test binary uses a part of it.
#![allow(dead_code)]

pub(crate) mod book;
pub(crate) mod process;
pub(crate) mod workspace;
