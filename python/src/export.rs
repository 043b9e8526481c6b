//! Complete runs for a data repository, and their citations.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::atomic::AtomicBool;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use slipfront_run::export::{Attribution, Author, ExportError, Licence, WholeRun, bibtex, cff, write_crate};

use crate::errors::{folder_error, in_words_of_python};
use crate::process::detached;

/// Describes runs as a Process Run Crate, and returns the path of the description with sentences about what
/// the crate lacks.
#[pyfunction]
pub(crate) fn ro_crate(
    py: Python<'_>,
    folders: Vec<PathBuf>,
    author: Option<&str>,
    licence: Option<&str>,
    out: Option<PathBuf>,
    force: bool,
) -> PyResult<(PathBuf, Vec<String>)> {
    let by = attribution(author, licence)?;
    let never = AtomicBool::new(false);
    let written = detached(py, || {
        write_crate(&read(&folders)?, out.as_deref(), &by, force, &never)
    })?;
    let notes = by.notes().into_iter().map(in_words_of_python).collect();
    Ok((written.map_err(export_error)?, notes))
}

/// Citations of runs: entries of BibTeX, or a citation file (CFF).
#[pyfunction]
pub(crate) fn citation(
    py: Python<'_>,
    folders: Vec<PathBuf>,
    is_cff: bool,
    author: Option<&str>,
    licence: Option<&str>,
) -> PyResult<String> {
    let by = attribution(author, licence)?;
    let runs = detached(py, || read(&folders))?.map_err(export_error)?;
    if is_cff {
        cff(&runs, &by).map_err(export_error)
    } else {
        Ok(bibtex(&runs, &by))
    }
}

fn read(folders: &[PathBuf]) -> Result<Vec<WholeRun>, ExportError> {
    folders.iter().map(|folder| WholeRun::read(folder)).collect()
}

fn attribution(author: Option<&str>, licence: Option<&str>) -> PyResult<Attribution> {
    Ok(Attribution {
        author: parsed::<Author>("author", author)?,
        licence: parsed::<Licence>("licence", licence)?,
    })
}

/// The value of an argument that is given as text.
fn parsed<T: FromStr<Err = String>>(argument: &str, text: Option<&str>) -> PyResult<Option<T>> {
    let parsed = text.map(str::parse).transpose();
    parsed
        .map_err(|form| PyValueError::new_err(format!("{argument} = {:?}: {form}", text.unwrap_or_default())))
}

/// An argument that is missing, or a folder that cannot be exported.
fn export_error(error: ExportError) -> PyErr {
    if matches!(error, ExportError::NeedsAuthor | ExportError::NeedsFolder) {
        PyValueError::new_err(in_words_of_python(error))
    } else {
        folder_error(error)
    }
}
