//! Texts of strangers in messages: short, and without characters that a terminal would obey.

use std::path::Path;

/// The longest piece of a text that a message repeats, in characters.
pub const MAX_PIECE: usize = 100;
/// The longest sentence, in characters: a text that it repeats may be as long as its file.
const MAX_SENTENCE: usize = 1000;

/// At most 100 characters of a text, on one line.
pub fn shortened(text: &str) -> String {
    cut(text, MAX_PIECE)
}

/// A sentence that may repeat what stands in a file: at most 1000 characters, on one line.
pub fn sentence(text: &str) -> String {
    cut(text, MAX_SENTENCE)
}

/// A path that may be made of names in a file.
pub fn shown(path: &Path) -> String {
    sentence(&path.display().to_string())
}

/// A word as a shell reads it.
pub fn quoted(word: &str) -> String {
    // What cannot be quoted is a zero byte, which no argument can have.
    shlex::try_quote(word).unwrap_or_default().into_owned()
}

fn cut(text: &str, most: usize) -> String {
    let mut shown: String = text.chars().take(most).collect();
    if shown.len() < text.len() {
        shown.push_str("...");
    }
    shown.replace(|c: char| c.is_control() && c != '\t', " ")
}
