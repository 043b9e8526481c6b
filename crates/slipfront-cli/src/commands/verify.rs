//! Command `slipfront verify`: the files of results folders, compared with what was written there.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use slipfront::Execution;
use slipfront_base::number_format::count;
use slipfront_base::text::truncated;
use slipfront_base::unfinished::TemporaryFolder;
use slipfront_calibrate::CALIBRATIONS;
use slipfront_case::case::{Case, Ranks};
use slipfront_design::DESIGNS;
use slipfront_paper::verify as verify_paper;
use slipfront_run::clock;
use slipfront_run::manifest::Manifest;
use slipfront_run::pictures;
use slipfront_run::pictures::error::RunPictureError;
use slipfront_run::program;
use slipfront_run::results;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::run_folder::inspection::{CaseDefect, Inspection};
use slipfront_run::running::Running;
use slipfront_run::verify::{Verdict, VerifyError, differences, inspect, verify_run};
use slipfront_study::is_of_figures;
use slipfront_study::project_folder::Extent;
use slipfront_study::verify::{has_records, verify};

use crate::failure::Failure;
use crate::make_case::make_case;
use crate::print::print;
use crate::print_stderr::print_stderr;
use crate::progress::run::RunProgress;
use crate::ranks::CommandRanks;
use crate::signals::Signals;
use crate::threads::{count_from_one, set_threads};
use crate::wrap;

/// Check that results are complete and unchanged
///
/// Every file is compared with its checksum, and results of many runs with the recorded runs
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront verify results/baseline
  slipfront verify results/*
  slipfront verify --checksums results/design   compares files with their checksums alone
  slipfront verify --rerun results/baseline     runs its case again and compares every file

Tables, pictures and masks of studies, convergences, designs, calibrations and of the paper are derived again from the runs that their
folders record. What cannot be derived again is no success, unless --checksums asks for no more. Folders that hold pictures alone, as
`slipfront plot` writes them, are passed over. Pages that `--docs` writes are documents, and are not verified here.")]
pub(crate) struct VerifyCommand {
    /// Folders of results
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// Run the case of each run folder again, in the folder for temporary files (TMPDIR), and compare every
    /// file but the manifest
    #[arg(long, conflicts_with = "checksums")]
    rerun: bool,
    /// Compare files with their checksums, and derive nothing again
    #[arg(long)]
    checksums: bool,
    /// Most threads to use [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
    /// Say only what is wrong
    #[arg(short, long)]
    quiet: bool,
}

impl VerifyCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(self.threads)?;
        // A signal ends the work and not the process, so that nothing of it is left in the folder for
        // temporary files.
        let signals = Signals::catch().map_err(Failure::running)?;
        let (mut different, mut unusable, mut pictures, mut not_derived) = (0, 0, 0, 0);
        for folder in &self.folders {
            if holds_pictures_alone(folder) {
                pictures += 1;
                if !self.quiet {
                    let sentence = format!(
                        "{} holds pictures alone, of which nothing is recorded",
                        folder.display()
                    );
                    print(&wrap::note(&sentence))?;
                }
                continue;
            }
            let mut verdict = Verdict::default();
            let looked_at = self.look_at(folder, &signals, &mut verdict);
            Failure::if_stopped(&signals)?;
            different += usize::from(!verdict.differences.is_empty());
            not_derived += usize::from(verdict.not_derived.is_some() && !self.checksums);
            print(&self.report(folder, &verdict, looked_at.is_ok()))?;
            match looked_at {
                Ok(()) => {}
                // The others are looked at all the same.
                Err(Failure::Input(error)) => {
                    unusable += 1;
                    print_stderr(&format!("error: {error}"));
                }
                Err(failure) => return Err(failure),
            }
        }
        let of_all = format!("of {}", count(self.folders.len(), "folder"));
        let differ = if different == 1 { "differs" } else { "differ" };
        match (unusable, different) {
            (0, 0) if pictures == self.folders.len() => Err(Failure::input(anyhow::anyhow!(
                "there is nothing to verify: name folders of runs or studies"
            ))),
            (0, 0) if not_derived > 0 => Err(Failure::running(anyhow::anyhow!(
                "{not_derived} {of_all} {} as written, and could not be derived again: --checksums asks for no more",
                if not_derived == 1 { "is" } else { "are" }
            ))),
            (0, 0) => Ok(()),
            (0, _) => Err(Failure::running(anyhow::anyhow!(
                "{different} {of_all} {differ} from what was written"
            ))),
            (_, _) => Err(Failure::input(anyhow::anyhow!(
                "{unusable} {of_all} cannot be verified, {different} {differ}"
            ))),
        }
    }

    fn look_at(&self, folder: &Path, signals: &Signals, verdict: &mut Verdict) -> Result<(), Failure> {
        if self.rerun && has_records(folder) {
            return Err(Failure::input(anyhow::anyhow!(
                "{} is the folder of a study: --rerun repeats single runs, such as those in its folder runs/",
                folder.display()
            )));
        }
        if !self.rerun {
            let extent = if self.checksums {
                Extent::Checksums
            } else {
                Extent::Derived
            };
            *verdict = if is_of_figures(folder) {
                verify_paper(folder, extent, &signals.stop).map_err(Failure::input)?
            } else {
                verify(folder, &[DESIGNS, CALIBRATIONS], extent, &signals.stop).map_err(Failure::input)?
            };
            return Ok(());
        }
        let run = inspect(folder).map_err(Failure::input)?;
        *verdict = verify_run(&run, &signals.stop).map_err(Failure::input)?;
        self.repeat(&run, signals, verdict)
    }

    /// Runs the case of a folder again beside it, and adds the differences.
    fn repeat(&self, run: &Inspection, signals: &Signals, verdict: &mut Verdict) -> Result<(), Failure> {
        let (started, folder) = (clock::now(), run.path.as_path());
        let case = folder.join("case.toml");
        // A user may hand over a case through a pipe; in a folder of results it would be waited for.
        if !case.is_file() {
            let sentence = format!(
                "{} is not a regular file: there is nothing to repeat",
                case.display()
            );
            return Err(Failure::input(anyhow::anyhow!(sentence)));
        }
        let case = make_case(
            &CommandRanks::alone(),
            signals,
            self.quiet,
            |watch, _| match &run.case {
                Ok(file) => Case::to_run(file.clone(), "case", folder, watch, Ranks::ALONE),
                Err(CaseDefect::NotResolved(file)) => {
                    Case::to_run(*file.clone(), "case", folder, watch, Ranks::ALONE)
                }
                // It says why there is none.
                Err(CaseDefect::Unreadable(_) | CaseDefect::Invalid(_)) => {
                    Case::load(&case, &[], watch, Ranks::ALONE)
                }
            },
        );
        let case = Arc::new(case?);
        let again =
            TemporaryFolder::new(folder).map_err(|error| Failure::input(VerifyError::Temporary(error)))?;
        case.budget
            .check_disk(&case.file, again.path(), 0, false)
            .map_err(Failure::input)?;
        let mut running = Running::start(&case, None, Execution::on_threads(rayon::current_num_threads()));
        let mut progress = RunProgress::new(&running, self.quiet);
        let reason = loop {
            if let Some(reason) = running.advance(case.steps_per_poll()).map_err(Failure::running)? {
                break reason;
            }
            progress.show(&running.snapshot());
            Failure::if_stopped(signals)?;
        };
        progress.finish();
        let mut record = running.record(reason);
        let made = again.path().join("run");
        let mut made = RunFolder::prepare(&made, false, &case.inputs).map_err(Failure::running)?;
        results::write_case(&case, &mut made).map_err(Failure::running)?;
        results::write(&case, &mut record, &mut made).map_err(Failure::running)?;
        let before = run.manifest().ok();
        let now = complete_as(before, &case, made, started).map_err(Failure::running)?;
        verdict
            .differences
            .extend(differences(&now.files, folder, "are written now", &signals.stop));
        if let Some(before) = before {
            verdict
                .differences
                .extend(no_longer_written(before, &now, folder));
            if before.build != program::this_build() {
                let mut programs = (before.program(), program::this_program());
                if programs.0 == programs.1 {
                    programs = (truncated(&before.build), program::this_build().to_owned());
                }
                verdict.notes.push(format!(
                    "{} was written by {}, and repeated by {}",
                    folder.display(),
                    programs.0,
                    programs.1
                ));
            }
        }
        verdict.what += "; the same when repeated";
        Ok(())
    }

    fn report(&self, folder: &Path, verdict: &Verdict, complete: bool) -> String {
        let mut text = String::new();
        for difference in &verdict.differences {
            text += &format!("{difference}\n");
        }
        if self.quiet {
            return text;
        }
        if complete && verdict.differences.is_empty() {
            text += &format!("{}: {}\n", folder.display(), verdict.what);
        }
        let not_derived = verdict.not_derived.iter().filter(|_| !self.checksums);
        for note in verdict.notes.iter().chain(not_derived) {
            text += &wrap::note(note);
        }
        text
    }
}

/// Whether a folder holds pictures or movies and nothing else, as `slipfront plot` writes it.
fn holds_pictures_alone(folder: &Path) -> bool {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return false;
    };
    let mut names = entries
        .map(|entry| entry.map_or_else(|_| PathBuf::new(), |entry| PathBuf::from(entry.file_name())))
        .peekable();
    let is_picture = |name: &PathBuf| {
        let ending = name.extension().and_then(|ending| ending.to_str());
        ending.is_some_and(|ending| ["svg", "png", "gif", "mp4"].contains(&ending))
    };
    names.peek().is_some() && names.all(|name| is_picture(&name))
}

/// Completes the folder of a repeated run, with pictures unless the first run has drawn none.
fn complete_as(
    before: Option<&Manifest>,
    case: &Case,
    folder: RunFolder,
    started: jiff::Timestamp,
) -> Result<Manifest, RunPictureError> {
    if before.is_none_or(Manifest::has_pictures) {
        pictures::complete(case, folder, started, 1)
    } else {
        Ok(folder.complete(case, started, 1)?)
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
