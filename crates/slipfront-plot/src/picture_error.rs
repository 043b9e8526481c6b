//! Errors of making a picture.

/// Error of a picture that could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum PictureError {
    #[error("there is no {0} to draw")]
    Nothing(&'static str),
    #[error("curve `{label}` has {count} {counted} but {values} values of {column}")]
    Columns {
        label: String,
        count: usize,
        counted: &'static str,
        values: usize,
        column: &'static str,
    },
    #[error("a map of {columns} x {rows} cells has {values} values")]
    Cells {
        columns: usize,
        rows: usize,
        values: usize,
    },
    #[error("the axis `{title}` cannot be divided into cells: {reason}")]
    CellAxis { title: String, reason: &'static str },
    #[error("a lattice of {nx} x {ny} blocks cannot be drawn")]
    Lattice { nx: usize, ny: usize },
    #[error("a block size of {0} m cannot be drawn")]
    BlockSize(String),
    #[error("{what} has {found} values instead of {expected}")]
    Blocks {
        what: String,
        found: usize,
        expected: usize,
    },
    #[error(
        "a {side} of {mm} mm leaves no room for curves with text of {font_pt} pt: use at least {least_mm} mm"
    )]
    TooSmall {
        side: &'static str,
        mm: f64,
        least_mm: f64,
        font_pt: f64,
    },
    #[error("the height of a map follows from the shape of the slider: give only a width")]
    HeightOfMaps,
    #[error("the PNG could not be written: {0}")]
    Png(String),
    #[error("the GIF could not be written: {0}")]
    Gif(String),
}

/// Refuses a curve with a column that does not have one value for each point; `counted` is the word for the
/// points.
pub(crate) fn check_columns(
    label: &str,
    (counted, count): (&'static str, usize),
    columns: &[(&'static str, usize)],
) -> Result<(), PictureError> {
    let Some(&(column, values)) = columns.iter().find(|(_, values)| *values != count) else {
        return Ok(());
    };
    Err(PictureError::Columns {
        label: label.to_string(),
        count,
        counted,
        values,
        column,
    })
}
