//! A temporary folder in which the command runs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::LazyLock;

use slipfront_base::machine::free_disk;
use tempfile::TempDir;

use super::process::{Running, ended_with, output, program, stderr, stdout, unset, wait_for};

/// Contents of files, by file name.
pub(crate) type Files = BTreeMap<String, Vec<u8>>;

/// Largest number of bytes read from a file: a larger file is one of the empty files of a TiB that tests
/// create.
const MAX_READ_BYTES: u64 = 1 << 30;

/// The folder of Linux for files in memory. Files there are not forced to a disk, which would take half of
/// the time of these tests.
const IN_MEMORY: &str = "/dev/shm";

/// Smallest number of bytes that must be free in memory: all tests together use less than a tenth of it.
const ROOM: f64 = 4e9;

/// Whether programs can be started from [`IN_MEMORY`], which the system may forbid: some tests do.
static STARTS_PROGRAMS: LazyLock<bool> = LazyLock::new(|| {
    let script = "printf '#!/bin/sh\n' > program && chmod 700 program && ./program";
    let starts = |folder: &TempDir| {
        let mut shell = Command::new("sh");
        let output = shell.args(["-c", script]).current_dir(folder).output();
        output.is_ok_and(|output| output.status.success())
    };
    TempDir::new_in(IN_MEMORY).is_ok_and(|folder| starts(&folder))
});

/// A temporary folder. File names are relative to it, and commands run in it.
pub(crate) struct Workspace {
    folder: TempDir,
}

impl Workspace {
    pub(crate) fn new() -> Self {
        let has_room = free_disk(Path::new(IN_MEMORY)).is_some_and(|free| free > ROOM);
        let folder = if has_room && std::env::var_os("TMPDIR").is_none() && *STARTS_PROGRAMS {
            TempDir::new_in(IN_MEMORY)
        } else {
            TempDir::new()
        };
        Self {
            folder: folder.unwrap(),
        }
    }

    /// The path of a file or folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file, and makes its parent folders.
    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        let path = self.path(name);
        std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    pub(crate) fn read_text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    pub(crate) fn exists(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    /// Waits until a file or folder exists.
    pub(crate) fn wait_for(&self, name: &str) {
        wait_for(name, || self.exists(name));
    }

    /// Removes a file, link or folder, if it exists.
    pub(crate) fn remove(&self, name: &str) {
        let path = self.path(name);
        match path.symlink_metadata() {
            Ok(metadata) if metadata.is_dir() => std::fs::remove_dir_all(path).unwrap(),
            Ok(_) => std::fs::remove_file(path).unwrap(),
            Err(_) => {}
        }
    }

    /// Makes a folder that contains exactly these files.
    pub(crate) fn fill(&self, folder: &str, files: &Files) {
        self.remove(folder);
        for (name, bytes) in files {
            self.write(&format!("{folder}/{name}"), bytes);
        }
    }

    /// Every regular file below a folder, with its contents.
    pub(crate) fn files(&self, folder: &str) -> Files {
        let mut files = Files::new();
        collect(&self.path(folder), "", &mut files);
        files
    }

    /// The command, with its arguments given in one line.
    pub(crate) fn process(&self, line: &str) -> Command {
        let mut process = unset(program());
        process
            .args(line.split_whitespace())
            .current_dir(self.folder.path());
        process
    }

    /// Runs the command.
    pub(crate) fn output(&self, line: &str) -> Output {
        output(&mut self.process(line))
    }

    /// Runs the command and asserts that it succeeds; returns its stdout.
    pub(crate) fn succeed(&self, line: &str) -> String {
        let output = ended_with(&mut self.process(line), 0);
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs the command and asserts that it fails with this status and prints no results; returns its stderr.
    pub(crate) fn fail(&self, line: &str, status: i32) -> String {
        let output = self.output(line);
        let errors = stderr(&output);
        let context = format!("{line}\n{}{errors}", stdout(&output));
        assert_eq!(output.status.code(), Some(status), "{context}");
        assert!(output.stdout.is_empty(), "it fails but prints results: {context}");
        assert!(!errors.contains("panicked"), "{context}");
        errors
    }

    /// Starts the command; its stderr can be read, and its stdout is discarded.
    pub(crate) fn start(&self, line: &str) -> Running {
        let mut process = self.process(line);
        Running::start(process.stdout(Stdio::null()).stderr(Stdio::piped()))
    }

    /// Starts `run` and waits until it prints the physics of its case: from then on, when meshing is
    /// complete, a signal stops it with a checkpoint.
    pub(crate) fn start_run(&self, line: &str) -> Running {
        let mut process = self.process(line);
        let mut child = Running::start(process.stdout(Stdio::piped()).stderr(Stdio::piped()));
        child.first_line();
        child
    }

    /// Runs a shell script.
    pub(crate) fn shell(&self, script: &str) -> Output {
        output(unset("sh").args(["-c", script]).current_dir(self.folder.path()))
    }
}

fn collect(folder: &Path, prefix: &str, files: &mut Files) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().into_string().unwrap());
        let kind = entry.file_type().unwrap();
        if kind.is_dir() {
            collect(&entry.path(), &format!("{name}/"), files);
        } else if kind.is_file() && entry.metadata().unwrap().len() > MAX_READ_BYTES {
            files.insert(name, b"very large".to_vec());
        } else if kind.is_file() {
            files.insert(name, std::fs::read(entry.path()).unwrap());
        }
    }
}
