//! A complete run that is exported: read, compared with its checksums, and copied.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_base::disk::{folder_name, folder_of, make_folders, open_regular, write_atomic_with};
use slipfront_case::case_file::CaseFile;

use super::error::ExportError;
use crate::manifest::{Manifest, ManifestError, ManifestFile, Until};
use crate::names::MANIFEST;
use crate::verify::{VerifyError, differences, inspect, verify_run};

/// A complete run, every file of which is as it was written.
#[derive(Debug)]
pub struct WholeRun {
    pub(super) folder: PathBuf,
    /// Name of the folder.
    pub(super) name: String,
    pub(super) case: CaseFile,
    pub(super) manifest: Manifest,
    /// Length and hash of the manifest.
    manifest_file: ManifestFile,
}

impl WholeRun {
    /// Reads a run folder and compares every file with its checksum.
    ///
    /// # Errors
    /// [`ExportError::Run`] for a folder without a complete run, [`ExportError::Changed`] when a file has
    /// changed.
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
        Ok(Self {
            folder: folder.to_owned(),
            name: folder_name(folder).unwrap_or_default(),
            case,
            manifest,
            manifest_file,
        })
    }

    /// The identifier of the run: the checksum of its manifest.
    pub(super) fn identifier(&self) -> String {
        format!("blake3:{}", self.manifest.checksum)
    }

    /// Every file of the run, the manifest last.
    pub(super) fn files(&self) -> impl Iterator<Item = &ManifestFile> {
        self.manifest.files.iter().chain([&self.manifest_file])
    }

    /// Copies every file of the run to a new folder, where it is compared with its checksum.
    pub(super) fn copy(&self, to: &Path, stop: &AtomicBool) -> Result<(), ExportError> {
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
