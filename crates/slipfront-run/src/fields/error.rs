//! Why `fields.nc` cannot be written or read.

use std::io;
use std::path::PathBuf;

/// Why `fields.nc` cannot be written or read: one sentence that ends with the remedy.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum FieldsError {
    #[error(
        "cannot write `{path}`: {what} has {found} values where {wanted} are wanted; hand over matching arrays"
    )]
    Shape {
        path: PathBuf,
        what: String,
        found: usize,
        wanted: usize,
    },
    #[error(
        "cannot write `{path}`: one field of {columns} x {rows} values takes more than the 2 GiB that the format holds; \
         set `output.stride` to {stride} or more"
    )]
    TooLarge {
        path: PathBuf,
        columns: usize,
        rows: usize,
        stride: usize,
    },
    #[error("cannot write `{path}`: {source}; check that the folder exists, is writable and has room")]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot read `{path}`: {source}; check the path and its permissions")]
    Read { path: PathBuf, source: io::Error },
    #[error("`{path}` is not a fields file of slipfront: {detail}; run the case again")]
    Broken { path: PathBuf, detail: String },
}
