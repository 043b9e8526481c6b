//! The command `slipfront`: one file per subcommand under `commands/`, each thin.
//!
//! Errors go to stderr as sentences, results to stdout. Exit status: 0 done, 1 a run failed, 2 bad input or
//! usage, 128 + its number stopped by a signal: 129, 130 and 143 by SIGHUP, SIGINT and SIGTERM.

// These end the process where they cannot print.
#![deny(clippy::print_stderr, clippy::print_stdout)]

mod commands;
mod failure;
mod probe;
mod progress;
mod report;
mod saving;
mod say;
mod signals;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

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

fn main() -> ExitCode {
    let command = Cli::parse().command;
    // Without it, files are written all the same.
    let _ = signals::let_writes_fail();
    let done = match command {
        Command::Run(run) => run.execute(),
        Command::Check(check) => check.execute(),
        Command::Study(study) => study.execute(),
        Command::Paper(paper) => paper.execute(),
        Command::Texture(texture) => texture.execute(),
        Command::Plot(plot) => plot.execute(),
        Command::Verify(verify) => verify.execute(),
        Command::Completions(completions) => completions.execute(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
