//! Export of the folders of studies and other projects: the files in their lists with their meanings, the
//! project as an action, and each run of a study as a further action.

use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use csv::StringRecord;
use serde::Deserialize;
use slipfront_base::disk::{folder_name, open_regular};
use slipfront_base::number_format::count;
use slipfront_run::export::{Action, ExportError, Exported, ExportedFile, MadeBy, Parameter};
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::ManifestFile;
use slipfront_run::names::{CASE, CONVERGENCE, RUNS, TABLES};
use slipfront_run::run_copy::file_names;
use thiserror::Error;

use crate::error::StudyError;
use crate::folder::is_of_figures;
use crate::project_folder::{
    CHECKSUMS, Checksums, Derivation, Journal, JournalEntry, ProjectKind, VerifyStudyError, verify_checksums,
};
use crate::study_file::STUDIES;
use crate::summary_values::{AFTER_AXES, BEFORE_AXES};
use crate::verify::verify_kept;

/// Reason why a folder is not exported.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ExportFolderError {
    #[error("the {what} in {path} is not finished: run it again to resume it, and then export it")]
    Unfinished { what: &'static str, path: PathBuf },
    #[error(
        "{path} contains figures of `slipfront paper`, which can be computed again: give folders of runs or studies"
    )]
    Figures { path: PathBuf },
    #[error(transparent)]
    Folder(#[from] StudyError),
    #[error(transparent)]
    Kept(#[from] VerifyStudyError),
    #[error(transparent)]
    Results(#[from] ExportError),
}

/// A line of the journal of any project.
#[derive(Deserialize)]
struct RecordedRun {
    id: String,
}

impl JournalEntry for RecordedRun {
    const KEYS: &'static [&'static str] = &["id"];
}

/// Reads the folder of a run, of a study, or of a project of one of these `others`, for export, and compares
/// every file with its checksum.
///
/// # Errors
/// When it is not such a folder, was not finished, cannot be read, or was changed after it was written.
pub fn exported(folder: &Path, others: &[Derivation]) -> Result<Exported, ExportFolderError> {
    if STUDIES.has_results_in(folder) {
        return study(folder);
    }
    if let Some(other) = others.iter().find(|other| other.kind.has_results_in(folder)) {
        return project(folder, other.kind, other.kind.name);
    }
    if is_of_figures(folder) {
        let path = folder.to_owned();
        return Err(ExportFolderError::Figures { path });
    }
    Ok(Exported::run(folder)?)
}

/// A study with its runs. A study with a comparison of its meshes is a convergence.
fn study(folder: &Path) -> Result<Exported, ExportFolderError> {
    let is_over_meshes = folder.join(CONVERGENCE[0]).exists();
    let kind = if is_over_meshes {
        "convergence"
    } else {
        STUDIES.name
    };
    let mut study = project(folder, &STUDIES, kind)?;
    add_runs(&mut study)?;
    Ok(study)
}

/// The folder of a project, as in its list of files. The project is an action of this `kind`: its project
/// file and the given files are the inputs, and all others are the results.
fn project(folder: &Path, of: &ProjectKind, kind: &'static str) -> Result<Exported, ExportFolderError> {
    let never = AtomicBool::new(false);
    let (mut verdict, is_complete) = verify_checksums(folder, of, &[], &never)?;
    if of.name == STUDIES.name {
        verify_kept(folder, &mut verdict, &never)?;
    }
    ExportError::expect_none(verdict.differences)?;
    if !is_complete {
        let path = folder.to_owned();
        return Err(ExportFolderError::Unfinished { what: kind, path });
    }
    let list = Checksums::read(folder)?.unwrap_or_default();
    let (runs, _) = Journal::read::<RecordedRun>(folder, of.journal)?;
    let runs: HashSet<String> = runs.into_iter().map(|run| run.id).collect();
    let runs = count(runs.len(), "recorded run");
    let mut files = list.files;
    for name in [of.journal, CHECKSUMS] {
        files.push(file_of(folder, name)?);
    }
    let name = folder_name(folder).unwrap_or_default();
    let names = || files.iter().map(|file| file.name.clone());
    let (objects, results) = names().partition(|name| is_given(of, name));
    let of_command = names().filter(|name| name == of.file || meaning_among(of.given, name).is_some());
    let program = MadeBy {
        version: list.version,
        revision: list.revision,
        build: list.build,
    };
    let action = Action {
        id: format!("{kind}-{}", list.seal),
        name: format!("The {kind} {name}"),
        command: Some((format!("slipfront {}", of.table), of_command.collect())),
        description: format!("{} has a line for each of {runs}", of.journal),
        failure: None,
        seal: Some(list.seal.clone()),
        program: program.clone(),
        times: Default::default(),
        objects,
        parameters: Vec::new(),
        results,
    };
    let files = files.into_iter().map(|file| ExportedFile {
        meaning: meaning(of, &file.name),
        file,
    });
    Ok(Exported {
        folder: folder.to_owned(),
        name,
        kind,
        what: Some(format!("{kind} from {runs}")),
        program,
        file: of.file,
        list: CHECKSUMS,
        seal: list.seal,
        finished: String::new(),
        files: files.collect(),
        actions: vec![action],
    })
}

/// A file of a folder as it is now.
fn file_of(folder: &Path, name: &str) -> Result<ManifestFile, StudyError> {
    let path = folder.join(name);
    Ok(ManifestFile::of(folder, name).map_err(FolderError::read(&path))?)
}

/// Whether a file is an input of a project.
fn is_given(of: &ProjectKind, name: &str) -> bool {
    name == of.file || name.starts_with("inputs/") || meaning_among(of.given, name).is_some()
}

/// Content of a file of a project.
fn meaning(of: &ProjectKind, name: &str) -> String {
    if name == of.file {
        return format!("The {} file, with its base case in it", of.name);
    }
    let known = meaning_among(of.given, name).or_else(|| meaning_among(of.found, name));
    let meaning = match known {
        Some(meaning) => meaning,
        None if name == of.journal => "A line for every run that has ended",
        None if name == CHECKSUMS => {
            "Length and BLAKE3 checksum of every other file, and the program that wrote them"
        }
        None if name.starts_with("inputs/") => "A file that the cases read",
        None => "A file of the results",
    };
    meaning.to_owned()
}

/// Meaning of a file, found by the beginning of its name.
fn meaning_among(known: &[(&str, &'static str)], name: &str) -> Option<&'static str> {
    let found = known.iter().find(|(begin, _)| name.starts_with(begin));
    found.map(|(_, meaning)| *meaning)
}

/// Adds the runs in the table of a study: runs with a kept folder together with their files, the others only
/// as rows of the table.
fn add_runs(study: &mut Exported) -> Result<(), ExportFolderError> {
    let path = study.folder.join(TABLES[0]);
    let unreadable = FolderError::read(&path);
    let table = open_regular(&path)
        .map_err(&unreadable)
        .map_err(StudyError::from)?;
    let mut table = csv::Reader::from_reader(table);
    let damaged = |error: csv::Error| StudyError::from(unreadable(error.into()));
    let columns = table.headers().map_err(damaged)?.clone();
    let Some(end) = columns.iter().position(|column| column == AFTER_AXES[0]) else {
        return Ok(());
    };
    let mut known = HashSet::new();
    for row in table.into_records() {
        let row = TableRow {
            columns: &columns,
            axes: BEFORE_AXES.len()..end,
            cells: row.map_err(damaged)?,
        };
        // Points may share a run.
        if known.insert(row.run().to_owned()) {
            add_run(study, &row)?;
        }
    }
    Ok(())
}

/// A row of the table of runs.
struct TableRow<'a> {
    columns: &'a StringRecord,
    /// Positions of the columns of the axes.
    axes: Range<usize>,
    cells: StringRecord,
}

impl TableRow<'_> {
    /// The cell of column number `after`, counted from 0, behind those of the axes.
    fn after_axes(&self, after: usize) -> &str {
        self.cells.get(self.axes.end + after).unwrap_or_default()
    }

    fn run(&self) -> &str {
        self.after_axes(1)
    }

    /// The reason why the run failed, if it did.
    fn failure(&self) -> Option<&str> {
        (self.after_axes(2) == "failed").then(|| self.after_axes(3))
    }

    /// Levels of the axes, and the seed.
    fn keys(&self) -> Vec<(&str, &str)> {
        let columns = self.columns.iter().zip(&self.cells);
        let levels = columns.skip(self.axes.start).take(self.axes.len());
        levels.chain([("friction.seed", self.after_axes(0))]).collect()
    }

    /// Name of the run in a study.
    fn name(&self, study: &Exported) -> String {
        let keys = self
            .keys()
            .into_iter()
            .map(|(key, level)| format!("{key} = {level}"));
        let role = self.cells.get(2).unwrap_or_default();
        format!(
            "Run {} of the {} {}: {role} at {}",
            self.run(),
            study.kind,
            study.name,
            keys.collect::<Vec<_>>().join(", ")
        )
    }
}

/// Adds a run of a study.
fn add_run(study: &mut Exported, row: &TableRow) -> Result<(), ExportFolderError> {
    let name = row.name(study);
    let at = format!("{RUNS}/{}", row.run());
    let kept = study.folder.join(&at);
    // The names of kept folders are hashes; another name could lead out of the folder.
    let is_hash = !row.run().is_empty() && row.run().bytes().all(|byte| byte.is_ascii_hexdigit());
    let is_kept = is_hash && kept.is_dir();
    if is_kept && row.failure().is_none() {
        let mut run = Exported::run(&kept)?;
        for action in &mut run.actions {
            action.name.clone_from(&name);
        }
        study.take(&at, run);
        return Ok(());
    }
    let [whole, ..] = &study.actions[..] else {
        return Ok(());
    };
    let mut objects = whole.objects.clone();
    if is_kept {
        let kept_files = files_of_failed(&study.folder, &at)?;
        objects.extend(kept_files.iter().map(|of| of.file.name.clone()));
        study.files.extend(kept_files);
    }
    let keys = row.keys().into_iter();
    let action = Action {
        id: format!("run-{}-of-{}", row.run(), study.seal),
        name,
        command: None,
        description: format!(
            "Its row in {} and its line in {} have its numbers",
            TABLES[0], STUDIES.journal
        ),
        failure: row.failure().map(str::to_owned),
        seal: None,
        program: whole.program.clone(),
        times: Default::default(),
        objects,
        parameters: keys.map(|(key, level)| Parameter::of(key, level)).collect(),
        results: vec![TABLES[0].to_owned(), STUDIES.journal.to_owned()],
    };
    study.actions.push(action);
    Ok(())
}

/// The case that is kept of a failed run, and the files that it reads.
fn files_of_failed(folder: &Path, at: &str) -> Result<Vec<ExportedFile>, StudyError> {
    let path = folder.join(at);
    let names = file_names(&path).map_err(FolderError::read(&path))?;
    let of_case = names
        .iter()
        .filter(|name| *name == CASE || name.starts_with("inputs/"));
    let file = |name: &String| {
        let meaning = "The case of a run that failed, or a file that it reads".to_owned();
        let file = file_of(folder, &format!("{at}/{name}"))?;
        Ok(ExportedFile { file, meaning })
    };
    of_case.map(file).collect()
}
