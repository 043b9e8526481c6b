//! The subcommands.

pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod paper;
pub(crate) mod plot;
pub(crate) mod run;
pub(crate) mod study;
pub(crate) mod texture;
pub(crate) mod verify;

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseError;

use crate::failure::Failure;

/// Which case, and what is changed in it.
#[derive(Args)]
pub(crate) struct CaseArgs {
    /// Case file; without one, the embedded baseline: Fig. 3 of the paper
    #[arg(value_name = "CASE.toml")]
    case: Option<PathBuf>,
    /// Sets a key of the case file, such as drive.v_star=0.05 or texture.0.coverage=5; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Seed of the random friction coefficients: short for --set friction.seed=N
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
}

impl CaseArgs {
    /// The case file, if one was named.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.case.as_deref()
    }

    pub(crate) fn load(self) -> Result<Case, Failure> {
        let mut overrides = self.overrides;
        overrides.extend(self.seed.map(|seed| format!("friction.seed={seed}")));
        match self.case {
            Some(path) => Case::load(&path, &overrides),
            None => baseline(&overrides),
        }
        .map_err(Failure::input)
    }
}

/// The baseline is a case file like any other, kept in the program.
fn baseline(overrides: &[String]) -> Result<Case, CaseError> {
    let text = include_str!("../baseline.toml");
    Case::parse(text, "baseline", overrides)
}

/// Prints to stdout. A reader that has seen enough and closed the pipe is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::running(
            anyhow::anyhow!("cannot write to standard output: {error}"),
        )),
        _ => Ok(()),
    }
}

/// Bounds the threads of this process; gives their number.
pub(crate) fn set_threads(threads: Option<u16>) -> Result<usize, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from));
    pool.build_global().map_err(Failure::running)?;
    Ok(rayon::current_num_threads())
}

/// Whether two paths lead to one file.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
