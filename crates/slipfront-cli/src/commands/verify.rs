//! `slipfront verify`: compares the files of results folders with their records.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use serde_json::{Value, json};
use slipfront_base::number_format::count;
use slipfront_base::text::truncated;
use slipfront_calibrate::CALIBRATIONS;
use slipfront_case::case::{Case, Ranks};
use slipfront_design::DESIGNS;
use slipfront_paper::verify as verify_paper;
use slipfront_run::clock;
use slipfront_run::manifest::{Manifest, Processors};
use slipfront_run::pictures;
use slipfront_run::pictures::error::RunPictureError;
use slipfront_run::program;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::run_folder::inspection::{CaseDefect, Inspection};
use slipfront_run::verify::{FolderCheck, differences, inspect, verify_run};
use slipfront_study::is_of_figures;
use slipfront_study::project_folder::Extent;
use slipfront_study::verify::{has_records, verify};

use crate::failure::Failure;
use crate::print::{print, print_json};
use crate::print_stderr::print_stderr;
use crate::run_again::{RunAgain, case_to_run, of_file};
use crate::signals::Signals;
use crate::threads::{count_from_one, set_threads};
use crate::wrap;

/// Check that results are complete and unchanged
///
/// Compares every file with its checksum, and results of several runs with the recorded runs
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront verify results/baseline
  slipfront verify results/*
  slipfront verify --checksums results/design   only compares files with their checksums
  slipfront verify --rerun results/baseline     also runs the case again and compares every file
  slipfront verify --json results/* | jq '.folders[] | select(.status != \"unchanged\").folder'

Tables, pictures and masks of studies, convergences, designs, calibrations and the paper are computed again from the runs recorded in their folders. A file that cannot be computed again is a failure, unless --checksums is given. Folders that contain only pictures of `slipfront plot`, and pages of `--docs`, are not verified.")]
pub(crate) struct VerifyCommand {
    /// Folders of results
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// Run the case of each run folder again, in the folder for temporary files (TMPDIR), and compare every
    /// file except the manifest
    #[arg(long, conflicts_with = "checksums")]
    rerun: bool,
    /// Only compare files with their checksums
    #[arg(long)]
    checksums: bool,
    /// Maximum number of threads [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
    /// Print only errors
    #[arg(short, long)]
    quiet: bool,
    /// Print only the result for each folder to stdout, as JSON
    #[arg(long)]
    json: bool,
}

impl VerifyCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(self.threads)?;
        // A signal ends the work, not the process, so no file is left in the folder for temporary files.
        let signals = Signals::catch().map_err(Failure::running)?;
        let mut found = Vec::new();
        for folder in &self.folders {
            let looked_at = self.look_at(folder, &signals)?;
            Failure::if_stopped(&signals)?;
            if !self.json {
                print(&self.report(folder, &looked_at))?;
            }
            if let Some(error) = &looked_at.error {
                print_stderr(&format!("error: {error}"));
            }
            found.push(looked_at);
        }
        if self.json {
            let folders = self.folders.iter().zip(&found);
            let folders: Vec<_> = folders.map(|(folder, found)| found.to_json(folder)).collect();
            print_json(&json!({ "folders": folders }))?;
        }
        outcome(&found)
    }

    /// Verifies a folder. A folder that cannot be verified is a finding, not a failure, so the other folders
    /// are still verified.
    fn look_at(&self, folder: &Path, signals: &Signals) -> Result<Finding, Failure> {
        if holds_pictures_alone(folder) {
            let check = FolderCheck {
                what: "only pictures, without recorded results".to_owned(),
                ..FolderCheck::default()
            };
            return Ok(Finding {
                status: Status::Pictures,
                check,
                error: None,
            });
        }
        let mut check = FolderCheck::default();
        let error = match self.verify(folder, signals, &mut check) {
            Ok(()) => None,
            Err(Failure::Input(error)) => Some(error.to_string()),
            Err(failure) => return Err(failure),
        };
        if self.checksums {
            check.not_derived = None;
        }
        let status = if error.is_some() {
            Status::Unusable
        } else if !check.differences.is_empty() {
            Status::Different
        } else if check.not_derived.is_some() {
            Status::NotDerived
        } else {
            Status::Unchanged
        };
        Ok(Finding { status, check, error })
    }

    fn verify(&self, folder: &Path, signals: &Signals, check: &mut FolderCheck) -> Result<(), Failure> {
        if self.rerun {
            if has_records(folder) {
                return Err(Failure::input(format!(
                    "{} is the folder of a study: --rerun repeats only single runs, such as those in its folder runs/",
                    folder.display()
                )));
            }
            let run = inspect(folder).map_err(Failure::input)?;
            *check = verify_run(&run, &signals.stop).map_err(Failure::input)?;
            return self.repeat(&run, signals, check);
        }
        let extent = if self.checksums {
            Extent::Checksums
        } else {
            Extent::Derived
        };
        *check = if is_of_figures(folder) {
            verify_paper(folder, extent, &signals.stop).map_err(Failure::input)?
        } else {
            verify(folder, &[DESIGNS, CALIBRATIONS], extent, &signals.stop).map_err(Failure::input)?
        };
        Ok(())
    }

    /// Runs the case of a folder again in a temporary folder, and adds the differences to the check.
    fn repeat(&self, run: &Inspection, signals: &Signals, check: &mut FolderCheck) -> Result<(), Failure> {
        let (started, folder) = (clock::now(), run.path.as_path());
        let case = case_to_run(folder, signals, self.quiet, |watch| match &run.case {
            Ok(file) => of_file(file.clone(), folder, watch),
            Err(CaseDefect::NotResolved(file)) => of_file(*file.clone(), folder, watch),
            // `load` reports why there is no case.
            Err(CaseDefect::Unreadable(_) | CaseDefect::Invalid(_)) => {
                Case::load(&folder.join("case.toml"), &[], watch, Ranks::ALONE)
            }
        })?;
        let RunAgain {
            case,
            made,
            temporary: _temporary,
        } = RunAgain::run(case, folder, signals, self.quiet)?;
        let before = run.manifest().ok();
        let now = complete_as(before, &case, made, started).map_err(Failure::running)?;
        let found = &mut check.differences;
        found.extend(differences(&now.files, folder, "are written now", &signals.stop));
        if let Some(before) = before {
            found.extend(no_longer_written(before, &now, folder));
            if before.build != program::this_build() {
                let mut programs = (before.program(), program::this_program());
                if programs.0 == programs.1 {
                    programs = (truncated(&before.build), program::this_build().to_owned());
                }
                check.notes.push(format!(
                    "{} was written by {}, and repeated by {}",
                    folder.display(),
                    programs.0,
                    programs.1
                ));
            }
        }
        check.what += "; the same when repeated";
        Ok(())
    }

    fn report(&self, folder: &Path, found: &Finding) -> String {
        let (check, folder) = (&found.check, folder.display());
        let differences = check.differences.iter();
        let text: String = differences.map(|difference| format!("{difference}\n")).collect();
        if self.quiet {
            return text;
        }
        let outcome = match found.status {
            Status::Pictures => wrap::note(&format!("{folder} holds {}", check.what)),
            Status::Unchanged | Status::NotDerived => format!("{folder}: {}\n", check.what),
            Status::Different | Status::Unusable => String::new(),
        };
        text + &outcome + &wrap::notes(check.notes.iter().chain(&check.not_derived))
    }
}

/// Fails unless all folders are unchanged.
fn outcome(found: &[Finding]) -> Result<(), Failure> {
    let n = |status: Status| found.iter().filter(|found| found.status == status).count();
    let of_all = format!("of {}", count(found.len(), "folder"));
    let different = n(Status::Different);
    let differ = if different == 1 { "differs" } else { "differ" };
    match (n(Status::Unusable), different, n(Status::NotDerived)) {
        (0, 0, _) if n(Status::Pictures) == found.len() => Err(Failure::input(
            "there is nothing to verify: give folders of runs or studies",
        )),
        (0, 0, 0) => Ok(()),
        (0, 0, not_derived) => Err(Failure::running(format!(
            "{not_derived} {of_all} {} as written, and could not be computed again: use --checksums to skip this",
            if not_derived == 1 { "is" } else { "are" }
        ))),
        (0, _, _) => Err(Failure::running(format!(
            "{different} {of_all} {differ} from what was written"
        ))),
        (unusable, _, _) => Err(Failure::input(format!(
            "{unusable} {of_all} cannot be verified, {different} {differ}"
        ))),
    }
}

/// The result of verifying a folder.
struct Finding {
    status: Status,
    check: FolderCheck,
    /// Reason why the folder cannot be verified.
    error: Option<String>,
}

impl Finding {
    fn to_json(&self, folder: &Path) -> Value {
        json!({
            "folder": folder.display().to_string(),
            "status": self.status,
            "what": self.check.what,
            "differences": self.check.differences,
            "notes": self.check.notes,
            "not_derived": self.check.not_derived,
            "error": self.error,
        })
    }
}

/// Outcome for a folder, by its name in JSON.
#[derive(Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Status {
    /// All files are as they were written.
    Unchanged,
    /// All files are as they were written, but could not be derived again from the recorded runs.
    NotDerived,
    /// Some file is not as it was written.
    Different,
    /// The folder holds only pictures, without recorded results.
    Pictures,
    /// The folder cannot be verified.
    Unusable,
}

/// Whether a folder contains only pictures or movies, as `slipfront plot` writes it.
fn holds_pictures_alone(folder: &Path) -> bool {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return false;
    };
    let endings: Vec<_> = entries
        .map(|entry| entry.ok()?.path().extension()?.to_str().map(str::to_owned))
        .collect();
    let is_picture = |ending: &str| ["svg", "png", "pdf", "eps", "gif", "mp4"].contains(&ending);
    !endings.is_empty()
        && endings
            .iter()
            .all(|ending| ending.as_deref().is_some_and(is_picture))
}

/// Completes the folder of a repeated run, with pictures unless the first run was without them.
fn complete_as(
    before: Option<&Manifest>,
    case: &Case,
    folder: RunFolder,
    started: jiff::Timestamp,
) -> Result<Manifest, RunPictureError> {
    let processors = Processors::threads(1);
    if before.is_none_or(Manifest::has_pictures) {
        pictures::complete(case, folder, started, processors)
    } else {
        Ok(folder.complete(case, started, processors)?)
    }
}

/// Files of a run that its repetition does not write.
fn no_longer_written(before: &Manifest, now: &Manifest, folder: &Path) -> Vec<String> {
    let gone = before
        .files
        .iter()
        .filter(|file| now.files.iter().all(|other| other.name != file.name));
    gone.map(|file| format!("{} is not written now", folder.join(&file.name).display()))
        .collect()
}
