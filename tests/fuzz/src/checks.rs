//! Checks that all targets share.

use std::fmt::Display;

/// Most characters of a message: a sentence and a line of the file with its caret.
const MAX_CHARS: usize = 2000;

/// Demands that the message of an error is readable on a terminal: not empty, not too long, without control
/// characters.
pub(crate) fn readable(error: &impl Display) {
    let message = error.to_string();
    assert!(!message.trim().is_empty(), "an error without words");
    let length = message.chars().count();
    assert!(
        length <= MAX_CHARS,
        "a message of {length} characters: {message:.200}"
    );
    let odd = message
        .chars()
        .find(|c| c.is_control() && !matches!(c, '\n' | '\t'));
    assert!(odd.is_none(), "a message with the character {odd:?}: {message:?}");
}
