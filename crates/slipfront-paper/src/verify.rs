//! Compares a folder of figures with the list of its files, and with the results that follow from the stored
//! data.

use std::fs::File;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_base::disk::{make_folders, open_limited};
use slipfront_base::unfinished::TemporaryFolder;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::ManifestFile;
use slipfront_run::names::FIGURE_CACHE;
use slipfront_run::verify::{FolderCheck, VerifyError, differences};
use slipfront_study::project_folder::{Checksums, Extent, ResultFiles, verify_complete};
use slipfront_study::{PAPER, RunJournal, StudyError};

use crate::cache::MAX_BYTES;
use crate::error::PaperError;
use crate::paper::{PaperOptions, run};
use crate::report::write;

/// Compares the folder of `slipfront paper` with the list of its files, and then with pictures and tables
/// that are made again from the data of its figures, unless another program has measured these.
///
/// # Errors
/// When the folder cannot be read, and after a stop.
pub fn verify(folder: &Path, extent: Extent, stop: &AtomicBool) -> Result<FolderCheck, PaperError> {
    let mut check = verify_complete(folder, &PAPER, &[FIGURE_CACHE], stop)?;
    if extent == Extent::Derived && check.differences.is_empty() {
        derive(folder, &mut check, stop)?;
    }
    if stop.load(Ordering::Relaxed) {
        return Err(StudyError::Interrupted.into());
    }
    Ok(check)
}

/// Makes pictures and tables again from the data of the figures, of the full or the reduced paper, and
/// compares the folder with them.
fn derive(folder: &Path, check: &mut FolderCheck, stop: &AtomicBool) -> Result<(), PaperError> {
    let temporary = TemporaryFolder::new(folder).map_err(VerifyError::Temporary);
    let temporary = temporary.map_err(StudyError::from)?;
    let names = |files: &[ManifestFile]| files.iter().map(|file| file.name.clone()).collect::<Vec<_>>();
    let files_of = |folder: &Path| Ok::<_, PaperError>(Checksums::read(folder)?.unwrap_or_default().files);
    let listed = names(&files_of(folder)?);
    for reduced in [false, true] {
        let again = temporary.path().join(if reduced { "reduced" } else { "full" });
        copy_data(&folder.join(FIGURE_CACHE), &again.join(FIGURE_CACHE))?;
        let options = PaperOptions {
            threads: 1,
            stop,
            reduced,
            folder: &again,
        };
        // No figure is requested, so the result has those with stored data.
        let paper = run(&[], &RunJournal::open(&again)?, &options, &|_| {})?;
        write(&paper, &ResultFiles::new(&again, "paper", false), Vec::new())?;
        let files = files_of(&again)?;
        if names(&files) == listed {
            check.differences = differences(&files, folder, "follow from the data of the figures", stop);
            check.what += ", and as the data of the figures give them, which are not derived again";
            return Ok(());
        }
    }
    check.not_derived = Some(format!(
        "the pictures and tables in {} were not recomputed: their data in {FIGURE_CACHE}/ are incomplete or come from another \
         program",
        folder.display()
    ));
    Ok(())
}

/// Copies the data of figures, which are regular files of a limited length.
fn copy_data(from: &Path, to: &Path) -> Result<(), PaperError> {
    make_folders(to).map_err(FolderError::unwritable(to))?;
    let unreadable = FolderError::read(from);
    for entry in std::fs::read_dir(from).map_err(&unreadable)? {
        let name = entry.map_err(&unreadable)?.file_name();
        let path = from.join(&name);
        let copied = open_limited(&path, MAX_BYTES)
            .and_then(|mut data| std::io::copy(&mut data, &mut File::create(to.join(&name))?));
        copied.map_err(FolderError::read(&path))?;
    }
    Ok(())
}
