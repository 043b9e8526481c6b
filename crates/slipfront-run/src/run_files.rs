//! The files of a run, in its folder or in memory.

use std::io::{Cursor, ErrorKind, Read, Seek};
use std::path::{Path, PathBuf};

use slipfront_base::disk::{expect_at_most, found_behind, open_regular};

use crate::folder_error::FolderError;

/// Files of a run: all of its folder, or some in memory.
#[derive(Clone, Copy, Debug)]
pub enum RunFiles<'a> {
    /// A folder on disk.
    Folder(&'a Path),
    /// Contents of files, by their names in the folder that the run would have.
    InMemory(&'a [(String, Vec<u8>)]),
}

impl<'a> RunFiles<'a> {
    /// Path that names the run in errors and legends; empty in memory.
    pub fn path(self) -> &'a Path {
        match self {
            Self::Folder(path) => path,
            Self::InMemory(_) => Path::new(""),
        }
    }

    /// Returns a file that every run has written. In a folder, its existence is checked only when it is read.
    ///
    /// # Errors
    /// If the file is not among those in memory.
    pub fn file(self, name: &str) -> Result<RunFile<'a>, FolderError> {
        let path = self.path().join(name);
        match self {
            Self::Folder(_) => Ok(RunFile::from(path)),
            Self::InMemory(_) => self
                .found(name)?
                .ok_or_else(|| FolderError::read(&path)(ErrorKind::NotFound.into())),
        }
    }

    /// Returns a file that a run may not have written; none if it does not exist.
    ///
    /// # Errors
    /// If the system cannot determine whether the file exists.
    pub fn found(self, name: &str) -> Result<Option<RunFile<'a>>, FolderError> {
        let path = self.path().join(name);
        match self {
            Self::Folder(_) => {
                let found = found_behind(&path).map_err(FolderError::read(&path))?;
                Ok(found.map(|_| RunFile::from(path)))
            }
            Self::InMemory(files) => {
                let mut files = files.iter();
                let found = files.find(|(known, _)| known == name);
                Ok(found.map(|(_, contents)| RunFile::of_bytes(path, contents)))
            }
        }
    }
}

/// Bytes that can be read from any position.
pub(crate) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// A file of a run, on the disk or in memory.
#[derive(Clone, Debug)]
pub struct RunFile<'a> {
    path: PathBuf,
    /// Contents of a file in memory; none on the disk.
    contents: Option<&'a [u8]>,
}

impl From<PathBuf> for RunFile<'_> {
    /// The file on disk at this path.
    fn from(path: PathBuf) -> Self {
        Self { path, contents: None }
    }
}

impl<P: AsRef<Path> + ?Sized> From<&P> for RunFile<'_> {
    /// The file on disk at this path.
    fn from(path: &P) -> Self {
        path.as_ref().to_owned().into()
    }
}

impl<'a> RunFile<'a> {
    /// A file in memory, which errors name by this path.
    pub fn of_bytes(path: impl Into<PathBuf>, contents: &'a [u8]) -> Self {
        Self {
            path: path.into(),
            contents: Some(contents),
        }
    }

    /// Path that names the file in errors.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Opens the file. Returns its bytes, from the first one on, and their number.
    ///
    /// # Errors
    /// If a file on disk is not a regular file, or cannot be opened.
    pub(crate) fn open(&self) -> std::io::Result<(Box<dyn Source + 'a>, u64)> {
        if let Some(contents) = self.contents {
            return Ok((Box::new(Cursor::new(contents)), contents.len() as u64));
        }
        let file = open_regular(&self.path)?;
        let length = file.metadata()?.len();
        Ok((Box::new(file), length))
    }

    /// Reads a file of at most `most` bytes.
    ///
    /// # Errors
    /// If it is longer, or cannot be read.
    pub(crate) fn read(&self, most: u64) -> std::io::Result<Vec<u8>> {
        let (file, length) = self.open()?;
        expect_at_most(length, most)?;
        let mut bytes = Vec::new();
        file.take(most).read_to_end(&mut bytes)?;
        Ok(bytes)
    }
}
