//! The inputs of a project, which its folder keeps so that the project can be repeated from there.

use std::io::Write;
use std::path::Path;

use slipfront_base::disk::{TEXT_MAX_BYTES, read_limited};

use super::input_copies::Copy;
use super::kind::ProjectKind;
use super::result_files::{Batch, Others, ResultFiles};
use crate::error::StudyError;

/// The files that are needed to repeat a project.
pub struct Given {
    /// The text of the project's file, with its base case inside.
    pub text: String,
    /// Copies of the files that the text names.
    pub copies: Vec<Copy>,
    /// Files that the command was given in addition to the text, such as measured records, by their names in
    /// the folder.
    pub others: Vec<(String, Vec<u8>)>,
}

impl Given {
    /// Whether a folder has other files of these names.
    pub(crate) fn differs_in(&self, kind: &ProjectKind, folder: &Path) -> bool {
        let differs = |name: &str, bytes: &[u8]| {
            let before = read_limited(&folder.join(name), TEXT_MAX_BYTES);
            before.is_ok_and(|before| before != bytes)
        };
        differs(kind.file, self.text.as_bytes())
            || self.others.iter().any(|(name, bytes)| differs(name, bytes))
            || self.copies.iter().any(|copy| copy.differs_in(folder))
    }

    /// Writes the files to a batch for a folder; `force` replaces edited files there.
    pub(crate) fn stage(&self, kind: &ProjectKind, folder: &Path, force: bool) -> Result<Batch, StudyError> {
        let mut batch = ResultFiles::new(folder, kind.name, force).begin();
        batch.copy_all(&self.copies)?;
        for (name, bytes) in &self.others {
            batch.write(name, |to| to.write_all(bytes))?;
        }
        batch.write(kind.file, |to| to.write_all(self.text.as_bytes()))?;
        Ok(batch)
    }

    /// Writes the files to a folder, where results will be added; `force` replaces edited files there.
    ///
    /// # Errors
    /// When the folder contains another project, or edited or foreign files with these names; when the system
    /// refuses to write.
    pub fn place(&self, kind: &ProjectKind, folder: &Path, force: bool) -> Result<ResultFiles, StudyError> {
        if self.differs_in(kind, folder) {
            return Err(StudyError::Changed {
                what: kind.name,
                path: folder.to_owned(),
            });
        }
        self.stage(kind, folder, force)?.place_given(Others::Stay)
    }
}
