//! The data of figures, stored as soon as they are measured, so that a call after a stop need not measure
//! them again.
//!
//! A file contains the data of a figure under a step rule, and a checksum. A file that is damaged, or was
//! made by another program, with other cases or with other options, is ignored.

use std::path::{Path, PathBuf};

use crate::embedded_cases::FILES;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::step_rule::StepRule;
use slipfront_base::disk::{make_folders, read_limited, write_atomic};
use slipfront_base::unfinished::clear_unfinished;
use slipfront_run::checksum;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::ManifestFile;
use slipfront_run::names::FIGURE_CACHE;
use slipfront_run::program;
use slipfront_study::RunJournal;

/// Largest size of a file in bytes; the data of a figure take some megabytes.
pub(crate) const MAX_BYTES: u64 = 1 << 28;

/// The stored data of figures in a results folder.
#[derive(Debug)]
pub struct FigureCache {
    folder: PathBuf,
    /// Hash of the program, its cases and the options: everything that the data depend on besides figure and
    /// step rule.
    origin: blake3::Hash,
}

impl FigureCache {
    /// The data that this build of the program has stored in the results folder `folder`.
    ///
    /// # Errors
    /// When the folder cannot be made.
    pub fn open(folder: &Path, reduced: bool) -> Result<Self, PaperError> {
        let folder = folder.join(FIGURE_CACHE);
        make_folders(&folder).map_err(|source| FolderError::Unwritable {
            path: folder.clone(),
            source,
        })?;
        // This call may run other figures than a call that was killed.
        clear_unfinished(&folder);
        let mut hasher = blake3::Hasher::new();
        hasher.update(program::this_build().as_bytes());
        hasher.update(slipfront_study::SOURCE_HASH.as_bytes());
        hasher.update(env!("SLIPFRONT_SOURCE_HASH").as_bytes());
        for (name, text) in FILES {
            hasher.update(name.as_bytes()).update(text.as_bytes());
        }
        hasher.update(&[u8::from(reduced)]);
        Ok(Self {
            folder,
            origin: hasher.finalize(),
        })
    }

    /// The file of a figure.
    pub fn path(&self, figure: &str, step: StepRule) -> PathBuf {
        let step = match step {
            StepRule::Auto => "auto",
            StepRule::Paper => "paper",
        };
        self.folder.join(format!("{figure}-{step}.bin"))
    }

    /// The contents of a file: the data and their checksum.
    pub fn with_checksum(&self, data: &[u8]) -> Vec<u8> {
        checksum::with_checksum(self.origin.as_bytes(), data)
    }

    /// The data of a figure; none if its file is missing, damaged or of another origin.
    pub fn load(&self, figure: &str, step: StepRule) -> Option<FigureData> {
        let bytes = read_limited(&self.path(figure, step), MAX_BYTES).ok()?;
        let data = checksum::verified(self.origin.as_bytes(), &bytes)?;
        postcard::from_bytes(data).ok()
    }

    /// Stores the data of a figure.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn save(&self, figure: &str, step: StepRule, data: &FigureData) -> Result<(), PaperError> {
        let path = self.path(figure, step);
        // Serialisation of plain data into memory does not fail.
        let Ok(data) = postcard::to_stdvec(data) else {
            return Ok(());
        };
        Ok(write_atomic(&path, &self.with_checksum(&data))
            .map_err(|source| FolderError::Write { path, source })?)
    }
}

/// The files that the results in a folder follow from: the journal, and the stored data of figures.
///
/// # Errors
/// When the system refuses to list or to read them.
pub fn sources(folder: &Path, records: &RunJournal) -> Result<Vec<ManifestFile>, PaperError> {
    let path = folder.join(FIGURE_CACHE);
    let unreadable = FolderError::read(&path);
    let mut sources = vec![records.listed()?];
    for entry in std::fs::read_dir(&path).map_err(&unreadable)? {
        let name = entry.map_err(&unreadable)?.file_name();
        let name = format!("{FIGURE_CACHE}/{}", name.to_string_lossy());
        sources.push(ManifestFile::read(folder, &name).map_err(&unreadable)?);
    }
    sources.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(sources)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::MeasuredNumber;

    #[test]
    fn data_come_back_unless_damaged_or_made_otherwise() {
        let folder = tempfile::tempdir().unwrap();
        let cache = FigureCache::open(folder.path(), true).unwrap();
        let mut data = FigureData::default();
        data.number("fig99.one", MeasuredNumber::from_values(&[1.0, 2.0]));
        data.value("fig99.none", f64::INFINITY);
        cache.save("fig99", StepRule::Auto, &data).unwrap();
        assert_eq!(cache.load("fig99", StepRule::Auto).unwrap().numbers, data.numbers);
        assert!(cache.load("fig99", StepRule::Paper).is_none());
        assert!(
            FigureCache::open(folder.path(), false)
                .unwrap()
                .load("fig99", StepRule::Auto)
                .is_none()
        );
        let path = cache.path("fig99", StepRule::Auto);
        let whole = std::fs::read(&path).unwrap();
        for cut in [0, 31, whole.len() - 1] {
            std::fs::write(&path, &whole[..cut]).unwrap();
            assert!(cache.load("fig99", StepRule::Auto).is_none(), "{cut}");
        }
        std::fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
        assert!(cache.load("fig99", StepRule::Auto).is_none());
        let mut flipped = whole;
        flipped[40] ^= 1;
        std::fs::write(&path, flipped).unwrap();
        assert!(cache.load("fig99", StepRule::Auto).is_none());
    }
}
