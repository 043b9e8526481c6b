//! Journals: a line for every run that has ended, appended and forced to the disk.
//!
//! A line that a crash cut short, or that was damaged later, fails its checksum, and its run counts as not done. Before
//! anything is appended, a part of a line at the end of the file is cut off.

use std::collections::HashMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::StudyError;
use crate::record::{
    FinishedRun, JournalRecord, Line, RunResult, looks_like_ours, may_begin_ours, parse_line, to_line,
};
use slipfront_base::disk::{open_limited, sync_folder};
use slipfront_base::unfinished::clear_unfinished;
use slipfront_run::names::RECORDS;

/// A file of records, a line each, open for one process alone.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens the file of this name in a folder, unless another process has it open, and makes an empty one where there is
    /// none. Returns the records in it, and the number of lines that failed their checksum.
    pub fn open<T: JournalRecord>(folder: &Path, name: &str) -> Result<(Self, Vec<T>, usize), StudyError> {
        let path = folder.join(name);
        let mut file = open_locked(&path, folder)?;
        // A study that has changed since it was killed may not write the same files again.
        clear_unfinished(folder);
        let lines = JournalLines::read(&mut file).map_err(failed("open", &path))?;
        lines.expect_ours(&path)?;
        lines.repair_end(&mut file).map_err(failed("write to", &path))?;
        file.seek(SeekFrom::End(0)).map_err(failed("open", &path))?;
        // A new file survives a power cut only once its folder is on the disk.
        if lines.bytes == 0 {
            sync_folder(folder).map_err(failed("write to", &path))?;
        }
        Ok((Self { path, file }, lines.records, lines.damaged))
    }

    /// Copies a file of records of this kind, called `name`, from one folder to another. It is looked at before: what is no record is
    /// not copied, however long it is.
    pub fn copy<T: JournalRecord>(from: &Path, to: &Path, name: &str) -> Result<(), StudyError> {
        let path = from.join(name);
        let open = || open_limited(&path, u64::MAX);
        let lines = open().and_then(|mut file| JournalLines::<T>::read(&mut file));
        let lines = lines.map_err(failed("read", &path))?;
        lines.expect_ours(&path)?;
        let to = to.join(name);
        let copied =
            File::create(&to).and_then(|mut to| std::io::copy(&mut open()?.take(lines.bytes), &mut to));
        copied.map(drop).map_err(failed("write to", &to))
    }

    /// Appends lines and waits until they are on the disk; earlier records stay whole.
    pub fn append(&mut self, lines: &[u8]) -> Result<(), StudyError> {
        let Self { path, file } = self;
        let before = file.stream_position();
        let before = before.map_err(failed("write to", path))?;
        let appended = file.write_all(lines).and_then(|()| file.sync_data());
        appended.map_err(|source| {
            // Whole lines stay. If a part of a line cannot be cut off, the next start does it.
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

/// The record file of a study folder, open for one process alone, whose threads may share it.
#[derive(Debug)]
pub struct Records {
    written: Mutex<Written>,
    /// Lines that failed their checksum.
    pub damaged: usize,
}

/// The file, and the results in it.
#[derive(Debug)]
struct Written {
    journal: Journal,
    results: HashMap<String, RunResult>,
}

impl Records {
    /// Name of the record file in its folder.
    pub const FILE: &str = RECORDS;

    /// Opens the records of a study folder, unless another process has them open; a folder without them gets an empty file.
    pub fn open(folder: &Path) -> Result<Self, StudyError> {
        let (journal, records, damaged) = Journal::open(folder, RECORDS)?;
        // Each record is dropped before the next is looked at.
        let results = records.into_iter().map(|record| entry(&record));
        Ok(Self {
            written: Mutex::new(Written {
                journal,
                results: results.collect(),
            }),
            damaged,
        })
    }

    /// The file and results, locked for this thread. A thread that panicked has left them whole: results are added last.
    fn written(&self) -> MutexGuard<'_, Written> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The result of the run with this identity, if it is recorded.
    pub fn get(&self, id: &str) -> Option<RunResult> {
        self.written().results.get(id).cloned()
    }

    /// Number of runs recorded.
    pub fn len(&self) -> usize {
        self.written().results.len()
    }

    /// Whether the file has no records.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Appends finished runs that are not recorded yet and waits until they are on the disk; earlier records stay whole.
    pub fn append(&self, records: &[FinishedRun]) -> Result<(), StudyError> {
        let Written { journal, results } = &mut *self.written();
        // Studies that share the file may have made the same run at the same time.
        let unknown = records.iter().filter(|record| !results.contains_key(&record.id));
        let lines: Vec<u8> = unknown.flat_map(to_line).collect();
        if lines.is_empty() {
            return Ok(());
        }
        journal.append(&lines)?;
        results.extend(records.iter().map(entry));
        Ok(())
    }

    /// Appends the records of another folder that are not here yet, and returns their number.
    pub fn merge(&mut self, folder: &Path) -> Result<usize, StudyError> {
        let path = folder.join(RECORDS);
        let read =
            open_limited(&path, u64::MAX).and_then(|mut file| JournalLines::<FinishedRun>::read(&mut file));
        let lines = read.map_err(failed("read", &path))?;
        lines.expect_ours(&path)?;
        self.damaged += lines.damaged;
        let mut records = lines.records;
        records.retain(|record| self.get(&record.id).is_none());
        // Their lines need not be in memory all at once.
        for some in records.chunks(LINES_AT_ONCE) {
            self.append(some)?;
        }
        Ok(records.len())
    }
}

/// The part of a record that is kept in memory.
fn entry(record: &FinishedRun) -> (String, RunResult) {
    (record.id.clone(), record.outcome.result())
}

/// The error of an action on a record file that the system refused.
fn failed(action: &'static str, path: &Path) -> impl Fn(std::io::Error) -> StudyError {
    move |source| StudyError::Records {
        action,
        path: path.to_owned(),
        source,
    }
}

/// Opens the record file and locks it for this process.
fn open_locked(path: &Path, folder: &Path) -> Result<File, StudyError> {
    let mut options = OpenOptions::new();
    options.read(true).append(true).create(true);
    let file = options.open(path).map_err(failed("open", path))?;
    let metadata = file.metadata().map_err(failed("open", path))?;
    // Reading a pipe would wait for a writer, and reading a device might not end.
    if !metadata.is_file() {
        return Err(StudyError::NotRecords {
            path: path.to_owned(),
        });
    }
    // Some file systems of clusters have no locks; the study runs there without one.
    if let Err(TryLockError::WouldBlock) = file.try_lock() {
        return Err(StudyError::Busy {
            path: folder.to_owned(),
        });
    }
    Ok(file)
}

/// Number of records whose lines are written at once: each time waits for the disk.
const LINES_AT_ONCE: usize = 1000;

/// The longest line of a record file: hundreds of times what a run takes.
const LINE_MAX_BYTES: u64 = 1 << 20;

/// The contents of a record file.
struct JournalLines<T> {
    records: Vec<T>,
    /// Lines that fail their checksum.
    damaged: usize,
    /// Whether a line is a record or may once have been one.
    ours: bool,
    /// Whether a line is whole, but no record of this kind.
    is_of_others: bool,
    /// Whether a line is longer than any record.
    too_long: bool,
    bytes: u64,
    /// Whether the last line is a record without a line break.
    lacks_break: bool,
    /// Position at which the last line begins, if it is a part of a line.
    cut_at: Option<u64>,
}

impl<T: JournalRecord> JournalLines<T> {
    /// Reads line by line: a file of any length takes no more memory than its records.
    fn read(file: &mut impl Read) -> std::io::Result<Self> {
        let mut file = BufReader::new(file);
        let mut lines = Self {
            records: Vec::new(),
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
                Some(Line::Record(record)) => {
                    lines.records.push(record);
                    lines.lacks_break = !broken;
                }
                // Its run counts as not made, as that of a damaged line.
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

    /// Makes the file end with a line break, so that the next record begins a line: a record that lacks its line break gets
    /// it, and a part of a record is cut off.
    fn repair_end(&self, file: &mut File) -> std::io::Result<()> {
        match self.cut_at {
            Some(begin) => file.set_len(begin),
            None if self.lacks_break => file.write_all(b"\n").and_then(|()| file.sync_data()),
            None => Ok(()),
        }
    }

    /// Refuses a file that is not a record file, not even a damaged one, or has records of another kind.
    fn expect_ours(&self, path: &Path) -> Result<(), StudyError> {
        let path = path.to_owned();
        if self.too_long || (self.damaged > 0 && !self.ours) {
            return Err(StudyError::NotRecords { path });
        }
        if self.is_of_others {
            return Err(StudyError::OtherRecords { path });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Outcome;

    fn record(id: &str) -> FinishedRun {
        FinishedRun {
            id: id.to_owned(),
            wall_time_s: 0.5,
            outcome: Outcome::Done(Box::default()),
        }
    }

    /// A line that lacks its line break alone is whole.
    #[test]
    fn a_line_cut_short_anywhere_is_not_run_and_does_not_harm_the_next() {
        let whole = to_line(&record("a"));
        let next = to_line(&record("b"));
        // Every place would be a thousand waits for the disk.
        for cut in (0..40)
            .chain((40..next.len() - 1).step_by(97))
            .chain([next.len() - 2, next.len() - 1])
        {
            let left = usize::from(cut == next.len() - 1);
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join(RECORDS), [&whole[..], &next[..cut]].concat()).unwrap();
            let records = Records::open(folder.path()).unwrap();
            assert_eq!(
                (records.len(), records.get("b").is_some()),
                (1 + left, left == 1),
                "cut at {cut}"
            );
            records.append(&[record("c")]).unwrap();
            drop(records);
            let records = Records::open(folder.path()).unwrap();
            assert_eq!((records.len(), records.damaged), (2 + left, 0), "cut at {cut}");
            // The first line of all may be cut as well.
            std::fs::write(folder.path().join(RECORDS), &next[..cut]).unwrap();
            drop(records);
            let records = Records::open(folder.path()).unwrap();
            assert_eq!(records.len(), left, "cut at {cut}");
        }
    }

    #[test]
    fn a_flipped_bit_spoils_its_own_line_only() {
        let lines = [
            to_line(&record("a")),
            to_line(&record("b")),
            to_line(&record("c")),
        ]
        .concat();
        let middle = lines.len() / 2;
        for bit in 0..8 {
            let mut damaged = lines.clone();
            damaged[middle] ^= 1 << bit;
            let lines = JournalLines::<FinishedRun>::read(&mut damaged.as_slice()).unwrap();
            let ids: Vec<&str> = lines.records.iter().map(|record| record.id.as_str()).collect();
            assert_eq!(ids, ["a", "c"]);
            assert!(lines.damaged >= 1);
        }
    }

    #[test]
    fn one_process_at_a_time_and_no_foreign_file() {
        let folder = tempfile::tempdir().unwrap();
        let first = Records::open(folder.path()).unwrap();
        assert!(matches!(
            Records::open(folder.path()),
            Err(StudyError::Busy { .. })
        ));
        drop(first);
        // Whatever it is called, and whether or not its last line ends.
        let path = folder.path().join(RECORDS);
        for mine in [
            "some notes\nof mine\n",
            "{\"my\": \"notes\"}",
            "deadbeef, and more",
        ] {
            std::fs::write(&path, mine).unwrap();
            let opened = Records::open(folder.path());
            assert!(matches!(opened, Err(StudyError::NotRecords { .. })), "{mine}");
            assert_eq!(std::fs::read(&path).unwrap(), mine.as_bytes());
        }
    }

    /// A file without end, and an entry that is no file, are refused: they are neither read nor waited for.
    #[cfg(unix)]
    #[test]
    fn what_never_ends_is_refused() {
        let (folder, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let mut records = Records::open(other.path()).unwrap();
        let path = folder.path().join(RECORDS);
        let refused = |records: &mut Records| {
            let opened = Records::open(folder.path());
            assert!(matches!(opened, Err(StudyError::NotRecords { .. })), "{opened:?}");
            assert!(records.merge(folder.path()).is_err());
        };
        File::create(&path).unwrap().set_len(1 << 40).unwrap();
        refused(&mut records);
        std::fs::remove_file(&path).unwrap();
        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        refused(&mut records);
    }

    /// Studies that share the records may make the same run at the same time.
    #[test]
    fn a_run_is_recorded_once() {
        let folder = tempfile::tempdir().unwrap();
        let records = Records::open(folder.path()).unwrap();
        std::thread::scope(|scope| {
            for other in ["b", "c"] {
                let records = &records;
                scope.spawn(move || records.append(&[record("a"), record(other)]).unwrap());
            }
        });
        assert_eq!(records.len(), 3);
        let lines = std::fs::read_to_string(folder.path().join(RECORDS)).unwrap();
        assert_eq!(lines.lines().count(), 3);
    }

    #[test]
    fn merging_twice_is_merging_once() {
        let (one, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        Records::open(one.path()).unwrap().append(&[record("a")]).unwrap();
        let mut records = Records::open(other.path()).unwrap();
        records.append(&[record("b")]).unwrap();
        assert_eq!(records.merge(one.path()).unwrap(), 1);
        assert_eq!(records.merge(one.path()).unwrap(), 0);
        assert_eq!(records.len(), 2);
    }
}
