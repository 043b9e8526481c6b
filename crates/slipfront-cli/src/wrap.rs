//! Wraps sentences between words, where a terminal would break them anywhere.

use slipfront_base::text::{self, COLUMNS, wrapped};

/// Width in columns of the terminal on stdout; 80 for a file or pipe.
pub(crate) fn stdout_columns() -> usize {
    columns(terminal_size::terminal_size_of(std::io::stdout())).unwrap_or(COLUMNS)
}

/// Width in columns of the terminal on stderr; none if it is not a terminal.
pub(crate) fn stderr_columns() -> Option<usize> {
    columns(terminal_size::terminal_size_of(std::io::stderr()))
}

fn columns(size: Option<(terminal_size::Width, terminal_size::Height)>) -> Option<usize> {
    size.map(|(width, _)| usize::from(width.0))
        .filter(|&columns| columns > 0)
}

/// Formats a note for stdout, with its line break.
pub(crate) fn note(sentence: &str) -> String {
    text::note(sentence, stdout_columns())
}

/// Formats notes for stdout, one after the other.
pub(crate) fn notes(sentences: impl IntoIterator<Item: AsRef<str>>) -> String {
    let notes = sentences.into_iter().map(|sentence| note(sentence.as_ref()));
    notes.collect()
}

/// Formats a text for stderr: lines are wrapped only on a terminal, so that programs can search for whole
/// sentences. A line that begins with a blank is an excerpt of a file, and stays unchanged.
pub(crate) fn for_stderr(text: &str) -> String {
    let Some(columns) = stderr_columns() else {
        return text.to_owned();
    };
    let lines = text.lines().map(|line| {
        if line.starts_with(' ') {
            line.to_owned()
        } else {
            wrapped(line, columns)
        }
    });
    lines.collect::<Vec<_>>().join("\n")
}
