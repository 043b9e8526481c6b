//! The study folder: the study itself, the records, the tables and the pictures.

use std::collections::HashSet;
use std::fs::File;
use std::path::{Path, PathBuf};

use super::error::StudyError;
use super::execute::Findings;
use super::figures;
use super::file::StudyFile;
use super::inputs::Copy;
use super::plan::Plan;
use super::record::{Finding, RECORDS, Records};
use crate::folder::{
    FolderError, TEXT_MAX_BYTES, is_empty, open_bounded, open_regular, read_whole, remove_if_there,
    remove_unfinished_folders, stage, stage_folder, sync_folder, write_whole,
};
use crate::manifest::Manifest;

/// The study as a table with its base inside: what `slipfront study DIR/study.toml` repeats.
const STUDY: &str = "study.toml";

/// Folder of the run folders that a study keeps.
pub(crate) const RUNS: &str = "runs";

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
        if !used && !empty {
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
        let before = read_whole(&path.join(STUDY), TEXT_MAX_BYTES).ok();
        let before = before.filter(|before| before != text.as_bytes());
        let folder = Self {
            path: path.to_owned(),
            records,
            changed: before.is_some(),
            study: parse(&text)?,
        };
        // Pictures of what the study was are of no other use; one that cannot be read now has none that are known.
        let before = before.and_then(|before| parse(str::from_utf8(&before).ok()?).ok());
        if let Some(before) = before {
            let still: HashSet<String> = figures::names(&folder.study.axes).collect();
            folder.remove_pictures(figures::names(&before.axes).filter(|name| !still.contains(name)));
        }
        folder.copy(&copies)?;
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
        let written = std::fs::create_dir_all(folder).and_then(|()| write_whole(&path, bytes));
        written.map_err(|source| FolderError::Write { path, source }.into())
    }

    /// Copies files, one after the other. None takes its name before all are read: it may be that of an original.
    fn copy(&self, copies: &[Copy]) -> Result<(), FolderError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            |source| FolderError::Write { path, source }
        };
        let mut staged = Vec::new();
        for Copy { name, original, .. } in copies {
            let path = self.path.join(name);
            let copied = stage(&self.path, |to| {
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

    /// Copies the complete run folders that a shard has kept and this folder lacks, each whole or not at all, and the cases of
    /// failed runs; gives their number.
    ///
    /// # Errors
    /// When one cannot be copied.
    pub fn take_kept(&self, plan: &Plan, findings: &Findings, shard: &Path) -> Result<usize, StudyError> {
        remove_unfinished_folders(&self.path.join(RUNS));
        let mut taken = 0;
        for (run, finding) in &findings.runs {
            let name = plan.folder_name(*run);
            let is_whole = |folder: &Path| match finding.as_ref() {
                // A kill may have come while it was written.
                Finding::Done(_) => Manifest::read(folder).is_ok(),
                Finding::Failed(_) => folder.is_dir(),
            };
            let (from, to) = (shard.join(RUNS).join(&name), self.path.join(RUNS).join(&name));
            if !is_whole(&from) || is_whole(&to) {
                continue;
            }
            copy_folder(&from, &to).map_err(|source| FolderError::Copy { from, to, source })?;
            taken += 1;
        }
        Ok(taken)
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

/// Copies a folder to one of another name, which is there when all of it is on the disk.
fn copy_folder(from: &Path, to: &Path) -> std::io::Result<()> {
    let beside = to.parent().unwrap_or(to);
    std::fs::create_dir_all(beside)?;
    let staged = stage_folder(beside)?;
    copy_files(from, staged.path())?;
    // What a kill left of one.
    if to.exists() {
        std::fs::remove_dir_all(to)?;
    }
    std::fs::rename(staged.path(), to)?;
    // There is nothing left to remove.
    let _ = staged.keep();
    sync_folder(beside)
}

fn copy_files(from: &Path, to: &Path) -> std::io::Result<()> {
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if entry.file_type()?.is_dir() {
            std::fs::create_dir(&to)?;
            copy_files(&from, &to)?;
        } else {
            let mut copy = File::create_new(to)?;
            std::io::copy(&mut open_regular(&from)?, &mut copy)?;
            copy.sync_all()?;
        }
    }
    sync_folder(to)
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
    open_bounded(&path, TEXT_MAX_BYTES).map_err(|source| FolderError::Read {
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
        read_whole(&path, TEXT_MAX_BYTES).map_err(|source| FolderError::Read { path, source })
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
