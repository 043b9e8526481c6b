//! The command from outside: what a user types, sees, and finds on disk.

// Helpers of tests are not tests by themselves to clippy.
#![allow(clippy::unwrap_used)]

#[expect(dead_code, reason = "the page of the command line has no keys")]
#[path = "../../../slipfront-case/tests/support/reference_page.rs"]
mod reference_page;
#[path = "../support/mod.rs"]
mod support;

mod attach_file;
mod broken;
mod calibrate;
#[cfg(unix)]
mod checkpoints;
mod converge;
mod design;
mod docs;
mod export;
mod export_studies;
mod figures;
mod fixtures;
mod folder;
mod input;
#[cfg(unix)]
mod lab;
mod looks;
mod output;
mod paper;
mod plot;
mod printed;
mod reference;
mod repetition;
mod result_files;
mod study;
mod texture;
mod verify;
