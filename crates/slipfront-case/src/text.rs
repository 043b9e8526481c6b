//! Text from outside (files, arguments) made fit for a message: short, and without control characters; and sentences in lines of some width.

use std::path::Path;

/// The longest part of a text that a message quotes, in characters.
pub const MAX_EXCERPT: usize = 100;
/// The columns of a text in a file.
pub const COLUMNS: usize = 80;
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

/// A note for a reader, with its line break, in lines of at most `columns` characters.
pub fn note(sentence: &str, columns: usize) -> String {
    format!("{}\n", wrapped(&format!("note: {sentence}"), columns))
}

/// Breaks a line between words into lines of at most `columns` characters, if no word is longer. Lines after the first are
/// indented. A command in backquotes is one word, so that it can be copied.
pub fn wrapped(line: &str, columns: usize) -> String {
    const INDENT: &str = "\n      ";
    let (mut text, mut used) = (String::new(), 0);
    let mut is_quoted = false;
    let words = line.split(|c| {
        is_quoted ^= c == '`';
        c == ' ' && !is_quoted
    });
    for word in words {
        let width = word.chars().count();
        if used > 0 && used + 1 + width > columns {
            text += INDENT;
            used = INDENT.len() - 1;
        } else if used > 0 {
            text.push(' ');
            used += 1;
        }
        text += word;
        used += width;
    }
    text
}

fn cut(text: &str, most: usize) -> String {
    let mut line: String = text.chars().take(most).collect();
    if line.len() < text.len() {
        line.push_str("...");
    }
    line.replace(|c: char| c.is_control() && c != '\t', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words() {
        assert_eq!(wrapped("note: short", 80), "note: short");
        let long = "note: one two three four";
        assert_eq!(wrapped(long, 13), "note: one two\n      three\n      four");
        let command = "go on by `slipfront run --resume a`, or not";
        assert_eq!(
            wrapped(command, 30),
            "go on by\n      `slipfront run --resume a`,\n      or not"
        );
        let endless = "x".repeat(20);
        assert_eq!(wrapped(&endless, 10), endless);
        let words = "word ".repeat(100);
        assert!(
            wrapped(words.trim(), 80)
                .lines()
                .all(|line| line.chars().count() <= 80)
        );
        assert_eq!(wrapped(words.trim(), 80).replace("\n      ", " "), words.trim());
    }
}
