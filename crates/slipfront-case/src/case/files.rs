//! Locations of the files that a case names: a folder, or memory.

use std::collections::HashMap;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::Arc;

/// Callback for the progress of making a case: it gets the share of a file that has been read, or of the
/// texture that has been laid over the blocks. The result `false` ends the work.
pub type Watch<'a> = dyn FnMut(f64) -> bool + 'a;

/// Contents of files by the names that a case gives them.
pub type FilesInMemory = HashMap<String, Arc<[u8]>>;

/// Locations of the files that a case names.
#[derive(Clone, Copy)]
pub struct Files<'a> {
    /// The folder to which names of files are relative.
    pub folder: &'a Path,
    /// Files in memory, which take precedence over the folder.
    pub in_memory: Option<&'a FilesInMemory>,
}

impl<'a> From<&'a Path> for Files<'a> {
    fn from(folder: &'a Path) -> Self {
        Self {
            folder,
            in_memory: None,
        }
    }
}

/// An open file, on the disk or in memory.
pub type OpenFile = Box<dyn ReadSeek>;

/// Contents of a file that can be read from any place.
pub trait ReadSeek: Read + Seek {}

impl<T: Read + Seek> ReadSeek for T {}

/// Opens contents that are in memory.
pub(super) fn open_in_memory(contents: &Arc<[u8]>) -> OpenFile {
    Box::new(Cursor::new(Arc::clone(contents)))
}

/// A file with reads that can be stopped: each read first calls `watch`, for every file format. The file ends
/// at its length when it was opened, because a growing file may have no end.
pub(super) struct Watched<'a, 'w> {
    file: OpenFile,
    /// Length of the file, and the place of the next read.
    length: u64,
    place: u64,
    watch: &'a mut Watch<'w>,
    /// Whether a read was refused to stop the work.
    pub(super) is_stopped: bool,
}

impl<'a, 'w> Watched<'a, 'w> {
    /// Begins to read a file of this length.
    pub(super) fn new(file: OpenFile, length: u64, watch: &'a mut Watch<'w>) -> Self {
        Self {
            file,
            length,
            place: 0,
            watch,
            is_stopped: false,
        }
    }
}

impl Read for Watched<'_, '_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let share = self.place as f64 / self.length.max(1) as f64;
        if !(self.watch)(share.min(1.0)) {
            self.is_stopped = true;
            return Err(io::Error::other("stopped"));
        }
        let left = self.length.saturating_sub(self.place);
        let most = bytes.len().min(left.try_into().unwrap_or(usize::MAX));
        let count = self.file.read(&mut bytes[..most])?;
        self.place += count as u64;
        Ok(count)
    }
}

impl Seek for Watched<'_, '_> {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.place = self.file.seek(place)?;
        Ok(self.place)
    }
}
