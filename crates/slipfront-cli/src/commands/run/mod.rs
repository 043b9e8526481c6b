//! `slipfront run`: one case, from the case file to the pictures.

mod checkpoint_timer;
mod complete;
mod execution;
mod resume;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use slipfront_base::text::{display_path, shell_path};
use slipfront_case::case::Case;
use slipfront_case::same_on_ranks::NamedInputs;
use slipfront_run::agree::RankFailure;
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::clock;
use slipfront_run::folder_error::FolderError;
use slipfront_run::results;
use slipfront_run::run_folder::{ClaimedFolder, OpenedFolder, RunFolder, expect_shared};
use slipfront_run::running::Running;

use self::checkpoint_timer::Interval;
use self::complete::complete;
use self::execution::RunOptions;
use crate::case_args::CaseArgs;
use crate::device::DeviceArgs;
use crate::failure::Failure;
use crate::print::print_message;
use crate::print_stderr::print_notes;
use crate::ranks::CommandRanks;
use crate::report::physics::physics;
use crate::runs_args::ForceArg;
use crate::signals::Signals;
use crate::threads::{count_from_one, set_threads};

/// Help on checkpoints.
pub(crate) const CHECKPOINTS_HELP: &str = "A checkpoint of the complete state is saved in the folder of the run at every \
--checkpoint interval and on SIGUSR1. Ctrl-C, SIGTERM and SIGHUP also save a checkpoint, and stop the run with status 130, 143 \
and 129. A run that was stopped and resumed, however often, writes bit-identical files.";

/// Run a case and write its results and pictures
///
/// Prints the physics of the case, the progress and a summary
#[derive(Args)]
pub(crate) struct RunCommand {
    #[command(flatten)]
    case: CaseArgs,
    /// Folder for the results [default: results/NAME with the name of the case, or of the folder that
    /// contains case.toml; the next free number is appended if it exists]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    force: ForceArg,
    /// Wall time between checkpoints, such as 30s or 1h, or off; at least 99 times the time to save one
    #[arg(long, value_name = "TIME", default_value = "5min")]
    checkpoint: Interval,
    /// Resume the run in this folder from its latest checkpoint; a complete run is not changed
    #[arg(long, value_name = "DIR", conflicts_with_all = ["case", "overrides", "seed", "out", "force"])]
    resume: Option<PathBuf>,
    /// Resume from the checkpoint before the latest one
    #[arg(long, requires = "resume")]
    previous: bool,
    /// Draw no pictures and no movie; `slipfront plot` and `slipfront movie` can make them later from the
    /// files of the run
    #[arg(long)]
    no_pictures: bool,
    /// Maximum number of threads [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
    #[command(flatten)]
    device: DeviceArgs,
    /// Do not print physics, progress and summary
    #[arg(short, long)]
    quiet: bool,
    /// Print only the summary to stdout, as JSON
    #[arg(long)]
    json: bool,
}

impl RunCommand {
    /// Runs the command on all ranks.
    pub(crate) fn execute(self, ranks: &CommandRanks) -> Result<(), RankFailure> {
        let started = clock::now();
        ranks.expect_same(|| self.shared_options())?;
        let options = ranks.agree(self.options(ranks))?;
        if let Some(folder) = &self.resume {
            return resume::resume(folder, self.previous, &options);
        }
        let case_path = self.case.path().map(Path::to_owned);
        let case = Arc::new(ranks.agree(self.case.load(ranks, &options.signals, options.quiet))?);
        let execution = options.execution(&case)?;
        let (force, saves) = (self.force.given, options.interval.saves());
        let named = Path::new("results").join(&case.name);
        let (out, takes_next) = self.out.map_or((named, !force), |out| (out, false));
        let claimed = ranks.first(|| {
            let mut number = 1;
            loop {
                let folder = numbered(&out, number);
                match claim_folder(&folder, case_path.as_deref(), &case, force, saves) {
                    Err(refusal) if refusal.may_take_next() && takes_next && number < MOST_FOLDERS => {
                        number += 1;
                    }
                    Err(refusal) => return Err(refusal.failure(&out)),
                    Ok(claimed) => return Ok((claimed, number)),
                }
            }
        })?;
        let (claimed, number) = claimed.unzip();
        let number = ranks.largest_of(number.unwrap_or(0) as f64) as usize;
        let (given, out) = (out.clone(), numbered(&out, number));
        if given != out && !options.quiet && ranks.is_first() {
            print_notes([format!(
                "the folder {} is not empty: results go to {}",
                display_path(&given),
                display_path(&out)
            )]);
        }
        if let Err(failure) = expect_shared(&out, &*ranks.communicator()) {
            if let Some(claimed) = claimed {
                claimed.release();
            }
            return Err(failure);
        }
        let signals = &options.signals;
        let folder = claimed
            .map(|claimed| begin_folder(claimed, &case, signals))
            .transpose();
        let folder = ranks.agree(folder)?;
        if options.is_verbose() {
            print_message(&physics(&case));
        }
        let checkpoints = Checkpoints::new(&out, &case, started);
        let running = Running::start(&case, None, execution);
        complete(running, folder, checkpoints, &options)
    }

    /// The options that all ranks must share. Each rank may have its own number of threads and folder, and
    /// only the first rank's printing options count.
    fn shared_options(&self) -> NamedInputs {
        let flag = |is_given: bool| if is_given { "given" } else { "not given" }.to_owned();
        let options = [
            ("--resume", flag(self.resume.is_some())),
            ("--previous", flag(self.previous)),
            ("--force", flag(self.force.given)),
            ("--checkpoint", self.checkpoint.to_string()),
            ("--no-pictures", flag(self.no_pictures)),
            ("--json", flag(self.json)),
            ("--device", self.device.to_string()),
        ];
        options.map(|(name, value)| (name.to_owned(), value)).into()
    }

    fn options(&self, ranks: &CommandRanks) -> Result<RunOptions, Failure> {
        // Ranks on the same machine share its cores.
        let default = (ranks.size() > 1).then_some(1);
        Ok(RunOptions {
            ranks: ranks.clone(),
            threads: set_threads(self.threads.or(default))?,
            device: self.device,
            interval: self.checkpoint,
            draws: !self.no_pictures,
            signals: Signals::catch().map_err(Failure::running)?,
            quiet: self.quiet,
            json: self.json,
        })
    }
}

/// Prepares the folder of a new run, but does not yet remove the files of an earlier one.
fn claim_folder(
    out: &Path,
    case_path: Option<&Path>,
    case: &Case,
    force: bool,
    saves: bool,
) -> Result<ClaimedFolder, FolderRefusal> {
    refuse_to_replace(case_path, case, out).map_err(FolderRefusal::HoldsInput)?;
    let folder = OpenedFolder::open(out).map_err(FolderRefusal::Folder)?;
    let replaced = if force {
        folder.inspection.managed_bytes().map_err(FolderRefusal::Folder)?
    } else {
        0
    };
    case.budget
        .check_disk(&case.file, out, replaced, saves)
        .map_err(|error| FolderRefusal::Disk(Failure::input(error)))?;
    folder.claim(force, &case.inputs).map_err(FolderRefusal::Folder)
}

/// Writes the case and its inputs to the folder of a new run, in place of an earlier one, so that the run can
/// be resumed if it is stopped. A signal stops the copying and removes the copies.
fn begin_folder(claimed: ClaimedFolder, case: &Case, signals: &Signals) -> Result<RunFolder, Failure> {
    let mut folder = claimed.take().map_err(Failure::input)?;
    folder.stop_on(Arc::clone(&signals.stop));
    match results::write_case(case, &mut folder) {
        Ok(()) => Ok(folder),
        Err(_) if signals.stopped().is_some() => {
            folder.discard();
            let sentence = "stopped while files were copied to the folder; they were removed";
            Err(Failure::stopped(signals, sentence))
        }
        Err(error) => Err(Failure::running(error)),
    }
}

/// Reasons why a folder was not claimed.
enum FolderRefusal {
    /// The folder contains other files, or cannot be used.
    Folder(FolderError),
    /// The folder contains the case to run, or a file that the case reads.
    HoldsInput(Failure),
    /// The disk has too little space.
    Disk(Failure),
}

impl FolderRefusal {
    /// Whether a folder with the next number can be used instead. A run that was stopped is resumed.
    fn may_take_next(&self) -> bool {
        matches!(
            self,
            Self::HoldsInput(_) | Self::Folder(FolderError::NotEmpty { .. })
        )
    }

    /// The error message; if a folder is taken, it names a free one.
    fn failure(self, out: &Path) -> Failure {
        let error = match self {
            Self::HoldsInput(failure) | Self::Disk(failure) => return failure,
            Self::Folder(error @ (FolderError::NotEmpty { .. } | FolderError::Interrupted { .. })) => error,
            Self::Folder(error) => return Failure::input(error),
        };
        let mut others = (2..MOST_FOLDERS).map(|number| numbered(out, number));
        match others.find(|free| free.symlink_metadata().is_err()) {
            Some(free) => {
                let free = shell_path(&free);
                Failure::input(format!("{error}; `--out {free}` is free"))
            }
            None => Failure::input(error),
        }
    }
}

/// Largest number of folder names to try.
const MOST_FOLDERS: usize = 1000;

/// The folder itself for the number 1, and its name with the number for others.
fn numbered(folder: &Path, number: usize) -> PathBuf {
    if number == 1 {
        return folder.to_owned();
    }
    let mut name = folder.as_os_str().to_owned();
    name.push(format!("-{number}"));
    PathBuf::from(name)
}

/// Refuses an output folder that contains the case to run, or a file that the case reads: `--force` would
/// replace this file, and it would be lost if the run fails.
fn refuse_to_replace(path: Option<&Path>, case: &Case, out: &Path) -> Result<(), Failure> {
    let inputs = case.inputs.iter().map(|input| input.original.as_path());
    let replaced = path.into_iter().chain(inputs).find(|path| {
        let [own, copies] = [out.to_owned(), out.join("inputs")].map(|folder| folder.canonicalize().ok());
        let path = path.canonicalize().ok();
        let is_case = path.as_ref().is_some_and(|path| path.ends_with("case.toml"));
        let folder = path.as_deref().and_then(Path::parent).map(Path::to_owned);
        folder.is_some() && ((is_case && folder == own) || folder == copies)
    });
    let Some(path) = replaced else { return Ok(()) };
    let sentence = format!(
        "the results would replace {}, an input of the run: choose another folder with --out",
        path.display()
    );
    Err(Failure::input(sentence))
}
