//! The header of a NetCDF-3 file, and the positions of the values after it.

use super::netcdf3::{ATTRIBUTES, CdfVersion, DIMENSIONS, ExternalType, StoredNumber, VARIABLES};

/// Largest size in bytes of a variable, or of one record of it, in a file with 64-bit offsets. The format
/// allows twice as much, but some readers store the size as a signed number.
const OFFSET64_MAX_BYTES: u64 = i32::MAX as u64 - 3;

/// The definition of a file, without the values of its variables.
pub(super) struct Definition {
    /// Number of records.
    pub(super) records: usize,
    /// Names and lengths; a length of 0 marks the dimension of the records, which comes first where it
    /// occurs.
    pub(super) dimensions: Vec<(&'static str, usize)>,
    pub(super) attributes: Vec<Attribute>,
    pub(super) variables: Vec<Variable>,
}

/// A name with some numbers, or with a text.
pub(super) struct Attribute {
    name: &'static str,
    kind: ExternalType,
    count: usize,
    bytes: Vec<u8>,
}

impl Attribute {
    pub(super) fn numbers<T: StoredNumber>(name: &'static str, values: &[T]) -> Self {
        let bytes = values.iter().flat_map(|value| value.encode().as_ref().to_vec());
        Self {
            name,
            kind: T::KIND,
            count: values.len(),
            bytes: bytes.collect(),
        }
    }

    pub(super) fn text(name: &'static str, text: &str) -> Self {
        Self::numbers(name, text.as_bytes())
    }
}

/// A variable, without its values.
pub(super) struct Variable {
    name: &'static str,
    /// Names of its dimensions.
    dimensions: Vec<&'static str>,
    kind: ExternalType,
    attributes: Vec<Attribute>,
}

impl Variable {
    /// A variable with a name for readers.
    pub(super) fn new(
        name: &'static str,
        dimensions: &[&'static str],
        kind: ExternalType,
        long_name: &str,
    ) -> Self {
        Self {
            name,
            dimensions: dimensions.to_vec(),
            kind,
            attributes: vec![Attribute::text("long_name", long_name)],
        }
    }

    /// A variable of doubles with a name for readers and a unit.
    pub(super) fn doubles(
        name: &'static str,
        dimensions: &[&'static str],
        long_name: &str,
        unit: &str,
    ) -> Self {
        Self::new(name, dimensions, ExternalType::Double, long_name).with_text("units", unit)
    }

    /// The variable with a further attribute.
    pub(super) fn with<T: StoredNumber>(mut self, name: &'static str, values: &[T]) -> Self {
        self.attributes.push(Attribute::numbers(name, values));
        self
    }

    /// The variable with a further attribute of text.
    pub(super) fn with_text(self, name: &'static str, text: &str) -> Self {
        self.with(name, text.as_bytes())
    }
}

/// The bytes of a header, and the positions of the values that it defines.
pub(super) struct HeaderBytes {
    pub(super) bytes: Vec<u8>,
    /// Positions in the order of the file: first the variables without records, then record after record.
    pub(super) places: Vec<ValuePlace>,
}

/// Place of the values of a variable, or of one record of it.
pub(super) struct ValuePlace {
    pub(super) variable: &'static str,
    /// Number of the record; 0 for a variable without records.
    pub(super) record: usize,
    pub(super) offset: u64,
    /// Padding bytes after the values, up to a multiple of four.
    pub(super) padding: usize,
}

impl Definition {
    /// Computes the layout of the file.
    pub(super) fn header(&self) -> HeaderBytes {
        let sizes = self.variables.iter().map(|variable| self.bytes_at_once(variable));
        let form = match sizes.max() {
            Some(bytes) if bytes > OFFSET64_MAX_BYTES => CdfVersion::Data64,
            _ => CdfVersion::Offset64,
        };
        // The length of the header does not depend on the offsets.
        let length = self.encode(form, |_| 0).len() as u64;
        let mut offset = length;
        let mut places = Vec::new();
        let records = (0..self.records).map(|record| (true, record));
        for (has_records, record) in [(false, 0)].into_iter().chain(records) {
            let stored = self.variables.iter();
            for variable in stored.filter(|variable| self.has_records(variable) == has_records) {
                let (bytes, padded) = (self.bytes_at_once(variable), self.padded_bytes(variable));
                places.push(ValuePlace {
                    variable: variable.name,
                    record,
                    offset,
                    padding: (padded - bytes) as usize,
                });
                offset += padded;
            }
        }
        let first = |variable: &Variable| {
            let mut places = places.iter();
            let place = places.find(|place| place.variable == variable.name);
            place.map_or(offset, |place| place.offset)
        };
        HeaderBytes {
            bytes: self.encode(form, first),
            places,
        }
    }

    fn has_records(&self, variable: &Variable) -> bool {
        self.dimensions_of(variable)
            .next()
            .is_some_and(|(_, length)| length == 0)
    }

    /// Number and length of each dimension of a variable.
    fn dimensions_of(&self, variable: &Variable) -> impl Iterator<Item = (usize, usize)> {
        let place = |wanted: &&str| self.dimensions.iter().position(|(name, _)| name == wanted);
        let places = variable.dimensions.iter().filter_map(place);
        places.map(|place| (place, self.dimensions[place].1))
    }

    /// Bytes of a whole variable or of one record of it.
    fn bytes_at_once(&self, variable: &Variable) -> u64 {
        let lengths = self
            .dimensions_of(variable)
            .map(|(_, length)| length.max(1) as u64);
        lengths.product::<u64>() * variable.kind.bytes() as u64
    }

    fn padded_bytes(&self, variable: &Variable) -> u64 {
        self.bytes_at_once(variable).next_multiple_of(4)
    }

    fn encode(&self, form: CdfVersion, offset: impl Fn(&Variable) -> u64) -> Vec<u8> {
        let mut bytes = Encoder {
            form,
            bytes: form.magic().to_vec(),
        };
        bytes.count(self.records);
        bytes.list(DIMENSIONS, &self.dimensions, |bytes, (name, length)| {
            bytes.text(name);
            bytes.count(*length);
        });
        bytes.attributes(&self.attributes);
        bytes.list(VARIABLES, &self.variables, |bytes, variable| {
            bytes.text(variable.name);
            bytes.count(variable.dimensions.len());
            self.dimensions_of(variable)
                .for_each(|(place, _)| bytes.count(place));
            bytes.attributes(&variable.attributes);
            bytes.number(variable.kind as u32);
            bytes.count(self.padded_bytes(variable) as usize);
            bytes.bytes.extend(offset(variable).to_be_bytes());
        });
        bytes.bytes
    }
}

/// The bytes of a header up to now.
struct Encoder {
    form: CdfVersion,
    bytes: Vec<u8>,
}

impl Encoder {
    fn number(&mut self, number: u32) {
        self.bytes.extend(number.to_be_bytes());
    }

    /// Appends a count. It fits in the 32 bits of the form with 64-bit offsets, because no larger variable is
    /// written in that form.
    fn count(&mut self, count: usize) {
        let bytes = (count as u64).to_be_bytes();
        self.bytes.extend(&bytes[bytes.len() - self.form.count_bytes()..]);
    }

    /// Appends zeros until the number of bytes is a multiple of four.
    fn pad(&mut self) {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }

    fn text(&mut self, text: &str) {
        self.count(text.len());
        self.bytes.extend(text.as_bytes());
        self.pad();
    }

    fn list<T>(&mut self, tag: u32, elements: &[T], element: impl Fn(&mut Self, &T)) {
        // An empty list has no tag.
        self.number(if elements.is_empty() { 0 } else { tag });
        self.count(elements.len());
        elements.iter().for_each(|one| element(self, one));
    }

    fn attributes(&mut self, attributes: &[Attribute]) {
        self.list(ATTRIBUTES, attributes, |bytes, attribute| {
            bytes.text(attribute.name);
            bytes.number(attribute.kind as u32);
            bytes.count(attribute.count);
            bytes.bytes.extend(&attribute.bytes);
            bytes.pad();
        });
    }
}
