//! Shared parts of the tests: programs under mpirun.

// Every test binary uses a part of it.
#![allow(dead_code)]

pub(crate) mod results;

use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Output};

/// Open MPI's parameter for the seconds between the signal on which ranks are to end and the one that kills
/// them.
pub(crate) const SECONDS_TO_END: &str = "OMPI_MCA_odls_base_sigkill_timeout";

/// The environment in which a test program finds the arguments of the command that it is to run.
const ARGUMENTS: &str = "SLIPFRONT_TEST_ARGUMENTS";

/// Starts a program with `ranks` ranks.
pub(crate) fn mpirun(ranks: usize, program: impl AsRef<OsStr>) -> Command {
    let mut command = launcher();
    command.args(["-n", &ranks.to_string()]).arg(program);
    command
}

/// The command mpirun, without a program to start yet. Ranks may be more than cores, and then give way to
/// each other while they wait.
pub(crate) fn launcher() -> Command {
    let mut command = Command::new("mpirun");
    command.args(["--allow-run-as-root", "--oversubscribe", "--bind-to", "none"]);
    // A rank that waits for ever is a failure of the test, not of the machine on which it runs. Four ranks on
    // two cores give way to whatever else works there at each of their steps, so that seconds become minutes.
    command.args(["--timeout", "600", "--mca", "mpi_yield_when_idle", "1"]);
    // Of ranks that end with another status than 0 mpirun kills at once what is left, and not after a second
    // or two.
    command.env(SECONDS_TO_END, "0");
    command
}

/// Waits for the end of a command.
pub(crate) fn output(command: &mut Command) -> Output {
    command.output().unwrap_or_else(|error| match error.kind() {
        ErrorKind::NotFound => panic!("these tests need mpirun: apt-get install openmpi-bin"),
        _ => panic!("{command:?}: {error}"),
    })
}

/// Text that is printed to stdout and stderr.
pub(crate) fn printed(output: &Output) -> String {
    [&output.stdout, &output.stderr]
        .map(|bytes| String::from_utf8_lossy(bytes))
        .concat()
}

/// Starts one of the tests of this program that are ignored otherwise, on every rank.
pub(crate) fn ranks_of_test(ranks: usize, test: &str) -> Command {
    let mut command = mpirun(ranks, std::env::current_exe().unwrap());
    command.args(only(test));
    command
}

/// Runs the plain command `slipfront`, which must succeed, in a folder, as a process of this test program,
/// which has [`run_plain_command`] in a test named `plain_command`.
pub(crate) fn run_plain(folder: &Path, line: &str) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(only("plain_command")).env(ARGUMENTS, line);
    let output = output(command.current_dir(folder));
    assert!(output.status.success(), "{}", printed(&output));
}

/// Ends this process as `slipfront` with the arguments that it was given.
pub(crate) fn run_plain_command() {
    let line = std::env::var(ARGUMENTS).unwrap();
    let line = std::iter::once("slipfront").chain(line.split_whitespace());
    assert_eq!(slipfront_cli::main(line.map(Into::into), None), 0);
}

fn only(test: &str) -> [&str; 5] {
    ["--ignored", "--exact", test, "--test-threads=1", "--nocapture"]
}
