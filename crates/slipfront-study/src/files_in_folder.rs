//! Files that a study or a design writes to its results folder.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use slipfront_case::disk::{folder_of, found_at, make_folders, sync_folder, write_atomic_with, write_beside};
use slipfront_plot::Picture;
use slipfront_run::folder_error::FolderError;

use crate::error::StudyError;
use crate::input_copies::Copy;

/// Writes a file of a folder atomically.
pub(crate) fn write_in(
    folder: &Path,
    name: &str,
    fill: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> Result<(), StudyError> {
    let path = folder.join(name);
    let written = make_folders(folder_of(&path)).and_then(|()| write_atomic_with(&path, fill));
    written.map_err(|source| StudyError::Write { path, source })
}

/// Writes a picture to a folder in both its formats.
pub(crate) fn write_picture(folder: &Path, name: &str, picture: &Picture) -> Result<(), StudyError> {
    write_in(folder, &format!("{name}.svg"), |file| {
        file.write_all(picture.svg.as_bytes())
    })?;
    write_in(folder, &format!("{name}.png"), |file| {
        file.write_all(&picture.png)
    })
}

/// Copies files to a folder, all of them under hidden names first: the name of a copy may be that of another original.
pub(crate) fn copy_in(folder: &Path, copies: &[Copy]) -> Result<(), StudyError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        |source| StudyError::Write { path, source }
    };
    let mut staged = Vec::new();
    for Copy { name, original, .. } in copies {
        let path = folder.join(name);
        // A link may lead to a folder that is not of this study.
        for above in path.ancestors().skip(1).take_while(|above| *above != folder) {
            let found = found_at(above).map_err(FolderError::read(above))?;
            if found.is_some_and(|found| !found.is_dir()) {
                let path = above.to_owned();
                return Err(FolderError::Foreign { path }.into());
            }
        }
        let copied = make_folders(folder_of(&path)).and_then(|()| {
            write_beside(&path, |to| {
                std::io::copy(&mut File::open(original)?, to).map(|_| ())
            })
        });
        // There may be more of them than can be open; the lock on the records keeps other processes away.
        staged.push((copied.map_err(failed(&path))?.into_temp_path(), path));
    }
    for (file, path) in staged {
        let persisted = file.persist(&path).map_err(|error| error.error);
        persisted
            .and_then(|()| sync_folder(folder_of(&path)))
            .map_err(failed(&path))?;
    }
    Ok(())
}
