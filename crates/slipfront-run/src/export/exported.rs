//! A folder of results that is exported: its files with their meanings, and the actions that made them.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_base::disk::{folder_name, folder_of, make_folders, open_regular, write_atomic_with};
use slipfront_base::number_format::count;
use slipfront_base::text::truncated;

use super::error::ExportError;
use super::meaning::meaning_in_run;
use super::parameters::{Parameter, parameters};
use crate::manifest::{Manifest, ManifestError, ManifestFile, Until};
use crate::names::{CASE, MANIFEST};
use crate::program;
use crate::verify::{VerifyError, differences, inspect, verify_run};

/// A folder of results in which no file has changed since it was written.
#[derive(Debug)]
pub struct Exported {
    /// Path of the folder.
    pub folder: PathBuf,
    /// Name of the folder.
    pub name: String,
    /// Kind of the results, such as `run` or `study`.
    pub kind: &'static str,
    /// Content of the folder, in addition to its name, such as `study from 24 recorded runs`; none for a run.
    pub what: Option<String>,
    /// The program that wrote the results.
    pub program: MadeBy,
    /// Name of the file from which the results can be reproduced.
    pub file: &'static str,
    /// Name of the list of checksums, which is sealed.
    pub list: &'static str,
    /// Seal of the list of checksums, which identifies the results.
    pub seal: String,
    /// Time at which the results were finished, UTC; empty where it is not recorded.
    pub finished: String,
    /// Every file of the results.
    pub files: Vec<ExportedFile>,
    /// The actions that made the files.
    pub actions: Vec<Action>,
}

/// A file with its meaning.
#[derive(Debug)]
pub struct ExportedFile {
    /// Path of the file in the folder, with its length and checksum.
    pub file: ManifestFile,
    /// Content of the file in words.
    pub meaning: String,
}

/// The program that wrote results.
#[derive(Clone, Debug)]
pub struct MadeBy {
    /// Version of slipfront.
    pub version: String,
    /// The git commit from which the program was built; none outside of git.
    pub revision: Option<String>,
    /// The identity of the build.
    pub build: String,
}

impl MadeBy {
    /// Name of the program in words.
    pub(super) fn in_words(&self) -> String {
        truncated(&program::in_words(&self.version, self.revision.as_deref()))
    }
}

/// An action that can be repeated: a run, or a study of many runs.
#[derive(Debug)]
pub struct Action {
    /// Globally unique identifier of the action.
    pub id: String,
    /// Name of the action for people.
    pub name: String,
    /// The command that repeats the action, and the files that are its arguments; none if there is no such
    /// command.
    pub command: Option<(String, Vec<String>)>,
    /// More about the action.
    pub description: String,
    /// Reason why the action failed; none if it succeeded.
    pub failure: Option<String>,
    /// Seal of the list of checksums of the action's results; none if it does not have its own list.
    pub seal: Option<String>,
    /// The program that performed the action.
    pub program: MadeBy,
    /// Times of begin and end, UTC; empty where they are not recorded.
    pub times: [String; 2],
    /// Paths of the input files of the action.
    pub objects: Vec<String>,
    /// Keys and values that the action used.
    pub parameters: Vec<Parameter>,
    /// Paths of the output files of the action.
    pub results: Vec<String>,
}

impl Exported {
    /// Reads the folder of a run and compares every file with its checksum.
    ///
    /// # Errors
    /// [`ExportError::Run`] for a folder without a complete run, [`ExportError::Changed`] when a file has
    /// changed.
    pub fn run(folder: &Path) -> Result<Self, ExportError> {
        let run = inspect(folder)?;
        let check = verify_run(&run, &AtomicBool::new(false))?;
        ExportError::expect_none(check.differences)?;
        let manifest = run.manifest().map_err(VerifyError::from)?.clone();
        let case = run.case_to_resume().map_err(VerifyError::from)?;
        let list = ManifestFile::read(folder, MANIFEST).map_err(|error| {
            let (path, why) = (folder.join(MANIFEST), error.to_string());
            VerifyError::from(ManifestError::Unreadable { path, why })
        })?;
        let name = folder_name(folder).unwrap_or_default();
        let action = action_of_run(&name, &manifest, parameters(case));
        let files = manifest.files.into_iter().chain([list]);
        let with_meaning = |file: ManifestFile| {
            let meaning = meaning_in_run(&file.name);
            ExportedFile { file, meaning }
        };
        Ok(Self {
            folder: folder.to_owned(),
            name,
            kind: "run",
            what: None,
            program: action.program.clone(),
            file: CASE,
            list: MANIFEST,
            seal: manifest.checksum,
            finished: manifest.finished,
            files: files.map(with_meaning).collect(),
            actions: vec![action],
        })
    }

    /// Adds the files and actions of other results, which are in the subfolder `at`.
    pub fn take(&mut self, at: &str, other: Self) {
        let below = |name: &mut String| name.insert_str(0, &format!("{at}/"));
        let first = self.files.len();
        self.files.extend(other.files);
        for ExportedFile { file, .. } in &mut self.files[first..] {
            below(&mut file.name);
        }
        for mut action in other.actions {
            let command = action.command.iter_mut().flat_map(|(_, files)| files);
            command
                .chain(&mut action.objects)
                .chain(&mut action.results)
                .for_each(below);
            self.actions.push(action);
        }
    }

    /// The name of the results, and a description of them if there is one.
    pub(super) fn title(&self) -> String {
        match &self.what {
            Some(what) => format!("{} ({what})", self.name),
            None => self.name.clone(),
        }
    }

    /// Hash of the file from which the results can be reproduced.
    pub(super) fn hash(&self) -> &str {
        let mut files = self.files.iter();
        let found = files.find(|found| found.file.name == self.file);
        found.map_or("", |found| &found.file.blake3)
    }

    /// Copies every file to a new folder, and compares it with its checksum.
    pub(super) fn copy(&self, to: &Path, stop: &AtomicBool) -> Result<(), ExportError> {
        for ExportedFile { file, .. } in &self.files {
            let (original, path) = (self.folder.join(&file.name), to.join(&file.name));
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
        let files = self.files.iter().map(|copied| &copied.file);
        let differences = differences(files, to, "were copied", stop);
        if stop.load(Ordering::Relaxed) {
            return Err(ExportError::Interrupted);
        }
        ExportError::expect_none(differences)
    }
}

/// A run as an action: the case, the files that it reads and its keys are its objects, every other file is a
/// result.
fn action_of_run(name: &str, manifest: &Manifest, parameters: Vec<Parameter>) -> Action {
    let names = manifest.files.iter().map(|file| file.name.clone());
    let (objects, results) = names
        .chain([MANIFEST.to_owned()])
        .partition(|name| name == CASE || name.starts_with("inputs/"));
    Action {
        id: format!("run-{}", manifest.checksum),
        name: format!("Run of the case {name}"),
        command: Some(("slipfront run".to_owned(), vec![CASE.to_owned()])),
        description: format!(
            "the bytes are the same on every machine; this one was {}, {}, {}; {CASE} has the BLAKE3 hash {}",
            manifest.host,
            manifest.platform,
            count(manifest.threads, "thread"),
            manifest.case_blake3
        ),
        failure: None,
        seal: Some(manifest.checksum.clone()),
        program: MadeBy {
            version: manifest.version.clone(),
            revision: manifest.revision.clone(),
            build: manifest.build.clone(),
        },
        times: [manifest.started.clone(), manifest.finished.clone()],
        objects,
        parameters,
        results,
    }
}
