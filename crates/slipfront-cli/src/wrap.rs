//! Sentences broken between words, where a terminal would break them anywhere.

/// The columns of the terminal that stdout is, or 80.
pub(crate) fn stdout_columns() -> usize {
    columns(terminal_size::terminal_size_of(std::io::stdout())).unwrap_or(80)
}

/// The columns of the terminal that stderr is, if it is one.
pub(crate) fn stderr_columns() -> Option<usize> {
    columns(terminal_size::terminal_size_of(std::io::stderr()))
}

fn columns(size: Option<(terminal_size::Width, terminal_size::Height)>) -> Option<usize> {
    size.map(|(width, _)| usize::from(width.0))
        .filter(|&columns| columns > 0)
}

/// A note for stdout, with its line break.
pub(crate) fn note(sentence: &str) -> String {
    format!("{}\n", wrapped(&format!("note: {sentence}"), stdout_columns()))
}

/// A text for stderr: lines are broken on a terminal alone, so that programs find sentences whole. A line that begins with a
/// blank is an excerpt of a file, and stays as it is.
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

/// A line broken between words into lines of at most `columns` characters, if no word is longer. Lines after the first are
/// indented. A command in backquotes is one word, so that it can be copied.
fn wrapped(line: &str, columns: usize) -> String {
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
