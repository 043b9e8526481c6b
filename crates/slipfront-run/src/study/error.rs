//! Errors of studies.

use std::path::PathBuf;

use thiserror::Error;

use crate::error::ResultsError;
use crate::program;
use crate::run_folder::error::FolderError;
use slipfront_case::case_file::CaseError;
use slipfront_case::text::display_path;
#[cfg(feature = "plot")]
use slipfront_plot::PictureError;

/// A study that cannot be used, or had to stop.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The study file, or its base case.
    #[error(transparent)]
    File(#[from] CaseError),
    /// A point of the study is not a valid case.
    #[error("the point {point} is not a valid case: {source}")]
    Point {
        /// Its levels.
        point: String,
        /// The reason.
        source: CaseError,
    },
    /// The study has very many runs.
    #[error("the study has {runs} runs, more than {limit}: give --yes if that is meant")]
    Large {
        /// Runs.
        runs: u64,
        /// Most runs without confirmation.
        limit: u64,
    },
    /// The study has more points than can be listed.
    #[error("the axes of the study multiply to more than {limit} points: take fewer levels")]
    TooLarge {
        /// Largest number of points.
        limit: usize,
    },
    /// More runs at once than there is memory for.
    #[error(
        "{threads} runs at once take about {needed} of memory where {available} are available to this process: give \
        --threads {fit}"
    )]
    Memory {
        /// Runs at once.
        threads: usize,
        /// Memory that they take.
        needed: String,
        /// Available memory.
        available: String,
        /// Number of runs that there is memory for.
        fit: usize,
    },
    /// A run that needs more memory than there is.
    #[error(
        "a run of the point {point} takes about {needed} of memory where {available} are available to this process: \
        lower `slider.blocks`, or keep no run folders (`study.keep`)"
    )]
    PointMemory {
        /// Its levels.
        point: String,
        /// Memory that it takes.
        needed: String,
        /// Available memory.
        available: String,
    },
    /// Results that need more disk space than there is.
    #[error(
        "the runs still to be done take about {needed} where {free} are free in {}: keep fewer run folders \
        (`study.keep`), or choose another folder with --out",
        path.display()
    )]
    Disk {
        /// Space that they take.
        needed: String,
        /// Free space.
        free: String,
        /// The folder.
        path: PathBuf,
    },
    /// The results folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The folder holds other files than those of a study.
    #[error("the folder {} holds other things than a study: choose another with --out", path.display())]
    NotAStudy {
        /// The folder.
        path: PathBuf,
    },
    /// Another process works in the folder.
    #[error("another study is running in {}: wait for it, or choose another folder with --out", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// The records could not be read or written.
    #[error("cannot {action} {}: {source}; finished runs are safe, and the study goes on from there when started again",
        path.display())]
    Records {
        /// What could not be done.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
    /// Another file of the folder could not be written.
    #[error(
        "cannot write {}: {source}; finished runs are safe, and the study goes on from there when started again",
        display_path(path)
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
    /// A file that is not a record file.
    #[error("{} is not the record file of a study", path.display())]
    NotRecords {
        /// The file.
        path: PathBuf,
    },
    /// A run folder could not be written.
    #[error(
        "cannot keep the folder of a run: {0}; finished runs are safe, and the study goes on from there when \
        started again"
    )]
    Keep(#[from] ResultsError),
    /// Shards that lack runs of the study.
    #[error(
        "{runs} runs are in none of the shards{}: finish them, or run the rest with `slipfront study` on the \
        study.toml of the united folder, with --out the folder itself",
        of_others(*others)
    )]
    Missing {
        /// Number of missing runs, as far as is known.
        runs: usize,
        /// Number of recorded runs that do not belong to the study.
        others: usize,
    },
    /// Shards of different studies.
    #[error("{} belongs to another study than {}: merge shards of one study only", other.display(), first.display())]
    Foreign {
        /// The first folder.
        first: PathBuf,
        /// The folder that differs.
        other: PathBuf,
    },
    /// A shard that does not exist.
    #[error("the shard `{given}` cannot be: {why}; write i/n with i from 1 to n, such as 2/8, or `slurm`")]
    Shard {
        /// The given text.
        given: String,
        /// The reason.
        why: String,
    },
    /// A table could not be written as CSV.
    #[error("cannot write a table of the study: {0}")]
    Table(#[from] csv::Error),
    /// A picture.
    #[cfg(feature = "plot")]
    #[error("cannot draw {name}: {source}")]
    Picture {
        /// Which one.
        name: String,
        /// The reason.
        source: PictureError,
    },
    /// Threads could not be started.
    #[error("cannot start the threads of the study: {0}")]
    Threads(std::io::Error),
    /// A signal asked to stop.
    #[error("stopped by a signal: finished runs are safe, and the same command goes on from there")]
    Interrupted,
}

/// The explanation of recorded runs that do not belong to a study, to be inserted into a sentence.
pub(crate) fn of_others(runs: usize) -> String {
    match runs {
        0 => String::new(),
        _ => format!(
            ", and {runs} recorded runs are of another program than {}, or of a study that was changed since",
            program::this_program()
        ),
    }
}
