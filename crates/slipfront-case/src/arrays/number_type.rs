//! Types of numbers in binary files.

/// Type of the stored numbers.
pub(super) struct NumberType {
    kind: Kind,
    /// Size of a number: 1, 2, 4 or 8 bytes.
    pub(super) size: usize,
    big_endian: bool,
}

#[derive(Clone, Copy)]
enum Kind {
    /// Unsigned integers; boolean values are 0 and 1.
    Unsigned,
    Signed,
    Float,
}

impl NumberType {
    /// The type of this name, such as `<f8`; `None` unless it is a boolean, integer or real type of at most
    /// 64 bits.
    pub(super) fn from_name(name: &str) -> Option<NumberType> {
        let mut letters = name.chars();
        let big_endian = match letters.next()? {
            '<' | '|' | '=' => false,
            '>' => true,
            _ => return None,
        };
        let kind = letters.next()?;
        let (kind, size) = match (kind, letters.as_str()) {
            ('b' | 'u', "1") => (Kind::Unsigned, 1),
            ('i', "1") => (Kind::Signed, 1),
            ('u' | 'i' | 'f', size @ ("2" | "4" | "8")) => {
                let kind = match kind {
                    'u' => Kind::Unsigned,
                    'i' => Kind::Signed,
                    _ => Kind::Float,
                };
                (kind, size.parse().ok()?)
            }
            _ => return None,
        };
        Some(NumberType {
            kind,
            size,
            big_endian,
        })
    }

    /// Decodes stored numbers.
    pub(super) fn decode(&self, stored: &[u8], numbers: &mut [f64]) {
        match self.size {
            1 => self.decode_sized::<1>(stored, numbers),
            2 => self.decode_sized::<2>(stored, numbers),
            4 => self.decode_sized::<4>(stored, numbers),
            _ => self.decode_sized::<8>(stored, numbers),
        }
    }

    /// Decodes numbers of `SIZE` bytes, which is the `size` of the type.
    fn decode_sized<const SIZE: usize>(&self, stored: &[u8], numbers: &mut [f64]) {
        for (number, stored) in numbers.iter_mut().zip(stored.as_chunks().0) {
            *number = self.value::<SIZE>(*stored);
        }
    }

    /// The value of `SIZE` bytes; integers beyond 2^53 are rounded.
    #[inline(always)]
    fn value<const SIZE: usize>(&self, mut stored: [u8; SIZE]) -> f64 {
        if self.big_endian {
            stored.reverse();
        }
        let bits = stored
            .iter()
            .rev()
            .fold(0, |bits, byte| bits << 8 | u64::from(*byte));
        let unused = 64 - 8 * SIZE as u32;
        match (self.kind, SIZE) {
            (Kind::Float, 2) => half(bits as u16),
            (Kind::Float, 4) => f64::from(f32::from_bits(bits as u32)),
            (Kind::Float, _) => f64::from_bits(bits),
            // Shifting up and back down carries the sign into the unused bytes.
            (Kind::Signed, _) => ((bits << unused) as i64 >> unused) as f64,
            _ => bits as f64,
        }
    }
}

/// The value of an IEEE 754 number of 16 bits: 1 sign, 5 exponent, 10 fraction.
fn half(bits: u16) -> f64 {
    let fraction = f64::from(bits & 0x3ff);
    let magnitude = match i32::from(bits >> 10 & 0x1f) {
        0 => fraction * 2f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1024.0 + fraction) * 2f64.powi(exponent - 25),
    };
    if bits >> 15 == 0 { magnitude } else { -magnitude }
}
