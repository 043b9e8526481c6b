//! Processes of the command: starting, signalling and waiting.

use std::io::Read;
use std::ops::{Deref, DerefMut};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::{Sender, channel};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

/// Time limit of a process: the longest take half a minute, and only a hang takes this long.
pub(crate) const MAX_TIME: Duration = Duration::from_secs(300);

/// Variables of the environment that change what the command does or prints. The tests may themselves run in
/// a Slurm task.
const SETTINGS: [&str; 7] = [
    "CLICOLOR_FORCE",
    "COLUMNS",
    "SLIPFRONT_SIMD",
    "SLURM_ARRAY_TASK_COUNT",
    "SLURM_ARRAY_TASK_ID",
    "SLURM_ARRAY_TASK_MAX",
    "SLURM_ARRAY_TASK_MIN",
];

/// The path of the command under test.
pub(crate) fn program() -> &'static str {
    // In tests/long, the program of that package.
    option_env!("CARGO_BIN_EXE_slipfront")
        .or(option_env!("CARGO_BIN_EXE_slipfront-under-test"))
        .expect("cargo builds the program of the package")
}

/// A process without the settings in the environment of the tests.
pub(crate) fn unset(program: &str) -> Command {
    let mut process = Command::new(program);
    for name in SETTINGS {
        process.env_remove(name);
    }
    process
}

/// A process that is killed if its test fails before its end.
pub(crate) struct Running {
    child: Child,
    /// The command line, for messages.
    line: String,
}

impl Running {
    pub(crate) fn start(command: &mut Command) -> Self {
        let (child, line) = (command.spawn().unwrap(), format!("{command:?}"));
        Self { child, line }
    }

    /// Waits for the first line that the process prints, which must come within [`MAX_TIME`].
    pub(crate) fn first_line(&mut self) -> String {
        let mut stream = self.stdout.take().unwrap();
        let (sender, printed) = channel();
        spawn(move || {
            // A buffer would keep what follows the line.
            let (mut line, mut byte) = (Vec::new(), [0]);
            while matches!(stream.read(&mut byte), Ok(1)) && byte != *b"\n" {
                line.extend(byte);
            }
            // The test may have ended.
            let _ = sender.send((line, stream));
        });
        let (line, stream) = printed
            .recv_timeout(MAX_TIME)
            .unwrap_or_else(|_| panic!("{} has printed no line after {MAX_TIME:?}", self.line));
        self.stdout = Some(stream);
        String::from_utf8(line).unwrap()
    }

    /// Waits for the end of the process, which must come within [`MAX_TIME`].
    pub(crate) fn ended(self) -> Output {
        self.ended_within(MAX_TIME)
            .unwrap_or_else(|hang| panic!("{hang}"))
    }

    /// Waits for the end of the process. After this time, it is killed, and what it has printed is the error.
    pub(crate) fn ended_within(mut self, limit: Duration) -> Result<Output, String> {
        let (sender, pieces) = channel();
        forward(0, self.stdout.take(), sender.clone());
        forward(1, self.stderr.take(), sender);
        let until = Instant::now() + limit;
        let left = || until.saturating_duration_since(Instant::now());
        let mut printed = [Vec::new(), Vec::new()];
        while let Ok((stream, piece)) = pieces.recv_timeout(left()) {
            printed[stream].extend::<Vec<u8>>(piece);
        }
        let [stdout, stderr] = printed;
        loop {
            if let Some(status) = self.try_wait().unwrap() {
                return Ok(Output {
                    status,
                    stdout,
                    stderr,
                });
            }
            if left().is_zero() {
                let said = [stdout, stderr].concat();
                let said = String::from_utf8_lossy(&said);
                return Err(format!("{} has not ended after {limit:?}:\n{said}", self.line));
            }
            sleep(Duration::from_millis(1));
        }
    }
}

impl Deref for Running {
    type Target = Child;

    fn deref(&self) -> &Child {
        &self.child
    }
}

impl DerefMut for Running {
    fn deref_mut(&mut self) -> &mut Child {
        &mut self.child
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // There is nothing to kill after its end.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends what comes from a stream, with the number of the stream, until it ends.
fn forward(number: usize, stream: Option<impl Read + Send + 'static>, to: Sender<(usize, Vec<u8>)>) {
    spawn(move || {
        let mut bytes = [0; 1 << 14];
        let mut stream = stream?;
        while let Ok(count @ 1..) = stream.read(&mut bytes) {
            to.send((number, bytes[..count].to_vec())).ok()?;
        }
        Some(())
    });
}

/// Runs a command to its end.
pub(crate) fn output(command: &mut Command) -> Output {
    let piped = command.stdin(Stdio::null()).stdout(Stdio::piped());
    Running::start(piped.stderr(Stdio::piped())).ended()
}

/// Text printed by a process to stderr.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Text printed by a process to stdout.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Runs a command, and asserts that it ends with this status.
pub(crate) fn ended_with(command: &mut Command, status: i32) -> Output {
    let output = output(command);
    let said = format!("{command:?}\n{}{}", stdout(&output), stderr(&output));
    assert_eq!(output.status.code(), Some(status), "{said}");
    output
}

/// Sends a signal such as `-INT` to a process that was not waited for.
pub(crate) fn send(child: &Child, signal: &str) {
    assert!(try_send(child, signal), "{signal} cannot be sent");
}

/// Sends a signal to a process that may have ended; returns whether it was still running.
pub(crate) fn try_send(child: &Child, signal: &str) -> bool {
    let kill = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .output();
    kill.unwrap().status.success()
}

/// Waits until a condition holds, and fails after two minutes.
pub(crate) fn wait_for(what: &str, mut holds: impl FnMut() -> bool) {
    let began = Instant::now();
    while !holds() {
        assert!(began.elapsed() < Duration::from_secs(120), "no {what}");
        sleep(Duration::from_millis(1));
    }
}

/// Waits until the command has installed its signal handlers: an earlier signal would end it.
pub(crate) fn wait_for_signal_handlers(child: &Child) {
    let process = child.id().to_string();
    // SIGXCPU, number 24, is caught last; a process that has ended has no mask.
    let caught = || signal_mask(&process, "SigCgt:").is_none_or(|mask| mask >> 23 & 1 == 1);
    if cfg!(target_os = "linux") {
        wait_for("signals to be caught", caught);
    } else {
        sleep(Duration::from_millis(300));
    }
}

/// Whether these tests run under `nohup`: then the commands in them also ignore the closing of a terminal.
pub(crate) fn ignores_hangup() -> bool {
    signal_mask("self", "SigIgn:").is_some_and(|mask| mask & 1 == 1)
}

/// A set of signals in the status of a process, with signal n at bit n - 1; none if the process has ended.
fn signal_mask(process: &str, name: &str) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let mask = status.lines().find_map(|line| line.strip_prefix(name))?;
    u64::from_str_radix(mask.trim(), 16).ok()
}
