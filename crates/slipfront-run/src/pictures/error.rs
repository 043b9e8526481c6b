//! Errors of the pictures of a run.

use std::path::PathBuf;

use slipfront_case::case_file::CaseError;
use slipfront_plot::{Picture, PictureError};
use thiserror::Error;

use crate::error::ResultsError;
use crate::fields::FieldsError;
use crate::folder_error::FolderError;
use crate::instrument::HELD_DRIVE;
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
    #[error("{0} has no units in its summary and series: run its case.toml again")]
    NoUnits(PathBuf),
    #[error(
        "forces and torques cannot share an axis: {0} and the other runs are not all rotations or all translations"
    )]
    NotComparable(PathBuf),
    #[error(transparent)]
    Record(#[from] Box<RecordError>),
    #[error(
        "a movie has at most {0} pictures, but the run has more snapshots: increase `every` of `output.snapshots`"
    )]
    TooManySnapshots(usize),
    #[error(
        "programs show a picture for at least a fiftieth of a second, so these {pictures} pictures take at least {seconds} s"
    )]
    TooFast { pictures: usize, seconds: f64 },
    #[error(
        "{path} has no maps of {field}: add it to `output.fields`, keep the default `output.snapshots` or list instants, and run the case again"
    )]
    NoMaps { path: PathBuf, field: &'static str },
    #[error("cannot draw {name}: {source}")]
    Picture {
        name: &'static str,
        source: PictureError,
    },
}

/// A picture, or the error that names it.
pub(super) fn drawn(
    name: &'static str,
    picture: Result<Picture, PictureError>,
) -> Result<Picture, RunPictureError> {
    picture.map_err(|source| RunPictureError::Picture { name, source })
}

/// A measured record that cannot be compared with the curves of runs, or has no clear place on them.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum RecordError {
    #[error(
        "{record} and the curve of a run overlap too little, by less than a tenth of the shorter one or of the points of the \
        record: after the shift the \
        record covers {from} to {to}, and {} covers {start} to {end}; check the units, and give another shift with --shift, or \
        none",
        run.display()
    )]
    LittleInCommon {
        record: String,
        from: String,
        to: String,
        run: PathBuf,
        start: String,
        end: String,
    },
    #[error(
        "{record} lasts {record_length}, and {} lasts {run_length}: check the unit of the record's times or displacements",
        run.display()
    )]
    OtherLength {
        record: String,
        record_length: String,
        run: PathBuf,
        run_length: String,
    },
    #[error(
        "{record} begins at {begin} {unit}, far from where runs begin: `--shift {}` begins it at 0",
        -begin
    )]
    FarAway {
        record: String,
        begin: f64,
        unit: &'static str,
    },
    #[error(
        "{record} fits {} best with a shift of {own}, but {} with {of_other}: give the shift with --shift",
        first.display(),
        other.display()
    )]
    ShiftsOfRuns {
        record: String,
        first: PathBuf,
        own: String,
        other: PathBuf,
        of_other: String,
    },
    #[error(
        "{record} fits about equally well with a shift of {one} and of {other}: give the shift with --shift"
    )]
    UnclearShift {
        record: String,
        one: String,
        other: String,
    },
    #[error(
        "{}: {HELD_DRIVE}", .0.display()
    )]
    HeldDrive(PathBuf),
}
