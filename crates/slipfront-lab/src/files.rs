//! The files of a case, and their names.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use slipfront_case::disk::{open_limited, read_limited};
use slipfront_case::text::{display_path, shell_quoted};
use slipfront_case::unfinished::TemporaryFolder;
use tempfile::TempDir;

/// Most bytes of all files of a case.
pub(crate) const MAX_FILES: u64 = 64 << 20;

/// A file of a case, in a temporary folder of its own that is removed with it. The cases that name the file share it.
#[derive(Debug)]
pub(crate) struct TemporaryFile {
    folder: TempDir,
    /// The folder of temporary files of this process, which must outlive the one in it.
    _parent: Arc<TemporaryFolder>,
    name: String,
    /// Length of the file, bytes.
    pub(crate) bytes: usize,
}

impl TemporaryFile {
    /// Writes a file under a plain name.
    pub(crate) fn new(name: &str, contents: &[u8]) -> std::io::Result<Self> {
        let parent = TemporaryFolder::shared()?;
        let folder = tempfile::tempdir_in(parent.path())?;
        std::fs::write(folder.path().join(name), contents)?;
        Ok(Self {
            folder,
            _parent: parent,
            name: name.to_owned(),
            bytes: contents.len(),
        })
    }

    /// Reads the contents of the file.
    pub(crate) fn read(&self) -> std::io::Result<Vec<u8>> {
        read_limited(&self.folder.path().join(&self.name), MAX_FILES)
    }

    /// The path of the file from the folder of temporary files.
    pub(crate) fn path(&self) -> String {
        let folder = self.folder.path();
        let folder = folder.strip_prefix(temporary()).unwrap_or(folder);
        format!("{}/{}", folder.display(), self.name)
    }
}

/// The folder of temporary files.
pub(crate) fn temporary() -> PathBuf {
    std::env::temp_dir()
}

/// The folders in which files of the disk may be read: one, and those that the user allows. What leads out of them, by its name
/// or by symbolic links, is refused.
pub(crate) struct ReadableFolders<'a> {
    folder: &'a Path,
    /// What the folder is called in messages.
    of: &'static str,
    /// The folders without symbolic links.
    roots: Vec<PathBuf>,
}

impl<'a> ReadableFolders<'a> {
    /// The folder of what messages call `of`, such as `the case`, and the allowed folders.
    pub(crate) fn new(folder: &'a Path, of: &'static str, allowed: &[PathBuf]) -> Result<Self, String> {
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
            of,
            roots: roots.map(resolved).collect::<Result<_, _>>()?,
        })
    }

    /// The path of what has this name, without symbolic links.
    ///
    /// # Errors
    /// A sentence, if there is none, or it lies elsewhere.
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
            self.of,
            shell_quoted(&display_path(at))
        ))
    }

    /// Reads a file.
    ///
    /// # Errors
    /// A sentence, if there is none, it lies elsewhere, is too large, or is no file.
    pub(crate) fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        let path = self.resolve(name)?;
        let sentence = |error: std::io::Error| error.to_string();
        let mut file = open_limited(&path, MAX_FILES).map_err(sentence)?;
        // A link may have been put on the way to it since it was found.
        if !is_at(file.get_ref(), &path) {
            return Err("it was replaced while it was opened: try again".to_owned());
        }
        let mut contents = Vec::new();
        file.read_to_end(&mut contents).map_err(sentence)?;
        Ok(contents)
    }
}

/// Whether a file that was opened is the one at this path, to which no symbolic link leads.
#[cfg(unix)]
fn is_at(opened: &std::fs::File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |found: std::io::Result<std::fs::Metadata>| found.ok().map(|found| (found.dev(), found.ino()));
    let there = id(path.symlink_metadata());
    there.is_some() && there == id(opened.metadata()) && path.canonicalize().is_ok_and(|found| found == path)
}

/// Whether a file that was opened is the one at this path: only its path tells, on systems without inodes.
#[cfg(not(unix))]
fn is_at(_opened: &std::fs::File, path: &Path) -> bool {
    path.canonicalize().is_ok_and(|found| found == path)
}

/// Characters that stand for themselves in names of files on every system.
fn is_plain(c: char) -> bool {
    c.is_alphanumeric() || "_-. ()+".contains(c)
}

/// Whether this is a name within a folder, and not a path that may lead out of it.
pub(crate) fn is_plain_name(name: &str) -> bool {
    !name.is_empty() && name.len() <= 100 && !name.starts_with('.') && name.chars().all(is_plain)
}

/// The name of a file as a plain one.
pub(crate) fn plain_name(path: &str) -> String {
    let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let name = name.trim_start_matches('.').chars();
    name.map(|c| if is_plain(c) { c } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_within_their_folder() {
        for path in ["a/../b.png", "..\\b.png", "/b.png", "b.png", ".b.png"] {
            assert_eq!(plain_name(path), "b.png", "{path}");
        }
        assert_eq!(plain_name("C:b*.png"), "C_b_.png");
        assert!(is_plain_name("run (2)") && is_plain_name("M\u{fc}nchen-1.0"));
        for name in ["", ".", "..", "a/b", "a\\b", "C:b", ".hidden", "a\nb"] {
            assert!(!is_plain_name(name), "{name:?}");
        }
    }

    /// A folder `case` with a file, one beside it, and links from the first into the second.
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
        // A folder whose name begins in the same way is another one.
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

    /// The file is found, and then its folder becomes a link to another one.
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
        // And the link goes again.
        std::fs::remove_file(&inner).unwrap();
        std::fs::rename(all.path().join("case/before"), &inner).unwrap();
        assert!(!is_at(&opened, &found));
    }
}
