//! Kinds of project folders beside those of studies, such as designs: what each has of its own.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use crate::error::StudyError;

/// A kind of project folders whose results follow from the runs in a journal.
#[derive(Debug)]
pub struct ProjectKind {
    /// Name of the kind in messages, such as `design`.
    pub name: &'static str,
    /// Name of the file in the folder from which the project is repeated.
    pub file: &'static str,
    /// Name of the journal of runs.
    pub journal: &'static str,
    /// Finds the results of a folder again in another one, until a stop, from a copy of its journal; returns the numbers of runs there before
    /// and after, since runs that the journal lacks are made.
    pub find_again: fn(folder: &Path, other: &Path, stop: &AtomicBool) -> Result<[usize; 2], StudyError>,
}

impl ProjectKind {
    /// Whether the folder is one of this kind.
    pub fn is_in(&self, folder: &Path) -> bool {
        folder.join(self.file).exists() && folder.join(self.journal).exists()
    }
}
