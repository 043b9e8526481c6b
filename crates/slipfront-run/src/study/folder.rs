//! The study folder: the study itself, the records, the tables and the pictures.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::error::StudyError;
use super::figures;
use super::input_copies::Copy;
use super::journal::{Finding, Records};
use super::plan::Plan;
use super::scheduler::Findings;
use super::study_file::StudyFile;
use crate::manifest::Manifest;
use crate::names::{CASE, FOUND, RECORDS, RUNS, TABLES};
use crate::run_folder::copy::copy_run;
use crate::run_folder::error::FolderError;
use slipfront_case::disk::{
    TEXT_MAX_BYTES, is_empty, is_folder, open_limited, read_limited, remove_if_there, write_atomic,
    write_temp,
};

/// The study as a table with its base inside: what `slipfront study DIR/study.toml` repeats.
const STUDY: &str = "study.toml";

/// A study folder with its records open.
#[derive(Debug)]
pub struct StudyFolder {
    path: PathBuf,
    /// What has been run.
    pub records: Records,
    /// Whether the study was another one when the folder was last used.
    pub changed: bool,
    /// The study as it stands in the folder, where it reads copies of its files.
    pub(super) study: StudyFile,
}

impl StudyFolder {
    /// Makes the folder ready: new, empty, or one that a study has used before.
    ///
    /// # Errors
    /// When it holds other things, cannot be written, or another process works in it.
    pub fn open(path: &Path, study: &StudyFile) -> Result<Self, StudyError> {
        let unwritable = |source| FolderError::Unwritable {
            path: path.to_owned(),
            source,
        };
        std::fs::create_dir_all(path).map_err(unwritable)?;
        let used = path.join(RECORDS).exists();
        let empty = is_empty(path).map_err(unwritable)?;
        // The findings of `slipfront paper` stand beside records as well.
        let of_paper = path.join(FOUND).is_dir() && !is_study(path);
        if (!used && !empty) || of_paper {
            return Err(StudyError::NotAStudy {
                path: path.to_owned(),
            });
        }
        let records = Records::open(path).map_err(|error| match error {
            StudyError::NotRecords { path } => FolderError::Foreign { path }.into(),
            error => error,
        })?;
        let (text, copies) = study.portable()?;
        let parse = |text: &str| {
            let name = path.join(STUDY).display().to_string();
            StudyFile::parse(text, &name, &study.name, path)
        };
        let before = read_limited(&path.join(STUDY), TEXT_MAX_BYTES).ok();
        let before = before.filter(|before| before != text.as_bytes());
        let folder = Self {
            path: path.to_owned(),
            records,
            changed: before.is_some(),
            study: parse(&text)?,
        };
        folder.copy(&copies)?;
        // Its tables and pictures would stand beside another study, and follow from the records at any time. One that cannot
        // be read now has no pictures that are known.
        if let Some(before) = before {
            if let Ok(before) = parse(&String::from_utf8_lossy(&before)) {
                folder.remove_pictures(figures::names(&before.axes));
            }
            for table in TABLES {
                let _ = remove_if_there(&path.join(table));
            }
        }
        folder.write(STUDY, text.as_bytes())?;
        Ok(folder)
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file, whole or not at all.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StudyError> {
        let path = self.path.join(name);
        let folder = path.parent().unwrap_or(&self.path);
        let written = std::fs::create_dir_all(folder).and_then(|()| write_atomic(&path, bytes));
        written.map_err(|source| StudyError::Write { path, source })
    }

    /// Copies files, one after the other. None takes its name before all are read: it may be that of an original.
    fn copy(&self, copies: &[Copy]) -> Result<(), StudyError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            |source| StudyError::Write { path, source }
        };
        let mut staged = Vec::new();
        for Copy { name, original, .. } in copies {
            let path = self.path.join(name);
            // What a link leads to is somebody else's.
            let mut above = path.ancestors().skip(1).take_while(|above| *above != self.path);
            if let Some(link) = above.find(|above| above.symlink_metadata().is_ok() && !is_folder(above)) {
                let path = link.to_owned();
                return Err(FolderError::Foreign { path }.into());
            }
            let copied = write_temp(&self.path, |to| {
                std::io::copy(&mut File::open(original)?, to).map(|_| ())
            });
            staged.push((copied.map_err(failed(&path))?, path));
        }
        for (file, path) in staged {
            std::fs::create_dir_all(path.parent().unwrap_or(&self.path)).map_err(failed(&path))?;
            file.persist(&path)
                .map_err(|error| error.error)
                .map_err(failed(&path))?;
        }
        Ok(())
    }

    /// Copies the run folders that a shard has kept whole and this folder lacks, and the cases of failed runs.
    ///
    /// # Errors
    /// When one cannot be copied.
    pub fn take_kept(&self, plan: &Plan, findings: &Findings, shard: &Path) -> Result<(), StudyError> {
        for (run, finding) in &findings.runs {
            let name = plan.folder_name(*run);
            let is_whole = |folder: &Path| match finding.as_ref() {
                // A kill may have come while it was written.
                Finding::Done(_) => Manifest::read(folder).is_ok(),
                Finding::Failed(_) => folder.join(CASE).is_file(),
            };
            let (from, to) = (shard.join(RUNS).join(&name), self.path.join(RUNS).join(&name));
            if !is_whole(&from) || is_whole(&to) {
                continue;
            }
            copy_run(&from, &to)?;
        }
        Ok(())
    }

    /// Removes pictures of these names, and none of others; one that cannot be removed does no harm.
    pub(super) fn remove_pictures(&self, names: impl Iterator<Item = String>) {
        for name in names {
            for ending in ["svg", "png"] {
                let _ = remove_if_there(&self.path.join(format!("{name}.{ending}")));
            }
        }
    }
}

/// Whether a study has used the folder.
pub fn is_study(folder: &Path) -> bool {
    folder.join(STUDY).exists()
}

/// Loads the study of a folder that has run one.
///
/// # Errors
/// As for any study file.
pub fn study_of(folder: &Path) -> Result<StudyFile, StudyError> {
    let path = folder.join(STUDY);
    // A user may hand over a study through a pipe; in a folder of results it would be waited for.
    open_limited(&path, TEXT_MAX_BYTES).map_err(|source| FolderError::Read {
        path: path.clone(),
        source,
    })?;
    let mut study = StudyFile::load(&path)?;
    study.name = folder
        .file_name()
        .map_or(study.name, |name| name.to_string_lossy().into_owned());
    Ok(study)
}

/// Refuses folders whose studies differ.
///
/// # Errors
/// [`StudyError::Foreign`] names the first that differs from the first of all.
pub fn refuse_foreign(folders: &[PathBuf]) -> Result<(), StudyError> {
    let read = |folder: &Path| {
        let path = folder.join(STUDY);
        read_limited(&path, TEXT_MAX_BYTES).map_err(|source| FolderError::Read { path, source })
    };
    let Some((first, others)) = folders.split_first() else {
        return Ok(());
    };
    let text = read(first)?;
    for other in others {
        if read(other)? != text {
            return Err(StudyError::Foreign {
                first: first.clone(),
                other: other.clone(),
            });
        }
    }
    Ok(())
}
