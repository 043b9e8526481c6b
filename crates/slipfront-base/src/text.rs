//! Text from outside (files, arguments) made fit for a message: short, and without control characters; and
//! sentences wrapped to a line width.

use std::path::Path;

/// The longest part of a text that a message quotes, in characters.
pub const MAX_EXCERPT: usize = 100;
/// Line width of text in a file, in columns.
pub const COLUMNS: usize = 80;
/// Largest length of a sentence, in characters: it may quote a text as long as a whole file.
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

/// A path as one argument of a shell command that a reader can paste. Control characters, bytes that are not
/// UTF-8, and backquotes, which would end the command in a sentence, are escaped as in C between `$'` and
/// `'`. Bash, zsh and ksh read this form.
pub fn shell_path(path: &Path) -> String {
    let path = if path.as_os_str().as_encoded_bytes().starts_with(b"-") {
        // Without `./` a command would take it for an option.
        &Path::new(".").join(path)
    } else {
        path
    };
    let is_escaped = |c: char| c.is_control() || c == '`';
    if let Some(word) = path.to_str().filter(|word| !word.contains(is_escaped)) {
        return shell_quoted(word);
    }
    let octal = |bytes: &[u8]| {
        bytes
            .iter()
            .map(|byte| format!("\\{byte:03o}"))
            .collect::<String>()
    };
    let character = |c: char| match c {
        '\'' | '\\' => format!("\\{c}"),
        _ if is_escaped(c) => octal(c.encode_utf8(&mut [0; 4]).as_bytes()),
        _ => c.to_string(),
    };
    let chunks = path.as_os_str().as_encoded_bytes().utf8_chunks();
    let escaped = chunks.map(|chunk| {
        let text: String = chunk.valid().chars().map(character).collect();
        text + &octal(chunk.invalid())
    });
    format!("$'{}'", escaped.collect::<String>())
}

/// A note for a reader, with its line break, in lines of at most `columns` characters.
pub fn note(sentence: &str, columns: usize) -> String {
    format!("{}\n", wrapped(&format!("note: {sentence}"), columns))
}

/// Breaks a line between words into lines of at most `columns` characters, unless a word is longer. Lines
/// after the first are indented. A command in backquotes is one word, so that it can be copied.
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
    fn a_path_is_one_argument_of_a_command() {
        for (path, argument) in [
            ("results/a-1", "results/a-1"),
            ("my run", "'my run'"),
            ("it's", "\"it's\""),
            ("$HOME", "'$HOME'"),
            ("-o", "./-o"),
            ("-an option", "'./-an option'"),
            ("two\nlines", "$'two\\012lines'"),
            ("it's a\\b\u{85}", "$'it\\'s a\\\\b\\302\\205'"),
            ("a ` b", "$'a \\140 b'"),
        ] {
            assert_eq!(shell_path(Path::new(path)), argument);
        }
    }

    /// The shell passes the bytes of the name to a command unchanged.
    #[cfg(unix)]
    #[test]
    fn bash_reads_a_path_as_it_is() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        use std::process::Command;
        let echo = |script: &str| Command::new("bash").args(["-c", script]).output();
        if echo("").is_err() {
            return;
        }
        // Every byte that a name can contain, alone and before a digit.
        let all: Vec<u8> = (1..=255).filter(|byte| *byte != b'/').collect();
        let each = all.iter().flat_map(|byte| [vec![*byte], vec![*byte, b'7']]);
        for name in each.chain([all.clone(), "-ü \u{1f642} ' \" \\ \n".into()]) {
            let argument = shell_path(Path::new(OsStr::from_bytes(&name)));
            assert!(
                !argument.contains(|c: char| c.is_control() || c == '`'),
                "{argument}"
            );
            let read = echo(&format!("printf %s {argument}")).unwrap().stdout;
            assert_eq!(read.strip_prefix(b"./").unwrap_or(&read), name, "{argument}");
        }
    }

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
