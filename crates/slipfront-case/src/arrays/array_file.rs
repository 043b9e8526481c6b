//! An array or image file that is being read.

use std::io::{BufRead, Read, Seek, SeekFrom};
use std::path::Path;

use super::error::ArrayError;

/// Contents of a file that can be read piece by piece, and from any place.
pub(super) trait ReadAnywhere: BufRead + Seek {}

impl<T: BufRead + Seek> ReadAnywhere for T {}

/// An array or image file that is being read.
pub(super) struct ArrayFile<'a> {
    /// Path of the file, for errors.
    pub(super) path: &'a Path,
    pub(super) source: &'a mut dyn ReadAnywhere,
}

impl ArrayFile<'_> {
    /// Length of the file and its first bytes, at most `most`. The source is rewound afterwards.
    pub(super) fn length_and_head(&mut self, most: u64) -> Result<(u64, Vec<u8>), ArrayError> {
        let read_error = ArrayError::read(self.path);
        let length = self.source.seek(SeekFrom::End(0)).map_err(&read_error)?;
        self.source.rewind().map_err(&read_error)?;
        let mut head = Vec::new();
        let first = (&mut *self.source).take(most).read_to_end(&mut head);
        first.map_err(&read_error)?;
        self.source.rewind().map_err(&read_error)?;
        Ok((length, head))
    }
}
