//! Reads the files that `write_fields` has written.

use std::ops::Range;
use std::path::Path;

use slipfront::observe::Field;
use slipfront::observe::frames::kept;
use slipfront_base::text;
use slipfront_case::field_info::{field_info, field_named};

use super::frame::*;
use super::netcdf3_reader::{NetCdf3Reader, NetCdfError, broken};
use crate::run_files::RunFile;

/// Range of all values of a variable.
pub(super) const WHOLE: Range<u64> = 0..u64::MAX;

/// Reads a `fields.nc` that [`write_fields`](super::write_fields) has written. Variables that slipfront does
/// not know are skipped.
pub fn read_fields<'f>(file: impl Into<RunFile<'f>>) -> Result<FieldsData, FieldsError> {
    read_rows(file, 0..usize::MAX)
}

/// Reads only these rows of a fields file, as far as they exist, counted from y = 0. This is for a file that
/// is larger than the memory.
pub fn read_rows<'f>(file: impl Into<RunFile<'f>>, rows: Range<usize>) -> Result<FieldsData, FieldsError> {
    open(&file.into(), |file| {
        let all: Vec<usize> = (0..file.records).collect();
        let data = read_chosen::<Vec<f32>>(file, |_| true, &all, &rows)?;
        let part = values_of(&rows, data.columns());
        Ok(FieldsData {
            mu_static: file.values(MU_STATIC, &[Y, X], 0, part.clone())?,
            mu_kinetic: file.values(MU_KINETIC, &[Y, X], 0, part.clone())?,
            first_slip_time_star: file.values(FIRST_SLIP, &[Y, X], 0, part)?,
            ..data
        })
    })
}

fn values_of(rows: &Range<usize>, columns: usize) -> Range<u64> {
    let [start, end] = [rows.start, rows.end].map(|row| (row as u64).saturating_mul(columns as u64));
    start..end
}

/// Reduction of the values of a field or of the texture while they are read, row after row.
pub trait Reduction {
    /// Begins the reduction of an array with rows of `columns` values, and with `rows` rows.
    fn begin(columns: usize, rows: usize) -> Self;

    /// Adds the next values.
    fn add(&mut self, values: impl Iterator<Item = f32>);

    /// Result of the reduction.
    fn finish(self) -> Vec<f32>;
}

/// The reduction that keeps all values.
impl Reduction for Vec<f32> {
    fn begin(_: usize, _: usize) -> Self {
        Self::new()
    }

    fn add(&mut self, values: impl Iterator<Item = f32>) {
        self.extend(values);
    }

    fn finish(self) -> Vec<f32> {
        self
    }
}

/// Reads the data of a picture of one field from a file of any length: only this field, at the snapshots with
/// the numbers that `choose` returns for the letters of all snapshots, and only the texture of the constant
/// arrays. All are [reduced](Reduction) while they are read. A reduced value counts as texture if more than
/// half of its blocks do.
pub fn read_maps<'f, R: Reduction>(
    file: impl Into<RunFile<'f>>,
    field: Field,
    choose: impl Fn(&[String]) -> Vec<usize>,
) -> Result<FieldsData, FieldsError> {
    open(&file.into(), |file| {
        let labels = (0..file.records).map(|record| read_label(file, record));
        let chosen = choose(&labels.collect::<Result<Vec<_>, _>>()?);
        read_chosen::<R>(file, |name| name == field, &chosen, &(0..usize::MAX))
    })
}

/// The number of snapshots in a file.
pub fn count_snapshots(path: &Path) -> Result<usize, FieldsError> {
    open(&path.into(), |file| Ok(file.records))
}

/// The numbers of at most `most` snapshots with these letters: all snapshots if there are no more; otherwise
/// those that have letters, or, if these are none or too many, `most` snapshots spread over the run.
pub fn choose_snapshots(labels: &[String], most: usize) -> Vec<usize> {
    let (count, shown) = (labels.len(), labels.len().min(most));
    let instants: Vec<usize> = (0..count).filter(|&k| !labels[k].is_empty()).collect();
    match instants.len() {
        found if count > most && (1..=most).contains(&found) => instants,
        _ => (0..shown).map(|k| k * (count - 1) / (shown - 1).max(1)).collect(),
    }
}

/// Reads the times of the first slips in place of fields, [reduced](Reduction) while they are read, and the
/// texture in the same way. The times are the only array of the only frame.
pub fn read_first_slips<R: Reduction>(from: &RunFile<'_>) -> Result<FieldsData, FieldsError> {
    open(from, |file| {
        let all = 0..usize::MAX;
        let mut data = read_chosen::<R>(file, |_| false, &[], &all)?;
        let times = read_reduced::<R>(file, FIRST_SLIP, &[Y, X], 0, &all, |value| value as f32)?;
        data.frames = vec![FieldFrame {
            time_star: 0.0,
            label: String::new(),
            step: 0,
            values: vec![times],
        }];
        Ok(data)
    })
}

/// Opens a file and reads something of it.
pub(super) fn open<'f, T>(
    file: &RunFile<'f>,
    read: impl FnOnce(&mut NetCdf3Reader<'f>) -> Result<T, NetCdfError>,
) -> Result<T, FieldsError> {
    let found = NetCdf3Reader::open(file).and_then(|mut file| read(&mut file));
    let path = || file.path().to_owned();
    found.map_err(|error| match error {
        NetCdfError::Io(source) => FieldsError::Read { path: path(), source },
        NetCdfError::Broken(detail) => FieldsError::Broken {
            path: path(),
            detail: text::single_line(&detail),
        },
    })
}

/// Some fields at some instants, and the texture; the other arrays are left empty.
fn read_chosen<R: Reduction>(
    file: &mut NetCdf3Reader<'_>,
    chosen: impl Fn(Field) -> bool,
    records: &[usize],
    rows: &Range<usize>,
) -> Result<FieldsData, NetCdfError> {
    let [nx, ny] = counts(file, BLOCKS)?;
    let [stride] = counts(file, STRIDE)?;
    let [block_size] = numbers(file, BLOCK_SIZE)?;
    let [time_unit_s] = numbers(file, TIME_UNIT)?;
    for (name, blocks) in [(X, nx), (Y, ny)] {
        let (found, wanted) = (file.dimension(name)?, kept(0..blocks, stride).len());
        if found != wanted {
            return broken(format!(
                "`{name}` has the length {found} where {wanted} is wanted"
            ));
        }
    }
    // The instants must be records: otherwise the whole of an array would be read for each of them.
    if !records.is_empty() && file.dimension(TIME)? != 0 {
        return broken(format!("`{TIME}` has a fixed length"));
    }
    // A file without instants has no fields, even if it defines some.
    let names: Vec<Field> = file
        .variables_over(&[TIME, Y, X])
        .filter_map(field_named)
        .filter(|name| chosen(*name) && !records.is_empty())
        .collect();
    let frames = records
        .iter()
        .map(|&record| read_frame::<R>(file, &names, record, rows));
    let frames = frames.collect::<Result<_, _>>()?;
    let flag = |value: f64| if value == 0.0 { 0.0 } else { 1.0 };
    let textured = read_reduced::<R>(file, TEXTURED, &[Y, X], 0, rows, flag)?;
    Ok(FieldsData {
        nx,
        ny,
        stride,
        first_row: rows.start,
        block_size,
        time_unit_s,
        names,
        textured: textured.iter().map(|share| *share > 0.5).collect(),
        frames,
        ..FieldsData::default()
    })
}

fn read_frame<R: Reduction>(
    file: &mut NetCdf3Reader<'_>,
    names: &[Field],
    record: usize,
    rows: &Range<usize>,
) -> Result<FieldFrame, NetCdfError> {
    let time_star = only(TIME_STAR, &file.values(TIME_STAR, &[TIME], record, WHOLE)?)?;
    let step = only(STEP, &file.values(STEP, &[TIME], record, WHOLE)?)? as u64;
    let label = read_label(file, record)?;
    let mut values = Vec::with_capacity(names.len());
    for name in names {
        let name = field_info(*name).name;
        values.push(read_reduced::<R>(
            file,
            name,
            &[TIME, Y, X],
            record,
            rows,
            |value| value as f32,
        )?);
    }
    Ok(FieldFrame {
        time_star,
        label,
        step,
        values,
    })
}

/// The letters of the instants A-F that a snapshot shows.
fn read_label(file: &mut NetCdf3Reader<'_>, record: usize) -> Result<String, NetCdfError> {
    let label = file.values(LABEL, &[TIME, LABEL_LENGTH], record, WHOLE)?;
    let label = label.iter().map(|byte| *byte as u8);
    let label: Vec<u8> = label.take_while(|byte| *byte != 0).collect();
    Ok(String::from_utf8_lossy(&label).into_owned())
}

/// The reduction of some rows of a variable of one value per block.
fn read_reduced<R: Reduction>(
    file: &mut NetCdf3Reader<'_>,
    name: &str,
    dimensions: &[&str],
    record: usize,
    rows: &Range<usize>,
    value: impl Fn(f64) -> f32,
) -> Result<Vec<f32>, NetCdfError> {
    let (columns, there) = (file.dimension(X)?, file.dimension(Y)?);
    let mut reduced = R::begin(columns, rows.end.min(there).saturating_sub(rows.start));
    file.read(name, dimensions, record, values_of(rows, columns), |piece| {
        reduced.add(piece.iter().map(|&number| value(number)));
    })?;
    Ok(reduced.finish())
}

/// Reads a global attribute of N positive numbers.
fn numbers<const N: usize>(file: &NetCdf3Reader<'_>, name: &str) -> Result<[f64; N], NetCdfError> {
    match <[f64; N]>::try_from(file.attribute(name)?) {
        Ok(values) if values.iter().all(|value| value.is_finite() && *value > 0.0) => Ok(values),
        _ => broken(format!(
            "the attribute `{name}` does not hold positive numbers, {N} in all"
        )),
    }
}

/// Reads a global attribute of N positive whole numbers; they fit, because the file stores them with 32 bits.
fn counts<const N: usize>(file: &NetCdf3Reader<'_>, name: &str) -> Result<[usize; N], NetCdfError> {
    let values = numbers::<N>(file, name)?.map(|value| value as usize);
    if values.contains(&0) {
        return broken(format!("the attribute `{name}` is below 1"));
    }
    Ok(values)
}

fn only(name: &str, values: &[f64]) -> Result<f64, NetCdfError> {
    values
        .first()
        .map_or_else(|| broken(format!("`{name}` is empty")), |first| Ok(*first))
}
