//! Run folders: their case, which is run again with the same bits, their curve, and their snapshots.

use std::path::{Path, PathBuf};

use slipfront_case::text::{display_path, truncated};
use slipfront_run::fields::read_fields;
use slipfront_run::names::{CASE, FIELDS, MANIFEST, SERIES, SUMMARY};
use slipfront_run::{series, summary, verify};
use slipfront_session::{Opened, RecordedRun, is_plain_name};

use crate::files::{self, ReadableFolders};

/// Largest file of fields whose snapshots are shown, in bytes.
const MAX_FIELDS: u64 = 32 << 20;

/// Names of the complete runs among the results.
pub(crate) fn folders(results: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(results).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter(|entry| entry.path().join(MANIFEST).is_file())
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| is_plain_name(name))
        .collect();
    names.sort();
    names
}

/// The folder of a run of this name.
///
/// # Errors
/// A sentence, if the name is more than a name, or leads out of the results and of what is `allowed`.
pub(crate) fn folder(results: &Path, name: &str, allowed: &[PathBuf]) -> Result<PathBuf, String> {
    if !is_plain_name(name) {
        return Err(format!(
            "{:?} is no run of the folder of results",
            truncated(name)
        ));
    }
    let found = ReadableFolders::new(results, "the results", allowed).and_then(|reach| reach.resolve(name));
    found.map_err(|error| format!("{} cannot be read: {error}", display_path(&results.join(name))))
}

/// Reads a complete run.
///
/// # Errors
/// A sentence, if it is none, or was changed since it was written, or one of its files lies elsewhere and not where it is `allowed`.
pub(crate) fn read(folder: &Path, allowed: &[PathBuf]) -> Result<Opened, String> {
    /// Any error as its sentence.
    fn sentence(error: impl std::fmt::Display) -> String {
        error.to_string()
    }
    let reach = ReadableFolders::new(folder, "the run", allowed)?;
    for name in [MANIFEST, CASE, SUMMARY, SERIES, FIELDS] {
        let path = folder.join(name);
        if path.symlink_metadata().is_ok() {
            reach
                .resolve(name)
                .map_err(|error| format!("{} cannot be read: {error}", display_path(&path)))?;
        }
    }
    let run = verify::inspect(folder).map_err(sentence)?;
    verify::expect_as_written(&run, |_| true).map_err(sentence)?;
    let canonical = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let name = canonical.file_name().unwrap_or_default().to_string_lossy();
    let document = files::document(&folder.join(CASE), &name, allowed).map_err(sentence)?;
    let summary = summary::read_summary(folder).map_err(sentence)?;
    let rows = series::read_csv(&folder.join(SERIES)).map_err(sentence)?;
    let fields = folder.join(FIELDS);
    let is_small = fields.metadata().is_ok_and(|found| found.len() <= MAX_FIELDS);
    let snapshots = if is_small {
        Some(read_fields(&fields).map_err(sentence)?)
    } else {
        None
    };
    let recorded = RecordedRun {
        contact_stress_max_pa: summary.si.map_or(f64::NAN, |si| si.contact_stress_max_pa) as f32,
        time_star: rows
            .iter()
            .map(|row| row.drive_time_star.unwrap_or(row.time_star))
            .collect(),
        mu_star: rows.iter().map(|row| row.mu_star).collect(),
        snapshots: snapshots.filter(|snapshots| snapshots.stride == 1 && !snapshots.frames.is_empty()),
    };
    Ok(Opened {
        document,
        recorded: Some(recorded),
    })
}
