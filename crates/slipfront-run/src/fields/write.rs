//! Writing: the header, the entries of a record about its instant, and the rows of blocks, each at its place.

use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

use slipfront::communicator::Communicator;
use slipfront::observe::Field;
use slipfront_case::field_info::field_info;
use tempfile::TempPath;

use super::definition::define;
use super::frame::*;
use super::netcdf3::StoredNumber;
use super::netcdf3_header::{HeaderBytes, ValuePlace};
use crate::shared_file::write_shared;

/// Number of bytes in the write buffer.
const BUFFER: usize = 1 << 18;

/// Padding of a variable of 16-bit numbers after an odd number of them: the beginning of NetCDF's fill value.
const SHORT_PADDING: [u8; 2] = [0x80, 0x01];

/// Writes the `fields.nc` that will be at `path` to a temporary file in a folder on the same file system.
/// Each rank writes the rows that it holds.
///
/// The file is complete and synced to disk. Only the first rank returns it, and renames it (`persist`).
/// Coordinates are the block centres in m and the time in s; fields are float32, constant arrays are float64.
///
/// # Errors
///
/// [`FieldsError::Write`] if the file cannot be written in full, on any rank.
pub fn write_fields(
    temporary: &Path,
    path: &Path,
    file: &FieldsData,
    communicator: &dyn Communicator,
) -> Result<Option<TempPath>, FieldsError> {
    let writer = FieldsWriter::new(file);
    let written = write_shared(
        temporary,
        communicator,
        |output| writer.create(output),
        |output| writer.write_rows(output),
    );
    written.map_err(|source| FieldsError::Write {
        path: path.to_owned(),
        source,
    })
}

/// A fields file with a known layout, so that processes that each hold some rows of the lattice can write it
/// together: one of them [creates](Self::create) it, and each [writes its rows](Self::write_rows) into it.
pub struct FieldsWriter<'a> {
    file: &'a FieldsData,
    header: HeaderBytes,
}

impl<'a> FieldsWriter<'a> {
    /// Computes the layout of the file. It depends only on the sizes, so it is the same in every process.
    ///
    /// # Panics
    /// If an array has another length than the others.
    pub fn new(file: &'a FieldsData) -> Self {
        let coefficients = [&file.mu_static, &file.mu_kinetic, &file.first_slip_time_star].map(Vec::len);
        let fields = file.frames.iter().flat_map(|frame| &frame.values).map(Vec::len);
        let is_alike = |length: usize| length == file.textured.len();
        assert!(
            coefficients.into_iter().chain(fields).all(is_alike),
            "arrays of a file have other lengths than its texture"
        );
        Self {
            file,
            header: define(file).header(),
        }
    }

    /// Writes everything except the values of blocks, which may have been written before.
    pub fn create(&self, output: impl Write + Seek) -> io::Result<()> {
        let file = self.file;
        let mut output = BufWriter::with_capacity(BUFFER, output);
        output.write_all(&self.header.bytes)?;
        for place in &self.header.places {
            // If there are no frames, the file has only constant arrays.
            let frame = file.frames.get(place.record);
            match (place.variable, frame) {
                (Y, _) => write_at(&mut output, place, 0, centers(file.ny, file))?,
                (X, _) => write_at(&mut output, place, 0, centers(file.nx, file))?,
                (TEXTURED, _) => {
                    let flags = file.rows() * file.columns();
                    let padding = i16::from_be_bytes(SHORT_PADDING);
                    write_at(&mut output, place, flags, (0..place.padding / 2).map(|_| padding))?;
                }
                (TIME, Some(frame)) => {
                    write_at(&mut output, place, 0, [frame.time_star * file.time_unit_s])?;
                }
                (TIME_STAR, Some(frame)) => write_at(&mut output, place, 0, [frame.time_star])?,
                (STEP, Some(frame)) => write_at(&mut output, place, 0, [frame.step as f64])?,
                (LABEL, Some(frame)) => {
                    let mut label = frame.label.clone().into_bytes();
                    label.resize(file.label_length() + place.padding, 0);
                    write_at(&mut output, place, 0, label)?;
                }
                _ => {}
            }
        }
        output.flush()
    }

    /// Writes the rows of blocks that this process holds, of every variable and every instant.
    pub fn write_rows(&self, output: impl Write + Seek) -> io::Result<()> {
        let file = self.file;
        let mut output = BufWriter::with_capacity(BUFFER, output);
        // Number of values before the first of these rows.
        let before = file.first_row * file.columns();
        for place in &self.header.places {
            match place.variable {
                TEXTURED => {
                    let flags = file.textured.iter().map(|flag| i16::from(*flag));
                    write_at(&mut output, place, before, flags)?;
                }
                MU_STATIC => write_at(&mut output, place, before, file.mu_static.iter().copied())?,
                MU_KINETIC => write_at(&mut output, place, before, file.mu_kinetic.iter().copied())?,
                FIRST_SLIP => {
                    // All NaN become the same one, because sign and payload depend on the machine.
                    let one_nan = |time: &f64| if time.is_nan() { f64::NAN } else { *time };
                    let times = file.first_slip_time_star.iter().map(one_nan);
                    write_at(&mut output, place, before, times)?;
                }
                name => {
                    let is_named = |field: &Field| field_info(*field).name == name;
                    let field = file.names.iter().position(is_named);
                    let values = field.and_then(|field| file.frames.get(place.record)?.values.get(field));
                    // Coordinates, and the entries of a record about its instant, are not values of blocks.
                    let Some(values) = values else { continue };
                    let one_nan = |value: &f32| if value.is_nan() { f32::NAN } else { *value };
                    write_at(&mut output, place, before, values.iter().map(one_nan))?;
                }
            }
        }
        output.flush()
    }
}

/// Writes values of a variable, after the first `before` values of it.
fn write_at<T: StoredNumber>(
    output: &mut (impl Write + Seek),
    place: &ValuePlace,
    before: usize,
    values: impl IntoIterator<Item = T>,
) -> io::Result<()> {
    let before = before as u64 * T::KIND.bytes() as u64;
    output.seek(SeekFrom::Start(place.offset + before))?;
    let mut values = values.into_iter();
    values.try_for_each(|value| output.write_all(value.encode().as_ref()))
}

/// The centres of the blocks that are kept along one axis, in m.
fn centers(blocks: usize, file: &FieldsData) -> impl Iterator<Item = f64> {
    let kept = (0..blocks).step_by(file.stride);
    kept.map(|block| (block as f64 + 0.5) * file.block_size)
}
