//! Errors of run folders.

use std::path::{Path, PathBuf};

use slipfront_base::text::display_path;
use slipfront_case::nearest::why_unread;
use thiserror::Error;

use crate::manifest::ManifestError;
use crate::resume_command::resume_command;

/// An error of a run folder.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum FolderError {
    #[error(
        "the folder {path} is not empty: choose another with --out, or replace slipfront's own files in it with --force"
    )]
    NotEmpty { path: PathBuf },
    #[error(
        "the folder {path} contains an interrupted run: resume it with `{}`, choose another folder with --out, or start again \
         with --force",
        resume_command("slipfront", path)
    )]
    Interrupted { path: PathBuf },
    #[error("{path} is not the folder of a run that can be resumed: {why}")]
    NoRun { path: PathBuf, why: &'static str },
    #[error("another process is running in the folder {path}: wait for it, or choose another folder")]
    Busy { path: PathBuf },
    #[error(
        "{} is not a file of an earlier run: move it away, or choose another folder",
        display_path(path)
    )]
    Foreign { path: PathBuf },
    #[error(
        "{} was changed after the run wrote it: move it away, or choose another folder",
        display_path(path)
    )]
    Edited { path: PathBuf },
    #[error("{0}; move it away, or choose another folder")]
    Manifest(#[from] ManifestError),
    #[error("cannot write to the folder {path}: {source}; make it writable, or choose another folder")]
    Unwritable { path: PathBuf, source: std::io::Error },
    #[error(
        "cannot write {}: {source}; the folder is incomplete and has no manifest.json",
        display_path(path)
    )]
    Write { path: PathBuf, source: std::io::Error },
    #[error(
        "cannot copy {} to {}: {source}; the files copied so far are complete, and the command can be repeated",
        display_path(from),
        display_path(to)
    )]
    Copy {
        from: PathBuf,
        to: PathBuf,
        source: std::io::Error,
    },
    #[error(
        "{} was changed during the run, so it no longer describes the run; the folder is incomplete and has no manifest.json: \
         restore the file",
        display_path(path)
    )]
    Changed { path: PathBuf },
    #[error(
        "{} was changed after the case was prepared: run the case again, and do not change this file during the run",
        display_path(path)
    )]
    InputChanged { path: PathBuf },
    #[error("cannot read {}: {}", display_path(path), why_unread(path, source))]
    Read { path: PathBuf, source: std::io::Error },
}

impl FolderError {
    /// An error of the system about a folder that should be written to.
    pub fn unwritable(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |source| Self::Unwritable {
            path: path.to_owned(),
            source,
        }
    }

    /// An error of the system about a file that should be written.
    pub fn write(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |source| Self::Write {
            path: path.to_owned(),
            source,
        }
    }

    /// An error of the system about a file or folder that should be read.
    pub fn read(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |source| Self::Read {
            path: path.to_owned(),
            source,
        }
    }
}
