//! Errors as exceptions, with the sentences of the command.

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

/// A case that cannot be run, as an exception with its place.
pub(crate) fn case_error(py: Python<'_>, error: &Error) -> PyErr {
    let raised = CaseError::new_err(error.to_string());
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

/// A study that cannot be planned or run.
pub(crate) fn study_error(py: Python<'_>, error: &StudyError) -> PyErr {
    match error {
        StudyError::File(source) => case_error(py, source),
        StudyError::Point { .. }
        | StudyError::Levels { .. }
        | StudyError::Bare { .. }
        | StudyError::MemoryLimit { .. }
        | StudyError::TimeLimit { .. } => CaseError::new_err(error.to_string()),
        StudyError::Failed { .. } => RunError::new_err(error.to_string()),
        error => FolderError::new_err(error.to_string()),
    }
}

/// A folder that cannot be read or written.
pub(crate) fn folder_error(error: impl std::fmt::Display) -> PyErr {
    FolderError::new_err(error.to_string())
}
