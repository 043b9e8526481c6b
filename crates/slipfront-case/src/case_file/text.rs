//! The text of a case or study file.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use super::error::CaseError;
use crate::nearest::similar_file;

/// Largest case file that is read, in MiB.
const MAX_MIB: u64 = 16;

/// Reads a case or study file of at most 16 MiB.
///
/// # Errors
/// When the path is missing, a folder, too large, or not UTF-8 text.
pub fn read_text(path: &Path) -> Result<String, CaseError> {
    let path = path.to_owned();
    if path.is_dir() {
        let near = path.join("case.toml");
        if near.is_file() {
            return Err(CaseError::Misspelt { path, near });
        }
        return Err(CaseError::Folder { path });
    }
    let file = File::open(&path).map_err(|source| {
        let is_missing = source.kind() == ErrorKind::NotFound;
        match similar_file(&path).filter(|_| is_missing) {
            Some(near) => CaseError::Misspelt {
                path: path.clone(),
                near,
            },
            None => CaseError::Unreadable {
                path: path.clone(),
                source,
            },
        }
    })?;
    read_text_from(file, &path)
}

/// Reads the text of a case of at most 16 MiB from an open file or a pipe; errors call it `path`.
///
/// # Errors
/// When it cannot be read, is too large, or is not UTF-8 text.
pub fn read_text_from(input: impl Read, path: &Path) -> Result<String, CaseError> {
    let path = path.to_owned();
    let limit = MAX_MIB << 20;
    let mut bytes = Vec::new();
    // The limit applies to the bytes that are read, because a device or a pipe reports no size.
    if let Err(source) = input.take(limit + 1).read_to_end(&mut bytes) {
        return Err(CaseError::Unreadable { path, source });
    }
    if bytes.len() as u64 > limit {
        let limit_mib = MAX_MIB;
        return Err(CaseError::TooLarge { path, limit_mib });
    }
    if is_utf16(&bytes) {
        return Err(CaseError::Utf16 { path });
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.iter().filter(|byte| **byte == b'\n').count() + 1;
        CaseError::NotText { path, line }
    })
}

/// Whether text is UTF-16: it begins with a byte order mark, or with an ASCII character next to a zero byte.
fn is_utf16(bytes: &[u8]) -> bool {
    matches!(
        bytes,
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [1..=127, 0, ..] | [0, 1..=127, ..]
    )
}
