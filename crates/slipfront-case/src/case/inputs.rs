//! Files that a case reads.

use std::path::{Path, PathBuf};

use slipfront::Lattice;

use super::within_budget;
use crate::arrays;
use crate::budget::Budget;
use crate::case_file::{CaseError, CaseFile};
use crate::folder::read_whole;

/// A file that a case reads, kept so that the run folder can hold a copy.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Path in the run folder.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// Files read so far, and what the case needs with them.
pub(super) struct Inputs {
    folder: PathBuf,
    pub(super) read: Vec<Input>,
    pub(super) budget: Budget,
}

impl Inputs {
    pub(super) fn new(folder: &Path, budget: Budget) -> Self {
        Self {
            folder: folder.to_owned(),
            read: Vec::new(),
            budget,
        }
    }

    /// The path of a file that the case names.
    pub(super) fn find(&self, file: &CaseFile, key: &str, written: &str) -> Result<PathBuf, CaseError> {
        let path = self.folder.join(written);
        let metadata = std::fs::metadata(&path).map_err(|error| unreadable(file, key, &path, &error))?;
        // A pipe would be waited for, and a device such as /dev/zero never ends.
        if !metadata.is_file() {
            let sentence = format!("{} is not a regular file: name a file that is", path.display());
            return Err(file.source.error(key, sentence));
        }
        Ok(path)
    }

    /// Notes a file that has been read; gives the path of its copy in the run folder.
    pub(super) fn keep(
        &mut self,
        file: &CaseFile,
        key: &str,
        path: &Path,
        lattice: &Lattice,
    ) -> Result<String, CaseError> {
        let longest = arrays::longest(path, lattice.nx, lattice.ny);
        let bytes = read_whole(path, longest).map_err(|error| unreadable(file, key, path, &error))?;
        let plain = path
            .file_name()
            .map_or_else(|| "input".into(), |name| name.to_string_lossy().into_owned());
        let mut name = format!("inputs/{plain}");
        let mut copies = 1;
        // Two files of one name from different folders stay two files.
        while let Some(other) = self.read.iter().find(|input| input.name == name) {
            if other.bytes == bytes {
                return Ok(name);
            }
            copies += 1;
            name = format!("inputs/{copies}-{plain}");
        }
        self.budget.add_input(bytes.len());
        self.read.push(Input {
            name: name.clone(),
            bytes,
        });
        within_budget(file, self.budget.check_making())?;
        Ok(name)
    }
}

fn unreadable(file: &CaseFile, key: &str, path: &Path, error: &std::io::Error) -> CaseError {
    let sentence = format!(
        "cannot read {}: {error}; paths are relative to the case file",
        path.display()
    );
    file.source.error(key, sentence)
}
