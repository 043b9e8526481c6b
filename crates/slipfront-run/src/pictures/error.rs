//! Errors of the pictures of a run.

use std::path::PathBuf;

use slipfront_case::case_file::CaseError;
use slipfront_plot::PictureError;
use thiserror::Error;

use crate::error::ResultsError;
use crate::fields::FieldsError;
use crate::folder_error::FolderError;
use crate::series::SeriesError;

/// An error of pictures, or of the results from which they are drawn.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum RunPictureError {
    #[error(transparent)]
    Results(#[from] ResultsError),
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Fields(#[from] FieldsError),
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(
        "{0} has no units in its summary and series: it was written by an older version; run its case.toml again"
    )]
    NoUnits(PathBuf),
    #[error(
        "forces and torques have no axis in common: {0} is a rotation or not, other than the runs beside it"
    )]
    NotComparable(PathBuf),
    #[error(
        "a movie has at most {0} pictures, and the run has kept more snapshots: raise `every` of `output.snapshots`"
    )]
    TooManySnapshots(usize),
    #[error(
        "{path} has no maps of {field}: name it in `output.fields`, leave `output.snapshots` at its default or list instants, and run the case again"
    )]
    NoMaps { path: PathBuf, field: &'static str },
    #[error("cannot draw {name}: {source}")]
    Picture {
        name: &'static str,
        source: PictureError,
    },
}
