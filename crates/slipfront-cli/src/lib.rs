//! The command `slipfront` as a library, for its program and for other packages that contain the command: one file per
//! subcommand under `commands/`, each thin.
//!
//! Errors go to stderr as sentences, results to stdout. Exit status: 0 done, 1 a run failed, 2 bad input or
//! usage, 128 + its number stopped by a signal: 129, 130 and 143 by SIGHUP, SIGINT and SIGTERM.

// The macros of these lints panic where they cannot print.
#![deny(clippy::print_stderr, clippy::print_stdout)]

mod case_args;
mod checkpoint_timer;
mod commands;
mod estimate_cost;
mod failure;
mod make_case;
mod print;
mod print_stderr;
mod progress;
mod report;
mod signals;
mod threads;
mod wrap;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser, Subcommand};

use slipfront_case::text::shell_quoted;
use slipfront_run::study::StudyFile;

use crate::failure::Failure;
use crate::print::expect_printed;

/// Friction of micro-textured surfaces: the lattice spring-block model of the transition from static to kinetic
/// friction.
#[derive(Parser)]
#[command(name = "slipfront", version, max_term_width = 100)]
#[command(after_help = "Examples:
  slipfront run                                   the embedded baseline (Fig. 3 of the paper)
  slipfront run cases/circle.toml -o results/a    a case file, results in a folder of your choice
  slipfront run --set drive.v_star=0.05 --seed 7  any key of the case file, from the command line
  slipfront plot results/a results/b -o both      friction curves of two runs over each other")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Run(commands::run::Run),
    Check(commands::check::Check),
    Study(commands::study::Study),
    Paper(commands::paper::Paper),
    Texture(commands::texture::Texture),
    Plot(commands::plot::Plot),
    Verify(commands::verify::Verify),
    Completions(commands::completions::Completions),
}

/// Runs the command with these arguments, the first of which is the name of the program; gives its exit status.
///
/// It belongs to a process of its own: signals are caught and the number of threads is set for the whole process, once.
pub fn main(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    let command = match Cli::try_parse_from(args) {
        Ok(cli) => cli.command,
        // Of a wrong line the status is what matters; help and version are what was asked for.
        Err(error) => {
            if let Some(sentence) = forgotten_subcommand(&error) {
                return Failure::input(anyhow::anyhow!(sentence)).report();
            }
            let status = ExitCode::from(error.exit_code() as u8);
            return match expect_printed(error.print()) {
                Err(failure) if !error.use_stderr() => failure.report(),
                _ => status,
            };
        }
    };
    // If the signal cannot be caught, only the error message for a file that grows too large is lost.
    let _ = signals::ignore_sigxfsz();
    let done = match command {
        Command::Run(run) => run.execute(),
        Command::Check(check) => check.execute(),
        Command::Study(study) => study.execute(),
        Command::Paper(paper) => paper.execute(),
        Command::Texture(texture) => texture.execute(),
        Command::Plot(plot) => plot.execute(),
        Command::Verify(verify) => verify.execute(),
        Command::Completions(completions) => completions.execute(Cli::command()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// What was meant by a file or folder in the place of the subcommand.
fn forgotten_subcommand(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidSubcommand) else {
        return None;
    };
    let path = std::path::Path::new(word);
    let is_toml = path.extension().is_some_and(|ending| ending == "toml");
    if error.kind() != ErrorKind::InvalidSubcommand || !(is_toml || path.is_dir()) {
        return None;
    }
    let quoted = shell_quoted(word);
    let meant = if path.is_dir() {
        format!("`slipfront plot {quoted}` or `slipfront verify {quoted}`")
    } else if StudyFile::load(path).is_ok_and(|study| study.is_study()) {
        format!("`slipfront study {quoted}`")
    } else {
        format!("`slipfront run {quoted}` or `slipfront check {quoted}`")
    };
    Some(format!(
        "{word} stands in the place of a subcommand: did you mean {meant}?"
    ))
}
