//! Shared helpers of the tests, which run programs under mpirun.

// Every test binary uses only some of these.
#![allow(dead_code)]

pub(crate) mod results;

use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Output};

/// Open MPI's parameter for the seconds between the signal that asks ranks to end and the signal that kills
/// them.
pub(crate) const SECONDS_TO_END: &str = "OMPI_MCA_odls_base_sigkill_timeout";

/// Environment variable with the arguments of the command that a test program is to run.
const ARGUMENTS: &str = "SLIPFRONT_TEST_ARGUMENTS";

/// Starts a program with `ranks` ranks.
pub(crate) fn mpirun(ranks: usize, program: impl AsRef<OsStr>) -> Command {
    let mut command = launcher();
    command.args(["-n", &ranks.to_string()]).arg(program);
    command
}

/// mpirun without a program to start yet. There may be more ranks than cores: ranks that wait yield to
/// others.
pub(crate) fn launcher() -> Command {
    let mut command = Command::new("mpirun");
    command.args(["--allow-run-as-root", "--oversubscribe", "--bind-to", "none"]);
    // A rank that waits for ever is a failure of the test, not of the machine. Four ranks on two cores yield
    // to other processes at each of their steps, so seconds become minutes.
    command.args(["--timeout", "600", "--mca", "mpi_yield_when_idle", "1"]);
    // When a rank ends with a status other than 0, mpirun kills the other ranks at once, instead of after a
    // second or two.
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

/// Text printed to stdout and stderr.
pub(crate) fn printed(output: &Output) -> String {
    [&output.stdout, &output.stderr]
        .map(|bytes| String::from_utf8_lossy(bytes))
        .concat()
}

/// Runs one of the ignored tests of this program on every rank.
pub(crate) fn ranks_of_test(ranks: usize, test: &str) -> Command {
    let mut command = mpirun(ranks, std::env::current_exe().unwrap());
    command.args(only(test));
    command
}

/// Runs the plain command `slipfront` in a folder, which must succeed. The command runs in a process of this
/// test program, which has a test named `plain_command` that calls [`run_plain_command`].
pub(crate) fn run_plain(folder: &Path, line: &str) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(only("plain_command")).env(ARGUMENTS, line);
    let output = output(command.current_dir(folder));
    assert!(output.status.success(), "{}", printed(&output));
}

/// Runs `slipfront` in this process with the arguments from the environment.
pub(crate) fn run_plain_command() {
    let line = std::env::var(ARGUMENTS).unwrap();
    let line = std::iter::once("slipfront").chain(line.split_whitespace());
    assert_eq!(slipfront_cli::main(line.map(Into::into), None), 0);
}

fn only(test: &str) -> [&str; 5] {
    ["--ignored", "--exact", test, "--test-threads=1", "--nocapture"]
}
