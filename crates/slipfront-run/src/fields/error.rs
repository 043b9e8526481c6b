//! Why `fields.nc` cannot be written or read.

use std::io;
use std::path::PathBuf;

/// Why `fields.nc` cannot be written or read: one sentence that ends with the remedy.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum FieldsError {
    #[error("cannot write `{}`: {what} has {found} values where {wanted} are wanted; hand over matching arrays", path.display())]
    Shape {
        path: PathBuf,
        what: String,
        found: usize,
        wanted: usize,
    },
    #[error(
        "cannot write `{}`: one field of {columns} x {rows} values takes more than the 2 GiB that the format holds; \
         set `output.stride` to {stride} or more",
        path.display()
    )]
    TooLarge {
        path: PathBuf,
        columns: usize,
        rows: usize,
        stride: usize,
    },
    #[error("cannot write `{}`: {source}; check that the folder exists, is writable and has room", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot read `{}`: {source}; check the path and its permissions", path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error("`{}` is not a fields file of slipfront: {detail}; run the case again", path.display())]
    Broken { path: PathBuf, detail: String },
}
