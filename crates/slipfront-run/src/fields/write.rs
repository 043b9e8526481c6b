//! Writing: first the definition of every dimension and variable, then the numbers.

use std::cell::RefCell;
use std::fmt::Debug;
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;
use std::rc::Rc;

use netcdf3::{DataSet, FileWriter, InvalidDataSet, Version};

use super::variables::{
    BLOCK_SIZE, BLOCKS, FIRST_SLIP, LABEL, LABEL_LENGTH, MU_KINETIC, MU_STATIC, STEP, STRIDE, TEXTURED, TIME,
    TIME_STAR, TIME_UNIT, X, Y,
};
use slipfront::observe::Field;
use slipfront_case::case::smallest_stride;

use super::error::FieldsError;
use super::frame::{FieldsFile, thin};
use slipfront_case::disk::write_temp;
use slipfront_case::field_info::field_info;

/// Writes `fields.nc`.
///
/// The file appears under its name only when it is complete: it is written beside it, flushed to the disk and
/// renamed. Coordinates are the block centres in m and the time in s; fields are float32, what never changes is
/// float64.
///
/// # Errors
///
/// [`FieldsError`] if an array does not have the length that `nx`, `ny` and `stride` ask for, one field takes more
/// than 2 GiB, or the file cannot be written in full.
pub fn write_fields(path: &Path, file: &FieldsFile) -> Result<(), FieldsError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    write_fields_via(folder.unwrap_or(Path::new(".")), path, file)
}

/// Writes `fields.nc` as [`write_fields`] does, with its temporary file in a folder on the same file system.
///
/// # Errors
///
/// As for [`write_fields`].
pub fn write_fields_via(temporary: &Path, path: &Path, file: &FieldsFile) -> Result<(), FieldsError> {
    check(path, file)?;
    let fill = |output: &mut File| write_to(output.try_clone()?, file).map(drop);
    let written = write_temp(temporary, fill).and_then(|written| Ok(written.persist(path)?));
    written.map_err(|source| FieldsError::Write {
        path: path.to_owned(),
        source,
    })
}

fn check(path: &Path, file: &FieldsFile) -> Result<(), FieldsError> {
    let wrong = |what: &str, found, wanted| {
        Err(FieldsError::Shape {
            path: path.to_owned(),
            what: what.to_owned(),
            found,
            wanted,
        })
    };
    for (what, size) in [("x", file.nx), ("y", file.ny), ("`output.stride`", file.stride)] {
        // The header stores them with 32 bits.
        let bound = size.clamp(1, i32::MAX as usize);
        if size != bound {
            return wrong(what, size, bound);
        }
    }
    check_size(path, file.nx, file.ny, file.stride)?;
    let statics = &file.statics;
    for (what, found) in [
        (TEXTURED, statics.textured.len()),
        (MU_STATIC, statics.mu_static.len()),
        (MU_KINETIC, statics.mu_kinetic.len()),
        (FIRST_SLIP, statics.first_slip_time_star.len()),
    ] {
        if found != file.nx * file.ny {
            return wrong(what, found, file.nx * file.ny);
        }
    }
    let (columns, rows) = (file.columns(), file.rows());
    for frame in file.frames {
        if frame.values.len() != file.names.len() {
            return wrong("a frame", frame.values.len(), file.names.len());
        }
        for (name, values) in file.names.iter().zip(&frame.values) {
            if values.len() != columns * rows {
                return wrong(field_info(*name).name, values.len(), columns * rows);
            }
        }
    }
    Ok(())
}

/// One variable must hold all blocks that are kept.
pub(super) fn check_size(path: &Path, nx: usize, ny: usize, stride: usize) -> Result<(), FieldsError> {
    let smallest = smallest_stride(nx, ny, stride);
    if stride == smallest {
        return Ok(());
    }
    Err(FieldsError::TooLarge {
        path: path.to_owned(),
        columns: nx.div_ceil(stride),
        rows: ny.div_ceil(stride),
        stride: smallest,
    })
}

impl FieldsFile<'_> {
    fn columns(&self) -> usize {
        self.nx.div_ceil(self.stride)
    }

    fn rows(&self) -> usize {
        self.ny.div_ceil(self.stride)
    }
}

/// Writes the whole file and gives the output back, with nothing left in a buffer.
pub(super) fn write_to<W: Write + Seek + 'static>(output: W, file: &FieldsFile) -> io::Result<W> {
    let sink = Sink::new(output);
    let definition = define(file).map_err(internal)?;
    let written = write_variables(sink.clone(), &definition, file);
    sink.finish(written)
}

fn write_variables(
    output: Sink<impl Write + Seek + 'static>,
    definition: &DataSet,
    file: &FieldsFile,
) -> Result<(), netcdf3::WriteError> {
    let mut writer = FileWriter::open_seek_write("", Box::new(output))?;
    writer.set_def(definition, Version::Offset64Bit, 0)?;

    writer.write_var_f64(X, &centers(file.nx, file))?;
    writer.write_var_f64(Y, &centers(file.ny, file))?;
    let statics = &file.statics;
    let textured: Vec<i16> = statics
        .textured
        .iter()
        .map(|textured| i16::from(*textured))
        .collect();
    writer.write_var_i16(TEXTURED, &thin(&textured, file.nx, file.stride))?;
    writer.write_var_f64(MU_STATIC, &thin(statics.mu_static, file.nx, file.stride))?;
    writer.write_var_f64(MU_KINETIC, &thin(statics.mu_kinetic, file.nx, file.stride))?;
    let first_slip = statics
        .first_slip_time_star
        .iter()
        .map(|time| if time.is_nan() { f64::NAN } else { *time });
    let first_slip: Vec<f64> = first_slip.collect();
    writer.write_var_f64(FIRST_SLIP, &thin(&first_slip, file.nx, file.stride))?;

    let label_length = label_length(file);
    for (record, frame) in file.frames.iter().enumerate() {
        writer.write_record_f64(TIME, record, &[frame.time_star * file.time_unit_s])?;
        writer.write_record_f64(TIME_STAR, record, &[frame.time_star])?;
        writer.write_record_f64(STEP, record, &[frame.step as f64])?;
        let mut label = frame.label.clone().into_bytes();
        label.resize(label_length, 0);
        writer.write_record_u8(LABEL, record, &label)?;
        for (name, values) in file.names.iter().zip(&frame.values) {
            // One NaN only: its sign and payload depend on the machine.
            let values: Vec<f32> = values
                .iter()
                .map(|value| if value.is_nan() { f32::NAN } else { *value })
                .collect();
            writer.write_record_f32(field_info(*name).name, record, &values)?;
        }
    }
    writer.close()
}

/// The centres of the blocks that are kept along one axis, in m.
fn centers(blocks: usize, file: &FieldsFile) -> Vec<f64> {
    (0..blocks)
        .step_by(file.stride)
        .map(|block| (block as f64 + 0.5) * file.block_size)
        .collect()
}

/// NetCDF has no length 0, so that empty labels take one byte.
fn label_length(file: &FieldsFile) -> usize {
    file.frames
        .iter()
        .map(|frame| frame.label.len())
        .max()
        .unwrap_or(0)
        .max(1)
}

/// Every dimension, attribute and variable, without the numbers.
///
/// Blanks are NaN, which every reader knows; there is no `_FillValue`, because `netcdf3` finds its variables by
/// comparing them with all their attributes, and NaN equals nothing. Nor have x and y an `axis`: ParaView would
/// take them for longitude and latitude.
fn define(file: &FieldsFile) -> Result<DataSet, InvalidDataSet> {
    let mut set = DataSet::new();
    set.add_global_attr_string("Conventions", "CF-1.8")?;
    set.add_global_attr_string("title", "Fields of a spring-block model of friction")?;
    set.add_global_attr_string("source", concat!("slipfront ", env!("CARGO_PKG_VERSION")))?;
    set.add_global_attr_i32(BLOCKS, vec![file.nx as i32, file.ny as i32])?;
    set.add_global_attr_i32(STRIDE, vec![file.stride as i32])?;
    set.add_global_attr_f64(BLOCK_SIZE, vec![file.block_size])?;
    set.add_global_attr_f64(TIME_UNIT, vec![file.time_unit_s])?;
    define_statics(&mut set, file)?;
    // A record dimension without records makes ParaView crash.
    if !file.frames.is_empty() {
        define_frames(&mut set, file)?;
    }
    Ok(set)
}

fn define_statics(set: &mut DataSet, file: &FieldsFile) -> Result<(), InvalidDataSet> {
    set.add_fixed_dim(Y, file.rows())?;
    set.add_fixed_dim(X, file.columns())?;
    set.add_var_f64(Y, &[Y])?;
    describe(set, Y, "y of the block centre", "m")?;
    set.add_var_f64(X, &[X])?;
    describe(set, X, "x of the block centre", "m")?;
    // 16 bits, because the padding after a pair of bytes is not zero as the format wants it.
    set.add_var_i16(TEXTURED, &[Y, X])?;
    describe(set, TEXTURED, "texture", "1")?;
    set.add_var_attr_i16(TEXTURED, "flag_values", vec![0, 1])?;
    set.add_var_attr_string(TEXTURED, "flag_meanings", "contact cavity")?;
    set.add_var_f64(MU_STATIC, &[Y, X])?;
    describe(set, MU_STATIC, "static friction coefficient", "1")?;
    set.add_var_f64(MU_KINETIC, &[Y, X])?;
    describe(set, MU_KINETIC, "kinetic friction coefficient", "1")?;
    set.add_var_f64(FIRST_SLIP, &[Y, X])?;
    describe(set, FIRST_SLIP, "time t* of the first slip", "1")?;
    set.add_var_attr_string(FIRST_SLIP, "comment", "NaN where a block never slips")
}

fn define_frames(set: &mut DataSet, file: &FieldsFile) -> Result<(), InvalidDataSet> {
    set.set_unlimited_dim(TIME, file.frames.len())?;
    set.add_fixed_dim(LABEL_LENGTH, label_length(file))?;
    set.add_var_f64(TIME, &[TIME])?;
    describe(set, TIME, "time since the start of the drive", "s")?;
    set.add_var_attr_string(TIME, "axis", "T")?;
    set.add_var_f64(TIME_STAR, &[TIME])?;
    describe(set, TIME_STAR, "dimensionless time t*", "1")?;
    set.add_var_f64(STEP, &[TIME])?;
    describe(set, STEP, "number of the time step", "1")?;
    set.add_var_u8(LABEL, &[TIME, LABEL_LENGTH])?;
    set.add_var_attr_string(LABEL, "long_name", "name of the instant")?;
    for name in file.names {
        let info = field_info(*name);
        let text = info.name;
        set.add_var_f32(text, &[TIME, Y, X])?;
        describe(set, text, info.long_name, info.unit)?;
        set.add_var_attr_string(text, "coordinates", "time_star instant")?;
        match name {
            Field::Traction => set.add_var_attr_string(text, "comment", "NaN in cavities")?,
            Field::Sliding => {
                set.add_var_attr_f32(text, "flag_values", vec![0.0, 1.0])?;
                set.add_var_attr_string(text, "flag_meanings", "stuck sliding")?;
            }
            _ => {}
        }
    }
    Ok(())
}

fn describe(set: &mut DataSet, variable: &str, long_name: &str, units: &str) -> Result<(), InvalidDataSet> {
    set.add_var_attr_string(variable, "long_name", long_name)?;
    set.add_var_attr_string(variable, "units", units)
}

/// The errors of `netcdf3` have no `Display`.
fn internal(error: impl Debug) -> io::Error {
    io::Error::other(format!("the NetCDF file cannot be laid out ({error:?})"))
}

/// A buffered output that several owners share.
///
/// `netcdf3` writes number by number, keeps only the kind of an error, and drops its output without looking whether
/// the last bytes went through. The sink collects small writes, keeps the first error, and is still there at the end.
struct Sink<W: Write>(Rc<RefCell<SinkState<W>>>);

struct SinkState<W: Write> {
    output: BufWriter<W>,
    error: Option<io::Error>,
}

impl<W: Write + Seek> Sink<W> {
    fn new(output: W) -> Sink<W> {
        Sink(Rc::new(RefCell::new(SinkState {
            output: BufWriter::new(output),
            error: None,
        })))
    }

    fn clone(&self) -> Sink<W> {
        Sink(Rc::clone(&self.0))
    }

    /// Gives the output back if all went well, and the first error if not.
    fn finish(self, written: Result<(), netcdf3::WriteError>) -> io::Result<W> {
        let Some(state) = Rc::into_inner(self.0) else {
            return Err(io::Error::other("the output is still in use"));
        };
        let SinkState { mut output, error } = state.into_inner();
        match (error, written) {
            (Some(error), _) => Err(error),
            (None, Err(error)) => Err(internal(error)),
            (None, Ok(())) => {
                output.flush()?;
                output.into_inner().map_err(io::IntoInnerError::into_error)
            }
        }
    }

    fn keep_error<T>(&self, action: impl FnOnce(&mut BufWriter<W>) -> io::Result<T>) -> io::Result<T> {
        let mut state = self.0.borrow_mut();
        action(&mut state.output).map_err(|error| {
            let kind = error.kind();
            state.error.get_or_insert(error);
            kind.into()
        })
    }
}

impl<W: Write + Seek> Write for Sink<W> {
    /// Takes all bytes or fails: `netcdf3` does not look at the number of bytes taken.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.keep_error(|output| output.write_all(bytes))?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.keep_error(BufWriter::flush)
    }
}

impl<W: Write + Seek> Seek for Sink<W> {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.keep_error(|output| output.seek(position))
    }
}
