//! What is said on stderr.

use std::io::Write;

/// Says a line. Where it cannot be said, since the terminal has closed, its reader has gone or the disk under it is full, it is
/// lost, and nothing else: a run goes on, and ends with the status that it should.
pub(crate) fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
