//! What can go wrong with the results of a run.

use std::path::PathBuf;

use slipfront_case::case_file::CaseError;
use slipfront_case::text;
#[cfg(feature = "plot")]
use slipfront_plot::PictureError;
use thiserror::Error;

use crate::fields::FieldsError;
use crate::run_folder::error::FolderError;
use crate::series::SeriesError;

/// What can go wrong with results.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// The run folder cannot be read or written.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// `case.toml` cannot be written.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// `fields.nc` cannot be written or read.
    #[error(transparent)]
    Fields(#[from] FieldsError),
    /// `series.csv` cannot be read.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// The rows of `series.csv` cannot be serialized.
    #[error("cannot write series.csv: {0}")]
    Csv(#[from] csv::Error),
    /// `summary.json` holds something else.
    #[error("{} is not the summary of a slipfront run: {}", path.display(), text::single_line(&source.to_string()))]
    Summary {
        /// The file.
        path: PathBuf,
        /// The error of the JSON reader.
        source: serde_json::Error,
    },
    /// A picture cannot be drawn.
    #[cfg(feature = "plot")]
    #[error("cannot draw {name}: {source}")]
    Picture {
        /// Its name without the ending.
        name: &'static str,
        /// The error of the plotting library.
        source: PictureError,
    },
}
