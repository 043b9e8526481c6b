//! Heights as the grey levels of a TIFF picture with 16 bits or more, in strips or tiles. The top row lies at
//! the largest y.

use std::ops::Range;

use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use super::grid::{HeightGrid, Line, Take, points};
use super::image::{beside_grey, in_colours, too_coarse};
use crate::arrays::array_file::ArrayFile;
use crate::arrays::error::{ArrayError, broken, contents_error};

/// The largest strip or tile, in bytes.
const PIECE_MAX_BYTES: usize = 1 << 26;
/// Largest width of a tile that is wider than its picture: the decoder decodes all of its columns, however
/// few the picture has.
const TILE_MAX_WIDTH: u32 = 1 << 10;
/// Value of the tag for grey levels that rise towards black.
const WHITE_IS_ZERO: u32 = 0;
/// Value of the tag for rows from the top, each from the left.
const TOP_LEFT: u16 = 1;

pub(super) fn read(file: &mut ArrayFile, take: &mut Take) -> Result<HeightGrid, ArrayError> {
    let path = file.path;
    let unreadable = |error: TiffError| match error {
        TiffError::IoError(source) if source.kind() != std::io::ErrorKind::UnexpectedEof => {
            ArrayError::read(path)(source)
        }
        TiffError::LimitsExceeded => {
            let problem = format!(
                "has strips or tiles of more than {} MiB: save it in smaller ones",
                PIECE_MAX_BYTES >> 20
            );
            contents_error(path, problem)
        }
        other => broken(path, ".tif", &other.to_string()),
    };
    let mut limits = Limits::default();
    limits.decoding_buffer_size = PIECE_MAX_BYTES;
    limits.intermediate_buffer_size = PIECE_MAX_BYTES;
    let decoder = Decoder::new(&mut *file.source).map_err(unreadable)?;
    let mut decoder = decoder.with_limits(limits);
    let color = decoder.colortype().map_err(unreadable)?;
    match color {
        ColorType::Gray(_) => {}
        // Several numbers per pixel that are not a colour.
        ColorType::GrayA(_) | ColorType::Multiband { .. } => return Err(beside_grey(path)),
        _ => return Err(in_colours(path)),
    }
    if color.bit_depth() < 16 {
        return Err(too_coarse(path, color.bit_depth()));
    }
    let meaning = decoder.find_tag_unsigned::<u32>(Tag::PhotometricInterpretation);
    if meaning.map_err(unreadable)? == Some(WHITE_IS_ZERO) {
        let problem = "has grey levels in which 0 is white: save it with 0 as black, the lowest height";
        return Err(contents_error(path, problem.to_owned()));
    }
    let orientation = decoder
        .find_tag_unsigned::<u16>(Tag::Orientation)
        .map_err(unreadable)?;
    if let Some(other) = orientation.filter(|orientation| *orientation != TOP_LEFT) {
        let problem = format!(
            "says by `Orientation` = {other} that it is to be turned or mirrored before it is shown: save it as it is shown, with {TOP_LEFT}"
        );
        return Err(contents_error(path, problem));
    }
    if decoder.more_images() {
        let problem = "holds several pictures: save the height map alone";
        return Err(contents_error(path, problem.to_owned()));
    }
    let (width, height) = decoder.dimensions().map_err(unreadable)?;
    let points = points(path, ".tif", width.into(), height.into())?;
    // The height of a chunk is not checked: the last strip is shorter, and the stated height of a strip may
    // be the largest number.
    let (chunk_width, chunk_height) = decoder.chunk_dimensions();
    if chunk_width > width.max(TILE_MAX_WIDTH) {
        let problem = format!(
            "has tiles {chunk_width} pixels wide and is {width} wide itself: save it in strips, or in tiles of at most {TILE_MAX_WIDTH}"
        );
        return Err(contents_error(path, problem));
    }
    let across = width.div_ceil(chunk_width);
    let mut heights = Vec::new();
    for chunk in 0..across * height.div_ceil(chunk_height) {
        let decoded = decoder.read_chunk(chunk).map_err(unreadable)?;
        let (columns, rows) = decoder.chunk_data_dimensions(chunk);
        for row in 0..rows {
            let start = (row * columns) as usize;
            numbers(&decoded, start..start + columns as usize, &mut heights);
            take(&Line {
                row: (chunk / across * chunk_height + row) as usize,
                column: (chunk % across * chunk_width) as usize,
                heights: &heights,
            })?;
        }
    }
    Ok(HeightGrid::without_units(points, true))
}

/// Numbers of a strip or tile.
fn numbers(decoded: &DecodingResult, range: Range<usize>, numbers: &mut Vec<f64>) {
    numbers.clear();
    match decoded {
        DecodingResult::U8(stored) => numbers.extend(stored[range].iter().copied().map(f64::from)),
        DecodingResult::I8(stored) => numbers.extend(stored[range].iter().copied().map(f64::from)),
        DecodingResult::U16(stored) => numbers.extend(stored[range].iter().copied().map(f64::from)),
        DecodingResult::I16(stored) => numbers.extend(stored[range].iter().copied().map(f64::from)),
        DecodingResult::U32(stored) => numbers.extend(stored[range].iter().copied().map(f64::from)),
        DecodingResult::I32(stored) => numbers.extend(stored[range].iter().copied().map(f64::from)),
        DecodingResult::U64(stored) => numbers.extend(stored[range].iter().map(|&number| number as f64)),
        DecodingResult::I64(stored) => numbers.extend(stored[range].iter().map(|&number| number as f64)),
        DecodingResult::F16(stored) => numbers.extend(stored[range].iter().map(|number| number.to_f64())),
        DecodingResult::F32(stored) => numbers.extend(stored[range].iter().copied().map(f64::from)),
        DecodingResult::F64(stored) => numbers.extend_from_slice(&stored[range]),
    }
}
