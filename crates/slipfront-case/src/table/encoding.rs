//! The encoding of a table.

use std::io::{self, Read};
use std::str::from_utf8;

/// Encoding of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// UTF-8, which includes ASCII.
    Utf8,
    /// UTF-16, the lower byte first.
    Utf16Le,
    /// UTF-16, the higher byte first.
    Utf16Be,
    /// Latin-1 with the extensions of Windows (code page 1252): any text that is not valid UTF-8.
    Windows1252,
}

impl Encoding {
    /// The encoding of the text that begins with `head`.
    ///
    /// ```
    /// # use slipfront_case::table::Encoding;
    /// assert_eq!(Encoding::detect(b"\xff\xfet\0"), Encoding::Utf16Le);
    /// assert_eq!(Encoding::detect(b"t (\xb5s)\n"), Encoding::Windows1252);
    /// ```
    pub fn detect(head: &[u8]) -> Self {
        match head {
            [0xff, 0xfe, ..] => return Self::Utf16Le,
            [0xfe, 0xff, ..] => return Self::Utf16Be,
            _ => {}
        }
        // Text of any of these tables is mostly ASCII, and in UTF-16 every second byte of ASCII is zero.
        let zeros = |first: usize| {
            head.iter()
                .skip(first)
                .step_by(2)
                .filter(|byte| **byte == 0)
                .count()
        };
        let (even, odd) = (zeros(0), zeros(1));
        if head.len() > 3 && (even + odd) * 10 > head.len() * 4 {
            return if odd > even { Self::Utf16Le } else { Self::Utf16Be };
        }
        match from_utf8(head) {
            Ok(_) => Self::Utf8,
            // The head may end within a character.
            Err(error) if error.error_len().is_none() => Self::Utf8,
            Err(_) => Self::Windows1252,
        }
    }

    /// The text of a source as UTF-8, without its byte order mark.
    pub(super) fn decoded<R: Read>(self, source: R) -> DecodedText<R> {
        DecodedText {
            encoding: self,
            source,
            bytes: Vec::new(),
            text: String::new(),
            taken: 0,
            is_start: true,
        }
    }

    /// The text of these bytes; invalid bytes are replaced.
    pub(crate) fn text(self, bytes: &[u8]) -> String {
        let mut text = Vec::new();
        // Reading from memory cannot fail.
        let _ = self.decoded(bytes).read_to_end(&mut text);
        String::from_utf8_lossy(&text).into_owned()
    }

    /// Moves the characters at the beginning of `bytes` to the end of `text`. An incomplete character stays,
    /// unless this is the end.
    fn decode(self, bytes: &mut Vec<u8>, text: &mut String, is_end: bool) {
        let of_units = |unit: fn([u8; 2]) -> u16| {
            let (pairs, _) = bytes.as_chunks();
            let mut units = Vec::from_iter(pairs.iter().map(|pair| unit(*pair)));
            // The first half of a surrogate pair waits for the second.
            if !is_end && units.last().is_some_and(|unit| (0xd800..0xdc00).contains(unit)) {
                units.pop();
            }
            units
        };
        let taken = match self {
            Self::Utf8 => {
                let whole = match from_utf8(bytes) {
                    Err(error) if error.error_len().is_none() && !is_end => error.valid_up_to(),
                    _ => bytes.len(),
                };
                text.push_str(&String::from_utf8_lossy(&bytes[..whole]));
                whole
            }
            Self::Windows1252 => {
                text.extend(bytes.iter().map(|byte| match byte {
                    0x80..0xa0 => WINDOWS_1252[usize::from(byte - 0x80)],
                    byte => char::from(*byte),
                }));
                bytes.len()
            }
            Self::Utf16Le | Self::Utf16Be => {
                let units = of_units(match self {
                    Self::Utf16Le => u16::from_le_bytes,
                    _ => u16::from_be_bytes,
                });
                let decoded = char::decode_utf16(units.iter().copied());
                text.extend(decoded.map(|found| found.unwrap_or(char::REPLACEMENT_CHARACTER)));
                2 * units.len()
            }
        };
        bytes.drain(..taken);
    }

    /// The name of the encoding, unless it is UTF-8.
    pub(super) fn unusual(self) -> Option<&'static str> {
        match self {
            Self::Utf8 => None,
            Self::Utf16Le | Self::Utf16Be => Some("UTF-16"),
            Self::Windows1252 => Some("Latin-1"),
        }
    }
}

/// Characters of code page 1252 from 0x80 to 0x9f, where it differs from Latin-1.
const WINDOWS_1252: [char; 32] = [
    '\u{20ac}', '\u{81}', '\u{201a}', '\u{192}', '\u{201e}', '\u{2026}', '\u{2020}', '\u{2021}', '\u{2c6}',
    '\u{2030}', '\u{160}', '\u{2039}', '\u{152}', '\u{8d}', '\u{17d}', '\u{8f}', '\u{90}', '\u{2018}',
    '\u{2019}', '\u{201c}', '\u{201d}', '\u{2022}', '\u{2013}', '\u{2014}', '\u{2dc}', '\u{2122}', '\u{161}',
    '\u{203a}', '\u{153}', '\u{9d}', '\u{17e}', '\u{178}',
];

/// Number of bytes that are decoded at a time.
const CHUNK: u64 = 1 << 16;

/// Converts a text to UTF-8 while it is read. Decoding libraries contain tables for all encodings, which
/// would make the page's module a tenth larger.
pub(super) struct DecodedText<R> {
    encoding: Encoding,
    source: R,
    /// Bytes of an incomplete character.
    bytes: Vec<u8>,
    /// Decoded text; its first `taken` bytes have already been returned.
    text: String,
    taken: usize,
    is_start: bool,
}

impl<R: Read> Read for DecodedText<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while self.taken == self.text.len() {
            (self.taken, self.text) = (0, std::mem::take(&mut self.text));
            self.text.clear();
            let is_end = (&mut self.source).take(CHUNK).read_to_end(&mut self.bytes)? == 0;
            self.encoding.decode(&mut self.bytes, &mut self.text, is_end);
            if self.is_start && !self.text.is_empty() {
                self.is_start = false;
                self.taken = self.text.len() - self.text.trim_start_matches('\u{feff}').len();
            }
            if is_end && self.taken == self.text.len() {
                return Ok(0);
            }
        }
        let mut rest = &self.text.as_bytes()[self.taken..];
        let read = rest.read(into)?;
        self.taken += read;
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::*;

    /// Source that returns its bytes one by one.
    struct OneByOne<'b>(&'b [u8]);

    impl Read for OneByOne<'_> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            let n = into.len().min(1);
            self.0.read(&mut into[..n])
        }
    }

    const TEXT: &str = "\u{feff}t (\u{b5}s);\u{20ac} \u{1f600}\n";

    fn utf_16(bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
        TEXT.encode_utf16().flat_map(bytes).collect()
    }

    #[test_case(Encoding::Utf8, TEXT.as_bytes(); "utf 8")]
    #[test_case(Encoding::Utf16Le, &utf_16(u16::to_le_bytes); "utf 16, low byte first")]
    #[test_case(Encoding::Utf16Be, &utf_16(u16::to_be_bytes); "utf 16, high byte first")]
    fn characters_may_be_cut(encoding: Encoding, bytes: &[u8]) {
        let mut text = String::new();
        encoding
            .decoded(OneByOne(bytes))
            .read_to_string(&mut text)
            .unwrap();
        assert_eq!(text, TEXT.trim_start_matches('\u{feff}'));
    }

    #[test]
    fn what_is_no_character_is_replaced() {
        assert_eq!(
            Encoding::Windows1252.text(b"\xb5\x80\x96"),
            "\u{b5}\u{20ac}\u{2013}"
        );
        assert_eq!(Encoding::Utf8.text(b"a\xc2"), "a\u{fffd}");
        assert_eq!(Encoding::Utf16Le.text(b"a\0\x3d\xd8"), "a\u{fffd}");
    }
}
