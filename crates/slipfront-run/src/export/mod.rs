//! Complete runs for other programs: as a Process Run Crate (RO-Crate) for data repositories, and as
//! citations.
//!
//! A run does not know its author and licence. What the user does not give is reported as missing, and never
//! made up.

mod attribution;
mod citation;
mod error;
mod parameters;
mod ro_crate;
mod whole_run;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use slipfront_base::disk::{folder_of, is_empty, is_same, make_folders, sync_folder, write_atomic};
use slipfront_base::text::truncated;
use slipfront_base::unfinished::UnfinishedFolder;

pub use self::attribution::{Attribution, Author, Licence};
pub use self::citation::{bibtex, cff};
pub use self::error::ExportError;
pub use self::whole_run::WholeRun;
use crate::clock;
use crate::names::RO_CRATE;

/// Describes runs as a Process Run Crate and returns the path of `ro-crate-metadata.json`: copies of them in
/// the new folder `out`, or without `out` one run in its own folder, where `force` replaces an earlier
/// description.
///
/// # Errors
/// [`ExportError::NeedsFolder`] for several runs without `out`; [`ExportError::Interrupted`] after a stop;
/// when a file or folder stands where one is to be made, when two runs have one name, and when the system
/// refuses to read or write.
pub fn write_crate(
    runs: &[WholeRun],
    out: Option<&Path>,
    by: &Attribution,
    force: bool,
    stop: &AtomicBool,
) -> Result<PathBuf, ExportError> {
    match (out, runs) {
        (Some(out), runs) => crate_of_copies(runs, out, by, stop),
        (None, [run]) => describe_in_place(run, by, force),
        (None, _) => Err(ExportError::NeedsFolder),
    }
}

/// Describes a run in its own folder, in `ro-crate-metadata.json`, and returns the path of this file. It is
/// not one of the run's files.
fn describe_in_place(run: &WholeRun, by: &Attribution, force: bool) -> Result<PathBuf, ExportError> {
    let path = run.folder.join(RO_CRATE);
    // A broken link is a file of the user as well.
    if path.symlink_metadata().is_ok() && !force {
        return Err(ExportError::Exists { path });
    }
    let bytes = ro_crate::metadata(&[(run, String::new())], by, clock::now());
    write_durably(&path, &bytes)?;
    Ok(path)
}

/// Copies runs to a new folder, each to a folder of its name, describes them there in
/// `ro-crate-metadata.json`, and returns the path of this file. The folder has its name when all of it is
/// there.
fn crate_of_copies(
    runs: &[WholeRun],
    out: &Path,
    by: &Attribution,
    stop: &AtomicBool,
) -> Result<PathBuf, ExportError> {
    let mut names: Vec<&String> = runs.iter().map(|run| &run.name).collect();
    names.sort_unstable();
    if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(ExportError::SameName {
            name: truncated(pair[0]),
        });
    }
    let failed = |source| ExportError::Write {
        path: out.to_owned(),
        source,
    };
    if is_same(out, Path::new(".")) {
        return Err(ExportError::WorkedIn { path: out.to_owned() });
    }
    // A link leads to the folder that is meant.
    let place = out.canonicalize().unwrap_or_else(|_| out.to_owned());
    if place.exists() && !is_empty(&place).map_err(failed)? {
        return Err(ExportError::NotEmpty { path: out.to_owned() });
    }
    make_folders(folder_of(&place)).map_err(failed)?;
    let hidden = UnfinishedFolder::beside(&place).map_err(failed)?;
    for run in runs {
        run.copy(&hidden.path().join(&run.name), stop)?;
    }
    let placed: Vec<_> = runs.iter().map(|run| (run, format!("{}/", run.name))).collect();
    let description = ro_crate::metadata(&placed, by, clock::now());
    write_durably(&hidden.path().join(RO_CRATE), &description)?;
    hidden.persist(&place).map_err(failed)?;
    Ok(out.join(RO_CRATE))
}

fn write_durably(path: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    let written = write_atomic(path, bytes).and_then(|()| sync_folder(folder_of(path)));
    written.map_err(|source| ExportError::Write {
        path: path.to_owned(),
        source,
    })
}
