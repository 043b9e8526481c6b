//! Errors of case files, in sentences that name the place and the remedy.

use std::fmt;
use std::io;
use std::ops::Range;
use std::path::PathBuf;

use thiserror::Error;

use crate::nearest::why_unread;
use crate::same_on_ranks::Difference;
use slipfront_base::text::{MAX_EXCERPT, single_line, truncated};

/// A case file that cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum CaseError {
    #[error("cannot read {}: {}", path.display(), why_unread(path, source))]
    Unreadable { path: PathBuf, source: io::Error },
    #[error("there is no file {}: did you mean {}?", path.display(), near.display())]
    Misspelt { path: PathBuf, near: PathBuf },
    #[error("{} is a folder: name the file in it", path.display())]
    Folder { path: PathBuf },
    #[error("{} is larger than {limit_mib} MiB, so it is not a case or study file", path.display())]
    TooLarge { path: PathBuf, limit_mib: u64 },
    #[error("{} is UTF-16 text, not UTF-8: save it again with the encoding UTF-8", path.display())]
    Utf16 { path: PathBuf },
    #[error("{}:{line}: the file is not UTF-8 text: save it again with the encoding UTF-8", path.display())]
    NotText { path: PathBuf, line: usize },
    #[error("the case cannot be written as TOML: {0}")]
    Unwritable(#[from] toml::ser::Error),
    #[error(transparent)]
    Invalid(Box<Invalid>),
    #[error("stopped while the case was prepared; nothing was written")]
    Stopped,
    /// An error of another rank, in the words of that rank.
    #[error("{0}")]
    OnOtherRank(String),
    #[error(transparent)]
    Differs(#[from] Difference),
}

/// An error in the contents of a case, with its place.
#[derive(Debug, Error)]
#[error("{}{sentence}{}", place.as_ref().map(|place| format!("{place}: ")).unwrap_or_default(),
    place.as_ref().map(Place::excerpt).unwrap_or_default())]
pub struct Invalid {
    /// Place of the wrong value; none for values set in code.
    pub place: Option<Place>,
    /// The error, and the remedy.
    pub sentence: String,
}

impl CaseError {
    /// An invalid value or key at a place, in a sentence.
    pub fn invalid(place: Option<Place>, sentence: impl Into<String>) -> Self {
        let sentence = single_line(&sentence.into());
        Self::Invalid(Box::new(Invalid { place, sentence }))
    }

    /// The error without its place, for a value that no file contains.
    pub fn without_place(&self) -> String {
        match self {
            Self::Invalid(invalid) => invalid.sentence.clone(),
            error => error.to_string(),
        }
    }
}

/// Place at which a value was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A place in the case file.
    File {
        /// The file's name.
        name: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The line, and a caret under the value.
        excerpt: String,
    },
    /// A place in the value of a `--set`, with this text.
    Override(String),
}

impl Place {
    /// The place of a span of the file `name`, which holds `text`.
    pub(super) fn in_file(name: &str, text: &str, span: Range<usize>) -> Self {
        let start = text.floor_char_boundary(span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line = text[line_start..].lines().next().unwrap_or_default();
        let marked = text.get(start..span.end).unwrap_or_default();
        let marked = marked.lines().next().unwrap_or_default();
        Self::File {
            name: name.to_owned(),
            line: text[..start].matches('\n').count() + 1,
            column: text[line_start..start].chars().count() + 1,
            excerpt: excerpt(line, start - line_start, marked.chars().count()),
        }
    }

    /// The line with its caret; empty for a `--set`.
    pub fn excerpt(&self) -> &str {
        match self {
            Self::File { excerpt, .. } => excerpt,
            Self::Override(_) => "",
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File {
                name, line, column, ..
            } => write!(f, "{name}:{line}:{column}"),
            Self::Override(text) => write!(f, "--set {text}"),
        }
    }
}

/// The line, and below it carets under `width` characters from byte `start`; empty when there is nothing to
/// show.
fn excerpt(line: &str, start: usize, width: usize) -> String {
    let before = &line[..start.min(line.len())];
    if line.trim().is_empty() || before.chars().count() > MAX_EXCERPT {
        return String::new();
    }
    // Tabs stay tabs, so that the caret is below its character for any tab width.
    let margin = before.replace(|c| c != '\t', " ");
    let line = truncated(line);
    let room = line.chars().count().saturating_sub(before.chars().count());
    format!("\n  {line}\n  {margin}{}", "^".repeat(width.min(room).max(1)))
}
