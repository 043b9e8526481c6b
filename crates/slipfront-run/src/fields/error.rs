//! Why `fields.nc` cannot be written or read.

use std::io;
use std::path::PathBuf;

/// Why `fields.nc` cannot be written or read: one sentence that ends with the remedy.
#[derive(Debug, thiserror::Error)]
pub enum FieldsError {
    /// The lattice and its arrays do not fit together.
    #[error("cannot write `{}`: {what} has {found} values where {wanted} are wanted; hand over matching arrays", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// The array or size.
        what: String,
        /// Its length.
        found: usize,
        /// The length wanted.
        wanted: usize,
    },
    /// An array exceeds what one NetCDF-3 variable can hold.
    #[error(
        "cannot write `{}`: one field of {columns} x {rows} values takes more than the 2 GiB that the format holds; \
         set `output.stride` to {stride} or more",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Values along x, thinned.
        columns: usize,
        /// Values along y, thinned.
        rows: usize,
        /// The smallest stride that fits.
        stride: usize,
    },
    /// The file cannot be written.
    #[error("cannot write `{}`: {source}; check that the folder exists, is writable and has room", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file cannot be opened or read.
    #[error("cannot read `{}`: {source}; check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The bytes are not those of a fields file.
    #[error("`{}` is not a fields file of slipfront: {detail}; run the case again", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        detail: String,
    },
}
