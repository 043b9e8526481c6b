//! Detects a `--set` with a key and value that the shell has split into several words.

use std::ffi::OsString;
use std::path::Path;

use slipfront_base::text::{shell_quoted, truncated};

/// Error message for the first `--set` with a key and value that are several words, with the single word that
/// was meant: `--set drive.v_star 0.05`, or `--set slider.blocks=[50, 50]` without quotes around it.
pub(crate) fn divided_override(args: &[OsString]) -> Option<String> {
    let words: Vec<&str> = args
        .iter()
        .map(|word| word.to_str().unwrap_or_default())
        .collect();
    let overrides = (1..words.len()).filter_map(|at| match words[at].strip_prefix("--set=") {
        Some(first) => Some((first, &words[at + 1..])),
        None if words[at - 1] == "--set" => Some((words[at], &words[at + 1..])),
        None => None,
    });
    overrides.into_iter().find_map(|(first, rest)| {
        if let Some(key) = first.strip_suffix('=') {
            joined(key, rest).map(|meant| sentence(first, &meant))
        } else if first.contains('=') {
            whole_value(first, rest).map(|meant| {
                format!(
                    "--set {}: the shell has split the value at a blank: put it in quotes, --set {}",
                    truncated(first),
                    quoted(&meant)
                )
            })
        } else {
            joined(first, rest).map(|meant| sentence(first, &meant))
        }
    })
}

fn sentence(first: &str, meant: &str) -> String {
    format!(
        "--set {}: key and value are one word, joined by `=`: --set {}",
        truncated(first),
        quoted(meant)
    )
}

/// A key joined with the next word, if that is its value.
fn joined(key: &str, rest: &[&str]) -> Option<String> {
    let value = match rest {
        ["=", value, ..] => value,
        [value, ..] => value.strip_prefix('=').unwrap_or(value),
        [] => return None,
    };
    let is_option = value.starts_with('-') && value.parse::<f64>().is_err();
    let is_file = value.ends_with(".toml") || Path::new(value).exists();
    (!value.is_empty() && !is_option && !is_file).then(|| format!("{key}={value}"))
}

/// An override joined with the following words up to its last closing bracket; none if it opens no bracket,
/// or none is closed.
fn whole_value(first: &str, rest: &[&str]) -> Option<String> {
    let is_open = |text: &str| text.matches(['[', '{']).count() > text.matches([']', '}']).count();
    let mut whole = first.to_owned();
    let mut rest = rest.iter();
    while is_open(&whole) {
        whole = format!("{whole} {}", rest.next()?);
    }
    (whole.len() > first.len()).then_some(whole)
}

/// An override, in quotes if the shell needs them; `=` does not.
fn quoted(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "=._-+".contains(c);
    truncated(&if text.chars().all(is_plain) {
        text.to_owned()
    } else {
        shell_quoted(text)
    })
}
