//! The `.npy` files of numpy.

use std::io::{BufRead, Seek, SeekFrom};
use std::path::Path;

use super::array_file::ArrayFile;
use super::error::{ArrayError, broken, contents_error, value_error};
use super::npy_header::NpyHeader;
use super::number_type::NumberType;
use super::pixels::{SIDE_MAX, limit_pixels};
use super::slab::Slab;
use slipfront_base::text::truncated;

/// Largest length of a header; numpy itself refuses longer ones.
pub(super) const HEADER_MAX_BYTES: u64 = 10_000;

/// Reads a mask for some rows from a `.npy` file called `path`, of shape (ny, nx): 1 or true = textured, 0 or
/// false = not.
///
/// Any real, integer or boolean type is accepted, in either byte and memory order. Returns the values in
/// row-major order, the smallest y first.
///
/// # Errors
/// [`ArrayError`] if the file is not a `.npy` file, has another shape, or has another value: a picture or a
/// height map does not define unambiguously what is textured.
pub fn mask_npy(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    slab: &Slab,
) -> Result<Vec<bool>, ArrayError> {
    let wanted = "0 or 1 (1 is a dark pixel)";
    let values = values(&mut ArrayFile { path, source }, slab, wanted, |value| {
        ![0.0, 1.0].contains(&value)
    })?;
    Ok(values.iter().map(|value| *value == 1.0).collect())
}

/// Reads the last state of a run for some rows from a `.npy` file called `path`, of shape (4, ny, nx): the
/// displacements of each block along x and y, and its velocities along both.
///
/// # Errors
/// If the file is not a `.npy` file, of another shape or memory order, or has a value that is not finite.
pub fn state_npy(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    slab: &Slab,
) -> Result<[Vec<f64>; 4], ArrayError> {
    let Slab { nx, ny, ref rows } = *slab;
    let mut file = ArrayFile { path, source };
    let mut array = NpyArray::open(&mut file, |shape| {
        if shape == [4, ny as u64, nx as u64] {
            Ok([4 * ny, nx])
        } else {
            let problem = format!(
                "has the shape {} where the last state of a run of {nx} x {ny} blocks has (4, {ny}, {nx}); name `state.npy` of a run \
                 with `output.final_state` and these blocks",
                in_brackets(shape)
            );
            Err(contents_error(path, problem))
        }
    })?;
    if array.fortran_order {
        let problem = "has the first axis fastest; save the array with `np.ascontiguousarray`".to_owned();
        return Err(contents_error(path, problem));
    }
    let mut found = [(); 4].map(|()| vec![0.0; slab.n_blocks()]);
    for (layer, values) in found.iter_mut().enumerate() {
        array.read((layer * ny + rows.start) * nx, values)?;
    }
    // Searches by block, not by layer, so that the lowest rank with an error has the first one.
    let wrong = |b: usize| {
        found
            .iter()
            .map(|values| values[b])
            .find(|value| !value.is_finite())
    };
    if let Some((b, value)) = (0..slab.n_blocks()).find_map(|b| Some((b, wrong(b)?))) {
        let place = [rows.start + b / nx, b % nx];
        return Err(value_error(path, &value.to_string(), place, "a finite number"));
    }
    Ok(found)
}

/// The rows of a slab of an array of shape (ny, nx), in row-major order.
pub(super) fn values(
    file: &mut ArrayFile,
    slab: &Slab,
    wanted: &str,
    is_wrong: impl Fn(f64) -> bool,
) -> Result<Vec<f64>, ArrayError> {
    let Slab { nx, ny, ref rows } = *slab;
    let path = file.path;
    let mut array = NpyArray::open(file, |shape| {
        if shape == [ny as u64, nx as u64] {
            Ok([ny, nx])
        } else {
            Err(wrong_shape(path, shape, nx, ny))
        }
    })?;
    let mut values = vec![0.0; slab.n_blocks()];
    if array.fortran_order {
        let mut of_column = vec![0.0; rows.len()];
        for column in 0..nx {
            array.read(column * ny + rows.start, &mut of_column)?;
            let places = values.iter_mut().skip(column).step_by(nx);
            places.zip(&of_column).for_each(|(place, value)| *place = *value);
        }
    } else {
        array.read(rows.start * nx, &mut values)?;
    }
    if let Some(at) = values.iter().position(|value| is_wrong(*value)) {
        let place = [rows.start + at / nx, at % nx];
        return Err(value_error(path, &values[at].to_string(), place, wanted));
    }
    Ok(values)
}

/// Reads an array of any size in the order of its file, and returns its columns and rows. `take` gets
/// consecutive numbers of a row, with their row, counted along the first axis, and the column of the first
/// number.
pub(super) fn rows(
    file: &mut ArrayFile,
    mut take: impl FnMut([usize; 2], &[f64]) -> Result<(), ArrayError>,
) -> Result<[u64; 2], ArrayError> {
    /// Number of values in memory at once: at least the largest number along a side.
    const BAND: usize = SIDE_MAX as usize;
    let path = file.path;
    let mut array = NpyArray::open(file, |shape| {
        let &[height, width] = shape else {
            let problem = format!(
                "has {} axes where a height map has two, (ny, nx): save the heights alone, and no colours",
                shape.len()
            );
            return Err(contents_error(path, problem));
        };
        limit_pixels(path, width, height)?;
        Ok([height as usize, width as usize])
    })?;
    let [ny, nx] = array.shape;
    // Rows, or columns if the array is in Fortran order.
    let (count, length) = if array.fortran_order { (nx, ny) } else { (ny, nx) };
    let at_once = BAND / length.max(1);
    let mut numbers = Vec::new();
    let mut of_row = Vec::new();
    for first in (0..count).step_by(at_once) {
        numbers.resize(at_once.min(count - first) * length, 0.0);
        array.read(first * length, &mut numbers)?;
        if array.fortran_order {
            for row in 0..ny {
                of_row.clear();
                of_row.extend(numbers.iter().skip(row).step_by(ny));
                take([row, first], &of_row)?;
            }
        } else {
            for (row, numbers) in (first..).zip(numbers.chunks_exact(length.max(1))) {
                take([row, 0], numbers)?;
            }
        }
    }
    Ok([nx as u64, ny as u64])
}

/// An open array file.
struct NpyArray<'f, 'a> {
    file: &'f mut ArrayFile<'a>,
    number: NumberType,
    /// Whether columns are contiguous, rather than rows.
    fortran_order: bool,
    /// Rows and columns.
    shape: [usize; 2],
    /// Index of the next number in the source.
    at: usize,
}

impl<'f, 'a> NpyArray<'f, 'a> {
    /// Opens an array that has the wanted `shape`.
    fn open(
        file: &'f mut ArrayFile<'a>,
        shape: impl FnOnce(&[u64]) -> Result<[usize; 2], ArrayError>,
    ) -> Result<Self, ArrayError> {
        let path = file.path;
        let (length, head) = file.length_and_head(HEADER_MAX_BYTES)?;
        let (header, data_start) = read_header(&head, path)?;
        let number = header.plain_type().and_then(NumberType::from_name).ok_or_else(|| {
            let problem = format!(
                "holds values of type {} where real numbers, integers or booleans are wanted; convert the array with \
                 `.astype(float)` before saving it",
                truncated(header.descr)
            );
            contents_error(path, problem)
        })?;
        let shape = shape(&header.shape)?;
        let wanted = data_start as u64 + number.size as u64 * shape[0] as u64 * shape[1] as u64;
        if length != wanted {
            let detail = format!("it has {length} bytes, but its header requires {wanted}");
            return Err(broken(path, ".npy", &detail));
        }
        let start = SeekFrom::Start(data_start as u64);
        file.source.seek(start).map_err(ArrayError::read(path))?;
        Ok(Self {
            file,
            number,
            fortran_order: header.fortran_order,
            shape,
            at: 0,
        })
    }

    /// Reads consecutive numbers, beginning with the number of index `start`.
    fn read(&mut self, start: usize, numbers: &mut [f64]) -> Result<(), ArrayError> {
        let read_error = ArrayError::read(self.file.path);
        let size = self.number.size;
        // No seek if the numbers follow directly, so that buffered bytes are not read again.
        if start != self.at {
            let ahead = (start as i64 - self.at as i64) * size as i64;
            self.file.source.seek_relative(ahead).map_err(&read_error)?;
        }
        self.at = start + numbers.len();
        let mut piece = [0; 8192];
        for numbers in numbers.chunks_mut(piece.len() / size) {
            let stored = &mut piece[..numbers.len() * size];
            self.file.source.read_exact(stored).map_err(&read_error)?;
            self.number.decode(stored, numbers);
        }
        Ok(())
    }
}

/// The bytes of a `.npy` file of the shape (ny, nx) that holds a mask of rows of `nx` blocks, the smallest y
/// first. [`mask_npy`] reads it back.
pub fn npy_of_mask(nx: usize, textured: &[bool]) -> Vec<u8> {
    let ny = textured.len() / nx.max(1);
    let data = textured.iter().map(|&is_textured| u8::from(is_textured));
    head("|b1", &[ny, nx]).into_iter().chain(data).collect()
}

/// The bytes before the numbers in a `.npy` file that holds the last state of `nx` x `ny` blocks: four layers
/// of 64-bit numbers, which [`state_npy`] reads back.
pub fn head_of_state(nx: usize, ny: usize) -> Vec<u8> {
    head("<f8", &[4, ny, nx])
}

/// The bytes before the numbers in a `.npy` file of this type and shape.
fn head(descr: &str, shape: &[usize]) -> Vec<u8> {
    const BEFORE_HEADER: usize = 10;
    let sizes: Vec<String> = shape.iter().map(ToString::to_string).collect();
    let sizes = sizes.join(", ");
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({sizes}), }}");
    // Numpy begins the data at a multiple of 64 bytes, after a line break.
    let blanks = 63 - (BEFORE_HEADER + header.len()) % 64;
    header.extend(std::iter::repeat_n(' ', blanks));
    header.push('\n');
    let length = (header.len() as u16).to_le_bytes();
    [&b"\x93NUMPY\x01\x00"[..], &length, header.as_bytes()].concat()
}

/// Reads the header from the first bytes of a file; returns it with the number of bytes before the data.
fn read_header<'a>(head: &'a [u8], path: &Path) -> Result<(NpyHeader<'a>, usize), ArrayError> {
    let refuse = |detail: &str| broken(path, ".npy", detail);
    if !head.starts_with(b"\x93NUMPY") {
        return Err(refuse("it does not begin with the signature of numpy"));
    }
    let (text_start, text_bytes) = match head {
        [_, _, _, _, _, _, 1, _, a, b, ..] => (10, usize::from(u16::from_le_bytes([*a, *b]))),
        [_, _, _, _, _, _, 2 | 3, _, a, b, c, d, ..] => (12, u32::from_le_bytes([*a, *b, *c, *d]) as usize),
        [_, _, _, _, _, _, major, minor, ..] if !(1..=3).contains(major) => {
            let detail = format!("its format version is {major}.{minor}, known are 1.0 to 3.0");
            return Err(refuse(&detail));
        }
        _ => return Err(refuse("it ends inside the header")),
    };
    let data_start = text_start + text_bytes;
    let Some(text) = head.get(text_start..data_start) else {
        let detail =
            format!("its header of {data_start} bytes is cut short or longer than {HEADER_MAX_BYTES} bytes");
        return Err(refuse(&detail));
    };
    let header = NpyHeader::parse(text)
        .ok_or_else(|| refuse("its header is corrupt or does not describe a plain array of numbers"))?;
    Ok((header, data_start))
}

fn wrong_shape(path: &Path, found: &[u64], nx: usize, ny: usize) -> ArrayError {
    let remedy = if found == [nx as u64, ny as u64] {
        "transpose the array before saving it"
    } else {
        "save one value per block, or change `blocks`"
    };
    let sizes = in_brackets(found);
    let problem = format!("has the shape {sizes} where ({ny}, {nx}), that is (ny, nx), is wanted; {remedy}");
    contents_error(path, problem)
}

/// A shape as numpy prints it.
fn in_brackets(shape: &[u64]) -> String {
    let sizes: Vec<String> = shape.iter().map(u64::to_string).collect();
    format!("({})", sizes.join(", "))
}
