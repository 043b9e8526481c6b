//! What is asked of every parser.

use std::fmt::Display;

/// The longest message, in characters: a sentence and a line of the file with its caret.
const LONGEST: usize = 2000;

/// An error is a message that a person can read on a terminal, whatever the file holds.
pub(crate) fn readable(error: &impl Display) {
    let message = error.to_string();
    assert!(!message.trim().is_empty(), "an error without words");
    let length = message.chars().count();
    assert!(
        length <= LONGEST,
        "a message of {length} characters: {message:.200}"
    );
    let odd = message
        .chars()
        .find(|c| c.is_control() && !matches!(c, '\n' | '\t'));
    assert!(odd.is_none(), "a message with the character {odd:?}: {message:?}");
}
