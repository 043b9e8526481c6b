//! Writing: first the definition of every dimension and variable, then the numbers.

use std::cell::RefCell;
use std::fmt::Debug;
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;
use std::rc::Rc;

use netcdf3::{DataSet, DataType, FileWriter, InvalidDataSet, Version};
use slipfront::observe::Field;
use slipfront_case::case::smallest_stride;
use slipfront_case::disk::write_temp;
use slipfront_case::field_info::field_info;
use tempfile::TempPath;

use super::frame::*;

/// Writes what will be the `fields.nc` at `path` to a temporary file in a folder on the same file system.
///
/// It is complete and on the disk, and takes its name when it is renamed (`persist`). Coordinates are the block
/// centres in m and the time in s; fields are float32, what never changes is float64.
///
/// # Errors
///
/// [`FieldsError`] if an array does not have the length that `nx`, `ny` and `stride` ask for, one field takes more
/// than 2 GiB, or the file cannot be written in full.
pub fn write_fields(temporary: &Path, path: &Path, file: &FieldsFile) -> Result<TempPath, FieldsError> {
    check(path, file)?;
    let fill = |output: &mut File| write_to(output.try_clone()?, file).map(drop);
    write_temp(temporary, fill).map_err(|source| FieldsError::Write {
        path: path.to_owned(),
        source,
    })
}

fn check(path: &Path, file: &FieldsFile) -> Result<(), FieldsError> {
    let expect = |what: &str, found: usize, wanted: usize| match found == wanted {
        true => Ok(()),
        false => Err(FieldsError::Shape {
            path: path.to_owned(),
            what: what.to_owned(),
            found,
            wanted,
        }),
    };
    for (what, size) in [("x", file.nx), ("y", file.ny), ("`output.stride`", file.stride)] {
        // The header stores them with 32 bits.
        expect(what, size, size.clamp(1, i32::MAX as usize))?;
    }
    check_size(path, file.nx, file.ny, file.stride)?;
    let (statics, blocks) = (&file.statics, file.nx * file.ny);
    expect(TEXTURED, statics.textured.len(), blocks)?;
    expect(MU_STATIC, statics.mu_static.len(), blocks)?;
    expect(MU_KINETIC, statics.mu_kinetic.len(), blocks)?;
    expect(FIRST_SLIP, statics.first_slip_time_star.len(), blocks)?;
    for frame in file.frames {
        expect("a frame", frame.values.len(), file.names.len())?;
        for (name, values) in file.names.iter().zip(&frame.values) {
            expect(field_info(*name).name, values.len(), file.columns() * file.rows())?;
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

    /// NetCDF has no length 0, so that empty labels take one byte.
    fn label_length(&self) -> usize {
        let lengths = self.frames.iter().map(|frame| frame.label.len());
        lengths.max().unwrap_or(0).max(1)
    }
}

/// Writes the whole file and gives the output back, with nothing left in a buffer.
pub(super) fn write_to<W: Write + Seek + 'static>(output: W, file: &FieldsFile) -> io::Result<W> {
    let definition = define(file).map_err(internal)?;
    let output = BufWriter::new(output);
    let state = Rc::new(RefCell::new(SinkState { output, error: None }));
    let written = write_variables(Sink(Rc::clone(&state)), &definition, file);
    let Some(state) = Rc::into_inner(state) else {
        return Err(io::Error::other("the output is still in use"));
    };
    let SinkState { mut output, error } = state.into_inner();
    error.map_or(Ok(()), Err)?;
    written.map_err(internal)?;
    output.flush()?;
    output.into_inner().map_err(io::IntoInnerError::into_error)
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
    let textured: Vec<i16> = statics.textured.iter().copied().map(i16::from).collect();
    writer.write_var_i16(TEXTURED, &thin(&textured, file.nx, file.stride))?;
    writer.write_var_f64(MU_STATIC, &thin(statics.mu_static, file.nx, file.stride))?;
    writer.write_var_f64(MU_KINETIC, &thin(statics.mu_kinetic, file.nx, file.stride))?;
    // One NaN only: its sign and payload depend on the machine.
    let mut first_slip = thin(statics.first_slip_time_star, file.nx, file.stride);
    let nans = first_slip.iter_mut().filter(|time| time.is_nan());
    nans.for_each(|time| *time = f64::NAN);
    writer.write_var_f64(FIRST_SLIP, &first_slip)?;

    for (record, frame) in file.frames.iter().enumerate() {
        writer.write_record_f64(TIME, record, &[frame.time_star * file.time_unit_s])?;
        writer.write_record_f64(TIME_STAR, record, &[frame.time_star])?;
        writer.write_record_f64(STEP, record, &[frame.step as f64])?;
        let mut label = frame.label.clone().into_bytes();
        label.resize(file.label_length(), 0);
        writer.write_record_u8(LABEL, record, &label)?;
        for (name, values) in file.names.iter().zip(&frame.values) {
            let one_nan = |value: &f32| if value.is_nan() { f32::NAN } else { *value };
            let values: Vec<f32> = values.iter().map(one_nan).collect();
            writer.write_record_f32(field_info(*name).name, record, &values)?;
        }
    }
    writer.close()
}

/// The centres of the blocks that are kept along one axis, in m.
fn centers(blocks: usize, file: &FieldsFile) -> Vec<f64> {
    let kept = (0..blocks).step_by(file.stride);
    kept.map(|block| (block as f64 + 0.5) * file.block_size).collect()
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
    define_variable(set, Y, &[Y], DataType::F64, "y of the block centre", "m")?;
    define_variable(set, X, &[X], DataType::F64, "x of the block centre", "m")?;
    // 16 bits, because the padding after a pair of bytes is not zero as the format wants it.
    define_variable(set, TEXTURED, &[Y, X], DataType::I16, "texture", "1")?;
    set.add_var_attr_i16(TEXTURED, "flag_values", vec![0, 1])?;
    set.add_var_attr_string(TEXTURED, "flag_meanings", "contact cavity")?;
    for (name, long_name) in [
        (MU_STATIC, "static friction coefficient"),
        (MU_KINETIC, "kinetic friction coefficient"),
        (FIRST_SLIP, "time t* of the first slip"),
    ] {
        define_variable(set, name, &[Y, X], DataType::F64, long_name, "1")?;
    }
    set.add_var_attr_string(FIRST_SLIP, "comment", "NaN where a block never slips")
}

fn define_frames(set: &mut DataSet, file: &FieldsFile) -> Result<(), InvalidDataSet> {
    set.set_unlimited_dim(TIME, file.frames.len())?;
    set.add_fixed_dim(LABEL_LENGTH, file.label_length())?;
    for (name, long_name, units) in [
        (TIME, "time since the start of the drive", "s"),
        (TIME_STAR, "dimensionless time t*", "1"),
        (STEP, "number of the time step", "1"),
    ] {
        define_variable(set, name, &[TIME], DataType::F64, long_name, units)?;
    }
    set.add_var_attr_string(TIME, "axis", "T")?;
    set.add_var_u8(LABEL, &[TIME, LABEL_LENGTH])?;
    set.add_var_attr_string(LABEL, "long_name", "name of the instant")?;
    for field in file.names {
        let info = field_info(*field);
        let name = info.name;
        define_variable(set, name, &[TIME, Y, X], DataType::F32, info.long_name, info.unit)?;
        set.add_var_attr_string(name, "coordinates", "time_star instant")?;
        match field {
            Field::Traction => set.add_var_attr_string(name, "comment", "NaN in cavities")?,
            Field::Sliding => {
                set.add_var_attr_f32(name, "flag_values", vec![0.0, 1.0])?;
                set.add_var_attr_string(name, "flag_meanings", "stuck sliding")?;
            }
            _ => {}
        }
    }
    Ok(())
}

fn define_variable(
    set: &mut DataSet,
    name: &str,
    dimensions: &[&str],
    data_type: DataType,
    long_name: &str,
    units: &str,
) -> Result<(), InvalidDataSet> {
    set.add_var(name, dimensions, data_type)?;
    set.add_var_attr_string(name, "long_name", long_name)?;
    set.add_var_attr_string(name, "units", units)
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
