//! The file `manifest.json`: the files of a run folder, and the program, time and machine that wrote them.
//!
//! The manifest is the only file of a run that another run of the same case does not reproduce, and it is the
//! last to be written.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};
use slipfront::surface::STREAMS;
use slipfront::{Kernel, simd_width};
use thiserror::Error;

use crate::names::{CASE, MANIFEST, RunPicture};
use crate::resume_command::resume_command;
use crate::{clock, program};
use slipfront_base::disk::{TEXT_MAX_BYTES, found_at, json, open_regular, read_limited};
use slipfront_base::machine::host_name;
use slipfront_base::ordered::map_of;
use slipfront_base::text::{single_line, truncated};
use slipfront_case::case::{Case, Input};

/// The last key of a manifest in its file. The checksum, its value, is the hash of all bytes before it.
const CHECKSUM_KEY: &[u8] = b"\"seal\"";

/// The files that were written, and their origin. Keys that are missing in the file are empty.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of slipfront.
    pub version: String,
    /// The git commit from which the program was built, with `-dirty` if its sources were changed; null
    /// outside of git.
    #[serde(default)]
    pub revision: Option<String>,
    /// The identity of the build, which is equal for programs that give the same bits: see
    /// [`program::this_build`].
    #[serde(default)]
    pub build: String,
    /// The kernel that made the steps.
    #[serde(default)]
    pub kernel: String,
    /// The SIMD width of the kernel; results do not depend on it.
    #[serde(default)]
    pub simd_width: String,
    /// Number of threads that the run was allowed; results do not depend on it.
    pub threads: usize,
    /// Name of the device that computed the steps, if it was not the processor; results do not depend on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// Name of the machine.
    pub host: String,
    /// Operating system and processor.
    pub platform: String,
    /// Time at which the run began, UTC.
    pub started: String,
    /// Time at which the last file was written, UTC.
    pub finished: String,
    /// Seconds from the beginning to the end, by a monotonic clock.
    pub wall_time_s: f64,
    /// BLAKE3 hash of `case.toml`; equal cases have equal hashes.
    #[serde(default)]
    pub case_blake3: String,
    /// Origin of the run's random numbers.
    #[serde(default)]
    pub random: Random,
    /// Reason why the run has no pictures, if the program that ran it cannot draw.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub without_pictures: Option<String>,
    /// Every other file of the run.
    pub files: Vec<ManifestFile>,
    /// BLAKE3 hash of the manifest itself up to this key, which is named `seal` in the file.
    #[serde(default, rename = "seal")]
    pub checksum: String,
}

/// Seed and streams of the random numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Random {
    /// Name of the generator.
    pub generator: String,
    /// Seed of the run.
    pub seed: u64,
    /// The streams by the quantity that is drawn from them.
    pub streams: BTreeMap<String, u64>,
}

/// A file and its checksum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestFile {
    /// Path of the file in the folder.
    pub name: String,
    /// Length of the file in bytes.
    pub bytes: u64,
    /// BLAKE3 hash of the file, hexadecimal.
    pub blake3: String,
}

/// The command that resumes an unfinished run, if the folder holds its case.
fn way_to_go_on(folder: &Path) -> String {
    if folder.join(CASE).exists() {
        let command = resume_command("slipfront", folder);
        format!("; if it did not, `{command}` resumes it")
    } else {
        String::new()
    }
}

/// Times of a run, as written in a manifest.
#[derive(Clone, Debug)]
pub struct RunTimes {
    /// Time at which the run began, UTC, as in RFC 3339.
    pub started: String,
    /// Time at which the run ended, UTC, as in RFC 3339.
    pub finished: String,
    /// Seconds from the beginning to the end, by a monotonic clock.
    pub wall_time_s: f64,
}

/// Reason why a manifest cannot be used.
#[derive(Clone, Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ManifestError {
    #[error(
        "{path} has no manifest.json: it is not a run folder, or its run did not finish{}",
        way_to_go_on(path)
    )]
    Missing { path: PathBuf },
    #[error("cannot read {path}: {why}")]
    Unreadable { path: PathBuf, why: String },
    #[error("{path} is damaged: {why}")]
    Damaged { path: PathBuf, why: String },
}

/// Threads or device that computed a run; results do not depend on them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Processors {
    /// Number of threads that the run was allowed.
    pub threads: usize,
    /// Name of the device that computed the steps, if it was not the processor.
    pub device: Option<String>,
}

impl Processors {
    /// Threads of the processor.
    pub fn threads(threads: usize) -> Self {
        Self {
            threads,
            device: None,
        }
    }
}

impl Manifest {
    /// Manifest of a run that has just finished and has written these files.
    pub(crate) fn new(
        files: Vec<ManifestFile>,
        case: &Case,
        started: jiff::Timestamp,
        processors: Processors,
    ) -> Self {
        // The clock may have been set back since another process began the run.
        let finished = clock::now().max(started);
        let times = RunTimes {
            started: started.to_string(),
            finished: finished.to_string(),
            wall_time_s: finished.duration_since(started).as_secs_f64(),
        };
        Self::at(files, case, times, processors)
    }

    /// The bytes of the manifest of a run on one thread with its files in memory, including the reason why it
    /// has no pictures, if it has none.
    pub fn of_run_in_memory(
        files: &[(String, Vec<u8>)],
        case: &Case,
        times: RunTimes,
        without_pictures: Option<String>,
    ) -> Vec<u8> {
        let files = files
            .iter()
            .map(|(name, contents)| ManifestFile::of_bytes(name, contents));
        let manifest = Self {
            without_pictures,
            ..Self::at(files.collect(), case, times, Processors::threads(1))
        };
        manifest.with_checksum().1
    }

    /// Manifest of a run that began and ended at these times.
    fn at(files: Vec<ManifestFile>, case: &Case, times: RunTimes, processors: Processors) -> Self {
        let case_file = files.iter().find(|file| file.name == CASE);
        Self {
            version: program::VERSION.to_owned(),
            revision: program::REVISION.map(str::to_owned),
            build: program::this_build().to_owned(),
            kernel: Kernel::default().for_model(&case.model).name().to_owned(),
            simd_width: simd_width().to_owned(),
            threads: processors.threads,
            device: processors.device,
            host: host_name().to_string_lossy().into_owned(),
            platform: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            started: times.started,
            finished: times.finished,
            wall_time_s: times.wall_time_s,
            case_blake3: case_file.map_or(String::new(), |file| file.blake3.clone()),
            random: Random {
                generator: "ChaCha8".to_owned(),
                seed: case.file.friction.seed,
                streams: map_of(STREAMS.map(|(name, number)| (name.to_owned(), number))),
            },
            without_pictures: None,
            files,
            checksum: String::new(),
        }
    }

    /// Whether the run has drawn its pictures; every run with pictures has the one of friction.
    pub fn has_pictures(&self) -> bool {
        let friction = RunPicture::Friction.files();
        self.files.iter().any(|file| friction.contains(&file.name))
    }

    /// The manifest with its checksum, and the bytes of its file.
    pub(crate) fn with_checksum(mut self) -> (Self, Vec<u8>) {
        self.checksum = String::new();
        self.checksum = seal(&json(&self)).unwrap_or_default();
        let bytes = json(&self);
        (self, bytes)
    }

    /// Reads the manifest of a run folder, if it is unchanged.
    pub fn read(folder: &Path) -> Result<Self, ManifestError> {
        let path = folder.join(MANIFEST);
        let bytes = read_limited(&path, TEXT_MAX_BYTES).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => ManifestError::Missing {
                path: folder.to_owned(),
            },
            _ => ManifestError::Unreadable {
                path: path.clone(),
                why: error.to_string(),
            },
        })?;
        Self::of_bytes(&path, &bytes)
    }

    /// Reads a manifest from its bytes, if it is unchanged; errors name it by the path.
    pub fn of_bytes(path: &Path, bytes: &[u8]) -> Result<Self, ManifestError> {
        let damaged = |why| ManifestError::Damaged {
            path: path.to_owned(),
            why,
        };
        let manifest: Self =
            serde_json::from_slice(bytes).map_err(|error| damaged(single_line(&error.to_string())))?;
        if is_sealed(bytes) {
            return Ok(manifest);
        }
        let why = if manifest.checksum.is_empty() {
            "it has no seal, so changes cannot be detected"
        } else {
            "its seal is wrong: it was changed after the run"
        };
        Err(damaged(why.to_owned()))
    }

    /// The program that wrote the manifest, in words.
    pub fn program(&self) -> String {
        truncated(&program::in_words(&self.version, self.revision.as_deref()))
    }
}

/// The checksum that a list of files should have under its last key, `seal`, from the bytes before this key;
/// none if the bytes lack the key.
pub fn seal(manifest: &[u8]) -> Option<String> {
    let mut windows = manifest.windows(CHECKSUM_KEY.len());
    let before = windows.rposition(|bytes| bytes == CHECKSUM_KEY)?;
    Some(blake3::hash(&manifest[..before]).to_hex().to_string())
}

/// Whether a list of files is, to the byte, as it was written: its seal is right, and nothing follows but the
/// end of the list.
pub fn is_sealed(list: &[u8]) -> bool {
    let Some(seal) = seal(list) else { return false };
    list.ends_with(format!("\"seal\": \"{seal}\"\n}}\n").as_bytes())
}

/// A reader of a file that fails as soon as `stop` is set.
pub(crate) struct Until<'s, R> {
    pub(crate) file: R,
    pub(crate) stop: &'s AtomicBool,
}

impl<R: Read> Read for Until<'_, R> {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(std::io::Error::other("stopped"));
        }
        self.file.read(bytes)
    }
}

/// Whether the entry of this name in a folder is a file that equals one of those listed; none if there is no
/// such entry. A file of another length is not read: it may be huge.
///
/// # Errors
/// When the system cannot inspect or read the entry.
pub fn is_one_of<'a>(
    folder: &Path,
    name: &str,
    listed: impl IntoIterator<Item = &'a ManifestFile>,
) -> std::io::Result<Option<bool>> {
    let Some(found) = found_at(&folder.join(name))? else {
        return Ok(None);
    };
    let is_alike = |file: &&ManifestFile| file.name == name && file.bytes == found.len();
    let alike: Vec<&ManifestFile> = listed.into_iter().filter(is_alike).collect();
    if !found.is_file() || alike.is_empty() {
        return Ok(Some(false));
    }
    let found = ManifestFile::read(folder, name)?;
    Ok(Some(alike.contains(&&found)))
}

impl ManifestFile {
    /// A regular file of a folder as it is now.
    pub fn read(folder: &Path, name: &str) -> std::io::Result<Self> {
        Self::read_until(folder, name, &AtomicBool::new(false))
    }

    /// A regular file of a folder as it is now; an error as soon as `stop` is set.
    pub fn read_until(folder: &Path, name: &str, stop: &AtomicBool) -> std::io::Result<Self> {
        Self::read_beginning(folder, name, u64::MAX, stop)
    }

    /// The first bytes, at most `most`, of a regular file as it is now; an error as soon as `stop` is set.
    pub fn read_beginning(folder: &Path, name: &str, most: u64, stop: &AtomicBool) -> std::io::Result<Self> {
        let mut hasher = blake3::Hasher::new();
        let file = open_regular(&folder.join(name))?;
        hasher.update_reader(Until { file, stop }.take(most))?;
        Ok(Self::hashed(name, &hasher))
    }

    /// The entry with this name for a file that still has another name.
    pub fn read_copy(name: &str, copy: &Path) -> std::io::Result<Self> {
        let mut hasher = blake3::Hasher::new();
        hasher.update_reader(File::open(copy)?)?;
        Ok(Self::hashed(name, &hasher))
    }

    /// A file of this name with these contents.
    pub fn of_bytes(name: &str, contents: &[u8]) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(contents);
        Self::hashed(name, &hasher)
    }

    /// The copy of a file that the case reads.
    pub(crate) fn of_input(input: &Input) -> Self {
        Self {
            name: input.name.clone(),
            bytes: input.length,
            blake3: input.hash.to_hex().to_string(),
        }
    }

    /// An entry for a file of this name, from the hash of its bytes.
    pub fn hashed(name: &str, hasher: &blake3::Hasher) -> Self {
        Self {
            name: name.to_owned(),
            bytes: hasher.count(),
            blake3: hasher.finalize().to_hex().to_string(),
        }
    }
}
