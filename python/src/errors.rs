//! Errors as exceptions, with the sentences of the command.

use std::fmt::Display;
use std::io::ErrorKind;

use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use slipfront_case::case_file::{CaseError as Error, Place};
use slipfront_study::StudyError;

create_exception!(
    slipfront,
    CaseError,
    PyValueError,
    "A case that cannot be run. The message names the place and the remedy; `line` and `column` are where it was written, from 1, or None."
);
create_exception!(slipfront, RunError, PyRuntimeError, "A run that diverged.");
create_exception!(
    slipfront,
    ForkError,
    PyRuntimeError,
    "The use of slipfront in a process that was forked from one in which it had been used. The message names the remedy."
);
create_exception!(
    slipfront,
    FolderError,
    PyRuntimeError,
    "A folder of results that cannot be read or written, or is not as it was written."
);

/// Options of the command, and their counterparts in Python.
const OPTIONS: [(&str, &str); 13] = [
    ("another --set", "another override"),
    ("--set ", ""),
    ("with --out", "by `folder`"),
    ("with --force", "by `force=True`"),
    ("give --force", "give `force=True`"),
    ("--training", "`training`"),
    ("--max-memory", "`max_memory`"),
    ("--max-time", "`max_time`"),
    ("--levels", "`levels`"),
    ("--replicates", "`replicates`"),
    ("--threads", "`threads`"),
    ("--author \"NAME\"", "`author`"),
    (
        "--licence, such as --licence CC-BY-4.0",
        "`licence`, such as \"CC-BY-4.0\"",
    ),
];

/// Beginning of the names of files that are arrays in memory; a number and the key of the array follow.
pub(crate) const IN_MEMORY: &str = "memory:/";

/// The sentence of an error in terms of Python: arguments instead of options, keys instead of files in
/// memory.
pub(crate) fn in_words_of_python(error: impl Display) -> String {
    let mut sentence = error.to_string();
    for (option, argument) in OPTIONS {
        sentence = sentence.replace(option, argument);
    }
    let mut parts = sentence.split(IN_MEMORY);
    let mut in_python = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let named = part.split_once('/').and_then(|(_, rest)| rest.split_once(".npy"));
        match named {
            Some((key, rest)) => match by_index(rest) {
                Some((index, value, rest)) => in_python.extend([key, &index, value, rest]),
                None => in_python.extend([key, rest]),
            },
            None => in_python.extend([IN_MEMORY, part]),
        }
    }
    in_python
}

/// The index of a wrong value in an array, that value, and the rest of the sentence after the name of the
/// file of the array.
fn by_index(after_name: &str) -> Option<(String, &str, &str)> {
    let (value, rest) = after_name.strip_prefix("` has ")?.split_once(" in row ")?;
    let (row, rest) = rest.split_once(", column ")?;
    let (column, rest) = rest.split_once(" (both counted from 0)")?;
    Some((format!("[{row}, {column}]` is "), value, rest))
}

/// A case that cannot be run, as an exception with its place.
pub(crate) fn case_error(py: Python<'_>, error: &Error) -> PyErr {
    let sentence = in_words_of_python(error);
    let raised = if is_missing(error) {
        missing_file_error(py, sentence)
    } else {
        CaseError::new_err(sentence)
    };
    let place = match error {
        Error::Invalid(invalid) => match &invalid.place {
            Some(Place::File { line, column, .. }) => (Some(*line), Some(*column)),
            _ => (None, None),
        },
        Error::NotText { line, .. } => (Some(*line), None),
        _ => (None, None),
    };
    let value = raised.value(py);
    let set = value
        .setattr("line", place.0)
        .and_then(|()| value.setattr("column", place.1));
    set.err().unwrap_or(raised)
}

/// Whether the error is that the file of a case or of a study is missing.
fn is_missing(error: &Error) -> bool {
    match error {
        Error::Misspelt { .. } => true,
        Error::Unreadable { source, .. } => source.kind() == ErrorKind::NotFound,
        _ => false,
    }
}

/// A case error that is also a `FileNotFoundError`: a class with two bases is made in Python.
fn missing_file_error(py: Python<'_>, sentence: String) -> PyErr {
    let class = py
        .import("slipfront._case")
        .and_then(|module| module.getattr("MissingFileError"));
    match class.and_then(|class| class.call1((sentence,))) {
        Ok(raised) => PyErr::from_value(raised),
        Err(error) => error,
    }
}

/// A study that cannot be planned or run.
pub(crate) fn study_error(py: Python<'_>, error: &StudyError) -> PyErr {
    match error {
        StudyError::File(source) => case_error(py, source),
        StudyError::Point { .. }
        | StudyError::ReferencePoint { .. }
        | StudyError::Levels { .. }
        | StudyError::Bare { .. }
        | StudyError::NoDesign { .. }
        | StudyError::MemoryLimit { .. }
        | StudyError::TimeLimit { .. } => CaseError::new_err(in_words_of_python(error)),
        StudyError::Failed { .. } => RunError::new_err(in_words_of_python(error)),
        error => FolderError::new_err(in_words_of_python(error)),
    }
}

/// A folder that cannot be read or written.
pub(crate) fn folder_error(error: impl Display) -> PyErr {
    FolderError::new_err(in_words_of_python(error))
}
