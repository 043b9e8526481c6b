//! Files that a case reads.

use std::path::{Path, PathBuf};

use slipfront::Lattice;

use super::budget::Budget;
use crate::arrays;
use crate::case_file::{CaseError, CaseFile};

/// A file that a case reads, kept so that the run folder can hold a copy.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Path of its copy in the run folder.
    pub name: String,
    /// Path that it was read from.
    pub original: PathBuf,
    /// Its contents.
    pub bytes: Vec<u8>,
}

/// Names the copy of a file in the folder `inputs/` after its plain name; files of one name and different contents are
/// numbered. The name, and whether a copy of it has the same contents already.
///
/// `describe` gives the name of a copy made before, and whether its contents are those of the file.
pub fn name_of_copy<'c, C>(
    plain: &str,
    copies: &'c [C],
    describe: impl Fn(&'c C) -> (&'c str, bool),
) -> (String, bool) {
    let mut name = format!("inputs/{plain}");
    let mut number = 1;
    while let Some((_, is_same)) = copies.iter().map(&describe).find(|(other, _)| *other == name) {
        if is_same {
            return (name, true);
        }
        number += 1;
        name = format!("inputs/{number}-{plain}");
    }
    (name, false)
}

/// A file that was read, and its contents.
pub(super) struct InputBytes {
    pub(super) path: PathBuf,
    pub(super) bytes: Vec<u8>,
}

/// Files read so far, and the budget of the case with them.
pub(super) struct Inputs<'a> {
    /// The folder that the names of files are relative to.
    pub(super) folder: &'a Path,
    pub(super) kept: Vec<Input>,
    pub(super) budget: Budget,
}

impl Inputs<'_> {
    /// Reads a file that the case names. It is read once, so that its copy holds what the case was made of.
    pub(super) fn read(
        &self,
        file: &CaseFile,
        key: &str,
        written: &str,
        lattice: &Lattice,
    ) -> Result<InputBytes, CaseError> {
        let path = self.folder.join(written);
        let bytes = arrays::read_file(&path, lattice.nx, lattice.ny)
            .map_err(|error| file.source.error(key, error.to_string()))?;
        Ok(InputBytes { path, bytes })
    }

    /// Keeps the contents of a file that the case uses; gives the path of its copy in the run folder.
    pub(super) fn keep(&mut self, file: &CaseFile, given: InputBytes) -> Result<String, CaseError> {
        let InputBytes { path, bytes } = given;
        let plain = path
            .file_name()
            .map_or_else(|| "input".into(), |name| name.to_string_lossy().into_owned());
        let (name, is_kept) = name_of_copy(&plain, &self.kept, |kept| (&kept.name, kept.bytes == bytes));
        if is_kept {
            return Ok(name);
        }
        self.budget.add_input(bytes.len());
        self.kept.push(Input {
            name: name.clone(),
            original: path,
            bytes,
        });
        self.budget.check_making(file)?;
        Ok(name)
    }
}
