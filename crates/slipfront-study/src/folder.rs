//! The results folder of a study: study file, journal, tables, pictures and run folders.

use std::collections::HashSet;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::anisotropy::anisotropies;
use crate::error::StudyError;
use crate::files_in_folder::{copy_in, write_in, write_picture};
use crate::journal::Records;
use crate::pictures;
use crate::plan::{Plan, RunKey};
use crate::study_file::StudyFile;
use crate::study_results::StudyResults;
use crate::{picture_plan, tables};
use slipfront_case::disk::{
    TEXT_MAX_BYTES, is_empty, make_folders, open_limited, read_limited, remove_if_there,
};
use slipfront_case::machine::free_disk;
use slipfront_case::number_format::byte_size;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::Manifest;
use slipfront_run::names::{CASE, CONVERGENCE, FIGURE_CACHE, RECORDS, RUNS, TABLES};
use slipfront_run::run_folder::copy::copy_run;

/// The study file in the folder, with the base case as a table in it: `slipfront study DIR/study.toml` repeats the study.
const STUDY: &str = "study.toml";

/// A study folder with its records open.
#[derive(Debug)]
pub struct StudyFolder {
    path: PathBuf,
    /// Finished runs.
    pub records: Records,
    /// Whether the study has changed since the folder was last used.
    pub changed: bool,
    /// The study in the folder, which reads copies of its files.
    pub study: StudyFile,
}

impl StudyFolder {
    /// Opens a results folder: a new one, an empty one, or one of an earlier call that no other process works in.
    pub fn open(path: &Path, study: &StudyFile) -> Result<Self, StudyError> {
        make_folders(path).map_err(FolderError::unwritable(path))?;
        let used = path.join(RECORDS).exists();
        let empty = is_empty(path).map_err(FolderError::unwritable(path))?;
        // A folder of `slipfront paper` has records and no study file.
        let is_of_figures = path.join(FIGURE_CACHE).is_dir() && !is_study(path);
        if (!used && !empty) || is_of_figures {
            return Err(StudyError::OtherThings {
                what: "study",
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
        copy_in(path, &copies)?;
        if let Some(before) = before {
            // Its tables and pictures do not belong to this study, and can be made from the records again. If its file cannot
            // be read, the names of its pictures are not known, and they stay.
            if let Ok(before) = parse(&String::from_utf8_lossy(&before)) {
                folder.remove_pictures(picture_plan::names(&before.axes));
            }
            for name in TABLES.into_iter().chain(CONVERGENCE) {
                let _ = remove_if_there(&folder.path.join(name));
            }
        }
        folder.write(STUDY, |file| file.write_all(text.as_bytes()))?;
        Ok(folder)
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file atomically.
    pub(crate) fn write(
        &self,
        name: &str,
        fill: impl FnOnce(&mut File) -> std::io::Result<()>,
    ) -> Result<(), StudyError> {
        write_in(&self.path, name, fill)
    }

    /// Copies complete run folders, and the cases of failed runs, from the folder of a shard, where this folder lacks them.
    pub fn take_kept(&self, plan: &Plan, results: &StudyResults, shard: &Path) -> Result<(), StudyError> {
        for (run, result) in &results.runs {
            let name = plan.folder_name(*run);
            let is_whole = |folder: &Path| match result {
                // The run folder may be incomplete if the process was killed.
                Ok(_) => Manifest::read(folder).is_ok(),
                Err(_) => folder.join(CASE).is_file(),
            };
            let (from, to) = (shard.join(RUNS).join(&name), self.path.join(RUNS).join(&name));
            if is_whole(&from) && !is_whole(&to) {
                copy_run(&from, &to)?;
            }
        }
        Ok(())
    }

    /// Refuses a study if the disk has no room for the runs that it lacks, with the fewest replicates.
    pub fn check_disk(&self, plan: &Plan) -> Result<(), StudyError> {
        let lacking = |run: &RunKey| self.records.get(&plan.identity(*run)).is_none();
        let needed = plan.disk(plan.runs(plan.settings.min_replicates()).filter(lacking));
        match free_disk(&self.path) {
            Some(free) if needed > free => Err(StudyError::Disk {
                needed: byte_size(needed),
                free: byte_size(free),
                path: self.path.clone(),
            }),
            _ => Ok(()),
        }
    }

    /// Removes the pictures of these names. An error is ignored: an old picture that stays is no reason to stop.
    fn remove_pictures(&self, names: impl Iterator<Item = String>) {
        for name in names {
            for ending in ["svg", "png"] {
                let _ = remove_if_there(&self.path.join(format!("{name}.{ending}")));
            }
        }
    }
}

/// Writes the tables and pictures of a study to its folder, and removes its pictures of earlier results.
pub fn write(plan: &Plan, results: &StudyResults, folder: &StudyFolder) -> Result<(), StudyError> {
    let [runs, points, anisotropy] = TABLES;
    folder.write(runs, |file| Ok(tables::runs(plan, results, file)?))?;
    folder.write(points, |file| Ok(tables::points(plan, results, file)?))?;
    match anisotropies(plan, results).as_slice() {
        // As with pictures, a table of earlier results that stays is no reason to stop.
        [] => drop(remove_if_there(&folder.path.join(anisotropy))),
        rows => folder.write(anisotropy, |file| Ok(tables::anisotropy(rows, file)?))?,
    }
    let mut drawn: HashSet<String> = HashSet::new();
    pictures::draw(plan, results, |name, picture| {
        write_picture(&folder.path, &name, &picture)?;
        drawn.insert(name);
        Ok(())
    })?;
    folder.remove_pictures(picture_plan::names(&plan.axes).filter(|name| !drawn.contains(name)));
    Ok(())
}

/// Whether the folder is the results folder of a study.
pub fn is_study(folder: &Path) -> bool {
    folder.join(STUDY).exists()
}

/// Loads the study file of a results folder.
pub fn study_of(folder: &Path) -> Result<StudyFile, StudyError> {
    let path = folder.join(STUDY);
    // A study file given by the user may be a pipe; in a results folder, opening a pipe would block without end.
    open_limited(&path, TEXT_MAX_BYTES).map_err(FolderError::read(&path))?;
    let mut study = StudyFile::load(&path)?;
    if let Some(name) = folder.file_name() {
        study.name = name.to_string_lossy().into_owned();
    }
    Ok(study)
}

/// Refuses folders whose studies differ: names the first that differs from the first of all.
pub fn refuse_foreign(folders: &[PathBuf]) -> Result<(), StudyError> {
    let read = |folder: &Path| {
        let path = folder.join(STUDY);
        read_limited(&path, TEXT_MAX_BYTES).map_err(FolderError::read(&path))
    };
    let [first, others @ ..] = folders else {
        return Ok(());
    };
    let text = read(first)?;
    for other in others {
        if read(other)? != text {
            let (first, other) = (first.clone(), other.clone());
            return Err(StudyError::Foreign { first, other });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs read the copies of which their identity was made: changes of the original files during a study have no effect,
    /// and a changed copy is an error.
    #[test]
    fn runs_read_what_their_identity_was_made_of() {
        let folder = tempfile::tempdir().unwrap();
        let table = |value: f64| format!("{value},{value}\n").repeat(2);
        let original = folder.path().join("mu.csv");
        std::fs::write(&original, table(0.9)).unwrap();
        let text = "[base]\nslider.blocks = [2, 2]\nfriction.mu_static_field = 'mu.csv'";
        let file = StudyFile::parse(text, "study.toml", "study", folder.path()).unwrap();
        let plan = Plan::new(&file, None).unwrap();
        let run = plan.runs(1).next().unwrap();
        let out = StudyFolder::open(&folder.path().join("out"), &file).unwrap();
        std::fs::write(&original, table(0.8)).unwrap();
        let said = plan.case(run, &mut |_| true).unwrap_err().to_string();
        assert!(
            said.contains("no longer what it was when the study began"),
            "{said}"
        );
        let plan = plan.reading_copies(&out.study);
        let case = plan.case(run, &mut |_| true).unwrap();
        assert_eq!(case.inputs[0].hash, blake3::hash(table(0.9).as_bytes()));
        std::fs::write(folder.path().join("out/inputs/mu.csv"), table(0.7)).unwrap();
        assert!(plan.case(run, &mut |_| true).is_err());
    }
}
