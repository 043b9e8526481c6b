//! `manifest.json`: what was written to a run folder, by which program, when and where.
//!
//! It is the only file of a run that another run of the same case does not repeat, and the last to be written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use slipfront::surface::STREAMS;
use slipfront::{Kernel, simd_width};
use thiserror::Error;

use crate::names::{CASE, MANIFEST, RunPicture};
use crate::resume_command::resume_command;
use crate::{clock, program};
use slipfront_case::case::{Case, Input};
use slipfront_case::disk::{TEXT_MAX_BYTES, json, open_regular, read_limited};
use slipfront_case::machine::host_name;
use slipfront_case::text::{single_line, truncated};

/// The last key of a manifest in its file. The checksum, its value, is the hash of all bytes before it.
const CHECKSUM_KEY: &[u8] = b"\"seal\"";

/// What was written, and how it came about. Keys that an earlier version did not write are empty.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of slipfront.
    pub version: String,
    /// The git commit that it was built from, with `-dirty` if its sources were changed; null outside of git.
    #[serde(default)]
    pub revision: Option<String>,
    /// The identity of the build, by which programs that give the same bits are told: see [`program::this_build`].
    #[serde(default)]
    pub build: String,
    /// The kernel that made the steps.
    #[serde(default)]
    pub kernel: String,
    /// The SIMD width at which it was compiled; results do not depend on it.
    #[serde(default)]
    pub simd_width: String,
    /// Threads that it was allowed; results do not depend on them.
    pub threads: usize,
    /// Name of the machine.
    pub host: String,
    /// Operating system and processor.
    pub platform: String,
    /// When the run began, UTC.
    pub started: String,
    /// When its last file was written, UTC.
    pub finished: String,
    /// Seconds in between, whatever was done to the clock of the machine meanwhile.
    pub wall_time_s: f64,
    /// BLAKE3 hash of `case.toml`, by which equal cases are told.
    #[serde(default)]
    pub case_blake3: String,
    /// Where its random numbers come from.
    #[serde(default)]
    pub random: Random,
    /// Every other file of the run.
    pub files: Vec<ManifestFile>,
    /// BLAKE3 hash of the manifest itself up to this key, which is called `seal` in the file.
    #[serde(default, rename = "seal")]
    pub checksum: String,
}

/// Seed and streams of the random numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Random {
    /// The generator.
    pub generator: String,
    /// The seed.
    pub seed: u64,
    /// The streams by what is drawn from them.
    pub streams: BTreeMap<String, u64>,
}

/// A file and its checksum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestFile {
    /// Path in the folder.
    pub name: String,
    /// Length.
    pub bytes: u64,
    /// BLAKE3 hash, hexadecimal.
    pub blake3: String,
}

/// A manifest that cannot be used.
#[derive(Clone, Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ManifestError {
    #[error(
        "{path} holds no manifest.json: it is no run folder, or its run did not end; if it did not, `{}` goes on with it",
        resume_command("slipfront", path)
    )]
    Missing { path: PathBuf },
    #[error("cannot read {path}: {why}")]
    Unreadable { path: PathBuf, why: String },
    #[error("{path} is damaged: {why}")]
    Damaged { path: PathBuf, why: String },
}

impl Manifest {
    /// That of a run which ends now and has written these files.
    pub(crate) fn of(
        files: Vec<ManifestFile>,
        case: &Case,
        started: jiff::Timestamp,
        threads: usize,
    ) -> Self {
        let case_file = files.iter().find(|file| file.name == CASE);
        // The clock may have been set back since another process began the run.
        let finished = clock::now().max(started);
        Self {
            version: program::VERSION.to_owned(),
            revision: program::REVISION.map(str::to_owned),
            build: program::this_build().to_owned(),
            kernel: Kernel::default().for_model(&case.model).name().to_owned(),
            simd_width: simd_width().to_owned(),
            threads,
            host: host_name().to_string_lossy().into_owned(),
            platform: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            started: started.to_string(),
            finished: finished.to_string(),
            wall_time_s: finished.duration_since(started).as_secs_f64(),
            case_blake3: case_file.map_or(String::new(), |file| file.blake3.clone()),
            random: Random {
                generator: "ChaCha8".to_owned(),
                seed: case.file.friction.seed,
                streams: STREAMS.map(|(name, number)| (name.to_owned(), number)).into(),
            },
            files,
            checksum: String::new(),
        }
    }

    /// Whether the run has drawn its pictures, of which every run has that of the friction.
    pub fn has_pictures(&self) -> bool {
        let friction = RunPicture::Friction.files();
        self.files.iter().any(|file| friction.contains(&file.name))
    }

    /// The manifest with its checksum, and the bytes of its file.
    pub(crate) fn with_checksum(mut self) -> (Self, Vec<u8>) {
        self.checksum = String::new();
        self.checksum = checksum_of(&json(&self)).unwrap_or_default();
        let bytes = json(&self);
        (self, bytes)
    }

    /// Reads the manifest of a run folder, if it is as it was written.
    pub fn read(folder: &Path) -> Result<Self, ManifestError> {
        let path = folder.join(MANIFEST);
        let damaged = |why| ManifestError::Damaged {
            path: path.clone(),
            why,
        };
        let bytes = read_limited(&path, TEXT_MAX_BYTES).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => ManifestError::Missing {
                path: folder.to_owned(),
            },
            _ => ManifestError::Unreadable {
                path: path.clone(),
                why: error.to_string(),
            },
        })?;
        let manifest: Self =
            serde_json::from_slice(&bytes).map_err(|error| damaged(single_line(&error.to_string())))?;
        if checksum_of(&bytes).as_ref() == Some(&manifest.checksum) {
            return Ok(manifest);
        }
        let why = if manifest.checksum.is_empty() {
            "it has no seal, by which changes of it are seen"
        } else {
            "its seal does not fit, so that it was changed after the run"
        };
        Err(damaged(why.to_owned()))
    }

    /// The program that wrote it, in words.
    pub fn program(&self) -> String {
        truncated(&program::in_words(&self.version, self.revision.as_deref()))
    }
}

/// The checksum that the bytes of a manifest should have; none if they lack the key of it.
fn checksum_of(manifest: &[u8]) -> Option<String> {
    let mut windows = manifest.windows(CHECKSUM_KEY.len());
    let before = windows.rposition(|bytes| bytes == CHECKSUM_KEY)?;
    Some(blake3::hash(&manifest[..before]).to_hex().to_string())
}

impl ManifestFile {
    /// A regular file of a folder as it is now.
    pub fn of(folder: &Path, name: &str) -> std::io::Result<Self> {
        let mut hasher = blake3::Hasher::new();
        hasher.update_reader(open_regular(&folder.join(name))?)?;
        Ok(Self::hashed(name, &hasher))
    }

    /// The copy of a file that the case reads.
    pub(crate) fn of_input(input: &Input) -> Self {
        Self {
            name: input.name.clone(),
            bytes: input.length,
            blake3: input.hash.to_hex().to_string(),
        }
    }

    /// One of this name whose bytes have been hashed.
    pub(crate) fn hashed(name: &str, hasher: &blake3::Hasher) -> Self {
        Self {
            name: name.to_owned(),
            bytes: hasher.count(),
            blake3: hasher.finalize().to_hex().to_string(),
        }
    }
}
