//! The beginning of an array file, which is read before its numbers.

use std::io::{BufRead, Read, Seek, SeekFrom};
use std::path::Path;

use super::error::ArrayError;

/// Length of a source and its first bytes, at most `most`. The source is rewound afterwards.
pub(super) fn length_and_head(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    most: u64,
) -> Result<(u64, Vec<u8>), ArrayError> {
    let read_error = ArrayError::read(path);
    let length = source.seek(SeekFrom::End(0)).map_err(&read_error)?;
    source.rewind().map_err(&read_error)?;
    let mut head = Vec::new();
    let first = source.take(most).read_to_end(&mut head);
    first.map_err(&read_error)?;
    source.rewind().map_err(&read_error)?;
    Ok((length, head))
}
