//! Compares the folder of a project with the list of its files, and then with the results of its recorded
//! runs.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_base::disk::{TEXT_MAX_BYTES, found_at, open_limited};
use slipfront_base::number_format::{are, count};
use slipfront_base::text::single_line;
use slipfront_base::unfinished::{TemporaryFolder, is_unfinished};
use slipfront_plot::PictureLook;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::ManifestFile;
use slipfront_run::program;
use slipfront_run::verify::{FolderCheck, VerifyError, description_in, differences, unlisted_files};

use super::checksums::{CHECKSUMS, Checksums};
use super::kind::ProjectKind;
use crate::error::StudyError;

/// Extent of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Files are compared with their checksums.
    Checksums,
    /// Results are also derived again from the recorded runs.
    Derived,
}

/// Derives the results of a folder again in another one, from a copy of its journal, with pictures in this
/// look, until a stop. Missing runs are made; returns the numbers of runs before and after.
pub type FindAgain =
    fn(folder: &Path, other: &Path, look: &PictureLook, stop: &AtomicBool) -> Result<[usize; 2], StudyError>;

/// Compares what a folder has beside the files in its list, such as folders of runs; returns the end of the
/// sentence of the check.
pub type VerifyBeside =
    fn(folder: &Path, check: &mut FolderCheck, stop: &AtomicBool) -> Result<String, StudyError>;

/// A kind of project, and what can be done with its folders.
#[derive(Debug)]
pub struct Project {
    /// The kind.
    pub kind: &'static ProjectKind,
    /// Names, without their ending, of images in the folder that are not pictures of results.
    pub no_pictures: &'static [&'static str],
    /// Entries of the folder that are not in its list, and the function that compares them.
    pub beside: &'static [&'static str],
    /// The function that compares these entries with the journal.
    pub verify_beside: Option<VerifyBeside>,
    /// The function that derives the results of such a folder again; none for the figures of the paper.
    pub find_again: Option<FindAgain>,
}

impl Project {
    /// Derives the results of a folder again in another one; returns the numbers of runs before and after.
    ///
    /// # Errors
    /// When runs are missing that cannot be made again, results cannot be derived, or the system refuses to
    /// read or to write; after a stop.
    pub(crate) fn again(
        &self,
        folder: &Path,
        other: &Path,
        look: &PictureLook,
        stop: &AtomicBool,
    ) -> Result<[usize; 2], StudyError> {
        let Some(find_again) = self.find_again else {
            return Ok([0; 2]);
        };
        find_again(folder, other, look, stop).map_err(|error| match error {
            StudyError::Missing { runs, others } => StudyError::LacksRuns {
                path: folder.to_owned(),
                runs,
                others,
            },
            error => error,
        })
    }

    /// Compares the entries of a folder that are not in its list.
    pub(crate) fn verify_beside(
        &self,
        folder: &Path,
        check: &mut FolderCheck,
        stop: &AtomicBool,
    ) -> Result<(), StudyError> {
        if let Some(verify_beside) = self.verify_beside {
            let found = verify_beside(folder, check, stop)?;
            check.what += &found;
        }
        Ok(())
    }
}

/// Compares the files of a folder with its list, and notes entries that are neither in the list nor `beside`
/// it; the results are complete if the second value is true.
///
/// # Errors
/// When the system cannot list the folder.
pub(crate) fn verify_checksums(
    folder: &Path,
    kind: &ProjectKind,
    beside: &[&str],
    stop: &AtomicBool,
) -> Result<(FolderCheck, bool), StudyError> {
    let mut check = FolderCheck::default();
    for (name, remedy) in [
        (CHECKSUMS, "with this folder as --out"),
        (kind.file, "with this folder as --out"),
        (kind.journal, "with another --out, which repeats its runs"),
    ] {
        let path = folder.join(name);
        if found_at(&path).map_err(FolderError::read(&path))?.is_none() {
            check.differences.push(single_line(&format!(
                "{} is missing in the folder of a {}: put it back, or run `slipfront {}` again {remedy}",
                path.display(),
                kind.name,
                kind.table
            )));
        }
    }
    let path = folder.join(CHECKSUMS);
    let list = match Checksums::read(folder) {
        Ok(Some(list)) => list,
        Ok(None) => return Ok((check, false)),
        Err(StudyError::Checksums { why, .. }) => {
            check
                .differences
                .push(format!("{} is damaged: {why}", path.display()));
            return Ok((check, false));
        }
        Err(error) => return Err(error),
    };
    // A journal only grows: with more lines than the results follow from, these are no longer complete.
    let has_grown = |file: &&ManifestFile| {
        let length = std::fs::metadata(folder.join(&file.name)).map_or(0, |found| found.len());
        file.name == kind.journal
            && length > file.bytes
            && ManifestFile::read_beginning(folder, &file.name, file.bytes, stop)
                .is_ok_and(|found| found == **file)
    };
    let (grown, sources): (Vec<_>, Vec<_>) = list.sources.iter().partition(has_grown);
    let is_key = |file: &&ManifestFile| file.name == kind.file || file.name == kind.journal;
    let is_told = |file: &&ManifestFile| is_key(file) && !folder.join(&file.name).exists();
    let compared = list.files.iter().chain(sources).filter(|file| !is_told(file));
    check
        .differences
        .extend(differences(compared, folder, "were written", stop));
    if !list.replaced.is_empty() {
        let sentence = format!(
            "{}: the results were not completely written; run the command of this folder again to complete them",
            path.display()
        );
        check.differences.push(sentence);
    }
    let by = program::in_words(&list.version, list.revision.as_deref());
    check.what = format!(
        "{} unchanged since {by} wrote them",
        count(list.files.len(), "file")
    );
    let is_left = |name: &str| name.rsplit('/').next().is_some_and(is_unfinished);
    let known = list.files.iter().map(|file| file.name.as_str());
    let (described, outdated) = description_in(folder, &list.seal);
    let known = known
        .chain([CHECKSUMS, kind.journal])
        .chain(described)
        .chain(beside.iter().copied());
    check.notes = unlisted_files(folder, &known.collect(), is_left);
    check.notes.extend(outdated);
    Ok((check, list.is_complete && grown.is_empty()))
}

/// Compares the files of a folder with its list, as `verify_checksums` does, and refuses unfinished
/// results.
///
/// # Errors
/// When all files are as they were written, but the project is not finished; when the system cannot list the
/// folder.
pub fn verify_complete(
    folder: &Path,
    kind: &ProjectKind,
    beside: &[&str],
    stop: &AtomicBool,
) -> Result<FolderCheck, StudyError> {
    let (check, is_complete) = verify_checksums(folder, kind, beside, stop)?;
    if check.differences.is_empty() && !is_complete {
        let (what, path) = (kind.name, folder.to_owned());
        return Err(StudyError::Unfinished { what, path });
    }
    Ok(check)
}

/// Compares the folder of a project with its list, then with the results that follow from the runs in its
/// journal.
pub(crate) fn verify_project(
    folder: &Path,
    project: &Project,
    extent: Extent,
    stop: &AtomicBool,
) -> Result<FolderCheck, StudyError> {
    let mut check = verify_complete(folder, project.kind, project.beside, stop)?;
    if project.find_again.is_none() {
        check.not_derived = Some(format!(
            "the figures in {} were not drawn again: `slipfront verify` draws them",
            folder.display()
        ));
    } else if extent == Extent::Derived && check.differences.is_empty() {
        derive_from_runs(folder, project, &mut check, stop)?;
    }
    project.verify_beside(folder, &mut check, stop)?;
    Ok(check)
}

/// Compares the folder of a project with results that are derived in another folder from the runs in its
/// journal.
fn derive_from_runs(
    folder: &Path,
    project: &Project,
    check: &mut FolderCheck,
    stop: &AtomicBool,
) -> Result<(), StudyError> {
    let temporary = TemporaryFolder::new(folder).map_err(VerifyError::Temporary)?;
    // Opening a pipe would wait forever.
    let file = folder.join(project.kind.file);
    open_limited(&file, TEXT_MAX_BYTES).map_err(FolderError::read(&file))?;
    let [kept, all] = project.again(folder, temporary.path(), &PictureLook::default(), stop)?;
    if all > kept {
        let sentence = format!("{} not in the journal, and run again", are(all - kept, "run"));
        check.notes.push(sentence);
    }
    let again = Checksums::read(temporary.path())?.unwrap_or_default();
    check.differences = differences(&again.files, folder, "follow from its runs", stop);
    check.what = format!(
        "{}, a {} as its {} give it",
        check.what,
        project.kind.name,
        count(kept, "recorded run")
    );
    Ok(())
}
