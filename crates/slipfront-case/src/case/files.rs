//! The places of the files that a case names: a folder, or memory.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::Arc;

/// Contents of files by the names that a case gives them.
pub type FilesInMemory = HashMap<String, Arc<[u8]>>;

/// The places of the files that a case names.
#[derive(Clone, Copy)]
pub struct Files<'a> {
    /// The folder to which names of files are relative.
    pub folder: &'a Path,
    /// Files in memory, which are not looked for in the folder.
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

/// A file that was opened.
#[derive(Debug)]
pub enum Opened {
    /// A file on the disk.
    OnDisk(File),
    /// A file in memory.
    InMemory(Cursor<Arc<[u8]>>),
}

impl Opened {
    /// Opens contents that are in memory.
    pub(super) fn in_memory(contents: &Arc<[u8]>) -> Self {
        Self::InMemory(Cursor::new(Arc::clone(contents)))
    }
}

impl Read for Opened {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::OnDisk(file) => file.read(bytes),
            Self::InMemory(contents) => contents.read(bytes),
        }
    }
}

impl Seek for Opened {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        match self {
            Self::OnDisk(file) => file.seek(place),
            Self::InMemory(contents) => contents.seek(place),
        }
    }
}
