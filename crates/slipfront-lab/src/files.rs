//! Files of a case on the disk.

use std::io::Read;
use std::path::{Path, PathBuf};

use slipfront_base::disk::open_limited;
use slipfront_base::text::{display_path, shell_path};
use slipfront_case::case_file::{CaseError, read_text};
use slipfront_session::{Document, MAX_FILES};

/// Reads the case of a file, and the files that it names in its own folder or in the `allowed` folders.
///
/// # Errors
/// When it is not a case, a file cannot be read or lies elsewhere, or the files are too large.
pub(crate) fn document(path: &Path, name: &str, allowed: &[PathBuf]) -> Result<Document, CaseError> {
    let text = read_text(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let reach = ReadableFolders::new(folder, "the case", allowed);
    let reach = reach.map_err(|sentence| CaseError::invalid(None, sentence))?;
    Document::new(name, &text, |file| reach.read(file))
}

/// The folders from which files may be read: one folder, and the folders that the user allows. A name or a
/// symbolic link that leads out of them is refused.
pub(crate) struct ReadableFolders<'a> {
    folder: &'a Path,
    /// The owner of the folder in messages, such as `the case`.
    owner: &'static str,
    /// The folders without symbolic links.
    roots: Vec<PathBuf>,
}

impl<'a> ReadableFolders<'a> {
    /// The folder of `owner`, such as `the case`, together with the allowed folders.
    pub(crate) fn new(folder: &'a Path, owner: &'static str, allowed: &[PathBuf]) -> Result<Self, String> {
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        let resolved = |path: &Path| {
            let found = path.canonicalize();
            found.map_err(|error| format!("{} cannot be found: {error}", display_path(path)))
        };
        let roots = [folder].into_iter().chain(allowed.iter().map(PathBuf::as_path));
        Ok(Self {
            folder,
            owner,
            roots: roots.map(resolved).collect::<Result<_, _>>()?,
        })
    }

    /// Resolves a name to the path of a file or folder without symbolic links.
    ///
    /// # Errors
    /// A sentence, if nothing has this name or it lies outside the folders.
    pub(crate) fn resolve(&self, name: impl AsRef<Path>) -> Result<PathBuf, String> {
        let resolved = self.folder.join(name).canonicalize();
        let resolved = resolved.map_err(|error| error.to_string())?;
        if self.roots.iter().any(|root| resolved.starts_with(root)) {
            return Ok(resolved);
        }
        let at = resolved.parent().unwrap_or(&resolved);
        Err(format!(
            "it lies in {}, outside of the folder of {}: to have it read, and made part of links and exports, start \
             `slipfront lab` with --allow-files {}",
            display_path(at),
            self.owner,
            shell_path(at)
        ))
    }

    /// Reads a file of at most [`MAX_FILES`] bytes.
    ///
    /// # Errors
    /// A sentence, if there is no such file, or it lies outside the folders, is too large, or is not a file.
    pub(crate) fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        self.read_up_to(name, MAX_FILES)
    }

    /// Reads a file of at most `limit` bytes.
    ///
    /// # Errors
    /// A sentence, if there is no such file, or it lies outside the folders, is too large, or is not a file.
    pub(crate) fn read_up_to(&self, name: &str, limit: u64) -> Result<Vec<u8>, String> {
        let path = self.resolve(name)?;
        let sentence = |error: std::io::Error| error.to_string();
        let mut file = open_limited(&path, limit).map_err(sentence)?;
        // The path may have been replaced by a link after it was resolved.
        if !is_at(file.get_ref(), &path) {
            return Err("it was replaced while it was opened: try again".to_owned());
        }
        let mut contents = Vec::new();
        file.read_to_end(&mut contents).map_err(sentence)?;
        Ok(contents)
    }
}

/// Whether an open file is the file at this path, and the path is not a symbolic link.
#[cfg(unix)]
fn is_at(opened: &std::fs::File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |found: std::io::Result<std::fs::Metadata>| found.ok().map(|found| (found.dev(), found.ino()));
    let there = id(path.symlink_metadata());
    there.is_some() && there == id(opened.metadata()) && path.canonicalize().is_ok_and(|found| found == path)
}

/// Whether an open file is the file at this path; on systems without inodes only the path can be compared.
#[cfg(not(unix))]
fn is_at(_opened: &std::fs::File, path: &Path) -> bool {
    path.canonicalize().is_ok_and(|found| found == path)
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;

    /// A folder `case` with a file, a second folder next to it, and links from the first into the second.
    #[cfg(unix)]
    fn folders() -> TempDir {
        use std::os::unix::fs::symlink;
        let all = tempfile::tempdir().unwrap();
        let at = |name: &str| all.path().join(name);
        for folder in ["case/inner", "shared", "case-2"] {
            std::fs::create_dir_all(at(folder)).unwrap();
        }
        for file in ["case/a.csv", "case/inner/b.csv", "shared/x.csv", "case-2/y.csv"] {
            std::fs::write(at(file), file).unwrap();
        }
        symlink("inner/b.csv", at("case/link-inside.csv")).unwrap();
        symlink("../shared/x.csv", at("case/link-outside.csv")).unwrap();
        symlink("../shared", at("case/folder-outside")).unwrap();
        symlink("loop", at("case/loop")).unwrap();
        all
    }

    #[cfg(unix)]
    #[test]
    fn files_outside_of_the_folder_are_read_if_they_are_allowed() {
        let all = folders();
        let case = all.path().join("case");
        let shared = all.path().join("shared").canonicalize().unwrap();
        let own = ReadableFolders::new(&case, "the case", &[]).unwrap();
        let absolute = shared.join("x.csv").display().to_string();
        for (name, file) in [
            ("a.csv", "case/a.csv"),
            ("inner/../a.csv", "case/a.csv"),
            ("../case/a.csv", "case/a.csv"),
            ("link-inside.csv", "case/inner/b.csv"),
        ] {
            assert_eq!(own.read(name).unwrap(), file.as_bytes(), "{name}");
        }
        let allowed = ReadableFolders::new(&case, "the case", &[all.path().join("shared")]).unwrap();
        for name in [
            "../shared/x.csv",
            "link-outside.csv",
            "folder-outside/x.csv",
            &absolute,
        ] {
            let refused = own.read(name).unwrap_err();
            let remedy = format!("start `slipfront lab` with --allow-files {}", shared.display());
            assert!(
                refused.contains("outside of the folder of the case") && refused.ends_with(&remedy),
                "{refused}"
            );
            assert_eq!(allowed.read(name).unwrap(), b"shared/x.csv", "{name}");
        }
        // A folder with a name that only begins the same way is a different folder.
        assert!(allowed.read("../case-2/y.csv").unwrap_err().contains("outside"));
        for name in [
            "loop",
            "none.csv",
            "inner",
            "",
            "a.csv/../../shared/x.csv",
            "a\0.csv",
        ] {
            assert!(own.read(name).is_err(), "{name}");
        }
        assert!(ReadableFolders::new(&case, "the case", &[all.path().join("none")]).is_err());
    }

    /// A file is refused if its folder becomes a link to another folder between resolving and opening.
    #[cfg(unix)]
    #[test]
    fn a_file_that_was_replaced_by_a_link_is_noticed() {
        let all = folders();
        let found = all.path().canonicalize().unwrap().join("case/inner/b.csv");
        assert!(is_at(&std::fs::File::open(&found).unwrap(), &found));
        let inner = all.path().join("case/inner");
        std::fs::rename(&inner, all.path().join("case/before")).unwrap();
        std::fs::write(all.path().join("shared/b.csv"), "secret").unwrap();
        std::os::unix::fs::symlink("../shared", &inner).unwrap();
        let opened = std::fs::File::open(&found).unwrap();
        assert!(!is_at(&opened, &found));
        // The link is removed again.
        std::fs::remove_file(&inner).unwrap();
        std::fs::rename(all.path().join("case/before"), &inner).unwrap();
        assert!(!is_at(&opened, &found));
    }
}
