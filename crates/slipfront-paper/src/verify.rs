//! Compares a folder of figures with the list of its files, and with what follows from the data that were stored there.

use std::fs::File;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_case::disk::{make_folders, open_limited};
use slipfront_case::unfinished::TemporaryFolder;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::ManifestFile;
use slipfront_run::names::FIGURE_CACHE;
use slipfront_run::verify::{Verdict, VerifyError, differences};
use slipfront_study::Records;
use slipfront_study::result_files::{Checksums, ResultFiles};
use slipfront_study::verify::{Extent, verify_checksums};

use crate::cache::MAX_BYTES;
use crate::error::PaperError;
use crate::paper::{Paper, PaperOptions, run};
use crate::report::write;

/// Compares the folder of `slipfront paper` with the list of its files, then with pictures and tables that are made again from the
/// data of its figures, unless these were measured by another program.
///
/// # Errors
/// When the folder cannot be read, and after a stop.
pub fn verify(folder: &Path, extent: Extent, stop: &AtomicBool) -> Result<Verdict, PaperError> {
    let mut verdict = verify_checksums(folder, &[Records::FILE, FIGURE_CACHE], stop)?;
    if extent == Extent::Checksums || !verdict.differences.is_empty() {
        return Ok(verdict);
    }
    let temporary = TemporaryFolder::new(folder).map_err(VerifyError::Temporary)?;
    copy_data(&folder.join(FIGURE_CACHE), &temporary.path().join(FIGURE_CACHE))?;
    let records = Records::open(temporary.path())?;
    let again = |reduced| -> Result<Paper, PaperError> {
        let options = PaperOptions {
            threads: 1,
            stop,
            reduced,
            folder: temporary.path(),
        };
        // No figure is asked for: there are those whose data were stored.
        run(&[], &records, &options, &|_| {})
    };
    let mut paper = again(false)?;
    if paper.figures.is_empty() {
        paper = again(true)?;
    }
    write(&paper, &ResultFiles::new(temporary.path(), "paper", false))?;
    let names = |list: &[ManifestFile]| list.iter().map(|file| file.name.clone()).collect::<Vec<_>>();
    let [listed, now] = [folder, temporary.path()].map(Checksums::read);
    let [listed, now] = [listed?, now?].map(|list| list.unwrap_or_default().files);
    if names(&listed) == names(&now) {
        verdict.differences = differences(&now, folder, "follow from the data of the figures", stop);
        verdict.what += ", and as the data of the figures give them";
    } else {
        verdict.not_derived = Some(format!(
            "the pictures and tables in {} were not made again: not all of their data stand in {FIGURE_CACHE}/, or another program has \
             measured them",
            folder.display()
        ));
    }
    Ok(verdict)
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
