//! Printing to stdout, for all commands.

use std::io::{ErrorKind, Write};
use std::path::Path;

use serde::Serialize;

use crate::failure::Failure;
use crate::print_stderr::is_silent;

/// Prints the output of a command. A reader that closes the pipe, as `head` does, causes no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    expect_printed(write(text))
}

/// Prints a file of the results as the output of a command.
pub(crate) fn print_file(path: &Path) -> Result<(), Failure> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| Failure::running(format!("cannot read {}: {error}", path.display())))?;
    print(&format!("{}\n", text.trim_end()))
}

/// Prints the output of a command as JSON. A number that is not finite is null.
pub(crate) fn print_json(output: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(output).map_err(Failure::running)?;
    print(&format!("{text}\n"))
}

/// Prints a message of a command that produces files. A message that cannot be printed is lost: the command
/// continues and ends with the exit status of its work.
pub(crate) fn print_message(text: &str) {
    let _ = write(text);
}

/// Fails if the output of a command could not be printed, except because of a closed pipe.
pub(crate) fn expect_printed(written: std::io::Result<()>) -> Result<(), Failure> {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::running(format!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}

fn write(text: &str) -> std::io::Result<()> {
    if is_silent() {
        return Ok(());
    }
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush())
}
