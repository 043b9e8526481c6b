//! Tests of the command as a user sees it: its arguments, its output, and its files.

// Clippy does not count helpers of tests as tests.
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
mod reference;
mod repetition;
mod result_files;
mod study;
mod texture;
mod verify;
