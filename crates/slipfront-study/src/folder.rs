//! The results folder of a study: study file, journal, tables, pictures and run folders.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use crate::anisotropy::anisotropies;
use crate::error::StudyError;
use crate::finished_run::mark_of;
use crate::plan::{Plan, RunKey};
use crate::project_folder::{Batch, Checksums, Others, ProjectKind, ResultFiles, notes_of_use};
use crate::run_journal::RunJournal;
use crate::shard::Shard;
use crate::study_file::{STUDIES, StudyFile};
use crate::study_results::StudyResults;
use crate::{pictures, tables};
use slipfront_base::disk::{TEXT_MAX_BYTES, open_limited, read_limited};
use slipfront_base::machine::free_disk;
use slipfront_base::number_format::byte_size;
use slipfront_run::folder_error::FolderError;
use slipfront_run::names::{FIGURE_CACHE, RUNS, TABLES};
use slipfront_run::run_copy::copy_run;

const STUDY: &str = STUDIES.file;

/// A study folder with its records open.
#[derive(Debug)]
pub struct StudyFolder {
    path: PathBuf,
    /// Finished runs.
    pub records: RunJournal,
    /// Result files of the folder.
    pub(crate) files: ResultFiles,
    /// Whether the study has changed since the folder was last used.
    pub changed: bool,
    /// The study in the folder, which reads copies of its files.
    pub study: StudyFile,
}

impl StudyFolder {
    /// Opens a results folder: a new one, an empty one, or one of an earlier call that no other process uses.
    /// It is for the points of a `part`, or for all. If the study has changed since then, its tables and
    /// pictures are removed: they can be made again from the records.
    ///
    /// # Errors
    /// When the folder contains other things or another part of the study, or results that were edited
    /// afterwards, unless `force` is set; when another process uses it, or it cannot be written to.
    pub fn open(
        path: &Path,
        study: &StudyFile,
        part: Option<Shard>,
        force: bool,
    ) -> Result<Self, StudyError> {
        STUDIES.is_used(path)?;
        if is_of_figures(path) {
            return Err(STUDIES.other_things(path));
        }
        let records = RunJournal::from_opened(STUDIES.open_journal(path)?);
        let given = study.given()?;
        let parse = |text: &str| {
            let name = path.join(STUDY).display().to_string();
            StudyFile::parse(text, &name, &study.name, path)
        };
        let before = read_limited(&path.join(STUDY), TEXT_MAX_BYTES).ok();
        let changed = given.differs_in(&STUDIES, path);
        if let (
            Some(part),
            Ok(Some(Checksums {
                part: Some(there), ..
            })),
            false,
        ) = (part, Checksums::read(path), changed)
            && part.to_string() != there
        {
            let (path, part) = (path.to_owned(), part.to_string());
            return Err(StudyError::OtherPart { path, there, part });
        }
        // A user may change the study in the folder, and run that.
        let is_this = |before: &Vec<u8>| {
            let there = parse(&String::from_utf8_lossy(before)).ok();
            there.is_some_and(|there| there.given().is_ok_and(|there| there.text == given.text))
        };
        let mut batch = given.stage(&STUDIES, path, force)?;
        if before.is_some_and(|before| is_this(&before)) {
            batch.may_replace(STUDY);
        }
        batch.is_of_part(part);
        let files = batch.place_given(if changed { Others::Go } else { Others::Stay })?;
        Ok(Self {
            path: path.to_owned(),
            records,
            files,
            changed,
            study: parse(&given.text)?,
        })
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Sentences about a folder that has been used before.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = notes_of_use(self.records.damaged, 0);
        if self.changed {
            let changed = "the study was changed after this folder was last used; runs that still belong to it are kept";
            notes.push(changed.to_owned());
        }
        notes
    }

    /// Copies complete run folders, and the cases of failed runs, from the folders of shards if they are
    /// missing here.
    ///
    /// # Errors
    /// When the folder of a run is not the one that the journal names; when the system refuses to read or to
    /// write; after a stop.
    pub fn take_kept(
        &self,
        plan: &Plan,
        results: &StudyResults,
        shards: &[PathBuf],
        stop: &AtomicBool,
    ) -> Result<(), StudyError> {
        for (run, result) in &results.runs {
            if stop.load(Ordering::Relaxed) {
                return Err(StudyError::Interrupted);
            }
            let name = plan.folder_name(*run);
            let recorded = self.records.mark(&plan.identity(*run));
            // The run folder may be incomplete if the process was killed.
            let mark = |folder: &Path| mark_of(folder, result.is_ok());
            let is_its = |mark: &String| recorded.as_ref().is_none_or(|recorded| recorded == mark);
            let to = self.path.join(RUNS).join(&name);
            if mark(&to).is_some_and(|mark| is_its(&mark)) {
                continue;
            }
            let there = shards.iter().map(|shard| shard.join(RUNS).join(&name));
            let there: Vec<_> = there.filter_map(|path| Some((mark(&path)?, path))).collect();
            match there.iter().find(|(mark, _)| is_its(mark)) {
                Some((_, from)) => copy_run(from, &to)?,
                None if there.is_empty() => {}
                None => {
                    let path = there[0].1.clone();
                    return Err(StudyError::NotItsRun { path });
                }
            }
        }
        Ok(())
    }

    /// Refuses a study if the disk has no space for its missing runs, with the fewest replicates.
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
}

/// Writes the tables and pictures of a study to a batch of files, until a stop.
pub(crate) fn stage(
    plan: &Plan,
    results: &StudyResults,
    batch: &mut Batch,
    stop: &AtomicBool,
) -> Result<(), StudyError> {
    let [runs, points, anisotropy] = TABLES;
    batch.write(runs, |file| Ok(tables::runs(plan, results, file)?))?;
    batch.write(points, |file| Ok(tables::points(plan, results, file)?))?;
    let rows = anisotropies(plan, results);
    if !rows.is_empty() {
        batch.write(anisotropy, |file| Ok(tables::anisotropy(&rows, file)?))?;
    }
    let look = batch.look().clone();
    pictures::draw(plan, results, &look, |name, picture| {
        if stop.load(Ordering::Relaxed) {
            return Err(StudyError::Interrupted);
        }
        batch.write_picture(&name, &picture)
    })
}

/// Folders of `slipfront paper`.
pub const PAPER: ProjectKind = ProjectKind {
    name: "paper",
    table: "paper",
    file: "report.html",
    journal: RunJournal::FILE,
    given: &[],
    found: &[],
};

/// Whether the folder is one of `slipfront paper`, which has records but no study file.
pub fn is_of_figures(folder: &Path) -> bool {
    (folder.join(FIGURE_CACHE).is_dir() || PAPER.has_results_in(folder)) && !is_study(folder)
}

/// Whether the folder is the results folder of a study.
pub fn is_study(folder: &Path) -> bool {
    folder.join(STUDY).exists()
}

/// Loads the study file of a results folder.
pub fn study_of(folder: &Path) -> Result<StudyFile, StudyError> {
    let path = folder.join(STUDY);
    // A study file given by the user may be a pipe; in a results folder, opening a pipe would block forever.
    open_limited(&path, TEXT_MAX_BYTES).map_err(FolderError::read(&path))?;
    StudyFile::load(&path)
}

/// Refuses folders with different studies, and names the first that differs from the first folder.
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

    /// Runs read the copies that their identity was computed from. Changes of the original files during a
    /// study have no effect, and a changed copy is an error.
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
        let out = StudyFolder::open(&folder.path().join("out"), &file, None, false).unwrap();
        std::fs::write(&original, table(0.8)).unwrap();
        let said = plan.case(run, &mut |_| true).unwrap_err().to_string();
        assert!(said.contains("was changed after the study began"), "{said}");
        let plan = plan.reading_copies(&out.study);
        let case = plan.case(run, &mut |_| true).unwrap();
        assert_eq!(case.inputs[0].hash, blake3::hash(table(0.9).as_bytes()));
        std::fs::write(folder.path().join("out/inputs/mu.csv"), table(0.7)).unwrap();
        assert!(plan.case(run, &mut |_| true).is_err());
    }
}
