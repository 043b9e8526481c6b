//! The list of the result files of a folder with their checksums, `checksums.json`.

use std::path::{Component, Path};

use serde::{Deserialize, Serialize};
use slipfront_base::disk::{TEXT_MAX_BYTES, found_at, json, read_limited, write_atomic};
use slipfront_base::text::single_line;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::{ManifestFile, is_sealed, seal};

use crate::error::StudyError;

/// Name of the list of result files and their checksums.
pub const CHECKSUMS: &str = "checksums.json";

/// Content of a list: the result files, and the program that made them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Checksums {
    /// Content of the folder, such as `study`.
    pub of: String,
    /// Part of the points of a study that the folder is for, such as `2/8`; none for all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Version of slipfront.
    pub version: String,
    /// The git commit from which the program was built; null outside of git.
    pub revision: Option<String>,
    /// The identity of the build.
    pub build: String,
    /// The result files, in the order of their names.
    pub files: Vec<ManifestFile>,
    /// Whether the results are complete, as opposed to those of unfinished work.
    pub is_complete: bool,
    /// Files that complete results follow from, such as the journal of runs, as they were then.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sources: Vec<ManifestFile>,
    /// Files that were still to be replaced or removed when the list was written.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub replaced: Vec<ManifestFile>,
    /// BLAKE3 hash of the list up to this key.
    pub seal: String,
}

impl Checksums {
    /// Reads the list of a folder; none if there is none.
    ///
    /// # Errors
    /// When the list cannot be read, or was changed since it was written.
    pub fn read(folder: &Path) -> Result<Option<Self>, StudyError> {
        let path = folder.join(CHECKSUMS);
        if found_at(&path).map_err(FolderError::read(&path))?.is_none() {
            return Ok(None);
        }
        let damaged = |why: &str| StudyError::Checksums {
            path: path.clone(),
            why: single_line(why),
        };
        let bytes = read_limited(&path, TEXT_MAX_BYTES).map_err(|error| damaged(&error.to_string()))?;
        let list: Self = serde_json::from_slice(&bytes).map_err(|error| damaged(&error.to_string()))?;
        if !is_sealed(&bytes) {
            return Err(damaged("its seal is wrong: it was changed afterwards"));
        }
        match list
            .files
            .iter()
            .chain(&list.replaced)
            .chain(&list.sources)
            .find(|file| !is_inside(file))
        {
            Some(file) => Err(damaged(&format!(
                "it lists {}, which is outside the folder",
                file.name
            ))),
            None => Ok(Some(list)),
        }
    }

    /// The list of a folder even if it was changed since it was written; none if it is no list.
    pub(super) fn unsealed(folder: &Path) -> Option<Self> {
        let bytes = read_limited(&folder.join(CHECKSUMS), TEXT_MAX_BYTES).ok()?;
        let mut list: Self = serde_json::from_slice(&bytes).ok()?;
        list.files.retain(is_inside);
        list.replaced.retain(is_inside);
        Some(list)
    }

    pub(super) fn write(mut self, folder: &Path) -> Result<(), StudyError> {
        self.seal = String::new();
        self.seal = seal(&json(&self)).unwrap_or_default();
        let path = folder.join(CHECKSUMS);
        write_atomic(&path, &json(&self)).map_err(|source| StudyError::Write { path, source })
    }
}

/// Whether a file is in the folder of its list: a list from elsewhere must not lead to other files.
fn is_inside(file: &ManifestFile) -> bool {
    let mut parts = Path::new(&file.name).components();
    parts.all(|part| matches!(part, Component::Normal(_)))
}
