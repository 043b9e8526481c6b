//! Files written by a run.

use std::collections::BTreeMap;
use std::path::Path;

/// Contents of files, by file name.
pub(crate) type Files = BTreeMap<String, Vec<u8>>;

/// Every file of a complete run except the manifest, which contains machine names and dates.
pub(crate) fn results(folder: &Path) -> Files {
    let mut files = Files::new();
    for folder in [folder, &folder.join("inputs")] {
        for entry in std::fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_file() {
                let name = path.file_name().unwrap().to_string_lossy().into_owned();
                files.insert(name, std::fs::read(path).unwrap());
            }
        }
    }
    assert!(files.remove("manifest.json").is_some(), "no manifest");
    files
}

pub(crate) fn assert_same(one: &Files, other: &Files) {
    assert!(one.keys().eq(other.keys()));
    for (name, bytes) in one {
        assert!(*bytes == other[name], "{name} differs");
    }
}
