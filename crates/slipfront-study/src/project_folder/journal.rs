//! Journals: a line for every finished run, appended and synced to disk.
//!
//! A line that is incomplete after a crash, or damaged later, fails its checksum, and its run counts as not
//! done. Before anything is appended, an incomplete line at the end of the file is cut off.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use slipfront_base::disk::{open_limited, sync_folder};
use slipfront_base::unfinished::clear_unfinished;
use slipfront_run::manifest::ManifestFile;

use super::line::{JournalEntry, Line, looks_like_ours, may_begin_ours, parse_line, to_line};
use crate::error::StudyError;

/// A file with an entry on each line, open in only one process.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens the file of this name in a folder, unless another process has it open; creates it if it is
    /// missing. Returns the entries in it, and the number of lines that failed their checksum.
    pub fn open<T: JournalEntry>(folder: &Path, name: &str) -> Result<(Self, Vec<T>, usize), StudyError> {
        let path = folder.join(name);
        let mut file = open_locked(&path, folder)?;
        // If the study was killed and has changed since, it may not write the same files again.
        clear_unfinished(folder);
        let lines = JournalLines::read(&mut file).map_err(failed("open", &path))?;
        lines.expect_ours(&path)?;
        lines.repair_end(&mut file).map_err(failed("write to", &path))?;
        file.seek(SeekFrom::End(0)).map_err(failed("open", &path))?;
        // A new file survives a power failure only once its folder is synced.
        if lines.bytes == 0 {
            sync_folder(folder).map_err(failed("write to", &path))?;
        }
        Ok((Self { path, file }, lines.entries, lines.damaged))
    }

    /// Reads the file of this name in a folder, even if another process has it open: returns its entries, and
    /// the number of lines that failed their checksum.
    ///
    /// # Errors
    /// When the file cannot be read, or has no entries of this kind.
    pub fn read<T: JournalEntry>(folder: &Path, name: &str) -> Result<(Vec<T>, usize), StudyError> {
        let lines = JournalLines::read_at(&folder.join(name))?;
        Ok((lines.entries, lines.damaged))
    }

    /// Copies a file of entries of this kind, called `name`, from one folder to another. It is checked first,
    /// so a file without such entries is not copied, however long it is.
    pub fn copy<T: JournalEntry>(from: &Path, to: &Path, name: &str) -> Result<(), StudyError> {
        let path = from.join(name);
        let bytes = JournalLines::<T>::read_at(&path)?.bytes;
        let to = to.join(name);
        let copied = File::create(&to)
            .and_then(|mut to| std::io::copy(&mut open_limited(&path, u64::MAX)?.take(bytes), &mut to));
        copied.map(drop).map_err(failed("write to", &to))
    }

    /// The file with its present checksum. It is read through its own handle: Windows lets no other handle
    /// read a file that is locked.
    ///
    /// # Errors
    /// When the system refuses to read it.
    pub fn listed(&self) -> Result<ManifestFile, StudyError> {
        let (mut file, mut hasher) = (&self.file, blake3::Hasher::new());
        let read = file.rewind().and_then(|()| hasher.update_reader(file).map(drop));
        read.map_err(failed("read", &self.path))?;
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        Ok(ManifestFile::hashed(&name, &hasher))
    }

    /// Appends entries, each as a line, and waits until they are on disk; earlier entries stay intact.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub fn append(&mut self, entries: impl IntoIterator<Item = impl Serialize>) -> Result<(), StudyError> {
        let lines: Vec<u8> = entries.into_iter().flat_map(|entry| to_line(&entry)).collect();
        if lines.is_empty() {
            return Ok(());
        }
        let Self { path, file } = self;
        let before = file.stream_position();
        let before = before.map_err(failed("write to", path))?;
        let appended = file.write_all(&lines).and_then(|()| file.sync_data());
        appended.map_err(|source| {
            // Complete lines stay. If an incomplete line cannot be cut off, the next start does it.
            let length = file.metadata().map_or(0, |file| file.len());
            let there = length.saturating_sub(before) as usize;
            let there = &lines[..lines.len().min(there)];
            let last_break = there.iter().rposition(|&byte| byte == b'\n');
            let whole = last_break.map_or(0, |end| end + 1);
            let _ = file.set_len(before + whole as u64);
            failed("write to", path)(source)
        })
    }
}

/// The error of an action on a journal that the system refused.
fn failed(action: &'static str, path: &Path) -> impl Fn(std::io::Error) -> StudyError {
    move |source| StudyError::Journal {
        action,
        path: path.to_owned(),
        source,
    }
}

/// Opens the journal and locks it for this process.
fn open_locked(path: &Path, folder: &Path) -> Result<File, StudyError> {
    let mut options = OpenOptions::new();
    options.read(true).append(true).create(true);
    let file = options.open(path).map_err(failed("open", path))?;
    let metadata = file.metadata().map_err(failed("open", path))?;
    // Reading a pipe would wait for a writer, and reading a device might not end.
    if !metadata.is_file() {
        return Err(StudyError::NotJournal {
            path: path.to_owned(),
        });
    }
    // Some file systems of clusters do not support locks; the study runs there without one.
    if let Err(TryLockError::WouldBlock) = file.try_lock() {
        return Err(StudyError::Busy {
            path: folder.to_owned(),
        });
    }
    Ok(file)
}

/// Largest length of a line in a journal: hundreds of times that of a run.
const LINE_MAX_BYTES: u64 = 1 << 20;

/// The contents of a journal.
struct JournalLines<T> {
    entries: Vec<T>,
    /// Lines that fail their checksum.
    damaged: usize,
    /// Whether a line is an entry or may once have been one.
    ours: bool,
    /// Whether a line is complete, but not an entry of this kind.
    is_of_others: bool,
    /// Whether a line is longer than any entry.
    too_long: bool,
    bytes: u64,
    /// Whether the last line is an entry without a line break.
    lacks_break: bool,
    /// Position of the beginning of the last line, if that line is incomplete.
    cut_at: Option<u64>,
}

impl<T: JournalEntry> JournalLines<T> {
    /// Reads a file that may be open elsewhere, and refuses one without such entries.
    fn read_at(path: &Path) -> Result<Self, StudyError> {
        let read = open_limited(path, u64::MAX).and_then(|mut file| Self::read(&mut file));
        let lines = read.map_err(failed("read", path))?;
        lines.expect_ours(path)?;
        Ok(lines)
    }

    /// Reads line by line, so a file of any length takes no more memory than its entries.
    fn read(file: &mut impl Read) -> std::io::Result<Self> {
        let mut file = BufReader::new(file);
        let mut lines = Self {
            entries: Vec::new(),
            damaged: 0,
            ours: false,
            is_of_others: false,
            too_long: false,
            bytes: 0,
            lacks_break: false,
            cut_at: None,
        };
        let mut line = Vec::new();
        while !lines.too_long {
            line.clear();
            let read = file.by_ref().take(LINE_MAX_BYTES).read_until(b'\n', &mut line)? as u64;
            if read == 0 {
                break;
            }
            let begin = lines.bytes;
            lines.bytes += read;
            let broken = line.pop_if(|last| *last == b'\n').is_some();
            lines.too_long = !broken && read == LINE_MAX_BYTES;
            if line.is_empty() {
                continue;
            }
            lines.ours |= looks_like_ours(&line) || (!broken && may_begin_ours(&line));
            match parse_line(&line) {
                Some(Line::Entry(entry)) => {
                    lines.entries.push(entry);
                    lines.lacks_break = !broken;
                }
                // Its run counts as not done, as for a damaged line.
                Some(Line::OfOtherVersion) => lines.damaged += 1,
                Some(Line::OfOtherKind) => lines.is_of_others = true,
                None => {
                    lines.damaged += 1;
                    lines.cut_at = (!broken).then_some(begin);
                }
            }
        }
        Ok(lines)
    }

    /// Makes the file end with a line break, so that the next entry begins a new line: adds a missing line
    /// break, or cuts off an incomplete entry.
    fn repair_end(&self, file: &mut File) -> std::io::Result<()> {
        match self.cut_at {
            Some(begin) => file.set_len(begin),
            None if self.lacks_break => file.write_all(b"\n").and_then(|()| file.sync_data()),
            None => Ok(()),
        }
    }

    /// Refuses a file that is not a journal, not even a damaged one, or has entries of another kind.
    fn expect_ours(&self, path: &Path) -> Result<(), StudyError> {
        let path = path.to_owned();
        if self.too_long || (self.damaged > 0 && !self.ours) {
            return Err(StudyError::NotJournal { path });
        }
        if self.is_of_others {
            return Err(StudyError::OtherJournal { path });
        }
        Ok(())
    }
}
