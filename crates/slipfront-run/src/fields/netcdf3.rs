//! Elements of the header of a NetCDF-3 file, in the two forms that fields files have.

/// Form of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum CdfVersion {
    /// CDF-2: 64-bit offsets, all other numbers of the header with 32 bits.
    Offset64,
    /// CDF-5: 64-bit data, lengths and counts with 64 bits too.
    Data64,
}

impl CdfVersion {
    /// The first bytes of a file.
    pub(super) fn magic(self) -> &'static [u8; 4] {
        match self {
            CdfVersion::Offset64 => b"CDF\x02",
            CdfVersion::Data64 => b"CDF\x05",
        }
    }

    /// Bytes of a length or a count; tags and types always have 4.
    pub(super) fn count_bytes(self) -> usize {
        match self {
            CdfVersion::Offset64 => 4,
            CdfVersion::Data64 => 8,
        }
    }
}

// Tags at the beginning of the lists of a header.
pub(super) const DIMENSIONS: u32 = 0x0a;
pub(super) const VARIABLES: u32 = 0x0b;
pub(super) const ATTRIBUTES: u32 = 0x0c;

/// Type of a stored number (big-endian), with its code in a header.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ExternalType {
    Byte = 1,
    Char = 2,
    Short = 3,
    Int = 4,
    Float = 5,
    Double = 6,
}

impl ExternalType {
    pub(super) fn from_code(code: u32) -> Option<ExternalType> {
        let all = [
            ExternalType::Byte,
            ExternalType::Char,
            ExternalType::Short,
            ExternalType::Int,
            ExternalType::Float,
            ExternalType::Double,
        ];
        all.into_iter().find(|kind| *kind as u32 == code)
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            ExternalType::Byte | ExternalType::Char => 1,
            ExternalType::Short => 2,
            ExternalType::Int | ExternalType::Float => 4,
            ExternalType::Double => 8,
        }
    }

    pub(super) fn decode(self, bytes: &[u8]) -> impl Iterator<Item = f64> {
        let number = move |bytes: &[u8]| match (self, bytes) {
            (ExternalType::Byte, [a]) => f64::from(i8::from_be_bytes([*a])),
            (ExternalType::Short, [a, b]) => f64::from(i16::from_be_bytes([*a, *b])),
            (ExternalType::Int, [a, b, c, d]) => f64::from(i32::from_be_bytes([*a, *b, *c, *d])),
            (ExternalType::Float, [a, b, c, d]) => f64::from(f32::from_be_bytes([*a, *b, *c, *d])),
            (ExternalType::Double, [a, b, c, d, e, f, g, h]) => {
                f64::from_be_bytes([*a, *b, *c, *d, *e, *f, *g, *h])
            }
            (_, bytes) => bytes.first().copied().map_or(0.0, f64::from),
        };
        bytes.chunks_exact(self.bytes()).map(number)
    }
}

/// A number that can be stored.
pub(super) trait StoredNumber: Copy {
    const KIND: ExternalType;
    type Bytes: AsRef<[u8]>;

    fn encode(self) -> Self::Bytes;
}

macro_rules! stored_as {
    ($($number:ty: $kind:ident),*) => {$(
        impl StoredNumber for $number {
            const KIND: ExternalType = ExternalType::$kind;
            type Bytes = [u8; size_of::<$number>()];

            fn encode(self) -> Self::Bytes {
                self.to_be_bytes()
            }
        }
    )*};
}

stored_as!(u8: Char, i16: Short, i32: Int, f32: Float, f64: Double);
