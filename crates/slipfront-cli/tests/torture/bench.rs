//! A folder to work in, the command with bounds on its time and memory, and folders held against each other.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

use assert_cmd::Command;
use tempfile::TempDir;

/// The longest that a command may take: all of these end within a second on an idle machine.
const SECONDS: u64 = 120;
/// The most address space that a command may take, in KiB: 1 GiB, of which its threads reserve the greater part without
/// using it.
const MEMORY_KIB: u64 = 1 << 20;

/// The folder. What a command reads and writes stands in `work/`.
pub(crate) struct Bench {
    folder: TempDir,
}

/// How a command ended.
#[derive(Debug)]
pub(crate) struct Ended {
    pub(crate) status: i32,
    pub(crate) printed: String,
    pub(crate) said: String,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let folder = TempDir::new().unwrap();
        std::fs::create_dir_all(folder.path().join("work/temporary")).unwrap();
        Self { folder }
    }

    /// Of `work/`.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("work").join(name)
    }

    /// A file beside `work/`.
    pub(crate) fn beside(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    /// Removes a file or folder, if it is there.
    pub(crate) fn remove(&self, name: &str) {
        let path = self.path(name);
        match path.symlink_metadata() {
            Ok(metadata) if metadata.is_dir() => std::fs::remove_dir_all(path).unwrap(),
            Ok(_) => std::fs::remove_file(path).unwrap(),
            Err(_) => {}
        }
    }

    /// Makes a folder that holds these files.
    pub(crate) fn fill(&self, folder: &str, files: &Files) {
        self.remove(folder);
        for (name, bytes) in files {
            self.write(&format!("{folder}/{name}"), bytes);
        }
    }

    /// Every file below a folder with its bytes; nothing if there is no folder.
    pub(crate) fn files(&self, folder: &str) -> Files {
        let mut files = Files::new();
        collect(&self.path(folder), "", &mut files);
        files
    }

    /// What runs a line of slipfront under `watcher`, with bounds on memory and time.
    fn bounded<'a>(&self, watcher: impl IntoIterator<Item = &'a str>, line: &str) -> Command {
        let mut command = Command::new("sh");
        command
            .args(["-c", &format!("ulimit -v {MEMORY_KIB} && exec \"$@\""), "sh"])
            .args(watcher)
            .arg(program())
            .args(line.split_whitespace())
            .current_dir(self.path(""))
            .env("TMPDIR", self.path("temporary"))
            .env_remove("SLURM_ARRAY_TASK_ID")
            .env("RUST_BACKTRACE", "0")
            .timeout(Duration::from_secs(SECONDS));
        command
    }

    /// Runs a line. A hang, a crash, a panic, too much memory, a strange status and a failure without a sentence are
    /// findings.
    pub(crate) fn run(&self, line: &str) -> Result<Ended, String> {
        judged(line, &self.bounded([], line).output().unwrap())
    }

    /// The same under a watcher, which may let it be killed: then there is no end.
    pub(crate) fn run_under(&self, watcher: &[&str], line: &str) -> Result<Option<Ended>, String> {
        let output = self.bounded(watcher.iter().copied(), line).output().unwrap();
        match output.status.code() {
            None if output.stderr.is_empty() => Ok(None),
            _ => judged(line, &output).map(Some),
        }
    }

    /// Runs a line that must succeed.
    pub(crate) fn done(&self, line: &str) -> Result<Ended, String> {
        let ended = self.run(line)?;
        match ended.status {
            0 => Ok(ended),
            status => Err(format!("`{line}` ends with status {status}: {}", ended.said)),
        }
    }

    /// Starts a line that will be killed.
    pub(crate) fn start(&self, line: &str) -> std::process::Child {
        std::process::Command::new(program())
            .args(line.split_whitespace())
            .current_dir(self.path(""))
            .env("TMPDIR", self.path("temporary"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap()
    }
}

fn judged(line: &str, output: &std::process::Output) -> Result<Ended, String> {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (printed, said) = (text(&output.stdout), text(&output.stderr));
    let Some(status) = output.status.code() else {
        return Err(format!("`{line}` ends by {}: {said}", output.status));
    };
    let sound = match status {
        0 => true,
        1 | 2 => said.lines().any(|line| line.starts_with("error: ")),
        _ => false,
    };
    let alarming = [
        "panicked",
        "RUST_BACKTRACE",
        "memory allocation of",
        "fault of the program",
    ];
    if !sound
        || alarming
            .iter()
            .any(|word| said.contains(word) || printed.contains(word))
    {
        return Err(format!("`{line}` ends with status {status}: {printed}{said}"));
    }
    Ok(Ended {
        status,
        printed,
        said,
    })
}

pub(crate) fn program() -> &'static str {
    env!("CARGO_BIN_EXE_slipfront")
}

/// No file of a job is larger.
const LARGE_BYTES: u64 = 1 << 30;

pub(crate) type Files = BTreeMap<String, Vec<u8>>;

fn collect(folder: &Path, prefix: &str, files: &mut Files) {
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().into_string().unwrap());
        let kind = entry.file_type().unwrap();
        if kind.is_dir() {
            collect(&entry.path(), &format!("{name}/"), files);
        } else if entry.metadata().unwrap().len() > LARGE_BYTES {
            files.insert(name, b"very large".to_vec());
        } else if kind.is_file() {
            files.insert(name, std::fs::read(entry.path()).unwrap());
        }
    }
}
