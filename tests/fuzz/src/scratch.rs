//! A temporary folder of this process for the files that parsers read.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    // Records are synced to the disk after every line, which is fast in memory.
    let in_memory = || TempDir::new_in("/dev/shm");
    let asked = std::env::var_os("TMPDIR").map(|_| TempDir::new());
    asked
        .unwrap_or_else(in_memory)
        .or_else(|_| TempDir::new())
        .unwrap()
});

/// Writes a file into the folder.
pub(crate) fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = FOLDER.path().join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, bytes).unwrap();
    path
}

/// An empty folder inside the folder.
pub(crate) fn folder(name: &str) -> PathBuf {
    let path = FOLDER.path().join(name);
    if path.exists() {
        std::fs::remove_dir_all(&path).unwrap();
    }
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// A file of the repository.
pub(crate) fn repository(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}
