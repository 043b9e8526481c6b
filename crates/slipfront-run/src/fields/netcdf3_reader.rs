//! The NetCDF-3 format, read only: every count of a header is compared with the bytes that are left before
//! memory is reserved for its elements.

use std::collections::HashSet;
use std::io::{self, Read, SeekFrom};
use std::ops::Range;

use super::netcdf3::{ATTRIBUTES, CdfVersion, DIMENSIONS, ExternalType, VARIABLES};
use crate::run_files::{RunFile, Source};

/// Number of values that are read at once.
const PIECE: usize = 1 << 14;

/// Largest length of a header; headers of fields files take a few kilobytes.
const HEADER_MAX_BYTES: u64 = 1 << 20;

/// Error of a file.
#[derive(Debug, thiserror::Error)]
pub(super) enum NetCdfError {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("{0}")]
    Broken(String),
}

pub(super) fn broken<T>(detail: impl Into<String>) -> Result<T, NetCdfError> {
    Err(NetCdfError::Broken(detail.into()))
}

/// An open file and the content of its header.
pub(super) struct NetCdf3Reader<'f> {
    file: Box<dyn Source + 'f>,
    file_bytes: u64,
    /// Number of records, one for each instant.
    pub(super) records: usize,
    record_bytes: u64,
    /// Names and lengths; a length of 0 marks the record dimension.
    dimensions: Vec<(String, usize)>,
    /// Global attributes with their numbers; text counts as numbers too, one per byte.
    attributes: Vec<(String, Vec<f64>)>,
    variables: Vec<StoredVariable>,
}

struct StoredVariable {
    name: String,
    /// Dimensions of the variable, as indices.
    dimensions: Vec<usize>,
    kind: ExternalType,
    offset: u64,
}

impl<'f> NetCdf3Reader<'f> {
    /// Opens a file and reads its header.
    pub(super) fn open(file: &RunFile<'f>) -> Result<Self, NetCdfError> {
        let (mut file, file_bytes) = file.open()?;
        let mut bytes = Vec::new();
        file.by_ref().take(HEADER_MAX_BYTES).read_to_end(&mut bytes)?;
        let mut header = HeaderReader::begin(&bytes)?;
        let records = header.count()?;
        let dimensions = header.list(DIMENSIONS, 8, |header| Ok((header.name()?, header.count()?)))?;
        let attributes = header.list(ATTRIBUTES, 12, HeaderReader::attribute)?;
        let variables = header.list(VARIABLES, 28, |header| header.variable(dimensions.len()))?;
        each_once(dimensions.iter().map(|(name, _)| name))?;
        each_once(variables.iter().map(|variable| &variable.name))?;
        let mut reader = Self {
            file,
            file_bytes,
            records,
            record_bytes: 0,
            dimensions,
            attributes,
            variables,
        };
        let has_records = |variable: &&StoredVariable| reader.has_records(variable);
        let mut with_records = reader.variables.iter().filter(has_records);
        let record_bytes = with_records.try_fold(0, |total: u64, variable| {
            total.checked_add(reader.bytes_at_once(variable)?.checked_next_multiple_of(4)?)
        });
        reader.record_bytes = record_bytes.ok_or_else(|| absurd("one record"))?;
        // Only the header contains the number of records, so it must not exceed what the file has bytes for.
        let held = file_bytes.checked_div(reader.record_bytes).unwrap_or(0);
        if records as u64 > held {
            return broken(format!(
                "its header promises {records} instants where {file_bytes} bytes hold at most {held}"
            ));
        }
        Ok(reader)
    }

    /// The names of the variables that have exactly these dimensions.
    pub(super) fn variables_over<'a>(&'a self, dimensions: &'a [&str]) -> impl Iterator<Item = &'a str> {
        let is_over = |variable: &&StoredVariable| self.is_over(variable, dimensions);
        let over = self.variables.iter().filter(is_over);
        over.map(|variable| variable.name.as_str())
    }

    /// The numbers of a global attribute.
    pub(super) fn attribute(&self, name: &str) -> Result<&[f64], NetCdfError> {
        match self.attributes.iter().find(|(known, _)| known == name) {
            Some((_, values)) => Ok(values),
            None => broken(format!("it has no attribute `{name}`")),
        }
    }

    /// The length of a dimension; 0 for the record dimension.
    pub(super) fn dimension(&self, name: &str) -> Result<usize, NetCdfError> {
        match self.dimensions.iter().find(|(known, _)| known == name) {
            Some((_, length)) => Ok(*length),
            None => broken(format!("it has no dimension `{name}`")),
        }
    }

    /// The values in the range `part` of a variable with exactly these dimensions. The range counts the
    /// values of the whole variable, or of one record of it if the first dimension is the record dimension.
    pub(super) fn values(
        &mut self,
        name: &str,
        dimensions: &[&str],
        record: usize,
        part: Range<u64>,
    ) -> Result<Vec<f64>, NetCdfError> {
        let mut values = Vec::new();
        self.read(name, dimensions, record, part, |piece| values.extend(piece))?;
        Ok(values)
    }

    /// Passes the values on piece by piece, so that they need not all be in memory.
    pub(super) fn read(
        &mut self,
        name: &str,
        dimensions: &[&str],
        record: usize,
        part: Range<u64>,
        mut take: impl FnMut(&[f64]),
    ) -> Result<(), NetCdfError> {
        let is_meant =
            |variable: &&StoredVariable| variable.name == name && self.is_over(variable, dimensions);
        let Some(variable) = self.variables.iter().find(is_meant) else {
            return broken(format!("it has no variable `{name}({})`", dimensions.join(", ")));
        };
        let bytes = self.bytes_at_once(variable).ok_or_else(|| absurd(name))?;
        let skipped = if self.has_records(variable) {
            self.record_bytes.checked_mul(record as u64)
        } else {
            Some(0)
        };
        let start = skipped.and_then(|skipped| skipped.checked_add(variable.offset));
        let end = start.and_then(|start| start.checked_add(bytes));
        let (Some(start), Some(end)) = (start, end) else {
            return Err(absurd(name));
        };
        if end > self.file_bytes {
            let there = self.file_bytes;
            return broken(format!("it has {there} bytes where `{name}` ends at byte {end}"));
        }
        let value = variable.kind.bytes() as u64;
        let [from, to] = [part.start, part.end].map(|at| start + at.min(bytes / value) * value);
        let piece = PIECE as u64 * value;
        let (mut data, mut values) = (Vec::new(), Vec::new());
        self.file.seek(SeekFrom::Start(from))?;
        for first in (from..to).step_by(piece as usize) {
            data.resize(piece.min(to - first) as usize, 0);
            self.file.read_exact(&mut data)?;
            values.clear();
            values.extend(variable.kind.decode(&data));
            take(&values);
        }
        Ok(())
    }

    fn is_over(&self, variable: &StoredVariable, dimensions: &[&str]) -> bool {
        let ids = variable.dimensions.iter();
        let names = ids.map(|id| self.dimensions[*id].0.as_str());
        names.eq(dimensions.iter().copied())
    }

    fn has_records(&self, variable: &StoredVariable) -> bool {
        let first = variable.dimensions.first();
        first.is_some_and(|id| self.dimensions[*id].1 == 0)
    }

    /// The bytes of a whole variable or of one record of it, without padding.
    fn bytes_at_once(&self, variable: &StoredVariable) -> Option<u64> {
        let skipped = usize::from(self.has_records(variable));
        let dimensions = variable.dimensions.iter().skip(skipped);
        let mut lengths = dimensions.map(|id| self.dimensions[*id].1 as u64);
        lengths.try_fold(variable.kind.bytes() as u64, u64::checked_mul)
    }
}

/// Refuses duplicate names, because their arrays would be read twice, however long they are.
fn each_once<'a>(mut names: impl Iterator<Item = &'a String>) -> Result<(), NetCdfError> {
    let mut seen = HashSet::new();
    match names.find(|name| !seen.insert(*name)) {
        Some(twice) => broken(format!("its header defines `{twice}` twice")),
        None => Ok(()),
    }
}

fn absurd(variable: &str) -> NetCdfError {
    NetCdfError::Broken(format!("`{variable}` has an absurd size"))
}

/// The bytes of a header that are still to be read.
struct HeaderReader<'a> {
    form: CdfVersion,
    rest: &'a [u8],
}

impl<'a> HeaderReader<'a> {
    fn begin(bytes: &'a [u8]) -> Result<Self, NetCdfError> {
        let of_form = |form: CdfVersion| Some((form, bytes.strip_prefix(form.magic())?));
        match [CdfVersion::Offset64, CdfVersion::Data64]
            .into_iter()
            .find_map(of_form)
        {
            Some((form, rest)) => Ok(Self { form, rest }),
            None => broken("it does not begin like NetCDF-3 with 64-bit offsets or data"),
        }
    }

    fn take(&mut self, bytes: usize) -> Result<&'a [u8], NetCdfError> {
        let Some((taken, rest)) = self.rest.split_at_checked(bytes) else {
            return broken("its header is corrupt or cut short");
        };
        self.rest = rest;
        Ok(taken)
    }

    /// Takes `bytes` and the padding up to a multiple of 4.
    fn padded(&mut self, bytes: usize) -> Result<&'a [u8], NetCdfError> {
        let taken = self.take(bytes)?;
        self.take(bytes.next_multiple_of(4) - bytes)?;
        Ok(taken)
    }

    fn number(&mut self, bytes: usize) -> Result<u64, NetCdfError> {
        let bytes = self.take(bytes)?.iter();
        Ok(bytes.fold(0, |number, byte| number << 8 | u64::from(*byte)))
    }

    /// A tag or a type.
    fn code(&mut self) -> Result<u32, NetCdfError> {
        Ok(self.number(4)? as u32)
    }

    /// A length, a number of elements, an index.
    fn count(&mut self) -> Result<usize, NetCdfError> {
        let count = self.number(self.form.count_bytes())?;
        // A 32-bit machine could not hold a larger number of elements.
        usize::try_from(count).or_else(|_| broken(format!("its header counts {count} of something")))
    }

    fn name(&mut self) -> Result<String, NetCdfError> {
        let bytes = self.count()?;
        Ok(String::from_utf8_lossy(self.padded(bytes)?).into_owned())
    }

    /// A list of elements of at least `element_bytes` each, or nothing.
    fn list<T>(
        &mut self,
        tag: u32,
        element_bytes: usize,
        element: impl Fn(&mut Self) -> Result<T, NetCdfError>,
    ) -> Result<Vec<T>, NetCdfError> {
        let (found, count) = (self.code()?, self.count()?);
        let known = found == tag || (found == 0 && count == 0);
        if !known || count > self.rest.len() / element_bytes {
            return broken("its header is corrupt or cut short");
        }
        (0..count).map(|_| element(self)).collect()
    }

    fn kind(&mut self) -> Result<ExternalType, NetCdfError> {
        let code = self.code()?;
        let unknown = || broken(format!("its header names the unknown type {code}"));
        ExternalType::from_code(code).map_or_else(unknown, Ok)
    }

    fn attribute(&mut self) -> Result<(String, Vec<f64>), NetCdfError> {
        let name = self.name()?;
        let kind = self.kind()?;
        let count = self.count()?;
        let values = kind.decode(self.padded(count.saturating_mul(kind.bytes()))?);
        Ok((name, values.collect()))
    }

    fn variable(&mut self, dimensions_known: usize) -> Result<StoredVariable, NetCdfError> {
        let name = self.name()?;
        let count = self.count()?;
        if count > dimensions_known {
            return broken(format!(
                "`{name}` has {count} dimensions where {dimensions_known} are known"
            ));
        }
        let mut dimensions = Vec::new();
        for _ in 0..count {
            let id = self.count()?;
            if id >= dimensions_known {
                return broken(format!("`{name}` has a dimension that is not known"));
            }
            dimensions.push(id);
        }
        self.list(ATTRIBUTES, 12, HeaderReader::attribute)?;
        let kind = self.kind()?;
        // Skips the size, which follows from the dimensions.
        self.count()?;
        let offset = self.number(8)?;
        Ok(StoredVariable {
            name,
            dimensions,
            kind,
            offset,
        })
    }
}
