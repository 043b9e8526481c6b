//! A finished picture, and why one could not be made.

/// One picture in both formats, ready to be written to files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// An SVG document that carries its own font.
    pub svg: String,
    /// A PNG file, 300 dots per inch.
    pub png: Vec<u8>,
}

/// Why a picture could not be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PictureError {
    /// There is nothing to draw.
    #[error("there is no {0} to draw")]
    Nothing(&'static str),
    /// The columns of a curve differ in length.
    #[error("curve `{label}` has {times} times but {values} values of {column}")]
    Columns {
        /// The curve's label.
        label: String,
        /// How many times the curve has.
        times: usize,
        /// The column that differs.
        column: &'static str,
        /// How many values it has.
        values: usize,
    },
    /// The columns of a response curve differ in length.
    #[error("curve `{label}` has {points} points but {values} values of its {column}")]
    Points {
        /// The curve's label.
        label: String,
        /// How many points the curve has.
        points: usize,
        /// The column that differs.
        column: &'static str,
        /// How many values it has.
        values: usize,
    },
    /// A map does not have one value for every cell.
    #[error("a map of {columns} x {rows} cells has {values} values")]
    Cells {
        /// Cells along x.
        columns: usize,
        /// Cells along y.
        rows: usize,
        /// How many values it has.
        values: usize,
    },
    /// A map's axis cannot be divided into cells.
    #[error("the axis `{title}` cannot be divided into cells: {reason}")]
    CellAxis {
        /// The axis' title.
        title: String,
        /// Why.
        reason: &'static str,
    },
    /// The lattice has no block, or more than can be counted.
    #[error("a lattice of {nx} x {ny} blocks cannot be drawn")]
    Lattice {
        /// Blocks along x.
        nx: usize,
        /// Blocks along y.
        ny: usize,
    },
    /// The block size is not a positive length.
    #[error("a block size of {0} m cannot be drawn")]
    BlockSize(String),
    /// An array over blocks does not match the lattice.
    #[error("{what} has {found} values, but the lattice has {expected} blocks")]
    Blocks {
        /// The array.
        what: String,
        /// How many values it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// The pixels could not be made into a PNG file.
    #[error("the PNG could not be written: {0}")]
    Png(String),
}
