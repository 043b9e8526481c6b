//! Checkpoints of a run in its folder: what it needs to go on after it was stopped, with the same bytes in every file.
//!
//! A file is a line of JSON that tells whose checkpoint it is, the state in postcard's binary form, and the BLAKE3 hash of
//! both. It takes its name when it is whole; the one before it is kept beside it.

use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::checksum::{HashingWriter, verify_reader};
use crate::names::{CHECKPOINT, PREVIOUS};
use crate::program;
use crate::run_folder::unfinished::Unfinished;
use crate::running::{RunState, Running};
use slipfront_case::case::Case;
use slipfront_case::disk::{open_regular, sync_folder, write_temp};
use slipfront_case::text::truncated;

/// How the file is laid out. A program reads no other layout.
const LAYOUT: u32 = 1;

/// Longest first line.
const HEADER_MAX_BYTES: u64 = 4096;

/// The first line.
#[derive(Debug, Serialize, Deserialize)]
struct Header {
    slipfront_checkpoint: u32,
    program: String,
    case_blake3: String,
    step: u64,
    started: Timestamp,
}

/// Of a first line whatever version wrote it.
#[derive(Deserialize)]
struct Layout {
    slipfront_checkpoint: u32,
}

/// A checkpoint as it was read.
#[derive(Debug)]
pub struct LoadedCheckpoint {
    /// The state of the run.
    pub state: RunState,
    /// Its step.
    pub step: u64,
    /// When the run began.
    pub started: Timestamp,
    /// Whether it is the latest, and not the one before.
    latest: bool,
}

/// Why a run cannot go on from a checkpoint.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum CheckpointError {
    #[error("cannot read {path}: {source}")]
    Unreadable { path: PathBuf, source: std::io::Error },
    #[error("{path} is damaged: {why}")]
    Damaged { path: PathBuf, why: &'static str },
    #[error(
        "{path} has layout {found}, and this version reads layout {LAYOUT}: resume with the version that wrote it"
    )]
    Layout { path: PathBuf, found: u32 },
    #[error(
        "{path} was written by {found}, and this is {here}, which may not give the same bits: resume with that version"
    )]
    Program {
        path: PathBuf,
        found: String,
        here: &'static str,
    },
    #[error("{path} belongs to another case than the case.toml and inputs beside it")]
    Case { path: PathBuf },
}

/// Saves the checkpoints of one run.
#[derive(Debug)]
pub struct Checkpoints {
    folder: Unfinished,
    case_blake3: String,
    started: Timestamp,
    /// Whether the latest checkpoint there is known to be whole.
    latest_is_whole: bool,
    /// Step of the latest one that was saved or gone on from.
    saved_step: Option<u64>,
}

impl Checkpoints {
    /// Those of a run of `case` in `folder` that begins at `started`.
    pub fn new(folder: &Path, case: &Case, started: Timestamp) -> Self {
        Self {
            folder: Unfinished::of(folder),
            case_blake3: hash_of(case),
            started,
            latest_is_whole: false,
            saved_step: None,
        }
    }

    /// Those of a run that goes on from a checkpoint.
    pub fn after(folder: &Path, case: &Case, saved: &LoadedCheckpoint) -> Self {
        Self {
            latest_is_whole: saved.latest,
            saved_step: Some(saved.step),
            ..Self::new(folder, case, saved.started)
        }
    }

    /// The step from which the run would go on, if any was saved.
    pub fn saved_step(&self) -> Option<u64> {
        self.saved_step
    }

    /// When the run began.
    pub fn started(&self) -> Timestamp {
        self.started
    }

    /// Saves the state of the run. The checkpoint that was the latest is kept as the one before, unless it is damaged;
    /// whatever happens, one of the two is whole.
    pub fn save(&mut self, running: &Running) -> std::io::Result<()> {
        let header = Header {
            slipfront_checkpoint: LAYOUT,
            program: program::this_build().to_owned(),
            case_blake3: self.case_blake3.clone(),
            step: running.snapshot().step,
            started: self.started,
        };
        let whole = write_temp(&self.folder.temporary(), |file| write(file, &header, running))?;
        let [latest, previous] = [CHECKPOINT, PREVIOUS].map(|name| self.folder.path().join(name));
        if std::mem::take(&mut self.latest_is_whole) {
            match std::fs::rename(&latest, &previous) {
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        whole.persist(&latest)?;
        self.latest_is_whole = true;
        self.saved_step = Some(header.step);
        sync_folder(self.folder.path())
    }

    /// Reads the latest checkpoint of a run folder, or the one before it; none if there is none. Where a kill has left
    /// only the one before, that is the latest.
    pub fn load(
        folder: &Path,
        case: &Case,
        previous: bool,
    ) -> Result<Option<LoadedCheckpoint>, CheckpointError> {
        for name in [CHECKPOINT, PREVIOUS].into_iter().skip(usize::from(previous)) {
            let path = Unfinished::of(folder).path().join(name);
            // A link with nothing at its end must be refused, and not taken for no checkpoint.
            if path.symlink_metadata().is_ok() {
                let mut saved = read(&path, case)?;
                saved.latest = name == CHECKPOINT;
                return Ok(Some(saved));
            }
        }
        Ok(None)
    }
}

/// Hash of a case and of the files that it reads, by which equal cases are told.
fn hash_of(case: &Case) -> String {
    let mut hasher = blake3::Hasher::new();
    // A case that was loaded can be written.
    hasher.update(case.file.to_toml().unwrap_or_default().as_bytes());
    for input in &case.inputs {
        hasher.update(input.hash.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

fn write(file: &mut File, header: &Header, running: &Running) -> std::io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 20, HashingWriter::new(file));
    serde_json::to_writer(&mut writer, header)?;
    writer.write_all(b"\n")?;
    // Postcard drops the system's error of a failed write; `flush` gives it again.
    let written = postcard::to_io(&running.state(), &mut writer).map(|_| ());
    writer.flush()?;
    written.map_err(std::io::Error::other)?;
    let writer = writer.into_inner().map_err(std::io::IntoInnerError::into_error)?;
    writer.finish()
}

fn read(path: &Path, case: &Case) -> Result<LoadedCheckpoint, CheckpointError> {
    let owned = || path.to_owned();
    let unreadable = |source| CheckpointError::Unreadable {
        path: owned(),
        source,
    };
    let damaged = |why| CheckpointError::Damaged { path: owned(), why };
    let file = open_regular(path).map_err(unreadable)?;
    let mut reader = BufReader::with_capacity(1 << 20, file);
    let mut line = Vec::new();
    let mut start = reader.by_ref().take(HEADER_MAX_BYTES);
    start.read_until(b'\n', &mut line).map_err(unreadable)?;
    let unknown = || damaged("its first line is not that of a checkpoint");
    let Layout { slipfront_checkpoint } = serde_json::from_slice(&line).map_err(|_| unknown())?;
    if slipfront_checkpoint != LAYOUT {
        let (path, found) = (owned(), slipfront_checkpoint);
        return Err(CheckpointError::Layout { path, found });
    }
    let header: Header = serde_json::from_slice(&line).map_err(|_| unknown())?;
    // Nothing is made of bytes before they are known to be those that were written.
    reader.rewind().map_err(unreadable)?;
    let length = reader.get_ref().metadata().map_err(unreadable)?.len();
    let end = verify_reader(&mut reader, length).map_err(unreadable)?;
    let end = end.ok_or_else(|| damaged("its checksum does not fit"))?;
    let here = program::this_build();
    if header.program != here {
        let (path, found) = (owned(), truncated(&header.program));
        return Err(CheckpointError::Program { path, found, here });
    }
    if header.case_blake3 != hash_of(case) {
        return Err(CheckpointError::Case { path: owned() });
    }
    let begin = line.len() as u64;
    reader.seek(SeekFrom::Start(begin)).map_err(unreadable)?;
    let mut body = reader.take(end - begin);
    // Room for one number at a time.
    let mut number = [0; 16];
    let state = postcard::from_io((&mut body, &mut number)).map(|(state, _)| state);
    let state = state.ok().filter(|_| body.limit() == 0);
    Ok(LoadedCheckpoint {
        state: state.ok_or_else(|| damaged("it holds no state of a run"))?,
        step: header.step,
        started: header.started,
        latest: false,
    })
}
