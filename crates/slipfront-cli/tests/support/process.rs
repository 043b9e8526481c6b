//! Processes of the command: starting, signalling and waiting.

use std::process::{Child, Command, Output};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The path of the command under test.
pub(crate) fn program() -> &'static str {
    env!("CARGO_BIN_EXE_slipfront")
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
    let output = command.output().unwrap();
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

/// Waits until a condition holds, and fails after a minute.
pub(crate) fn wait_for(what: &str, mut holds: impl FnMut() -> bool) {
    let began = Instant::now();
    while !holds() {
        assert!(began.elapsed() < Duration::from_secs(60), "no {what}");
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
