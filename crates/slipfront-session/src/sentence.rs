//! Errors as sentences, in which a session passes them to its page.

use std::fmt::Display;

/// Converts any error to its message.
pub fn sentence(error: impl Display) -> String {
    error.to_string()
}
