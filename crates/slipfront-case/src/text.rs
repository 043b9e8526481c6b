//! Text from outside (files, arguments) made fit for a message: short, and without control characters.

use std::path::Path;

/// The longest part of a text that a message quotes, in characters.
pub const MAX_EXCERPT: usize = 100;
/// The longest sentence, in characters: a text that it quotes may be as long as its file.
const MAX_SENTENCE: usize = 1000;

/// At most 100 characters of a text, on one line.
pub fn truncated(text: &str) -> String {
    cut(text, MAX_EXCERPT)
}

/// At most 1000 characters of a sentence that may quote a file, on one line.
pub fn single_line(text: &str) -> String {
    cut(text, MAX_SENTENCE)
}

/// A path as a message names it: at most 1000 characters, on one line.
pub fn display_path(path: &Path) -> String {
    single_line(&path.display().to_string())
}

/// A word quoted for a POSIX shell where it needs quotes.
pub fn shell_quoted(word: &str) -> String {
    // Only a word with a zero byte cannot be quoted, and no argument holds one.
    shlex::try_quote(word).unwrap_or_default().into_owned()
}

fn cut(text: &str, most: usize) -> String {
    let mut line: String = text.chars().take(most).collect();
    if line.len() < text.len() {
        line.push_str("...");
    }
    line.replace(|c: char| c.is_control() && c != '\t', " ")
}
