//! Reasons why a run cannot be resumed from a checkpoint.

use std::path::PathBuf;

use slipfront_case::same_on_ranks::Difference;
use thiserror::Error;

/// Version of the file's layout. A program reads no other layout.
pub(super) const LAYOUT: u32 = 6;

/// Reason why a run cannot be resumed from a checkpoint.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum CheckpointError {
    #[error("cannot read {path}: {source}")]
    Unreadable { path: PathBuf, source: std::io::Error },
    #[error("{path} is damaged: {why}")]
    Damaged { path: PathBuf, why: &'static str },
    #[error(
        "{path} has layout {found}, but this version reads layout {LAYOUT}: resume with the version that wrote it"
    )]
    Layout { path: PathBuf, found: u32 },
    #[error(
        "{path} was written by {found}; this is {here}, which may not give bit-identical results: resume with the version that wrote it"
    )]
    Program {
        path: PathBuf,
        found: String,
        here: &'static str,
    },
    #[error("{path} does not belong to the case.toml and inputs in its folder")]
    Case { path: PathBuf },
    #[error(transparent)]
    Differs(#[from] Difference),
}
