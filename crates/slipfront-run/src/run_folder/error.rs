//! Why a run folder cannot be used.

use std::path::PathBuf;

use slipfront_case::text::display_path;
use thiserror::Error;

use super::resume_command::resume_command;

/// What can go wrong with a run folder.
#[derive(Debug, Error)]
pub enum FolderError {
    /// There is something in it already.
    #[error(
        "the folder {} is not empty: choose another with --out, or replace slipfront's own files in it with --force",
        path.display()
    )]
    NotEmpty {
        /// The folder.
        path: PathBuf,
    },
    /// There is a run in it that was interrupted.
    #[error(
        "the folder {} holds a run that was interrupted: go on with it by `{}`, choose another with --out, or begin again \
         with --force",
        path.display(),
        resume_command(path)
    )]
    Interrupted {
        /// The folder.
        path: PathBuf,
    },
    /// There is no run in it to go on with.
    #[error("{} is no folder of a run to go on with: {why}", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
        /// What is missing.
        why: &'static str,
    },
    /// Somebody else writes there.
    #[error("another process is running in the folder {}: wait for it, or choose another folder", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A file that is not slipfront's stands where one would be written.
    #[error(
        "{} is not a file of an earlier run: move it away or choose another folder with --out",
        display_path(path)
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// It cannot be made or written to.
    #[error("cannot write to the folder {}: {source}; make it writable, or choose another", path.display())]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error(
        "cannot write {}: {source}; the folder is left without manifest.json, as incomplete",
        display_path(path)
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The folder of a run could not be copied.
    #[error(
        "cannot copy {} to {}: {source}; what is there is whole, and the command may be repeated",
        display_path(from),
        display_path(to)
    )]
    Copy {
        /// The folder.
        from: PathBuf,
        /// Where it should have gone.
        to: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file was changed before the run was complete.
    #[error(
        "{} was changed while the run went on, so that it does not tell what was run; the folder is left without \
         manifest.json, as incomplete: put the file back as it was",
        display_path(path)
    )]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// A file could not be read back.
    #[error("cannot read {}: {source}", display_path(path))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}
