//! Verifies a folder by its kind.

use std::path::{Component, Path};
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_base::disk::read_limited;
use slipfront_base::number_format::count;
use slipfront_base::text::single_line;
use slipfront_base::unfinished::is_unfinished;
use slipfront_run::export::folders_in;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::{Manifest, ManifestError};
use slipfront_run::names::{FIGURE_CACHE, MANIFEST, RO_CRATE};
use slipfront_run::verify::{
    DESCRIPTION_MAX_BYTES, FolderCheck, VerifyError, inspect, unlisted_files, verify_run,
};

use crate::error::StudyError;
use crate::folder::{PAPER, is_of_figures};
use crate::project_folder::verify::verify_project;
use crate::project_folder::{Checksums, Extent, Project};
use crate::study_file::STUDIES;
use crate::write::STUDY_FOLDERS;

/// Folders of `slipfront paper`.
const PAPER_FOLDERS: Project = Project {
    kind: &PAPER,
    no_pictures: &[],
    beside: &[FIGURE_CACHE],
    verify_beside: None,
    find_again: None,
};

/// The project whose results a folder has: a study, one of these `others`, or the paper; none for other
/// folders.
pub(crate) fn project_in<'p>(folder: &Path, others: &'p [Project]) -> Option<&'p Project> {
    let mut projects = std::iter::once(&STUDY_FOLDERS).chain(others);
    let found = projects.find(|project| project.kind.has_results_in(folder));
    found.or_else(|| is_of_figures(folder).then_some(&PAPER_FOLDERS))
}

/// Whether a study has been run in the folder.
pub fn has_records(folder: &Path) -> bool {
    STUDIES.is_in(folder)
}

/// Verifies the folder of a run, of a study, or of a project of one of these `others` that was finished.
///
/// # Errors
/// When it is not such a folder, was not finished, or cannot be read; after a stop.
pub fn verify(
    folder: &Path,
    others: &[Project],
    extent: Extent,
    stop: &AtomicBool,
) -> Result<FolderCheck, StudyError> {
    let check = if let Some(project) = project_in(folder, others) {
        verify_project(folder, project, extent, stop)?
    } else if !folder.join(MANIFEST).exists() && folder.join(RO_CRATE).is_file() {
        verify_crate(folder, others, extent, stop)?
    } else {
        verify_run(&inspect(folder)?, stop)?
    };
    if stop.load(Ordering::Relaxed) {
        return Err(StudyError::Interrupted);
    }
    Ok(check)
}

/// Verifies every folder of results in a crate that `slipfront export` has made.
fn verify_crate(
    folder: &Path,
    others: &[Project],
    extent: Extent,
    stop: &AtomicBool,
) -> Result<FolderCheck, StudyError> {
    let path = folder.join(RO_CRATE);
    let mut check = FolderCheck::default();
    let description = read_limited(&path, DESCRIPTION_MAX_BYTES).map_err(FolderError::read(&path))?;
    let names = folders_in(&description).unwrap_or_default();
    if names.is_empty() {
        let damage = format!("{} is damaged: it names no folder of results", path.display());
        check.differences.push(damage);
    }
    for name in &names {
        let part = folder.join(name);
        let is_inside = Path::new(name)
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if !is_inside || !part.is_dir() {
            check
                .differences
                .push(single_line(&format!("{} is missing", part.display())));
            continue;
        }
        let of_part = verify(&part, others, extent, stop)?;
        let seal = match seal_of(&part) {
            Ok(seal) => seal,
            // Differences of the list or manifest itself are told already.
            Err(_) if !of_part.differences.is_empty() => None,
            Err(error) => return Err(error),
        };
        check.differences.extend(of_part.differences);
        check.notes.extend(of_part.notes);
        let is_described = |seal: String| {
            description
                .windows(seal.len())
                .any(|text| text == seal.as_bytes())
        };
        if !seal.is_none_or(is_described) {
            check.differences.push(single_line(&format!(
                "{} has other results than {} describes: it was replaced; export the original again",
                part.display(),
                path.display()
            )));
        }
    }
    let known = names.iter().map(String::as_str).chain([RO_CRATE]).collect();
    check.notes.extend(unlisted_files(folder, &known, is_unfinished));
    check.what = format!("a crate of {}, unchanged", count(names.len(), "folder"));
    Ok(check)
}

/// Seal of the list of a folder, or of its manifest; none if it has neither.
fn seal_of(folder: &Path) -> Result<Option<String>, StudyError> {
    if let Some(list) = Checksums::read(folder)? {
        return Ok(Some(list.seal));
    }
    match Manifest::read(folder) {
        Ok(manifest) => Ok(Some(manifest.checksum)),
        Err(ManifestError::Missing { .. }) => Ok(None),
        Err(error) => Err(VerifyError::from(error).into()),
    }
}
