//! Why a run folder cannot be used.

use std::path::PathBuf;

use slipfront_case::text::display_path;
use thiserror::Error;

use super::resume_command::resume_command;

/// What can go wrong with a run folder.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum FolderError {
    #[error(
        "the folder {} is not empty: choose another with --out, or replace slipfront's own files in it with --force",
        path.display()
    )]
    NotEmpty { path: PathBuf },
    #[error(
        "the folder {} holds a run that was interrupted: go on with it by `{}`, choose another with --out, or begin again \
         with --force",
        path.display(),
        resume_command(path)
    )]
    Interrupted { path: PathBuf },
    #[error("{} is no folder of a run to go on with: {why}", path.display())]
    NoRun { path: PathBuf, why: &'static str },
    #[error("another process is running in the folder {}: wait for it, or choose another folder", path.display())]
    Busy { path: PathBuf },
    #[error(
        "{} is not a file of an earlier run: move it away or choose another folder with --out",
        display_path(path)
    )]
    Foreign { path: PathBuf },
    #[error("cannot write to the folder {}: {source}; make it writable, or choose another", path.display())]
    Unwritable { path: PathBuf, source: std::io::Error },
    #[error(
        "cannot write {}: {source}; the folder is left without manifest.json, as incomplete",
        display_path(path)
    )]
    Write { path: PathBuf, source: std::io::Error },
    #[error(
        "cannot copy {} to {}: {source}; what is there is whole, and the command may be repeated",
        display_path(from),
        display_path(to)
    )]
    Copy {
        from: PathBuf,
        to: PathBuf,
        source: std::io::Error,
    },
    #[error(
        "{} was changed while the run went on, so that it does not tell what was run; the folder is left without \
         manifest.json, as incomplete: put the file back as it was",
        display_path(path)
    )]
    Changed { path: PathBuf },
    #[error("cannot read {}: {source}", display_path(path))]
    Read { path: PathBuf, source: std::io::Error },
}
