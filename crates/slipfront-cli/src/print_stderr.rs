//! Messages on stderr.

use std::io::Write;

/// Prints a line to stderr. A line that cannot be printed, since the terminal is closed or the disk is full, is lost: the
/// command goes on and ends with the exit status of its work.
pub(crate) fn print_stderr(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
