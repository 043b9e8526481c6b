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
/// numbered. Gives the name, and whether there is such a copy already.
///
/// `is_same` says of a name whether the copy that has it, if there is one, has the contents of the file.
pub fn name_of_copy(plain: &str, is_same: impl Fn(&str) -> Option<bool>) -> (String, bool) {
    let mut name = format!("inputs/{plain}");
    let mut number = 1;
    while let Some(is_same) = is_same(&name) {
        if is_same {
            return (name, true);
        }
        number += 1;
        name = format!("inputs/{number}-{plain}");
    }
    (name, false)
}

/// Files read so far, and the budget of the case with them.
pub(super) struct Inputs<'a> {
    /// The folder that the names of files are relative to.
    pub(super) folder: &'a Path,
    pub(super) kept: Vec<Input>,
    pub(super) budget: Budget,
}

impl Inputs<'_> {
    /// Reads a file that the case names. It is read once, so that its copy holds what the case was made of. It has its plain name
    /// until it is kept.
    pub(super) fn read(
        &self,
        file: &CaseFile,
        key: &str,
        written: &str,
        lattice: &Lattice,
    ) -> Result<Input, CaseError> {
        let original = self.folder.join(written);
        let name = original
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        let bytes = arrays::read_file(&original, lattice.nx, lattice.ny);
        Ok(Input {
            name: name.unwrap_or_else(|| "input".to_owned()),
            bytes: bytes.map_err(|error| file.source.error(key, error.to_string()))?,
            original,
        })
    }

    /// Keeps the contents of a file that the case uses; gives its position among the kept ones.
    pub(super) fn keep(&mut self, file: &CaseFile, mut given: Input) -> Result<usize, CaseError> {
        let position = |name: &str| self.kept.iter().position(|kept| kept.name == name);
        let is_same = |name: &str| Some(self.kept[position(name)?].bytes == given.bytes);
        let (name, _) = name_of_copy(&given.name, is_same);
        if let Some(position) = position(&name) {
            return Ok(position);
        }
        self.budget.inputs += given.bytes.len() as f64;
        given.name = name;
        self.kept.push(given);
        self.budget.check_making(file)?;
        Ok(self.kept.len() - 1)
    }
}
