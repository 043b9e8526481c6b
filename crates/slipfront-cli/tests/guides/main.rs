//! Tests of what the guides print: every console block, and tables of studies.

// Clippy does not count helpers of tests as tests.
#![allow(clippy::unwrap_used)]

#[path = "../support/mod.rs"]
mod support;

#[expect(dead_code, reason = "the guides show tables alone")]
#[path = "../command/study/results.rs"]
mod results;

mod printed;
mod studies;
