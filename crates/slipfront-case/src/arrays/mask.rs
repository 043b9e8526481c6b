//! Masks as PNG images: dark pixels are texture.

use std::io::{self, BufRead, ErrorKind, Seek, SeekFrom};
use std::path::Path;

use png::{BitDepth, ColorType, Decoder, DecodingError, Encoder, EncodingError, Reader, Transformations};

use super::array_file::{ArrayFile, ReadAnywhere};
use super::error::{ArrayError, broken};
use super::pixels::limit_pixels;
use super::slab::Slab;

/// Largest compression ratio: deflate packs at most about 1030 bytes into one.
const DEFLATE_MAX_RATIO: u64 = 1040;

/// Reads a mask for some rows of a lattice of `nx` x `ny` blocks from a PNG image called `path`, of any
/// colour type and depth.
///
/// The image is stretched over the slider, and a block is textured if the pixel at its centre is dark.
/// Returns the values in row-major order, the smallest y (the bottom of the image) first. All pixels are
/// read, but only those at the centres are kept.
///
/// A pixel is dark when its luminance, in 0 to 1, lies below `threshold`. The luminance is
///
/// ```text
/// 0.2126 R + 0.7152 G + 0.0722 B
/// ```
///
/// (Rec. 709) of the stored values, whatever gamma or colour profile the file names; a transparent pixel is
/// laid over white.
///
/// # Errors
/// [`ArrayError`] if the file is not a PNG image, corrupt, or has more than 2^28 pixels, or more than 2^20
/// along a side.
pub fn mask_png(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    threshold: f64,
    slab: &Slab,
) -> Result<Vec<bool>, ArrayError> {
    let mut file = ArrayFile { path, source };
    let reader = png_reader(&mut file, Transformations::EXPAND)?;
    read_rows(path, reader, threshold, slab)
}

/// Opens a PNG image of any colour type and depth, and checks its size and palette.
pub(super) fn png_reader<'f, 'a>(
    file: &'f mut ArrayFile<'a>,
    transformations: Transformations,
) -> Result<Reader<&'f mut (dyn ReadAnywhere + 'a)>, ArrayError> {
    let (path, source) = (file.path, &mut *file.source);
    let read_error = ArrayError::read(path);
    let file_bytes = source.seek(SeekFrom::End(0)).map_err(&read_error)?;
    source.rewind().map_err(&read_error)?;
    let unreadable = |source| decoding_error(path, source);
    let mut decoder = Decoder::new(source);
    decoder.set_transformations(transformations);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let info = decoder.read_header_info().map_err(unreadable)?;
    let pixels = u64::from(info.width) * u64::from(info.height);
    limit_pixels(path, info.width.into(), info.height.into())?;
    let packed_bytes = pixels * info.bits_per_pixel() as u64 / 8 / DEFLATE_MAX_RATIO;
    if file_bytes < packed_bytes {
        let detail = format!(
            "it has {file_bytes} bytes where its {} x {} pixels take at least {packed_bytes}",
            info.width, info.height
        );
        return Err(broken(path, ".png", &detail));
    }
    let reader = decoder.read_info().map_err(unreadable)?;
    if reader.info().color_type == ColorType::Indexed {
        check_palette(path, reader.info().palette.as_deref())?;
    }
    Ok(reader)
}

/// Refuses a palette that is not made of 1 to 256 whole colours: the decoder accepts any length, and panics
/// on a wrong one.
fn check_palette(path: &Path, palette: Option<&[u8]>) -> Result<(), ArrayError> {
    let bytes = palette.map_or(0, <[u8]>::len);
    if bytes.is_multiple_of(3) && (3..=768).contains(&bytes) {
        return Ok(());
    }
    let detail = format!("its palette has {bytes} bytes where 3 for each of 1 to 256 colours are wanted");
    Err(broken(path, ".png", &detail))
}

/// Decodes row by row, and keeps only the pixels at the centres of the blocks.
fn read_rows(
    path: &Path,
    mut reader: Reader<impl BufRead + Seek>,
    threshold: f64,
    slab: &Slab,
) -> Result<Vec<bool>, ArrayError> {
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let (color, depth) = reader.output_color_type();
    let pixel_bytes = color.samples() * if depth == BitDepth::Sixteen { 2 } else { 1 };
    let mut lines = lines(width, height, reader.info().interlaced);
    // The pixel at the centre of each block, along a row from the left and along a column from the top.
    let pixel = |block: usize, blocks: usize, pixels: usize| (2 * block + 1) * pixels / (2 * blocks);
    let Slab { nx, ny, ref rows } = *slab;
    let columns: Vec<usize> = (0..nx).map(|i| pixel(i, nx, width)).collect();
    // The rows of blocks from the top, in the order of the image.
    let from_top: Vec<usize> = rows
        .clone()
        .rev()
        .map(|j| pixel(ny - 1 - j, ny, height))
        .collect();
    let mut dark = vec![false; slab.n_blocks()];
    while let Some(stored) = reader.next_row().map_err(|source| decoding_error(path, source))? {
        let Some(line) = lines.next() else { break };
        let first = from_top.partition_point(|&row| row < line.row);
        for k in (first..from_top.len()).take_while(|&k| from_top[k] == line.row) {
            let blocks = &mut dark[(from_top.len() - 1 - k) * nx..][..nx];
            for (block, &column) in blocks.iter_mut().zip(&columns) {
                if let Some(at) = line.position(column) {
                    let pixel = &stored.data()[at * pixel_bytes..][..pixel_bytes];
                    *block = luminance(pixel, color, depth) < threshold;
                }
            }
        }
    }
    Ok(dark)
}

/// Pixels of a row of the image that are stored consecutively.
struct PixelLine {
    row: usize,
    first: usize,
    step: usize,
}

impl PixelLine {
    /// Position of the pixel of this column, if the line contains it.
    fn position(&self, column: usize) -> Option<usize> {
        let behind = column.checked_sub(self.first)?;
        behind.is_multiple_of(self.step).then_some(behind / self.step)
    }
}

/// The lines of an image in the order in which they are stored: row by row, or in the seven passes of Adam7.
fn lines(width: usize, height: usize, interlaced: bool) -> impl Iterator<Item = PixelLine> {
    /// First column and row, and steps between columns and rows.
    const ADAM7: [[usize; 4]; 7] = [
        [0, 0, 8, 8],
        [4, 0, 8, 8],
        [0, 4, 4, 8],
        [2, 0, 4, 4],
        [0, 2, 2, 4],
        [1, 0, 2, 2],
        [0, 1, 1, 2],
    ];
    let passes = if interlaced { &ADAM7[..] } else { &[[0, 0, 1, 1]] };
    let passes = passes.iter().filter(move |[column, ..]| *column < width);
    passes.flat_map(move |&[first, row, step, row_step]| {
        let rows = (row..height).step_by(row_step);
        rows.map(move |row| PixelLine { row, first, step })
    })
}

/// The Rec. 709 luminance of one pixel on white, in 0 to 1. Samples have been expanded to at least 8 bits.
fn luminance(pixel: &[u8], color: ColorType, depth: BitDepth) -> f64 {
    let sample = |index: usize| match depth {
        BitDepth::Sixteen => {
            f64::from(u16::from_be_bytes([pixel[2 * index], pixel[2 * index + 1]])) / 65535.0
        }
        _ => f64::from(pixel[index]) / 255.0,
    };
    let rec_709 = || 0.2126 * sample(0) + 0.7152 * sample(1) + 0.0722 * sample(2);
    let (luminance, opacity) = match color {
        ColorType::Grayscale => (sample(0), 1.0),
        ColorType::GrayscaleAlpha => (sample(0), sample(1)),
        ColorType::Rgba => (rec_709(), sample(3)),
        // Palettes have been expanded.
        ColorType::Rgb | ColorType::Indexed => (rec_709(), 1.0),
    };
    opacity * luminance + (1.0 - opacity)
}

pub(super) fn decoding_error(path: &Path, source: DecodingError) -> ArrayError {
    match source {
        DecodingError::IoError(source) if source.kind() != ErrorKind::UnexpectedEof => {
            ArrayError::read(path)(source)
        }
        DecodingError::IoError(_) => broken(path, ".png", "it ends before the last pixel"),
        other => broken(path, ".png", other.to_string().trim_end_matches('.')),
    }
}

/// The bytes of a black and white PNG image of a texture: one pixel per block, textured = black.
///
/// `textured` holds `nx * ny` values in row-major order, row j = 0 (the smallest y) first; the top row of the
/// image is the largest y. [`mask_png`] with this lattice reads the mask back.
///
/// # Errors
/// When there is no block, more blocks along a side than an image can have, or another number of values.
pub fn png_of_mask(nx: usize, ny: usize, textured: &[bool]) -> io::Result<Vec<u8>> {
    if textured.len() != nx * ny || textured.is_empty() {
        let sentence = format!("{} blocks are no image of {nx} x {ny} pixels", textured.len());
        return Err(io::Error::other(sentence));
    }
    encode(nx, ny, textured).map_err(io::Error::other)
}

/// PNG image in memory: one bit per pixel, 1 = white.
fn encode(nx: usize, ny: usize, textured: &[bool]) -> Result<Vec<u8>, EncodingError> {
    let mut rows = Vec::with_capacity(nx.div_ceil(8) * ny);
    for row in textured.chunks(nx).rev() {
        rows.extend(row.chunks(8).map(|eight| {
            let bits = eight.iter().enumerate();
            bits.fold(0, |byte, (bit, textured)| byte | u8::from(!textured) << (7 - bit))
        }));
    }
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, nx as u32, ny as u32);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::One);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rows)?;
    writer.finish()?;
    Ok(bytes)
}
