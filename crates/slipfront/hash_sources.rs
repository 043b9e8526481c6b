//! Hashes the sources of the crate that is being built, for the identity of the build: two programs built
//! from the same sources give the same bits.
//!
//! This file is in slipfront, and every crate that computes recorded numbers links to it.
//! `locked-versions.toml` of slipfront-run is a link to the lock file of the workspace. Packages contain such
//! links as files, so that a package gives the same hash as the checkout from which it was made.

use std::io;
use std::path::{Path, PathBuf};

/// Files and folders that are hashed, relative to the crate.
const SOURCES: [&str; 2] = ["src", "locked-versions.toml"];

/// Sets `SLIPFRONT_SOURCE_HASH` to the BLAKE3 hash of the names and contents of all source files.
///
/// # Errors
/// When a file cannot be read.
pub(crate) fn hash_sources() -> io::Result<()> {
    let mut files = Vec::new();
    for source in SOURCES.into_iter().filter(|source| Path::new(source).exists()) {
        println!("cargo::rerun-if-changed={source}");
        add_files(Path::new(source), &mut files)?;
    }
    // Folders are listed in no particular order.
    files.sort();
    let mut hasher = blake3::Hasher::new();
    for path in files {
        let bytes = std::fs::read(&path)?;
        let name = path.to_string_lossy().replace('\\', "/");
        // The length marks where a file ends and the next name begins.
        hasher.update(format!("{name}\n{}\n", bytes.len()).as_bytes());
        hasher.update(&bytes);
    }
    println!("cargo::rustc-env=SLIPFRONT_SOURCE_HASH={}", hasher.finalize());
    Ok(())
}

/// Adds a file, or all files below a folder.
fn add_files(path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if path.is_dir() {
        for entry in std::fs::read_dir(path)? {
            add_files(&entry?.path(), files)?;
        }
    } else {
        files.push(path.to_owned());
    }
    Ok(())
}
