//! Complete results for a data repository, and their citations.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::atomic::AtomicBool;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use slipfront_calibrate::CALIBRATIONS;
use slipfront_design::DESIGNS;
use slipfront_run::export::{Attribution, Author, ExportError, Exported, Licence, bibtex, cff, write_crate};
use slipfront_study::{StudyError, exported};

use crate::errors::{folder_error, in_words_of_python};
use crate::process::detached;

/// Describes results as a Process Run Crate, and returns the path of the description with sentences about
/// what the crate lacks.
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
        Ok(write_crate(&read(&folders)?, out.as_deref(), &by, force, &never)?)
    })?;
    let notes = by.notes().into_iter().map(in_words_of_python).collect();
    Ok((written.map_err(export_error)?, notes))
}

/// Citations of results: entries of BibTeX, or a citation file (CFF).
#[pyfunction]
pub(crate) fn citation(
    py: Python<'_>,
    folders: Vec<PathBuf>,
    is_cff: bool,
    author: Option<&str>,
    licence: Option<&str>,
) -> PyResult<String> {
    let by = attribution(author, licence)?;
    let results = detached(py, || read(&folders))?.map_err(export_error)?;
    if is_cff {
        cff(&results, &by).map_err(|error| export_error(error.into()))
    } else {
        Ok(bibtex(&results, &by))
    }
}

fn read(folders: &[PathBuf]) -> Result<Vec<Exported>, StudyError> {
    let read = |folder: &PathBuf| exported(folder, &[DESIGNS, CALIBRATIONS]);
    folders.iter().map(read).collect()
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
fn export_error(error: StudyError) -> PyErr {
    use ExportError::{NeedsAuthor, NeedsFolder};
    if matches!(error, StudyError::Export(NeedsAuthor | NeedsFolder)) {
        PyValueError::new_err(in_words_of_python(error))
    } else {
        folder_error(error)
    }
}
