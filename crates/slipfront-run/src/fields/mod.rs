//! `fields.nc`: what happens block by block, at a few instants of a run.
//!
//! The file is NetCDF-3 with 64-bit offsets and CF-1.8 attributes, so that xarray, ParaView, Octave and MATLAB
//! open it as it is. Fields have the dimensions (time, y, x), what never changes has (y, x); row j = 0 is the
//! smallest y. The file carries no date: equal input gives equal bytes. [`write_fields`] ends a run,
//! [`read_maps`] serves the pictures, [`read_fields`] whoever wants it all.

mod netcdf3_reader;
mod read;
mod write;

use std::io;
use std::path::PathBuf;

use slipfront::observe::Field;

pub use read::{read_fields, read_maps};
pub use write::write_fields;

/// What never changes in a run, block by block: `nx * ny` values each, row-major, row j = 0 first, not thinned.
#[derive(Debug, Clone, Copy)]
pub struct StaticFields<'a> {
    /// Whether the block is texture.
    pub textured: &'a [bool],
    /// Static friction coefficients.
    pub mu_static: &'a [f64],
    /// Kinetic friction coefficients.
    pub mu_kinetic: &'a [f64],
    /// Time t* of the first slip; NaN = never slipped.
    pub first_slip_time_star: &'a [f64],
}

/// The fields of one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldFrame {
    /// Time t*.
    pub time_star: f64,
    /// Name of the instant: `A` to `F`, several letters if they coincide, or empty.
    pub label: String,
    /// Number of the time step.
    pub step: u64,
    /// One array per name in [`FieldsFile::names`], in the unit of [`FieldInfo::unit`], thinned by [`thin`] and
    /// row-major.
    pub values: Vec<Vec<f32>>,
}

/// All that goes into `fields.nc`.
#[derive(Debug, Clone, Copy)]
pub struct FieldsFile<'a> {
    /// Number of blocks along x, before thinning.
    pub nx: usize,
    /// Number of blocks along y, before thinning.
    pub ny: usize,
    /// Every n-th block is kept, in both directions, from block 0 on.
    pub stride: usize,
    /// Edge of a block, in m.
    pub block_size: f64,
    /// Duration of one unit of t*, in s.
    pub time_unit_s: f64,
    /// The fields that every frame holds, each at most once.
    pub names: &'a [Field],
    /// What never changes.
    pub statics: StaticFields<'a>,
    /// The instants, in order of time; NetCDF wants each time once. There may be none.
    pub frames: &'a [FieldFrame],
}

/// The contents of a `fields.nc`; every array is thinned to `columns() * rows()` values and row-major.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldsData {
    /// Number of blocks along x, before thinning.
    pub nx: usize,
    /// Number of blocks along y, before thinning.
    pub ny: usize,
    /// Every n-th block is in the file, in both directions, from block 0 on.
    pub stride: usize,
    /// Edge of a block, in m.
    pub block_size: f64,
    /// Duration of one unit of t*, in s.
    pub time_unit_s: f64,
    /// The fields of every frame, in the order of [`FieldFrame::values`]; none if there are no frames.
    pub names: Vec<Field>,
    /// Whether the block is texture.
    pub textured: Vec<bool>,
    /// Static friction coefficients.
    pub mu_static: Vec<f64>,
    /// Kinetic friction coefficients.
    pub mu_kinetic: Vec<f64>,
    /// Time t* of the first slip; NaN = never slipped.
    pub first_slip_time_star: Vec<f64>,
    /// The instants, in order of time.
    pub frames: Vec<FieldFrame>,
}

impl FieldsData {
    /// Number of values along x.
    pub fn columns(&self) -> usize {
        self.nx.div_ceil(self.stride.max(1))
    }

    /// Number of values along y.
    pub fn rows(&self) -> usize {
        self.ny.div_ceil(self.stride.max(1))
    }
}

/// Keeps every `stride`-th value of every `stride`-th row, from the first on.
///
/// `values` is row-major with rows of `nx`; a `stride` of 0 counts as 1. The result has rows of
/// `nx.div_ceil(stride)`.
///
/// ```
/// # use slipfront_run::fields::thin;
/// assert_eq!(thin(&[0, 1, 2, 10, 11, 12, 20, 21, 22], 3, 2), [0, 2, 20, 22]);
/// ```
pub fn thin<T: Copy>(values: &[T], nx: usize, stride: usize) -> Vec<T> {
    let stride = stride.max(1);
    let rows = values.chunks(nx.max(1)).step_by(stride);
    rows.flat_map(|row| row.iter().step_by(stride)).copied().collect()
}

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

/// Names in the file that the writer and the reader share.
mod names {
    pub(super) const TIME: &str = "time";
    pub(super) const X: &str = "x";
    pub(super) const Y: &str = "y";
    pub(super) const LABEL_LENGTH: &str = "instant_length";
    pub(super) const TIME_STAR: &str = "time_star";
    pub(super) const STEP: &str = "step";
    pub(super) const LABEL: &str = "instant";
    pub(super) const TEXTURED: &str = "textured";
    pub(super) const MU_STATIC: &str = "mu_static";
    pub(super) const MU_KINETIC: &str = "mu_kinetic";
    pub(super) const FIRST_SLIP: &str = "first_slip_time_star";
    pub(super) const BLOCKS: &str = "blocks";
    pub(super) const STRIDE: &str = "stride";
    pub(super) const BLOCK_SIZE: &str = "block_size_m";
    pub(super) const TIME_UNIT: &str = "time_unit_s";
}

#[cfg(test)]
mod tests;
