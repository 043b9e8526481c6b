//! Checkpoints of runs: a header, the state and a seal over both.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use jiff::Timestamp;
use slipfront::StopReason;
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseFile;
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::names::CHECKPOINT;
use slipfront_run::run_folder::unfinished::Unfinished;
use slipfront_run::running::Running;

use crate::checks::readable;
use crate::{Memory, Target, scratch};

/// The first byte chooses one of [`CASES`]. The file is read as it is, with the seal that it should have, and with that and
/// the header; a run that can go on from there does so.
pub(crate) const CHECKPOINTS: Target = Target {
    name: "checkpoint",
    check: checkpoint,
    made,
    files: &[],
    dictionary: Some("json.dict"),
    longest: 16384,
    // Postcard reserves at most 1 MiB at once for a list that says it is longer; the kernel has a few blocks.
    memory: Memory {
        bytes: 16 << 20,
        per_byte: 256,
    },
    mutations: 300,
    repetitions: 20,
};

/// Both kernels, and both ways to keep fields.
const TEXTS: [&str; 3] = [
    "[slider]\nblocks = [4, 3]\n[time]\nduration_star = 20\n[drive]\nv_star = 0.2\n",
    "[slider]\nblocks = [3, 2]\n[time]\nduration_star = 20\n[output]\nsnapshots = [1.0, 5.0, 15.0]\nstride = 2\n",
    "[slider]\nblocks = [3, 3]\nedges = \"periodic\"\n[time]\nduration_star = 20\nstop = \"after_onset\"\n[friction]\n\
     law = \"literal\"\n[output]\nsnapshots = { every = 2.0 }\nfields = [\"sliding\"]\n",
];

static CASES: LazyLock<[Arc<Case>; 3]> = LazyLock::new(|| {
    // Not by `parse`, which asks for the memory that a run takes, if only to see whether it is there.
    let made = |file| Arc::new(Case::new(file, "case", Path::new("")).unwrap());
    TEXTS.map(|text| made(CaseFile::parse(text, "case.toml", &[]).unwrap()))
});

/// Steps of a run that goes on.
const STEPS: u64 = 20;

fn made() -> Vec<Vec<u8>> {
    let saved = |number: usize, steps: u64| {
        let mut running = Running::start(&CASES[number], 1);
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
    Unfinished::of(folder).path().join(CHECKPOINT)
}

/// The bytes of the checkpoint of a run.
fn save(folder: &Path, running: &Running) -> Vec<u8> {
    Unfinished::of(folder).create().unwrap();
    Checkpoints::new(folder, running.case(), Timestamp::UNIX_EPOCH)
        .save(running)
        .unwrap();
    std::fs::read(latest(folder)).unwrap()
}

fn checkpoint(input: &[u8]) {
    let Some((number, file)) = input.split_first() else {
        return;
    };
    let case = &CASES[usize::from(*number) % CASES.len()];
    go_on(case, file);
    let contents = &file[..file.len().saturating_sub(blake3::OUT_LEN)];
    go_on(case, &with_checksum(contents));
    // The state alone, under a header that fits as well.
    let folder = scratch::folder("checkpoint");
    let whole = save(&folder, &Running::start(case, 1));
    let length = |bytes: &[u8]| bytes.iter().position(|&byte| byte == b'\n').map(|at| at + 1);
    let header = &whole[..length(&whole).unwrap()];
    let begin = length(file).unwrap_or(0);
    let state = contents.get(begin..).unwrap_or_default();
    go_on(case, &with_checksum(&[header, state].concat()));
}

/// With the seal that fits.
fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    [bytes, blake3::hash(bytes).as_bytes()].concat()
}

/// A run goes on from what can be read, or the reason is told; what it saves then can be read again.
fn go_on(case: &Arc<Case>, file: &[u8]) {
    let folder = scratch::folder("checkpoint");
    Unfinished::of(&folder).create().unwrap();
    std::fs::write(latest(&folder), file).unwrap();
    let saved = match Checkpoints::load(&folder, case, false) {
        Ok(saved) => saved.unwrap(),
        Err(error) => return readable(&error),
    };
    let Some(mut running) = Running::resume(case, 1, saved.state) else {
        return;
    };
    match running.advance(STEPS) {
        Err(error) => readable(&error),
        Ok(ended) => {
            // A run that has ended is not gone on with.
            if ended.is_none() {
                let bytes = save(&folder, &running);
                let again = Checkpoints::load(&folder, case, false).unwrap().unwrap();
                let resumed = Running::resume(case, 1, again.state).unwrap();
                assert_eq!(save(&folder, &resumed), bytes);
            }
            let record = running.record(ended.unwrap_or(StopReason::End));
            assert_eq!(record.first_slip_time_star.len(), case.model.lattice.n_blocks());
        }
    }
}
