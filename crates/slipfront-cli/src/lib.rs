//! The command `slipfront` as a library, for its program and for other packages that contain the command.
//! Each subcommand has a thin file under `commands/`. `run` is the same code for one process and for the
//! ranks of `slipfront-mpi`.
//!
//! Errors go to stderr as sentences, results to stdout. `failure.rs` defines the exit statuses.

// These lints forbid the print macros, which panic if they cannot print.
#![deny(clippy::print_stderr, clippy::print_stdout)]

mod bounds;
mod browser;
mod case_args;
mod commands;
mod device;
mod divided_override;
mod failure;
mod help;
mod make_case;
mod print;
mod print_stderr;
mod progress;
mod ranks;
mod report;
mod run_again;
mod runs_args;
mod signals;
mod table_args;
mod threads;
mod wrap;

use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use slipfront::Communicator;
use slipfront_base::text::shell_path;
use slipfront_case::nearest::nearest;
use slipfront_run::agree::RankFailure;
use slipfront_run::program::{this_build, version_lines};
use slipfront_study::StudyFile;

use crate::commands::run::{CHECKPOINTS_HELP, RunCommand};
pub use crate::device::open_gpu;
use crate::divided_override::divided_override;
use crate::failure::{Failure, STATUSES, report};
use crate::print::{expect_printed, print};
use crate::print_stderr::silence;
use crate::ranks::CommandRanks;
pub use crate::report::physics::physics;

/// Friction of micro-textured surfaces: the lattice spring-block model of the transition from static to
/// kinetic friction.
#[derive(Parser)]
#[command(name = "slipfront", version, long_version = version_lines(), max_term_width = 100)]
#[command(help_template = help::template(&Command::augment_subcommands(clap::Command::new("slipfront"))))]
#[command(after_help = "Examples:
  slipfront run                                   the embedded baseline (Fig. 3 of the paper)
  slipfront run cases/circle.toml -o results/a    a case file, with results in this folder
  slipfront run --set drive.v_star=0.05 --seed 7  any key of the case file, from the command line
  slipfront plot results/a results/b -o both      friction curves of two runs in one picture")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[command(
        override_usage = "slipfront run [OPTIONS] [CASE.toml]\n       slipfront run [OPTIONS] --resume <DIR>",
        after_help = format!(
            "Examples:
  slipfront run
  slipfront run cases/groove_across.toml --set texture.0.coverage=5 -o results/groove-5
  slipfront run results/baseline/case.toml -o results/again    repeats a run bit for bit
  slipfront run --resume results/baseline                      resumes a run that was stopped
  slipfront run --no-pictures --json | jq .static_friction_star

{CHECKPOINTS_HELP}"
        )
    )]
    Run(RunCommand),
    Check(commands::check::CheckCommand),
    Study(commands::study::StudyCommand),
    Converge(commands::converge::ConvergeCommand),
    Design(commands::design::DesignCommand),
    Calibrate(commands::calibrate::CalibrateCommand),
    Family(commands::family::FamilyCommand),
    Paper(commands::paper::PaperCommand),
    Texture(commands::texture::TextureCommand),
    Plot(Box<commands::plot::PlotCommand>),
    Movie(commands::movie::MovieCommand),
    Lab(commands::lab::LabCommand),
    Verify(commands::verify::VerifyCommand),
    Export(commands::export::ExportCommand),
    Completions(commands::completions::CompletionsCommand),
    Man(commands::man::ManCommand),
    Licences(commands::licences::LicencesCommand),
}

/// Friction of micro-textured surfaces, with one lattice divided over several processes on one or more
/// machines; results are bit-identical to those of `slipfront run`.
#[derive(Parser)]
#[command(name = "slipfront-mpi", version, long_version = version_lines(), max_term_width = 100)]
struct RanksCli {
    #[command(subcommand)]
    command: RanksCommand,
}

#[derive(Subcommand)]
enum RanksCommand {
    #[command(
        override_usage = "mpirun -n <RANKS> slipfront-mpi run [OPTIONS] [CASE.toml]
       mpirun -n <RANKS> slipfront-mpi run [OPTIONS] --resume <DIR>",
        after_help = format!(
            "Each rank computes some rows of the lattice, on one thread unless --threads is given. There are at most as many ranks as rows. \
A run can be resumed with any number of ranks, or with `slipfront run --resume`.

Examples:
  mpirun -n 8 slipfront-mpi run cases/circle.toml -o results/circle
  mpirun -n 4 slipfront-mpi run --resume results/circle
  srun --mpi=pmix slipfront-mpi run cases/circle.toml -o results/circle

{CHECKPOINTS_HELP}"
        )
    )]
    Run(RunCommand),
    Licences(commands::licences::LicencesCommand),
}

/// Runs the command with these arguments, of which the first is the name of the program; returns its exit
/// status. The session of the laboratory as WebAssembly is searched for in `module_folder`, or next to the
/// program if that is none.
///
/// The command needs its own process: it catches signals and sets the number of threads for the whole
/// process, once.
pub fn main(args: impl IntoIterator<Item = OsString>, module_folder: Option<&Path>) -> u8 {
    let command = match parse::<Cli>(args) {
        Ok(Ok(cli)) => cli.command,
        Ok(Err(error)) => {
            return match forgotten_subcommand(&error) {
                Some(sentence) => Failure::input(sentence).report(),
                None => print_usage(&error),
            };
        }
        Err(failure) => return failure.report(),
    };
    execute(|| {
        let done = match command {
            Command::Run(run) => return run.execute(&CommandRanks::alone()),
            Command::Check(check) => check.execute(),
            Command::Study(study) => study.execute(),
            Command::Converge(converge) => converge.execute(),
            Command::Design(design) => design.execute(),
            Command::Calibrate(calibrate) => calibrate.execute(),
            Command::Family(family) => family.execute(),
            Command::Paper(paper) => paper.execute(),
            Command::Texture(texture) => texture.execute(),
            Command::Plot(plot) => plot.execute(),
            Command::Movie(movie) => movie.execute(),
            Command::Lab(lab) => lab.execute(module_folder),
            Command::Verify(verify) => verify.execute(),
            Command::Export(export) => export.execute(),
            Command::Completions(completions) => completions.execute(Cli::command()),
            Command::Man(man) => man.execute(command_line()),
            Command::Licences(licences) => licences.execute(),
        };
        done.map_err(RankFailure::from)
    })
}

/// Parses arguments, and applies the settings of the environment. Help and version are errors of clap; the
/// help of the program ends with the table of exit statuses.
fn parse<T: CommandFactory + FromArgMatches>(
    args: impl IntoIterator<Item = OsString>,
) -> Result<Result<T, clap::Error>, Failure> {
    let args: Vec<OsString> = args.into_iter().collect();
    if let Some(sentence) = divided_override(&args) {
        return Err(Failure::input(sentence));
    }
    limit_vectors()?;
    let mut command = with_statuses(T::command());
    let matches = command.try_get_matches_from_mut(args);
    Ok(matches.and_then(|matches| T::from_arg_matches(&matches).map_err(|error| error.format(&mut command))))
}

/// The subcommands and options of `slipfront`, from which help, manual pages and the page of the book are
/// generated.
pub fn command_line() -> clap::Command {
    with_statuses(Cli::command())
}

fn with_statuses(command: clap::Command) -> clap::Command {
    let help = match command.get_after_help() {
        Some(help) => format!("{help}\n\n{STATUSES}"),
        None => STATUSES.to_owned(),
    };
    command.after_help(help)
}

/// Runs the command `slipfront-mpi`, with one process for every rank of the communicator; arguments and exit
/// status are those of [`main`].
pub fn main_on_ranks(args: impl IntoIterator<Item = OsString>, communicator: Arc<dyn Communicator>) -> u8 {
    let ranks = CommandRanks::new("slipfront-mpi", communicator);
    if !ranks.is_first() {
        silence();
    }
    execute(|| {
        // This comes first, because ranks of other builds may differ in the messages that they exchange.
        ranks.expect_same(|| vec![("the build".to_owned(), this_build().to_owned())])?;
        let request = ranks.agree(parse_on_rank(args))?;
        let name = match &request {
            Ok(RanksCommand::Run(_)) => "a run",
            Ok(RanksCommand::Licences(_)) => "licences",
            Err(text) if text.kind() == ErrorKind::DisplayVersion => "the version",
            Err(_) => "help",
        };
        ranks.expect_same(|| vec![("what is asked for".to_owned(), name.to_owned())])?;
        match request {
            Ok(RanksCommand::Run(run)) => run.execute(&ranks),
            Ok(RanksCommand::Licences(licences)) => ranks.first(|| licences.execute()).map(|_| ()),
            Err(text) => ranks.first(|| print(&text.to_string())).map(|_| ()),
        }
    })
}

/// The request in the arguments of a rank, or help and version, which are errors of clap. Wrong arguments of
/// one rank are a failure of all ranks.
fn parse_on_rank(
    args: impl IntoIterator<Item = OsString>,
) -> Result<Result<RanksCommand, clap::Error>, Failure> {
    match parse::<RanksCli>(args)? {
        Err(error) if error.use_stderr() => {
            let text = error.to_string();
            // Without any arguments, clap returns the help.
            let missing = || format!("a subcommand is missing\n\n{}", text.trim_end());
            let sentence = text.trim_end().strip_prefix("error: ");
            Err(Failure::Input(sentence.map_or_else(missing, str::to_owned)))
        }
        parsed => Ok(parsed.map(|cli| cli.command)),
    }
}

/// Limits the vector instructions to those that the environment names, as on a processor without wider ones.
fn limit_vectors() -> Result<(), Failure> {
    const NAME: &str = "SLIPFRONT_SIMD";
    let Some(widest) = std::env::var_os(NAME) else {
        return Ok(());
    };
    slipfront::limit_simd_width(&widest.to_string_lossy())
        .map_err(|error| Failure::input(format!("{NAME} in the environment: {error}")))
}

fn execute(work: impl FnOnce() -> Result<(), RankFailure>) -> u8 {
    // If the signal cannot be caught, only the error message for a file above the size limit is lost.
    let _ = signals::ignore_sigxfsz();
    match work() {
        Ok(()) => 0,
        Err(failure) => report(&failure),
    }
}

/// Prints the requested help, or the error of the arguments.
fn print_usage(error: &clap::Error) -> u8 {
    let printed = error.print();
    // For wrong arguments only the status matters. Help and version were requested, so a failure to print
    // them is reported.
    match expect_printed(printed) {
        Err(failure) if !error.use_stderr() => failure.report(),
        _ => error.exit_code() as u8,
    }
}

/// The command that was probably meant by a word, a file or a folder in place of the subcommand.
fn forgotten_subcommand(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidSubcommand) else {
        return None;
    };
    let path = std::path::Path::new(word);
    let is_toml = path.extension().is_some_and(|ending| ending == "toml");
    if error.kind() != ErrorKind::InvalidSubcommand {
        return None;
    }
    if !(is_toml || path.is_dir()) {
        let command = Cli::command();
        let names: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
        return nearest(word, &names).map(|name| {
            format!(
                "{word:?} is not a subcommand: did you mean `slipfront {name}`? `slipfront --help` lists all"
            )
        });
    }
    let quoted = shell_path(path);
    let meant = if path.is_dir() {
        format!("`slipfront plot {quoted}` or `slipfront verify {quoted}`")
    } else if StudyFile::load(path).is_ok_and(|study| study.is_study()) {
        format!("`slipfront study {quoted}`")
    } else {
        format!("`slipfront run {quoted}` or `slipfront check {quoted}`")
    };
    Some(format!("{word} is not a subcommand: did you mean {meant}?"))
}
