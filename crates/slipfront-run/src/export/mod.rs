//! Complete results for other programs: as a Process Run Crate (RO-Crate) for data repositories, and as
//! citations.
//!
//! A run is described here; a folder of many runs describes itself as [`Exported`]. Results do not contain
//! their author and licence. If the user does not give these, they are reported as missing and never made up.

mod attribution;
mod citation;
mod error;
mod exported;
mod meaning;
mod parameters;
mod ro_crate;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use slipfront_base::disk::{folder_of, is_empty, is_same, make_folders, sync_folder, write_atomic};
use slipfront_base::text::truncated;
use slipfront_base::unfinished::UnfinishedFolder;

pub use self::attribution::{Attribution, Author, Licence};
pub use self::citation::{bibtex, cff};
pub use self::error::ExportError;
pub use self::exported::{Action, Exported, ExportedFile, MadeBy};
pub use self::parameters::Parameter;
pub use self::ro_crate::folders_in;
use crate::clock;
use crate::names::RO_CRATE;

/// Describes results as a Process Run Crate and returns the path of `ro-crate-metadata.json`. With `out`, the
/// folders are copied to this new folder; without it, one folder is described in place, where `force`
/// replaces an earlier description.
///
/// # Errors
/// [`ExportError::NeedsFolder`] for several folders without `out`; [`ExportError::Interrupted`] after a stop;
/// when a file or folder already exists where one must be created, when two folders have the same name, and
/// when reading or writing fails.
pub fn write_crate(
    folders: &[Exported],
    out: Option<&Path>,
    by: &Attribution,
    force: bool,
    stop: &AtomicBool,
) -> Result<PathBuf, ExportError> {
    match (out, folders) {
        (Some(out), folders) => crate_of_copies(folders, out, by, stop),
        (None, [results]) => describe_in_place(results, by, force),
        (None, _) => Err(ExportError::NeedsFolder),
    }
}

/// Describes results in their own folder, in `ro-crate-metadata.json`, and returns the path of this file. It
/// is not one of the results.
fn describe_in_place(results: &Exported, by: &Attribution, force: bool) -> Result<PathBuf, ExportError> {
    let path = results.folder.join(RO_CRATE);
    // A broken link also counts as a file of the user.
    if path.symlink_metadata().is_ok() && !force {
        return Err(ExportError::Exists { path });
    }
    let bytes = ro_crate::metadata(&[(results, String::new())], by, clock::now());
    write_durably(&path, &bytes)?;
    Ok(path)
}

/// Copies folders of results to a new folder, each under its name, describes them there in
/// `ro-crate-metadata.json`, and returns the path of this file. The folder gets its name when it is complete.
fn crate_of_copies(
    folders: &[Exported],
    out: &Path,
    by: &Attribution,
    stop: &AtomicBool,
) -> Result<PathBuf, ExportError> {
    let mut names: Vec<&String> = folders.iter().map(|results| &results.name).collect();
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
    // If `out` is a link, the target is the folder that it leads to.
    let place = out.canonicalize().unwrap_or_else(|_| out.to_owned());
    if place.exists() && !is_empty(&place).map_err(failed)? {
        return Err(ExportError::NotEmpty { path: out.to_owned() });
    }
    make_folders(folder_of(&place)).map_err(failed)?;
    let hidden = UnfinishedFolder::beside(&place).map_err(failed)?;
    for results in folders {
        results.copy(&hidden.path().join(&results.name), stop)?;
    }
    let placed = folders
        .iter()
        .map(|results| (results, format!("{}/", results.name)));
    let placed: Vec<_> = placed.collect();
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
