//! Case files that are read, case files that are refused with the sentence that they contain, height maps,
//! and cases that ranks make together.

// For clippy, helpers of tests are not tests themselves.
#![allow(clippy::unwrap_used)]

#[path = "../support/reference_page.rs"]
mod reference_page;

mod bad;
mod bulk;
mod coarse;
mod drawings;
mod few_blocks;
mod good;
mod heights;
mod hostile;
mod keys;
mod laws;
mod lengths;
mod ranks;
mod reference;
mod round_trip;
mod start;
mod stick_slip;
mod texture_files;

use std::fs;
use std::path::{Path, PathBuf};

/// The `.toml` files of a folder next to this file, in order.
fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder);
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

/// The text after `# name: ` in the comments at the beginning of a file.
fn notes(text: &str, name: &str) -> Vec<String> {
    let start = format!("# {name}: ");
    let comments = text.lines().take_while(|line| line.starts_with('#'));
    comments
        .filter_map(|line| line.strip_prefix(&start))
        .map(str::to_owned)
        .collect()
}
