//! What figures found, kept on disk as soon as it is found: a call that was stopped does not begin again.
//!
//! A file holds the figure's findings and a checksum. One that is damaged, or that another program, other cases or
//! other options made, counts as not there.

use std::path::{Path, PathBuf};

use crate::embedded_cases::FILES;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::step_rule::StepRule;
use slipfront_case::disk::{read_limited, remove_unfinished, write_atomic};
use slipfront_run::checksum;
use slipfront_run::names::FIGURE_CACHE;
use slipfront_run::program;
use slipfront_run::run_folder::error::FolderError;

/// A longer file holds something else: a figure's findings take some megabytes at the most.
const MAX_BYTES: u64 = 1 << 28;

/// Findings of earlier calls in one folder.
#[derive(Debug)]
pub struct FigureCache {
    folder: PathBuf,
    /// Hash of the program, its cases and the options: what findings depend on besides figure and step.
    origin: blake3::Hash,
}

impl FigureCache {
    /// Those in `folder`, made by this build of the program.
    ///
    /// # Errors
    /// When the folder cannot be made.
    pub fn open(folder: &Path, reduced: bool) -> Result<Self, PaperError> {
        let folder = folder.join(FIGURE_CACHE);
        std::fs::create_dir_all(&folder).map_err(|source| FolderError::Unwritable {
            path: folder.clone(),
            source,
        })?;
        // The records of the folder above are open, so that nobody else writes here.
        remove_unfinished(&folder);
        let mut hasher = blake3::Hasher::new();
        hasher.update(program::this_build().as_bytes());
        for (name, text) in FILES {
            hasher.update(name.as_bytes()).update(text.as_bytes());
        }
        hasher.update(&[u8::from(reduced)]);
        Ok(Self {
            folder,
            origin: hasher.finalize(),
        })
    }

    /// The file of a figure's findings.
    pub fn path(&self, figure: &str, step: StepRule) -> PathBuf {
        let step = match step {
            StepRule::Auto => "auto",
            StepRule::Paper => "paper",
        };
        self.folder.join(format!("{figure}-{step}.bin"))
    }

    /// The bytes of a file: findings with their checksum.
    pub fn with_checksum(&self, findings: &[u8]) -> Vec<u8> {
        checksum::with_checksum(self.origin.as_bytes(), findings)
    }

    /// What a figure found in an earlier call.
    pub fn load(&self, figure: &str, step: StepRule) -> Option<FigureData> {
        let bytes = read_limited(&self.path(figure, step), MAX_BYTES).ok()?;
        let findings = checksum::verified(self.origin.as_bytes(), &bytes)?;
        postcard::from_bytes(findings).ok()
    }

    /// Keeps what a figure found.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn save(&self, figure: &str, step: StepRule, found: &FigureData) -> Result<(), PaperError> {
        let path = self.path(figure, step);
        // Plain data: it always has a binary form.
        let Ok(findings) = postcard::to_stdvec(found) else {
            return Ok(());
        };
        Ok(write_atomic(&path, &self.with_checksum(&findings))
            .map_err(|source| FolderError::Write { path, source })?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Number;

    #[test]
    fn findings_come_back_unless_damaged_or_made_otherwise() {
        let folder = tempfile::tempdir().unwrap();
        let saved = FigureCache::open(folder.path(), true).unwrap();
        let mut found = FigureData::default();
        found.number("fig99.one", Number::of(&[1.0, 2.0]));
        found.value("fig99.none", f64::INFINITY);
        saved.save("fig99", StepRule::Auto, &found).unwrap();
        assert_eq!(
            saved.load("fig99", StepRule::Auto).unwrap().numbers,
            found.numbers
        );
        assert!(saved.load("fig99", StepRule::Paper).is_none());
        assert!(
            FigureCache::open(folder.path(), false)
                .unwrap()
                .load("fig99", StepRule::Auto)
                .is_none()
        );
        let path = saved.path("fig99", StepRule::Auto);
        let whole = std::fs::read(&path).unwrap();
        for cut in [0, 31, whole.len() - 1] {
            std::fs::write(&path, &whole[..cut]).unwrap();
            assert!(saved.load("fig99", StepRule::Auto).is_none(), "{cut}");
        }
        std::fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
        assert!(saved.load("fig99", StepRule::Auto).is_none());
        // What a kill left is removed.
        std::fs::write(folder.path().join("found/.slipfront123456"), "half of").unwrap();
        FigureCache::open(folder.path(), true).unwrap();
        assert_eq!(std::fs::read_dir(folder.path().join("found")).unwrap().count(), 1);
        let mut flipped = whole;
        flipped[40] ^= 1;
        std::fs::write(&path, flipped).unwrap();
        assert!(saved.load("fig99", StepRule::Auto).is_none());
    }
}
