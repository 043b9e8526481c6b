//! The files of a case, in memory and in a folder of their own.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use slipfront_case::unfinished::TemporaryFolder;
use tempfile::TempDir;

/// Files with plain names. Their folder goes with them.
#[derive(Debug)]
pub(crate) struct Files {
    contents: BTreeMap<String, Vec<u8>>,
    folder: TempDir,
    _parent: Arc<TemporaryFolder>,
}

impl Files {
    /// Writes them to a new folder.
    pub(crate) fn new(contents: BTreeMap<String, Vec<u8>>) -> std::io::Result<Self> {
        let parent = TemporaryFolder::shared()?;
        let folder = tempfile::tempdir_in(parent.path())?;
        for (name, bytes) in &contents {
            std::fs::write(folder.path().join(name), bytes)?;
        }
        Ok(Self {
            contents,
            folder,
            _parent: parent,
        })
    }

    pub(crate) fn contents(&self) -> &BTreeMap<String, Vec<u8>> {
        &self.contents
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }
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
}
