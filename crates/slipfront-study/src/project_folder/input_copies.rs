//! Files that the cases of a study read, copied so that a results folder can repeat the study on its own.

use std::fs::File;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use toml::{Table, Value};

use slipfront_case::case::name_of_copy;
use slipfront_case::case_file::names_a_file;
use slipfront_run::folder_error::FolderError;

/// Folder of the copies.
const FOLDER: &str = "inputs";

/// The plain name of a file: its path below the folder of the case, or the last part of a path elsewhere. A
/// copy has the plain name of its original.
pub(crate) fn plain_name(written: &str) -> String {
    let path = Path::new(written);
    let is_below = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if !path.components().all(is_below) {
        let last = path.file_name().map(|name| name.to_string_lossy().into_owned());
        return last.unwrap_or_else(|| written.to_owned());
    }
    let below = path.strip_prefix(FOLDER).unwrap_or(path).components();
    let below = below.filter(|part| matches!(part, Component::Normal(_)));
    let parts: Vec<_> = below.map(|part| part.as_os_str().to_string_lossy()).collect();
    parts.join("/")
}

/// A copy to be made of a file.
pub struct Copy {
    /// Path of the copy in the results folder.
    pub(crate) name: String,
    /// Path of the original.
    pub(crate) original: PathBuf,
    hash: blake3::Hash,
}

impl Copy {
    /// Whether the results folder has another file of this name.
    pub fn differs_in(&self, folder: &Path) -> bool {
        hash(&folder.join(&self.name)).is_ok_and(|found| found.is_some_and(|found| found != self.hash))
    }
}

/// Replaces the names of all files of a study, which are relative to `folder`, by those of copies.
pub(crate) fn copy(study: &mut Table, folder: &Path) -> Result<Vec<Copy>, FolderError> {
    let mut copies = Vec::new();
    visit_table(study, folder, &mut copies)?;
    Ok(copies)
}

fn visit_table(table: &mut Table, folder: &Path, copies: &mut Vec<Copy>) -> Result<(), FolderError> {
    // In an axis, the key and its values are in the same table.
    let lists_files = table.get("key").and_then(Value::as_str).is_some_and(names_a_file);
    for (key, value) in table.iter_mut() {
        let is_file = names_a_file(key) || (lists_files && key == "list");
        visit(value, is_file, folder, copies)?;
    }
    Ok(())
}

fn visit(value: &mut Value, is_file: bool, folder: &Path, copies: &mut Vec<Copy>) -> Result<(), FolderError> {
    match value {
        Value::String(name) if is_file => replace(name, folder.join(&*name), copies),
        Value::Array(values) => {
            let mut values = values.iter_mut();
            values.try_for_each(|value| visit(value, is_file, folder, copies))
        }
        Value::Table(table) => visit_table(table, folder, copies),
        _ => Ok(()),
    }
}

fn replace(name: &mut String, original: PathBuf, copies: &mut Vec<Copy>) -> Result<(), FolderError> {
    // Every point was valid, so no point reads a missing file.
    let Some(hash) = hash(&original).map_err(FolderError::read(&original))? else {
        return Ok(());
    };
    let is_same = |name: &str| Some(copies.iter().find(|made| made.name == name)?.hash == hash);
    let (copy, is_made) = name_of_copy(&plain_name(name), is_same);
    name.clone_from(&copy);
    if !is_made {
        copies.push(Copy {
            name: copy,
            original,
            hash,
        });
    }
    Ok(())
}

/// The hash of a regular file; none if there is no such file.
fn hash(path: &Path) -> std::io::Result<Option<blake3::Hash>> {
    match std::fs::metadata(path) {
        Ok(metadata) if metadata.is_file() => {}
        // Opening a pipe would wait, and a device never ends.
        Ok(_) => return Ok(None),
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return Ok(None);
        }
        Err(error) => return Err(error),
    }
    let mut hasher = blake3::Hasher::new();
    Ok(Some(hasher.update_reader(File::open(path)?)?.finalize()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_has_the_plain_name_of_its_original() {
        for (written, plain) in [
            ("mask.png", "mask.png"),
            ("./masks/a.png", "masks/a.png"),
            ("../masks/a.png", "a.png"),
            ("/data/a.png", "a.png"),
            ("inputs/masks/a.png", "masks/a.png"),
        ] {
            assert_eq!(plain_name(written), plain);
            assert_eq!(plain_name(&format!("inputs/{plain}")), plain);
        }
    }

    /// A file without end is not copied. No point reads it, so no case has detected it.
    #[cfg(unix)]
    #[test]
    fn what_never_ends_is_not_copied() {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("endless.png")).unwrap();
        let mut study: Table = "base.texture = [{ shape = 'mask', file = 'endless.png' }]"
            .parse()
            .unwrap();
        assert!(copy(&mut study, folder.path()).unwrap().is_empty());
    }

    /// A file that cannot be read is an error: a point may read it the next time.
    #[cfg(unix)]
    #[test]
    fn what_cannot_be_read_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("circle.png");
        std::os::unix::fs::symlink(&path, &path).unwrap();
        let mut study: Table = "base.texture = [{ shape = 'mask', file = 'circle.png' }]"
            .parse()
            .unwrap();
        let error = copy(&mut study, folder.path()).err().unwrap().to_string();
        assert!(error.contains("circle.png"), "{error}");
    }

    #[test]
    fn files_are_found_wherever_a_study_names_them() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.png", "b.png", "c.npy", "sub/a.png"] {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, name).unwrap();
        }
        std::fs::write(folder.path().join("sub/again.png"), "a.png").unwrap();
        let text = r#"
            base.texture = [{ shape = "mask", file = "a.png" }]
            axes = [
                { key = "texture.0.file", list = ["a.png", "sub/a.png", "missing.png"] },
                { zip = { "friction.mu_static_field" = ["c.npy"] } },
                { name = "shape", variants = { b = { texture = [{ shape = "mask", file = "b.png" }] } } },
            ]"#;
        let mut study: Table = text.parse().unwrap();
        let copies = copy(&mut study, folder.path()).unwrap();
        let names: Vec<&str> = copies.iter().map(|copy| copy.name.as_str()).collect();
        assert_eq!(
            names,
            ["inputs/a.png", "inputs/sub/a.png", "inputs/c.npy", "inputs/b.png"]
        );
        let printed = study.to_string();
        for name in names.iter().chain(&["\"missing.png\""]) {
            assert!(printed.contains(name), "{name} in {printed}");
        }
    }
}
