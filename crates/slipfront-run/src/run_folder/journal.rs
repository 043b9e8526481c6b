//! The journal of a run that is not complete: name, length and hash of every file that it has finished, as
//! one line of JSON for each.
//!
//! A line is synced to disk before its file gets its name, so that every file of the run is listed, whenever
//! the run is killed. A file of a listed name with other contents is somebody else's.

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::Path;

use slipfront_base::disk::{TEXT_MAX_BYTES, open_limited};

use crate::manifest::ManifestFile;

/// The journal, open for further lines.
#[derive(Debug)]
pub struct Journal(File);

impl Journal {
    /// Opens the journal, or creates an empty one. A partial line that a kill has left at the end is removed.
    pub(super) fn open(path: &Path) -> std::io::Result<Self> {
        let mut options = OpenOptions::new();
        let file = options.create(true).append(true).open(path)?;
        let bytes = read_bytes(path)?;
        let whole = bytes
            .iter()
            .rposition(|byte| *byte == b'\n')
            .map_or(0, |end| end + 1);
        if whole < bytes.len() {
            file.set_len(whole as u64)?;
        }
        Ok(Self(file))
    }

    /// Lists files, and waits until the lines are on the disk.
    pub(super) fn append(&mut self, files: &[ManifestFile]) -> std::io::Result<()> {
        if files.is_empty() {
            return Ok(());
        }
        let mut lines = Vec::new();
        for file in files {
            serde_json::to_writer(&mut lines, file)?;
            lines.push(b'\n');
        }
        self.0.write_all(&lines)?;
        self.0.sync_data()
    }
}

/// The files that a journal lists. A line that is cut short or damaged lists nothing.
pub(super) fn read(path: &Path) -> std::io::Result<Vec<ManifestFile>> {
    let bytes = read_bytes(path)?;
    let lines = bytes.split(|byte| *byte == b'\n');
    Ok(lines
        .filter_map(|line| serde_json::from_slice(line).ok())
        .collect())
}

fn read_bytes(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_limited(path, TEXT_MAX_BYTES)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(name: &str) -> ManifestFile {
        let mut hasher = blake3::Hasher::new();
        hasher.update(name.as_bytes());
        ManifestFile::hashed(name, &hasher)
    }

    #[test]
    fn a_line_cut_short_anywhere_lists_nothing_and_does_not_harm_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal.jsonl");
        Journal::open(&path)
            .unwrap()
            .append(&[file("a"), file("b")])
            .unwrap();
        let whole = std::fs::read(&path).unwrap();
        assert_eq!(read(&path).unwrap(), [file("a"), file("b")]);
        let first = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
        for cut in 0..whole.len() {
            std::fs::write(&path, &whole[..cut]).unwrap();
            Journal::open(&path).unwrap().append(&[file("c")]).unwrap();
            let expected = if cut < first {
                vec![file("c")]
            } else {
                vec![file("a"), file("c")]
            };
            assert_eq!(read(&path).unwrap(), expected, "cut at {cut}");
        }
    }
}
