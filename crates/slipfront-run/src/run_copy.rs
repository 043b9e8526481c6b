//! Copies of run folders, for studies that are merged.

use std::path::Path;

use slipfront_base::disk::{open_regular, write_temp};

use crate::folder_error::FolderError;
use crate::names::{CASE, MANIFEST, UNFINISHED};
use crate::run_folder::RunFolder;

/// Copies the files of a run folder. The case and the manifest come last: without them, the copy does not
/// count as complete.
pub fn copy_run(from: &Path, to: &Path) -> Result<(), FolderError> {
    let failed = |source| FolderError::Copy {
        from: from.to_owned(),
        to: to.to_owned(),
        source,
    };
    let mut copy = RunFolder::prepare(to, true, &[])?;
    let mut names = file_names(from).map_err(failed)?;
    // All other files come first; their order does not matter.
    names.sort_by_key(|name| [CASE, MANIFEST].iter().position(|last| name == last));
    for name in &names {
        if name == CASE {
            copy.sync()?;
        }
        let mut original = open_regular(&from.join(name)).map_err(failed)?;
        let file = write_temp(&copy.temporary(), |to| std::io::copy(&mut original, to).map(drop));
        let file = file.map_err(failed)?;
        if name == MANIFEST {
            copy.place_manifest(file)?;
        } else {
            copy.place(name, file)?;
        }
    }
    // A run that failed has only its case, and its copy remains the folder of an interrupted run.
    if names.iter().any(|name| name == MANIFEST) {
        copy.close();
    }
    Ok(())
}

/// Every file below a folder, without those of unfinished work, by its relative path.
pub fn file_names(folder: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    collect_names(folder, "", &mut names)?;
    Ok(names)
}

fn collect_names(folder: &Path, prefix: &str, names: &mut Vec<String>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder.join(prefix))? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if !entry.file_type()?.is_dir() {
            names.push(name);
        } else if name != UNFINISHED {
            collect_names(folder, &format!("{name}/"), names)?;
        }
    }
    Ok(())
}
