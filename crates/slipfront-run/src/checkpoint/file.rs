//! The file of a checkpoint.
//!
//! The file begins with a line of JSON that holds the identity of the run and the sizes of the columns. The
//! columns follow: raw little-endian numbers in the order of the whole lattice. The position of each number
//! follows from the first line, so that every rank can write and read the numbers of its own rows. The state
//! in postcard's binary format and the checksum of everything before it come last.

use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

use blake3::OUT_LEN;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use slipfront::Communicator;
use slipfront_base::disk::{open_regular, remove_if_there};
use slipfront_base::text::truncated;
use slipfront_case::same_on_ranks::expect_same;

use super::error::{CheckpointError, LAYOUT};
use crate::agree::agree_on_io;
use crate::checksum::hash_of_pieces;
use crate::columns::Columns;
use crate::program;
use crate::running::{RunState, Running};

/// Longest first line.
const HEADER_MAX_BYTES: u64 = 4096;

/// The first line.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Header {
    slipfront_checkpoint: u32,
    program: String,
    case_blake3: String,
    pub(super) step: u64,
    pub(super) started: Timestamp,
    pub(super) columns: [Columns; 2],
}

/// The part of a first line that every version has written.
#[derive(Deserialize)]
struct FormatVersion {
    slipfront_checkpoint: u32,
}

/// A file with a correct checksum.
#[derive(Debug)]
pub(super) struct VerifiedFile {
    pub(super) header: Header,
    pub(super) state: RunState,
    pub(super) file: File,
    /// Bytes before the columns.
    pub(super) begin: u64,
}

impl Header {
    /// The first line for a run that began at `started`, of the case with this hash.
    pub(super) fn new(case_blake3: &str, started: Timestamp, running: &Running) -> Self {
        Self {
            slipfront_checkpoint: LAYOUT,
            program: program::this_build().to_owned(),
            case_blake3: case_blake3.to_owned(),
            step: running.snapshot().step,
            started,
            columns: running.columns(),
        }
    }

    /// Number of bytes up to the end of the columns, which begin at byte `begin`; none on overflow.
    fn columns_end(&self, begin: u64) -> Option<u64> {
        let [blocks, fields] = self.columns.map(|columns| columns.bytes());
        begin.checked_add(blocks?)?.checked_add(fields?)
    }
}

/// Writes a checkpoint to a new file, with each rank writing its own rows, and syncs the file to disk.
///
/// On a file system shared by several machines, a machine is sure to see the data of another one only after
/// the other has closed the file. Therefore every rank writes all its data and closes the file before any
/// rank reads it. No rank reads while it writes: it would then write back whole pages of memory, with
/// outdated numbers of other ranks.
pub(super) fn write(
    path: &Path,
    header: &Header,
    running: &Running,
    communicator: &dyn Communicator,
) -> std::io::Result<()> {
    let is_first = communicator.rank() == 0;
    let mut line = serde_json::to_vec(header)?;
    line.push(b'\n');
    // All ranks use the length of the first rank's line, in which the time may have more digits than on other
    // ranks.
    let begin = of_first(communicator, line.len() as u64);
    let end = header.columns_end(begin).ok_or(ErrorKind::FileTooLarge)?;
    // All ranks compute the state together, and the first one writes it.
    let state = running.state();
    let begun = is_first.then(|| write_line_and_state(path, &line, end, &state));
    let begun = agree_on_io(communicator, begun.transpose())?;
    let length = of_first(communicator, begun.as_ref().map_or(0, |(_, length)| *length));
    let opened = match begun {
        Some((file, _)) => Ok(file),
        None => File::options().write(true).open(path),
    };
    let written = opened.and_then(|file| write_columns(file, begin, running));
    agree_on_io(communicator, written)?;
    let opened = File::options().read(true).write(is_first).open(path);
    let mut file = agree_on_io(communicator, opened)?;
    let checksum = hash_of_pieces(&mut file, length, communicator)?;
    let mut finish = || {
        if is_first {
            file.seek(SeekFrom::Start(length))?;
            file.write_all(checksum.as_bytes())?;
            file.sync_all()?;
        }
        Ok(())
    };
    agree_on_io(communicator, finish())
}

/// The number of the first rank, returned on all ranks.
fn of_first(communicator: &dyn Communicator, number: u64) -> u64 {
    let is_first = communicator.rank() == 0;
    let mut of_first = [if is_first { number.cast_signed() } else { 0 }];
    communicator.sum(&mut of_first);
    of_first[0].cast_unsigned()
}

/// Creates the file with everything except the columns and the checksum; the state starts at byte `end`.
/// Returns the file and its length.
fn write_line_and_state(
    path: &Path,
    line: &[u8],
    end: u64,
    state: &impl Serialize,
) -> std::io::Result<(File, u64)> {
    // Removes a file that a killed program left, even if it is a link.
    remove_if_there(path)?;
    let file = File::options().write(true).create_new(true).open(path)?;
    let mut writer = BufWriter::with_capacity(1 << 20, file);
    writer.write_all(line)?;
    writer.seek(SeekFrom::Start(end))?;
    // Postcard discards the system error of a failed write; `flush` returns it again.
    let written = postcard::to_io(state, &mut writer).map(|_| ());
    writer.flush()?;
    written.map_err(Error::other)?;
    let length = writer.stream_position()?;
    Ok((writer.into_inner()?, length))
}

/// Writes the columns of the rows that this rank holds, syncs them to disk and closes the file.
fn write_columns(mut file: File, begin: u64, running: &Running) -> std::io::Result<()> {
    running.write_columns(|offset, bytes| {
        file.seek(SeekFrom::Start(begin + offset))?;
        file.write_all(bytes)
    })?;
    file.sync_all()
}

/// Reads everything but the columns from a checkpoint of the case with this hash, and compares all bytes with
/// the checksum.
pub(super) fn read(
    path: &Path,
    case_blake3: &str,
    communicator: &dyn Communicator,
) -> Result<VerifiedFile, CheckpointError> {
    let owned = || path.to_owned();
    let unreadable = |source| CheckpointError::Unreadable {
        path: owned(),
        source,
    };
    let damaged = |why| CheckpointError::Damaged { path: owned(), why };
    let opened = agree_on_io(communicator, open(path)).map_err(unreadable)?;
    let (mut file, line, length, checksum) = opened;
    // On a shared file system, a machine may see a replaced file for a while.
    expect_same(communicator, || {
        let header = serde_json::from_str::<Header>(&line);
        let step = header.map_or("unknown".to_owned(), |header| header.step.to_string());
        let given = [
            ("step", step),
            ("first line", line.clone()),
            ("length", format!("{length} bytes")),
            ("checksum", blake3::hash(&checksum).to_hex().to_string()),
        ];
        let named = given.map(|(what, value)| (format!("the {what} of the checkpoint"), value));
        named.into()
    })?;
    let unknown = || damaged("its first line is not the first line of a checkpoint");
    let FormatVersion { slipfront_checkpoint } = serde_json::from_str(&line).map_err(|_| unknown())?;
    if slipfront_checkpoint != LAYOUT {
        let (path, found) = (owned(), slipfront_checkpoint);
        return Err(CheckpointError::Layout { path, found });
    }
    let header: Header = serde_json::from_str(&line).map_err(|_| unknown())?;
    // No bytes are interpreted before the checksum confirms them.
    let contents = length.saturating_sub(OUT_LEN as u64);
    let hash = hash_of_pieces(&mut file, contents, communicator).map_err(unreadable)?;
    if checksum != hash.as_bytes() {
        return Err(damaged("its checksum is wrong"));
    }
    let here = program::this_build();
    if header.program != here {
        let (path, found) = (owned(), truncated(&header.program));
        return Err(CheckpointError::Program { path, found, here });
    }
    if header.case_blake3 != case_blake3 {
        return Err(CheckpointError::Case { path: owned() });
    }
    let begin = line.len() as u64;
    let end = header.columns_end(begin).filter(|&end| end <= contents);
    let end = end.ok_or_else(|| damaged("it does not have the columns given in its first line"))?;
    let state = agree_on_io(communicator, read_state(&file, end, contents));
    let state = state.map_err(|error| match error.kind() {
        ErrorKind::InvalidData => damaged("it does not contain the state of a run"),
        _ => unreadable(error),
    })?;
    Ok(VerifiedFile {
        state,
        header,
        file,
        begin,
    })
}

/// Opens a file for reading, with its first line, which is empty if it is not text, its length, and its last
/// bytes, the checksum.
fn open(path: &Path) -> std::io::Result<(File, String, u64, Vec<u8>)> {
    let mut file = open_regular(path)?;
    let length = file.metadata()?.len();
    let mut line = Vec::new();
    BufReader::new((&file).take(HEADER_MAX_BYTES)).read_until(b'\n', &mut line)?;
    let mut checksum = Vec::new();
    file.seek(SeekFrom::Start(length.saturating_sub(OUT_LEN as u64)))?;
    (&file).take(OUT_LEN as u64).read_to_end(&mut checksum)?;
    Ok((
        file,
        String::from_utf8(line).unwrap_or_default(),
        length,
        checksum,
    ))
}

/// Reads the state, which occupies all bytes from `begin` to `end`; an error of [`ErrorKind::InvalidData`] if
/// they are not a state.
fn read_state(mut file: &File, begin: u64, end: u64) -> std::io::Result<RunState> {
    file.seek(SeekFrom::Start(begin))?;
    let file = ErrorKeepingReader { file, error: None };
    let mut body = BufReader::with_capacity(1 << 16, file).take(end - begin);
    // Scratch space for one number.
    let mut number = [0; 16];
    let state = postcard::from_io((&mut body, &mut number)).map(|(state, _)| state);
    let state = state.ok().filter(|_| body.limit() == 0);
    let error = body.into_inner().into_inner().error;
    state.ok_or_else(|| error.unwrap_or_else(|| ErrorKind::InvalidData.into()))
}

/// A reader that keeps the error of the last read, because postcard discards it.
struct ErrorKeepingReader<'a> {
    file: &'a File,
    error: Option<std::io::Error>,
}

impl Read for ErrorKeepingReader<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.file.read(bytes).map_err(|error| {
            let kind = error.kind().into();
            self.error = Some(error);
            kind
        })
    }
}
