//! Messages on stderr, unless another process of the command prints for all.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::wrap::for_stderr;

/// Whether another process of the same command prints for all processes.
static IS_SILENT: AtomicBool = AtomicBool::new(false);

/// Silences this process.
pub(crate) fn silence() {
    IS_SILENT.store(true, Ordering::Relaxed);
}

/// Whether another process prints for this one.
pub(crate) fn is_silent() -> bool {
    IS_SILENT.load(Ordering::Relaxed)
}

/// Prints notes to stderr, each wrapped to the terminal.
pub(crate) fn print_notes(sentences: impl IntoIterator<Item = String>) {
    for sentence in sentences {
        print_stderr(&for_stderr(&format!("note: {sentence}")));
    }
}

/// Prints a line to stderr. If it cannot be printed, because the terminal is closed or the disk is full, it
/// is lost: the command continues and ends with the exit status of its work.
pub(crate) fn print_stderr(line: &str) {
    if is_silent() {
        return;
    }
    let _ = writeln!(std::io::stderr(), "{line}");
}
