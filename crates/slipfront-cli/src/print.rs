//! Results on stdout.

use std::io::{ErrorKind, Write};

use crate::failure::Failure;

/// Prints to stdout. It is no failure when the reader has closed the pipe, as `head` does.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::running(anyhow::anyhow!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}
