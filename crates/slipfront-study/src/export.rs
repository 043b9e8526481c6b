//! Export of the folders of studies and other projects: the files in their lists with their meanings, the
//! project as an action, and each run of a study as a further action.

use std::collections::HashSet;
use std::ops::Range;
use std::path::Path;
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

use crate::error::StudyError;
use crate::project_folder::verify::verify_checksums;
use crate::project_folder::{CHECKSUMS, Checksums, Journal, JournalEntry, Project, ProjectKind};
use crate::study_file::STUDIES;
use crate::summary_values::{AFTER_AXES, BEFORE_AXES};
use crate::verify::project_in;

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
pub fn exported(folder: &Path, others: &[Project]) -> Result<Exported, StudyError> {
    match project_in(folder, others) {
        Some(Project { find_again: None, .. }) => {
            let path = folder.to_owned();
            Err(StudyError::ExportOfFigures { path })
        }
        Some(of) if of.kind.name == STUDIES.name => study(folder, of),
        Some(other) => project(folder, other, other.kind.name),
        None => Ok(Exported::run(folder)?),
    }
}

/// A study with its runs. A study with a comparison of its meshes is a convergence.
fn study(folder: &Path, study_project: &Project) -> Result<Exported, StudyError> {
    let is_over_meshes = folder.join(CONVERGENCE[0]).exists();
    let kind = if is_over_meshes {
        "convergence"
    } else {
        STUDIES.name
    };
    let mut study = project(folder, study_project, kind)?;
    add_runs(&mut study)?;
    Ok(study)
}

/// The folder of a project, as in its list of files. The project is an action of this `kind`: its project
/// file and the given files are the inputs, and all others are the results.
fn project(folder: &Path, project: &Project, kind: &'static str) -> Result<Exported, StudyError> {
    let (never, project_kind) = (AtomicBool::new(false), project.kind);
    let (mut check, is_complete) = verify_checksums(folder, project_kind, project.beside, &never)?;
    project.verify_beside(folder, &mut check, &never)?;
    ExportError::expect_none(check.differences)?;
    if !is_complete {
        let path = folder.to_owned();
        return Err(StudyError::UnfinishedExport { what: kind, path });
    }
    let list = Checksums::read(folder)?.unwrap_or_default();
    let (runs, _) = Journal::read::<RecordedRun>(folder, project_kind.journal)?;
    let runs: HashSet<String> = runs.into_iter().map(|run| run.id).collect();
    let runs = count(runs.len(), "recorded run");
    let mut files = list.files;
    for name in [project_kind.journal, CHECKSUMS] {
        files.push(file_of(folder, name)?);
    }
    let name = folder_name(folder).unwrap_or_default();
    let names = || files.iter().map(|file| file.name.clone());
    let (objects, results) = names().partition(|name| is_given(project_kind, name));
    let of_command =
        names().filter(|name| name == project_kind.file || meaning_among(project_kind.given, name).is_some());
    let program = MadeBy {
        version: list.version,
        revision: list.revision,
        build: list.build,
    };
    let action = Action {
        id: format!("{kind}-{}", list.seal),
        name: format!("The {kind} {name}"),
        command: Some((format!("slipfront {}", project_kind.table), of_command.collect())),
        description: format!("{} has a line for each of {runs}", project_kind.journal),
        failure: None,
        seal: Some(list.seal.clone()),
        program: program.clone(),
        times: Default::default(),
        objects,
        parameters: Vec::new(),
        results,
    };
    let files = files.into_iter().map(|file| ExportedFile {
        meaning: meaning(project_kind, &file.name),
        file,
    });
    Ok(Exported {
        folder: folder.to_owned(),
        name,
        kind,
        what: Some(format!("{kind} from {runs}")),
        program,
        file: project_kind.file,
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
    Ok(ManifestFile::read(folder, name).map_err(FolderError::read(&path))?)
}

/// Whether a file is an input of a project.
fn is_given(kind: &ProjectKind, name: &str) -> bool {
    name == kind.file || name.starts_with("inputs/") || meaning_among(kind.given, name).is_some()
}

/// Content of a file of a project.
fn meaning(kind: &ProjectKind, name: &str) -> String {
    if name == kind.file {
        return format!("The {} file, with its base case in it", kind.name);
    }
    let known = meaning_among(kind.given, name).or_else(|| meaning_among(kind.found, name));
    let meaning = match known {
        Some(meaning) => meaning,
        None if name == kind.journal => "A line for every run that has ended",
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
fn add_runs(study: &mut Exported) -> Result<(), StudyError> {
    let path = study.folder.join(TABLES[0]);
    let unreadable = FolderError::read(&path);
    let table = open_regular(&path).map_err(&unreadable)?;
    let mut table = csv::Reader::from_reader(table);
    let damaged = |error: csv::Error| unreadable(error.into());
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
fn add_run(study: &mut Exported, row: &TableRow) -> Result<(), StudyError> {
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
        parameters: keys
            .map(|(key, level)| Parameter::from_toml(key, level))
            .collect(),
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
