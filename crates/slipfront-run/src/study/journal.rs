//! Records of finished runs: one line each, appended, checksummed and forced to the disk.
//!
//! A line is `<checksum> <json>`. A line that a crash cut short, or that was damaged later, fails its checksum and
//! counts as not run; the file is cut back to its last whole record before anything is appended.

use std::collections::HashMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::error::StudyError;
use super::summary_values::SummaryValues;
use crate::names::RECORDS;
use crate::summary::Summary;
use slipfront_case::disk::{open_limited, remove_unfinished, sync_folder};

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Its numbers.
    Done(Box<Summary>),
    /// Why it failed.
    Failed(String),
}

impl Outcome {
    /// What tables and statistics need of it.
    fn result(&self) -> RunResult {
        match self {
            Self::Done(summary) => RunResult::Done(SummaryValues::of(summary)),
            Self::Failed(reason) => RunResult::Failed(reason.clone()),
        }
    }

    /// The same, unless the record file could not hold it: JSON has no infinite numbers.
    pub(super) fn or_not_finite(self) -> Self {
        let read_back = |outcome: &Self| {
            let json = serde_json::to_string(outcome).ok()?;
            serde_json::from_str::<Self>(&json).ok()
        };
        if read_back(&self).as_ref() == Some(&self) {
            self
        } else {
            Self::Failed("a number of its summary is not finite".to_owned())
        }
    }
}

/// What was found of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum RunResult {
    /// Its numbers.
    Done(SummaryValues),
    /// Why it failed.
    Failed(String),
}

/// One line of the record file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// What the run was: see [`super::Plan::identity`].
    pub id: String,
    /// Seconds that it took. The only thing here that another run of it would not repeat.
    pub wall_time_s: f64,
    /// How it ended.
    pub outcome: Outcome,
}

/// The record file of a study folder, open for one process alone.
#[derive(Debug)]
pub struct Records {
    path: PathBuf,
    file: File,
    results: HashMap<String, Arc<RunResult>>,
    /// Lines that failed their checksum.
    pub damaged: usize,
}

impl Records {
    /// Name of the record file in its folder.
    pub const FILE: &str = RECORDS;

    /// Opens the records of a study folder, or begins them.
    ///
    /// # Errors
    /// When another process has them open, when they cannot be read, or when the file is something else.
    pub fn open(folder: &Path) -> Result<Self, StudyError> {
        let path = folder.join(RECORDS);
        let failed = |action| {
            move |path: &Path, source| StudyError::Records {
                action,
                path: path.to_owned(),
                source,
            }
        };
        let (cannot_open, cannot_write) = (failed("open"), failed("write to"));
        let mut file = OpenOptions::new()
            .read(true)
            .append(true)
            .create(true)
            .open(&path)
            .map_err(|source| cannot_open(&path, source))?;
        let metadata = file.metadata().map_err(|source| cannot_open(&path, source))?;
        // A pipe would be waited for, and a device never ends.
        if !metadata.is_file() {
            return Err(StudyError::NotRecords { path });
        }
        // Some file systems of clusters have no locks; the study runs there without.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(StudyError::Busy {
                path: folder.to_owned(),
            });
        }
        // Nobody else writes in the folder from now on.
        remove_unfinished(folder);
        let lines = Lines::read(&mut file).map_err(|source| cannot_open(&path, source))?;
        if lines.are_foreign() {
            return Err(StudyError::NotRecords { path });
        }
        // What a crash left of a line must not swallow the next one; a record that lacks its line break alone gets it.
        match lines.end {
            End::Whole => {}
            End::NoBreak => file
                .write_all(b"\n")
                .and_then(|()| file.sync_data())
                .map_err(|source| cannot_write(&path, source))?,
            End::Cut { whole_bytes } => file
                .set_len(whole_bytes)
                .map_err(|source| cannot_write(&path, source))?,
        }
        file.seek(SeekFrom::End(0))
            .map_err(|source| cannot_open(&path, source))?;
        // A new file is only safe from a power cut once its folder is.
        if lines.bytes == 0 {
            sync_folder(folder).map_err(|source| cannot_write(&path, source))?;
        }
        let results = lines
            .records
            .into_iter()
            .map(|record| (record.id, Arc::new(record.outcome.result())))
            .collect();
        Ok(Self {
            path,
            file,
            results,
            damaged: lines.damaged,
        })
    }

    /// What was found of the run with this identity, if it was done.
    pub fn get(&self, id: &str) -> Option<&Arc<RunResult>> {
        self.results.get(id)
    }

    /// Number of runs recorded.
    pub fn len(&self) -> usize {
        self.results.len()
    }

    /// Whether nothing is recorded.
    pub fn is_empty(&self) -> bool {
        self.results.is_empty()
    }

    /// Appends finished runs and waits until the disk has them.
    ///
    /// # Errors
    /// When they cannot be written; what had been recorded before stays whole.
    pub fn append(&mut self, records: &[Record]) -> Result<(), StudyError> {
        if records.is_empty() {
            return Ok(());
        }
        let lines: Vec<u8> = records.iter().flat_map(to_line).collect();
        let failed = |source| StudyError::Records {
            action: "write to",
            path: self.path.clone(),
            source,
        };
        let before = self.file.stream_position().map_err(failed)?;
        let written = self.file.write_all(&lines).and_then(|()| self.file.sync_data());
        written.map_err(|source| {
            // What fits stays, all but a part of a line; if even that cannot be cut off, the next start does it.
            let there = self
                .file
                .metadata()
                .map_or(0, |file| file.len().saturating_sub(before));
            let there = &lines[..lines.len().min(there as usize)];
            let whole = there
                .iter()
                .rposition(|&byte| byte == b'\n')
                .map_or(0, |end| end + 1);
            let _ = self.file.set_len(before + whole as u64);
            failed(source)
        })?;
        for record in records {
            self.results
                .insert(record.id.clone(), Arc::new(record.outcome.result()));
        }
        Ok(())
    }

    /// Takes over the records of another folder that are not here yet.
    ///
    /// # Errors
    /// When they cannot be read or written.
    pub fn merge(&mut self, folder: &Path) -> Result<usize, StudyError> {
        let path = folder.join(RECORDS);
        let read = open_limited(&path, u64::MAX).and_then(|mut file| Lines::read(&mut file));
        let lines = read.map_err(|source| StudyError::Records {
            action: "read",
            path: path.clone(),
            source,
        })?;
        if lines.are_foreign() {
            return Err(StudyError::NotRecords { path });
        }
        self.damaged += lines.damaged;
        let mut records = lines.records;
        records.retain(|record| !self.results.contains_key(&record.id));
        self.append(&records)?;
        Ok(records.len())
    }
}

fn to_line(record: &Record) -> Vec<u8> {
    // Our own struct of numbers and strings: serialisation cannot fail.
    let json = serde_json::to_string(record).unwrap_or_default();
    format!("{} {json}\n", checksum(json.as_bytes())).into_bytes()
}

/// The longest line of a record file: hundreds of times what a run takes.
const LINE_MAX_BYTES: u64 = 1 << 20;

/// What a record file holds.
#[derive(Default)]
struct Lines {
    records: Vec<Record>,
    /// Lines that fail their checksum.
    damaged: usize,
    /// Whether a line is a record or may once have been one.
    ours: bool,
    /// Whether a line is longer than any record.
    too_long: bool,
    bytes: u64,
    end: End,
}

/// How a record file ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum End {
    /// With a line break, or it is empty.
    #[default]
    Whole,
    /// With a record that lacks its line break.
    NoBreak,
    /// With a part of a line, after so many bytes.
    Cut { whole_bytes: u64 },
}

impl Lines {
    /// Reads line by line: a file of any length takes no more memory than its records.
    fn read(file: &mut impl Read) -> std::io::Result<Self> {
        let mut file = BufReader::new(file);
        let mut lines = Self::default();
        let mut line = Vec::new();
        while !lines.too_long {
            line.clear();
            let read = file.by_ref().take(LINE_MAX_BYTES).read_until(b'\n', &mut line)? as u64;
            if read == 0 {
                break;
            }
            let whole_bytes = lines.bytes;
            lines.bytes += read;
            let broken = line.pop_if(|last| *last == b'\n').is_some();
            lines.too_long = !broken && read == LINE_MAX_BYTES;
            if line.is_empty() {
                continue;
            }
            let record = parse_line(&line);
            if !broken {
                lines.end = match record {
                    Some(_) => End::NoBreak,
                    None => End::Cut { whole_bytes },
                };
            }
            lines.ours |= looks_like_ours(&line) || (!broken && may_begin_ours(&line));
            match record {
                Some(record) => lines.records.push(record),
                None => lines.damaged += 1,
            }
        }
        Ok(lines)
    }

    /// Whether this is no record file, not even a damaged one.
    fn are_foreign(&self) -> bool {
        self.too_long || (self.damaged > 0 && !self.ours)
    }
}

fn parse_line(line: &[u8]) -> Option<Record> {
    let (sum, json) = line.split_at_checked(CHECKSUM)?;
    let json = json.strip_prefix(b" ")?;
    if checksum(json).as_bytes() != sum {
        return None;
    }
    serde_json::from_slice(json).ok()
}

/// Whether a line may once have been a record, to tell a damaged file from a foreign one.
fn looks_like_ours(line: &[u8]) -> bool {
    line.get(CHECKSUM) == Some(&b' ') && line.get(CHECKSUM + 1) == Some(&b'{')
}

/// Whether a record may once have been meant to go on after this: it is cut within its checksum, or a power cut left zeros.
fn may_begin_ours(line: &[u8]) -> bool {
    let (sum, blank) = line.split_at(line.len().min(CHECKSUM));
    let is_beginning = sum.iter().all(u8::is_ascii_hexdigit) && b" ".starts_with(blank);
    is_beginning || line.iter().all(|&byte| byte == 0)
}

/// Characters of a checksum.
const CHECKSUM: usize = 16;

fn checksum(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..CHECKSUM].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(id: &str) -> Record {
        Record {
            id: id.to_owned(),
            wall_time_s: 0.5,
            outcome: Outcome::Done(Box::default()),
        }
    }

    /// One cut short by its line break alone is whole.
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
            let mut records = Records::open(folder.path()).unwrap();
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
            let lines = Lines::read(&mut damaged.as_slice()).unwrap();
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

    /// A file without end, and what is no file, are neither read nor waited for.
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

    #[test]
    fn what_json_cannot_hold_is_a_failure() {
        let outcome = |value| {
            let summary = Summary {
                energy_error: value,
                ..Summary::default()
            };
            Outcome::Done(Box::new(summary)).or_not_finite()
        };
        assert!(matches!(outcome(0.1), Outcome::Done(_)));
        assert!(matches!(outcome(f64::NAN), Outcome::Failed(_)));
        assert!(matches!(outcome(f64::INFINITY), Outcome::Failed(_)));
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
