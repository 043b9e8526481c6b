//! Heights as the grey levels of a picture: PNG of 16 bits. The top row lies at the largest y.

use std::path::Path;

use png::{BitDepth, ColorType, Transformations};

use super::grid::{HeightGrid, Line, Take, points};
use crate::arrays::array_file::ArrayFile;
use crate::arrays::error::{ArrayError, contents_error};
use crate::arrays::mask::{decoding_error, png_reader};

pub(super) fn read(file: &mut ArrayFile, take: &mut Take) -> Result<HeightGrid, ArrayError> {
    let path = file.path;
    let mut reader = png_reader(file, Transformations::IDENTITY)?;
    let info = reader.info();
    match info.color_type {
        ColorType::Grayscale => {}
        ColorType::GrayscaleAlpha => return Err(beside_grey(path)),
        ColorType::Rgb | ColorType::Rgba | ColorType::Indexed => return Err(in_colours(path)),
    }
    if info.bit_depth != BitDepth::Sixteen {
        return Err(too_coarse(path, info.bit_depth as u8));
    }
    if info.interlaced {
        let problem = "is interlaced: save it without interlacing".to_owned();
        return Err(contents_error(path, problem));
    }
    let points = points(path, ".png", info.width.into(), info.height.into())?;
    let mut heights = vec![0.0; points[0]];
    let mut row = 0;
    while let Some(stored) = reader.next_row().map_err(|source| decoding_error(path, source))? {
        for (height, bytes) in heights.iter_mut().zip(stored.data().as_chunks().0) {
            *height = f64::from(u16::from_be_bytes(*bytes));
        }
        take(&Line::of_row(row, &heights))?;
        row += 1;
    }
    Ok(HeightGrid::without_units(points, true))
}

/// An error about a colour picture: its colours have no known order of heights.
pub(super) fn in_colours(path: &Path) -> ArrayError {
    let problem = "is a colour picture, which has no heights: export the heights as 16-bit grey levels, or as a .gsf, .x3p or \
                   .npy file";
    contents_error(path, problem.to_owned())
}

/// An error about a picture with channels other than grey levels.
pub(super) fn beside_grey(path: &Path) -> ArrayError {
    let problem = "has grey levels with a second channel, such as opacity (alpha): save only the grey levels, without transparency";
    contents_error(path, problem.to_owned())
}

/// An error about a picture with fewer bits than heights need.
pub(super) fn too_coarse(path: &Path, bits: u8) -> ArrayError {
    let problem = format!(
        "has grey levels of {bits} bits, too coarse for heights: export it with 16 bits, or as a .gsf, .x3p or .npy file"
    );
    contents_error(path, problem)
}
