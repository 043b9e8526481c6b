//! The command from outside: what a user types, sees, and finds on disk.

// Helpers of tests are not tests by themselves to clippy.
#![allow(clippy::unwrap_used)]

mod broken;
#[cfg(unix)]
mod checkpoints;
mod folder;
mod input;
mod looks;
mod output;
mod repetition;
mod texture;
mod verify;

use std::collections::BTreeMap;
use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

/// A small and quick case: 30 blocks, 800 steps.
const SMALL: &str = "[slider]\nblocks = [6, 5]\n[drive]\nv_star = 0.1\n";

/// The same with a mask.
const MASKED: &str =
    "[slider]\nblocks = [6, 5]\n[drive]\nv_star = 0.1\n[[texture]]\nshape='mask'\nfile='spot.png'\n";

/// Every file of a run without inputs (design, section 3).
const RUN_FILES: [&str; 9] = [
    "case.toml",
    "fields.nc",
    "friction.png",
    "friction.svg",
    "manifest.json",
    "series.csv",
    "stress.png",
    "stress.svg",
    "summary.json",
];

/// A working directory of its own that holds `small.toml`.
struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = TempDir::new().unwrap();
        let bench = Self { folder };
        bench.write("small.toml", SMALL);
        bench
    }

    /// The same, with `masked.toml`, which reads the mask `spot.png`.
    fn masked() -> Self {
        let bench = Self::new();
        bench.done("texture small.toml -o spot.png --set texture.0={shape=\"cavity\",coverage=15}");
        bench.write("masked.toml", MASKED);
        bench
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        let path = self.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, contents).unwrap();
    }

    fn read(&self, name: &str) -> Vec<u8> {
        let path = self.path().join(name);
        std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    fn exists(&self, name: &str) -> bool {
        self.path().join(name).exists()
    }

    /// The command, its arguments given as one line.
    fn slipfront(&self, line: &str) -> Command {
        let mut command = Command::new(program());
        command.current_dir(self.path()).args(line.split_whitespace());
        command
    }

    /// Runs a line that must succeed; gives what it says on stdout.
    fn done(&self, line: &str) -> String {
        let output = self.slipfront(line).assert().success().get_output().clone();
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs a line that must fail with this status; gives what it says on stderr.
    fn refused(&self, line: &str, status: i32) -> String {
        let assert = self.slipfront(line).assert().code(status);
        let output = assert.get_output();
        let said = String::from_utf8(output.stderr.clone()).unwrap();
        assert!(output.stdout.is_empty(), "{line} fails but prints results");
        assert!(!said.contains("panicked"), "{said}");
        said
    }

    fn summary(&self, folder: &str) -> serde_json::Value {
        serde_json::from_slice(&self.read(&format!("{folder}/summary.json"))).unwrap()
    }

    /// Every file below a folder with its bytes.
    fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let mut files = BTreeMap::new();
        collect(&self.path().join(folder), "", &mut files);
        files
    }

    /// The same, less the one file that may differ between repetitions.
    fn results(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let mut files = self.files(folder);
        assert!(files.remove("manifest.json").is_some(), "{folder} is incomplete");
        files
    }

    /// Compares two run folders, file by file.
    fn assert_same(&self, one: &str, other: &str) {
        let (one_files, other_files) = (self.results(one), self.results(other));
        let names: Vec<_> = one_files.keys().collect();
        assert_eq!(names, other_files.keys().collect::<Vec<_>>(), "{one}, {other}");
        for (name, bytes) in &one_files {
            assert!(
                bytes == &other_files[name],
                "{name} differs between {one} and {other}"
            );
        }
    }
}

fn collect(folder: &Path, prefix: &str, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().into_string().unwrap());
        if entry.path().is_dir() {
            collect(&entry.path(), &format!("{name}/"), files);
        } else {
            files.insert(name, std::fs::read(entry.path()).unwrap());
        }
    }
}

fn program() -> &'static str {
    env!("CARGO_BIN_EXE_slipfront")
}
