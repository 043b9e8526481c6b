//! Checkpoints of runs: a header, columns, the state and a checksum over all.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use jiff::Timestamp;
use serde_json::Value;
use slipfront::communicator::Alone;
use slipfront::{Execution, StopReason};
use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::CaseFile;
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::checksum::hash_of_pieces;
use slipfront_run::names::CHECKPOINT;
use slipfront_run::run_folder::unfinished::Unfinished;
use slipfront_run::running::Running;

use super::json::long_objects;
use crate::checks::readable;
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// The first byte chooses one of [`CASES`]. The rest is read as it is, then with the right checksum, then
/// with the right header as well, but for its columns; a run is resumed if the file can be read.
pub(crate) const CHECKPOINTS: Target = Target {
    name: "checkpoint",
    check: checkpoint,
    generated,
    files: &[],
    dictionary: Some("json.dict"),
    max_bytes: 16384,
    // Postcard reserves at most 1 MiB at once, however long a list claims to be; the lattices are small.
    memory: Memory {
        bytes: 16 << 20,
        per_byte: 256,
    },
    time: Time::READING,
    mutations: 300,
    repetitions: 20,
    long: || long_objects("\0", "\n"),
};

/// Both kernels, and both ways to keep fields.
const TEXTS: [&str; 3] = [
    "[slider]\nblocks = [4, 3]\n[time]\nduration_star = 20\n[drive]\nv_star = 0.2\n",
    "[slider]\nblocks = [3, 2]\n[time]\nduration_star = 20\n[output]\nsnapshots = [1.0, 5.0, 15.0]\nstride = 2\n",
    "[slider]\nblocks = [3, 3]\nedges = \"periodic\"\n[time]\nduration_star = 20\nstop = \"after_onset\"\n[friction]\n\
     law = \"literal\"\n[output]\nsnapshots = { every = 2.0 }\nfields = [\"sliding\"]\n",
];

static CASES: LazyLock<[Arc<Case>; 3]> = LazyLock::new(|| {
    // `Case::parse` would reserve the memory of a run, to see whether it is available.
    let made = |file| Arc::new(Case::new(file, "case", Path::new(""), &mut |_| true, Ranks::ALONE).unwrap());
    TEXTS.map(|text| made(CaseFile::parse(text, "case.toml", &[]).unwrap()))
});

/// Steps of a resumed run.
const STEPS: u64 = 20;

fn generated() -> Vec<Vec<u8>> {
    let saved = |number: usize, steps: u64| {
        let mut running = Running::start(&CASES[number], None, Execution::default());
        running.advance(steps).unwrap();
        [vec![number as u8], save(&scratch::folder("made"), &running)].concat()
    };
    vec![
        saved(0, 0),
        saved(0, 150),
        saved(1, 60),
        saved(2, 30),
        saved(2, 100),
    ]
}

/// The latest checkpoint of a run folder.
fn latest(folder: &Path) -> PathBuf {
    Unfinished::in_folder(folder).path().join(CHECKPOINT)
}

/// The bytes of the checkpoint of a run.
fn save(folder: &Path, running: &Running) -> Vec<u8> {
    Unfinished::in_folder(folder).create().unwrap();
    Checkpoints::new(folder, running.case(), Timestamp::UNIX_EPOCH)
        .save(running, &Alone)
        .unwrap();
    std::fs::read(latest(folder)).unwrap()
}

fn checkpoint(input: &[u8]) {
    let Some((number, file)) = input.split_first() else {
        return;
    };
    let case = &CASES[usize::from(*number) % CASES.len()];
    resume(case, file);
    let without_checksum = &file[..file.len().saturating_sub(blake3::OUT_LEN)];
    resume(case, &with_checksum(without_checksum));
    // Columns and state under the right header, with its own numbers of columns, if it has any.
    let folder = scratch::folder("checkpoint");
    let whole = save(&folder, &Running::start(case, None, Execution::default()));
    let length = |bytes: &[u8]| bytes.iter().position(|&byte| byte == b'\n').map(|at| at + 1);
    let mut header: Value = serde_json::from_slice(&whole[..length(&whole).unwrap()]).unwrap();
    let begin = length(file).unwrap_or(0);
    if let Ok(Value::Object(mut own)) = serde_json::from_slice(&file[..begin])
        && let Some(columns) = own.remove("columns")
    {
        header["columns"] = columns;
    }
    let header = format!("{header}\n");
    let rest = without_checksum.get(begin..).unwrap_or_default();
    resume(case, &with_checksum(&[header.as_bytes(), rest].concat()));
}

/// Appends the checksum.
fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    let hash = hash_of_pieces(&mut Cursor::new(bytes), bytes.len() as u64, &Alone).unwrap();
    [bytes, hash.as_bytes()].concat()
}

/// Resumes a run if the file can be read, and demands that what it then saves can be read again.
fn resume(case: &Arc<Case>, file: &[u8]) {
    let folder = scratch::folder("checkpoint");
    Unfinished::in_folder(&folder).create().unwrap();
    std::fs::write(latest(&folder), file).unwrap();
    let loaded = match Checkpoints::load(&folder, case, false, &Alone) {
        Ok(loaded) => loaded.unwrap(),
        Err(error) => return readable(&error),
    };
    let Some(mut running) = loaded.resume(case, Execution::default()).unwrap() else {
        return;
    };
    match running.advance(STEPS) {
        Err(error) => readable(&error),
        Ok(ended) => {
            // A run that has ended is not resumed.
            if ended.is_none() {
                let bytes = save(&folder, &running);
                let again = Checkpoints::load(&folder, case, false, &Alone).unwrap();
                let resumed = again
                    .unwrap()
                    .resume(case, Execution::default())
                    .unwrap()
                    .unwrap();
                assert_eq!(save(&folder, &resumed), bytes);
            }
            let record = running.record(ended.unwrap_or(StopReason::End));
            assert_eq!(record.first_slip_time_star.len(), case.model.lattice.n_blocks());
        }
    }
}
