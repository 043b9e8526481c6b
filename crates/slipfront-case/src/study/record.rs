//! Records of finished runs: one line each, appended, checksummed and forced to the disk.
//!
//! A line is `<checksum> <json>`. A line that a crash cut short, or that was damaged later, fails its checksum and
//! counts as not run; the file is cut back to its last whole line before anything is appended.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::StudyError;
use crate::summary::Summary;

/// Name of the record file in a study folder.
pub(super) const RECORDS: &str = "records.jsonl";

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Its numbers.
    Done(Box<Summary>),
    /// Why it failed.
    Failed(String),
}

/// One line of the record file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// What the run was: see [`super::plan::Plan::identity`].
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
    outcomes: HashMap<String, Outcome>,
    /// Lines that failed their checksum.
    pub damaged: usize,
}

impl Records {
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
        file.try_lock().map_err(|error| match error {
            std::fs::TryLockError::WouldBlock => StudyError::Busy {
                path: folder.to_owned(),
            },
            std::fs::TryLockError::Error(source) => cannot_open(&path, source),
        })?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)
            .map_err(|source| cannot_open(&path, source))?;
        let (records, damaged) = parse(&bytes);
        if records.is_empty() && damaged > 0 && bytes.contains(&b'\n') {
            return Err(StudyError::NotRecords { path });
        }
        // What a crash left of a line must not swallow the next one.
        let whole = bytes
            .iter()
            .rposition(|&byte| byte == b'\n')
            .map_or(0, |end| end + 1);
        if whole < bytes.len() {
            file.set_len(whole as u64)
                .map_err(|source| cannot_write(&path, source))?;
        }
        file.seek(SeekFrom::End(0))
            .map_err(|source| cannot_open(&path, source))?;
        let outcomes = records
            .into_iter()
            .map(|record| (record.id, record.outcome))
            .collect();
        Ok(Self {
            path,
            file,
            outcomes,
            damaged,
        })
    }

    /// How the run with this identity ended, if it has.
    pub fn get(&self, id: &str) -> Option<&Outcome> {
        self.outcomes.get(id)
    }

    /// Number of runs recorded.
    pub fn len(&self) -> usize {
        self.outcomes.len()
    }

    /// Whether nothing is recorded.
    pub fn is_empty(&self) -> bool {
        self.outcomes.is_empty()
    }

    /// Appends a finished run and waits until the disk has it.
    ///
    /// # Errors
    /// When it cannot be written; what had been recorded before stays whole.
    pub fn append(&mut self, record: Record) -> Result<(), StudyError> {
        let line = to_line(&record);
        let before = self.file.stream_position().unwrap_or(0);
        let written = self.file.write_all(&line).and_then(|()| self.file.sync_data());
        written.map_err(|source| {
            // A part of a line is taken back; if even that fails, the next start does it.
            let _ = self.file.set_len(before);
            StudyError::Records {
                action: "write to",
                path: self.path.clone(),
                source,
            }
        })?;
        self.outcomes.insert(record.id, record.outcome);
        Ok(())
    }

    /// Takes over the records of another folder that are not here yet.
    ///
    /// # Errors
    /// When they cannot be read or written.
    pub fn merge(&mut self, folder: &Path) -> Result<usize, StudyError> {
        let path = folder.join(RECORDS);
        let bytes = std::fs::read(&path).map_err(|source| StudyError::Records {
            action: "read",
            path: path.clone(),
            source,
        })?;
        let (records, damaged) = parse(&bytes);
        self.damaged += damaged;
        let mut taken = 0;
        for record in records {
            if !self.outcomes.contains_key(&record.id) {
                self.append(record)?;
                taken += 1;
            }
        }
        Ok(taken)
    }
}

fn to_line(record: &Record) -> Vec<u8> {
    // Our own struct of numbers and strings: serialisation cannot fail.
    let json = serde_json::to_string(record).unwrap_or_default();
    format!("{} {json}\n", checksum(json.as_bytes())).into_bytes()
}

/// The whole lines of a record file, and how many were not.
fn parse(bytes: &[u8]) -> (Vec<Record>, usize) {
    let mut records = Vec::new();
    let mut damaged = 0;
    for line in bytes.split(|&byte| byte == b'\n').filter(|line| !line.is_empty()) {
        match parse_line(line) {
            Some(record) => records.push(record),
            None => damaged += 1,
        }
    }
    (records, damaged)
}

fn parse_line(line: &[u8]) -> Option<Record> {
    let (sum, json) = line.split_at_checked(CHECKSUM)?;
    let json = json.strip_prefix(b" ")?;
    if checksum(json).as_bytes() != sum {
        return None;
    }
    serde_json::from_slice(json).ok()
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

    #[test]
    fn a_line_cut_short_anywhere_is_not_run_and_does_not_harm_the_next() {
        let whole = to_line(&record("a"));
        let next = to_line(&record("b"));
        for cut in 0..next.len() - 1 {
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join(RECORDS), [&whole[..], &next[..cut]].concat()).unwrap();
            let mut records = Records::open(folder.path()).unwrap();
            assert_eq!((records.len(), records.get("b")), (1, None), "cut at {cut}");
            records.append(record("c")).unwrap();
            drop(records);
            let records = Records::open(folder.path()).unwrap();
            assert_eq!((records.len(), records.damaged), (2, 0), "cut at {cut}");
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
            let (records, spoilt) = parse(&damaged);
            let ids: Vec<&str> = records.iter().map(|record| record.id.as_str()).collect();
            assert_eq!(ids, ["a", "c"]);
            assert!(spoilt >= 1);
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
        std::fs::write(folder.path().join(RECORDS), "some notes\nof mine\n").unwrap();
        assert!(matches!(
            Records::open(folder.path()),
            Err(StudyError::NotRecords { .. })
        ));
    }

    #[test]
    fn merging_twice_is_merging_once() {
        let (one, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        Records::open(one.path()).unwrap().append(record("a")).unwrap();
        let mut records = Records::open(other.path()).unwrap();
        records.append(record("b")).unwrap();
        assert_eq!(records.merge(one.path()).unwrap(), 1);
        assert_eq!(records.merge(one.path()).unwrap(), 0);
        assert_eq!(records.len(), 2);
    }
}
