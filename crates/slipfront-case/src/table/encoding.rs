//! The encoding of a table.

use std::io::Read;
use std::str::from_utf8;

use encoding_rs::{UTF_16BE, UTF_16LE, WINDOWS_1252};
use encoding_rs_io::{DecodeReaderBytes, DecodeReaderBytesBuilder};

/// Encoding of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// UTF-8, of which ASCII is a part.
    Utf8,
    /// UTF-16, the lower byte first.
    Utf16Le,
    /// UTF-16, the higher byte first.
    Utf16Be,
    /// Latin-1 as Windows extends it (code page 1252): what is not valid UTF-8.
    Windows1252,
}

impl Encoding {
    /// The encoding of the text that begins with `head`.
    ///
    /// ```
    /// # use slipfront_case::table::Encoding;
    /// assert_eq!(Encoding::of(b"\xff\xfet\0"), Encoding::Utf16Le);
    /// assert_eq!(Encoding::of(b"t (\xb5s)\n"), Encoding::Windows1252);
    /// ```
    pub fn of(head: &[u8]) -> Self {
        match head {
            [0xff, 0xfe, ..] => return Self::Utf16Le,
            [0xfe, 0xff, ..] => return Self::Utf16Be,
            _ => {}
        }
        // Text of any of these tables is mostly ASCII, of which every second byte of UTF-16 is zero.
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

    /// The text of a source as UTF-8, without the mark of its byte order.
    pub(super) fn decoded<R: Read>(self, source: R) -> DecodeReaderBytes<R, Vec<u8>> {
        let encoding = match self {
            Self::Utf8 => None,
            Self::Utf16Le => Some(UTF_16LE),
            Self::Utf16Be => Some(UTF_16BE),
            Self::Windows1252 => Some(WINDOWS_1252),
        };
        DecodeReaderBytesBuilder::new()
            .encoding(encoding)
            .strip_bom(true)
            .build(source)
    }

    /// The text of these bytes; what is none is replaced.
    pub(crate) fn text(self, bytes: &[u8]) -> String {
        let mut text = String::new();
        // Nothing fails where bytes are in memory, and all that is decoded is UTF-8.
        let _ = self.decoded(bytes).read_to_string(&mut text);
        text
    }

    /// The name of the encoding, unless it is the usual one.
    pub(super) fn unusual(self) -> Option<&'static str> {
        match self {
            Self::Utf8 => None,
            Self::Utf16Le | Self::Utf16Be => Some("UTF-16"),
            Self::Windows1252 => Some("Latin-1"),
        }
    }
}
