//! Complete runs told to other programs: as a Process Run Crate (RO-Crate) for data repositories, and as citations.
//!
//! Author and licence are not known to a run. What the user does not tell is told as missing, and never made up.

mod citation;
mod parameters;
mod ro_crate;

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_base::disk::{
    folder_of, is_empty, is_same, make_folders, open_regular, sync_folder, write_atomic, write_atomic_with,
};
use slipfront_base::text::truncated;
use slipfront_base::unfinished::UnfinishedFolder;
use slipfront_case::case_file::CaseFile;
use thiserror::Error;

pub use self::citation::{bibtex, cff};
use crate::clock;
use crate::manifest::{Manifest, ManifestError, ManifestFile, Until};
use crate::names::{MANIFEST, RO_CRATE};
use crate::verify::{VerifyError, differences, inspect, verify_run};

/// A complete run, every file of which is as it was written.
#[derive(Debug)]
pub struct WholeRun {
    folder: PathBuf,
    /// Name of the folder.
    name: String,
    case: CaseFile,
    manifest: Manifest,
    /// Length and hash of the manifest.
    manifest_file: ManifestFile,
}

/// Facts about results that only the user knows.
#[derive(Clone, Debug, Default)]
pub struct Told {
    /// Who made the runs.
    pub author: Option<Author>,
    /// Terms under which others may use the results.
    pub licence: Option<Licence>,
}

impl Told {
    /// Sentences about what a crate lacks, since the user did not tell it.
    pub fn notes(&self) -> Vec<&'static str> {
        let mut notes = Vec::new();
        if self.author.is_none() {
            notes.push("the crate names no author: add --author \"NAME\"");
        }
        if self.licence.is_none() {
            notes.push(
                "the crate has no licence, without which others may not use the results: add --licence, such as --licence CC-BY-4.0",
            );
        }
        notes
    }
}

/// Name of an author, with the address of an ORCID record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Author {
    name: String,
    orcid: Option<String>,
}

/// A licence, by its identifier in the list of SPDX or by its address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Licence {
    name: String,
    url: String,
}

/// Reason for which a run is not exported.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ExportError {
    #[error(transparent)]
    Run(#[from] VerifyError),
    #[error(
        "{difference}: only results that are as they were written are exported; run the case again to another folder"
    )]
    Changed { difference: String },
    #[error("{path} exists: replace it with --force, or write the crate to a new folder with --out")]
    Exists { path: PathBuf },
    #[error("the folder {path} is not empty: choose another with --out")]
    NotEmpty { path: PathBuf },
    #[error(
        "the command works in the folder {path}, which a new one would replace: name one in it with --out"
    )]
    WorkedIn { path: PathBuf },
    #[error("stopped by a signal: nothing is written")]
    Interrupted,
    #[error(
        "two of the runs stand in folders of the name {name}, as which both would be copied: rename one of them"
    )]
    SameName { name: String },
    #[error("several runs make one crate in a folder of its own: name it with --out")]
    NeedsFolder,
    #[error("a citation file needs an author: add --author \"NAME\"")]
    NeedsAuthor,
    #[error("cannot write {path}: {source}; choose another folder with --out")]
    Write { path: PathBuf, source: std::io::Error },
}

impl WholeRun {
    /// Reads a run folder and compares every file with its checksum.
    ///
    /// # Errors
    /// [`ExportError::Run`] for a folder without a complete run, [`ExportError::Changed`] when a file has changed.
    pub fn read(folder: &Path) -> Result<Self, ExportError> {
        let run = inspect(folder)?;
        if let Some(difference) = verify_run(&run, &AtomicBool::new(false))?
            .differences
            .into_iter()
            .next()
        {
            return Err(ExportError::Changed { difference });
        }
        let manifest = run.manifest().map_err(VerifyError::from)?.clone();
        let case = run.case_to_resume().map_err(VerifyError::from)?.clone();
        let manifest_file = ManifestFile::of(folder, MANIFEST).map_err(|error| {
            let (path, why) = (folder.join(MANIFEST), error.to_string());
            VerifyError::from(ManifestError::Unreadable { path, why })
        })?;
        // A folder named `.` has the name that the system knows.
        let path = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        Ok(Self {
            folder: folder.to_owned(),
            name,
            case,
            manifest,
            manifest_file,
        })
    }

    /// The identifier of the run: the checksum of its manifest.
    fn identifier(&self) -> String {
        format!("blake3:{}", self.manifest.checksum)
    }

    /// Every file of the run, the manifest last.
    fn files(&self) -> impl Iterator<Item = &ManifestFile> {
        self.manifest.files.iter().chain([&self.manifest_file])
    }

    /// Copies every file of the run to a new folder, where it is compared with its checksum.
    fn copy(&self, to: &Path, stop: &AtomicBool) -> Result<(), ExportError> {
        for ManifestFile { name, .. } in self.files() {
            let (original, path) = (self.folder.join(name), to.join(name));
            let copied = make_folders(folder_of(&path)).and_then(|()| {
                write_atomic_with(&path, |to| {
                    let file = open_regular(&original)?;
                    std::io::copy(&mut Until { file, stop }, to).map(drop)
                })
            });
            if stop.load(Ordering::Relaxed) {
                return Err(ExportError::Interrupted);
            }
            copied.map_err(|source| ExportError::Write { path, source })?;
        }
        let differences = differences(self.files(), to, "were copied", stop);
        if stop.load(Ordering::Relaxed) {
            return Err(ExportError::Interrupted);
        }
        match differences.into_iter().next() {
            Some(difference) => Err(ExportError::Changed { difference }),
            None => Ok(()),
        }
    }
}

impl FromStr for Author {
    type Err = String;

    /// Reads `NAME`, or `NAME <https://orcid.org/0000-0000-0000-0000>`.
    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "write a name, or \"NAME <https://orcid.org/0000-0000-0000-0000>\"";
        let (name, orcid) = match text.split_once('<') {
            Some((name, orcid)) => (name, Some(orcid.strip_suffix('>').ok_or(FORM)?)),
            None => (text, None),
        };
        let is_orcid = |address: &str| {
            address.strip_prefix("https://orcid.org/").is_some_and(|digits| {
                let parts = digits.split('-').collect::<Vec<_>>();
                let is_part =
                    |part: &&str| part.len() == 4 && part.bytes().all(|c| c.is_ascii_digit() || c == b'X');
                parts.len() == 4 && parts.iter().all(is_part)
            })
        };
        if name.trim().is_empty() || name.contains(char::is_control) || !orcid.is_none_or(is_orcid) {
            return Err(FORM.to_owned());
        }
        Ok(Self {
            name: name.trim().to_owned(),
            orcid: orcid.map(str::to_owned),
        })
    }
}

impl FromStr for Licence {
    type Err = String;

    /// Reads an identifier such as `CC-BY-4.0`, or an address.
    fn from_str(text: &str) -> Result<Self, String> {
        let is_address = ["https://", "http://"]
            .iter()
            .any(|start| text.starts_with(start));
        let is_identifier = |c: char| c.is_ascii_alphanumeric() || "-.+".contains(c);
        if text.is_empty()
            || (!is_address && !text.chars().all(is_identifier))
            || text.contains(char::is_whitespace)
        {
            return Err(
                "write an identifier of https://spdx.org/licenses, such as CC-BY-4.0, or an address"
                    .to_owned(),
            );
        }
        let url = if is_address {
            text.to_owned()
        } else {
            format!("https://spdx.org/licenses/{text}")
        };
        Ok(Self {
            name: text.to_owned(),
            url,
        })
    }
}

/// Describes runs as a Process Run Crate and returns the path of `ro-crate-metadata.json`: copies of them in the new folder `out`, or without
/// `out` one run in its own folder, where `force` replaces an earlier description.
///
/// # Errors
/// [`ExportError::NeedsFolder`] for several runs without `out`; [`ExportError::Interrupted`] after a stop; when a file or folder stands where one is to be made, when two runs have one
/// name, and when the system refuses to read or write.
pub fn write_crate(
    runs: &[WholeRun],
    out: Option<&Path>,
    told: &Told,
    force: bool,
    stop: &AtomicBool,
) -> Result<PathBuf, ExportError> {
    match (out, runs) {
        (Some(out), runs) => crate_of_copies(runs, out, told, stop),
        (None, [run]) => describe_in_place(run, told, force),
        (None, _) => Err(ExportError::NeedsFolder),
    }
}

/// Describes a run in its own folder, in `ro-crate-metadata.json`, and returns the path of this file. It is not one of the run's files.
fn describe_in_place(run: &WholeRun, told: &Told, force: bool) -> Result<PathBuf, ExportError> {
    let path = run.folder.join(RO_CRATE);
    // A broken link is a file of the user as well.
    if path.symlink_metadata().is_ok() && !force {
        return Err(ExportError::Exists { path });
    }
    let bytes = ro_crate::metadata(&[(run, String::new())], told, clock::now());
    write_durably(&path, &bytes)?;
    Ok(path)
}

/// Copies runs to a new folder, each to a folder of its name, describes them there in `ro-crate-metadata.json`, and returns the path of this
/// file. The folder has its name when all of it is there.
fn crate_of_copies(
    runs: &[WholeRun],
    out: &Path,
    told: &Told,
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
    let description = ro_crate::metadata(&placed, told, clock::now());
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
