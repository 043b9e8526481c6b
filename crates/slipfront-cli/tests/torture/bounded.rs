//! The command with limits on its time and memory, and checks of its exit.

use std::process::{Output, Stdio};
use std::time::Duration;

use crate::support::process::{Running, program, stderr, stdout, unset};
use crate::support::workspace::{Files, Workspace};

/// Time limit of a command: all of these end within a second on an idle machine.
const MAX_TIME: Duration = Duration::from_secs(120);
/// Limit on the address space of a command, KiB: 1 GiB, of which its threads reserve the larger part without
/// using it.
const MAX_MEMORY_KIB: u64 = 1 << 20;

/// Exit of a command.
#[derive(Debug)]
pub(crate) struct ExitedProcess {
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Workspace {
    /// Runs a line. A hang, a crash, a panic, too much memory, an unknown status and a failure without a
    /// message are findings.
    pub(crate) fn run_bounded(&self, line: &str) -> Result<ExitedProcess, String> {
        inspect(line, &self.bounded(&[], line)?)
    }

    /// Runs a line under a watcher, which may kill it; none if it was killed.
    pub(crate) fn run_watched(&self, watcher: &[&str], line: &str) -> Result<Option<ExitedProcess>, String> {
        let output = self.bounded(watcher, line)?;
        match output.status.code() {
            None if output.stderr.is_empty() => Ok(None),
            _ => inspect(line, &output).map(Some),
        }
    }

    /// Runs a line that must succeed.
    pub(crate) fn succeed_bounded(&self, line: &str) -> Result<ExitedProcess, String> {
        let ended = self.run_bounded(line)?;
        match ended.status {
            0 => Ok(ended),
            status => Err(format!("`{line}` ends with status {status}: {}", ended.stderr)),
        }
    }

    /// Starts a line that will be killed.
    pub(crate) fn start_silent(&self, line: &str) -> Running {
        let mut process = self.process(line);
        process.env("TMPDIR", self.path("temporary"));
        Running::start(process.stdout(Stdio::null()).stderr(Stdio::null()))
    }

    /// Every file below a folder, with its contents; empty if there is no folder.
    pub(crate) fn files_if_any(&self, folder: &str) -> Files {
        if self.path(folder).is_dir() {
            self.files(folder)
        } else {
            Files::new()
        }
    }

    /// Runs a line of slipfront under `watcher`, with limits on memory and time.
    fn bounded(&self, watcher: &[&str], line: &str) -> Result<Output, String> {
        let mut process = unset("sh");
        process
            .args(["-c", &format!("ulimit -v {MAX_MEMORY_KIB} && exec \"$@\""), "sh"])
            .args(watcher)
            .arg(program())
            .args(line.split_whitespace())
            .current_dir(self.path(""))
            .env("TMPDIR", self.path("temporary"))
            .env("RUST_BACKTRACE", "0")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        Running::start(&mut process).ended_within(MAX_TIME)
    }
}

fn inspect(line: &str, output: &Output) -> Result<ExitedProcess, String> {
    let (stdout, stderr) = (stdout(output), stderr(output));
    let Some(status) = output.status.code() else {
        return Err(format!("`{line}` ends by {}: {stderr}", output.status));
    };
    let sound = match status {
        0 => true,
        1 | 2 => stderr.lines().any(|line| line.starts_with("error: ")),
        _ => false,
    };
    let alarming = [
        "panicked",
        "RUST_BACKTRACE",
        "memory allocation of",
        "fault of the program",
    ];
    if !sound
        || alarming
            .iter()
            .any(|word| stderr.contains(word) || stdout.contains(word))
    {
        return Err(format!("`{line}` ends with status {status}: {stdout}{stderr}"));
    }
    Ok(ExitedProcess {
        status,
        stdout,
        stderr,
    })
}
