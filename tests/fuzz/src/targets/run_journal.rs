//! The journal of a study: finished runs, one line each with a checksum.

use slipfront_study::{FinishedRun, Outcome, RunJournal};

use super::json::{long_objects, summary};
use crate::checks::readable;
use crate::long::many;
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// The file as it is, then with the right checksum in every line.
pub(crate) const RUN_JOURNAL: Target = Target {
    name: "run_journal",
    check: run_journal,
    generated,
    files: &[],
    dictionary: Some("json.dict"),
    max_bytes: 8192,
    memory: Memory {
        bytes: 1 << 20,
        per_byte: 256,
    },
    time: Time::READING,
    mutations: 300,
    repetitions: 15,
    long,
};

fn finished(id: &str, outcome: Outcome) -> FinishedRun {
    FinishedRun {
        id: id.to_owned(),
        wall_time_s: 0.25,
        outcome,
        kept: (id.len() > 1).then(|| "0123".repeat(16)),
    }
}

fn generated() -> Vec<Vec<u8>> {
    let done = finished("0123456789abcdef", Outcome::Done(Box::new(summary())));
    let plain = finished("a", Outcome::Done(Box::default()));
    let failed = finished("b", Outcome::Failed("the run diverged at step 12".to_owned()));
    let line = |run: &FinishedRun| with_checksum(serde_json::to_string(run).unwrap().as_bytes());
    vec![
        line(&done),
        line(&failed),
        [line(&failed), line(&plain)].concat(),
        [line(&failed), line(&failed), b"0123456789abcdef {\"id\"".to_vec()].concat(),
        b"some notes\nof mine\n".to_vec(),
    ]
}

/// Files of many runs and of long ones.
fn long() -> Vec<Vec<u8>> {
    let failed = |id: &str| {
        format!("0123456789abcdef {{\"id\":\"{id}\",\"wall_time_s\":1,\"outcome\":{{\"Failed\":\"\"}}}}\n")
    };
    let mut all = long_objects("0123456789abcdef ", "\n");
    all.extend([failed("a#"), failed("a"), "\n".to_owned()].map(|line| many("", &line, "")));
    all
}

/// A line with the right checksum.
fn with_checksum(json: &[u8]) -> Vec<u8> {
    let sum = blake3::hash(json).to_hex();
    [&sum.as_bytes()[..16], b" ", json, b"\n"].concat()
}

/// A line without its checksum, if it has one.
fn without_checksum(line: &[u8]) -> &[u8] {
    match line.get(16) {
        Some(b' ') => &line[17..],
        _ => line,
    }
}

fn run_journal(input: &[u8]) {
    drop(open(input));
    let lines: Vec<&[u8]> = input.split(|&byte| byte == b'\n').map(without_checksum).collect();
    let file: Vec<u8> = lines.iter().flat_map(|json| with_checksum(json)).collect();
    let Some(journal) = open(&file) else { return };
    let mut whole = 0;
    for json in &lines {
        let Ok(run) = serde_json::from_slice::<FinishedRun>(json) else {
            continue;
        };
        whole += 1;
        assert!(journal.get(&run.id).is_some(), "{}", run.id);
        // A run is written as it was read.
        let printed = serde_json::to_string(&run).unwrap();
        let again: FinishedRun = serde_json::from_str(&printed).unwrap();
        assert_eq!(again, run);
        assert_eq!(serde_json::to_string(&again).unwrap(), printed);
    }
    assert_eq!(journal.damaged, lines.len() - whole);
}

/// Opens a journal, appends a run, and demands that all runs are there when it is opened again.
fn open(file: &[u8]) -> Option<RunJournal> {
    let folder = scratch::folder("run_journal");
    std::fs::write(folder.join(RunJournal::FILE), file).unwrap();
    let journal = match RunJournal::open(&folder) {
        Ok(journal) => journal,
        Err(error) => {
            readable(&error);
            // A file that is refused is left unchanged.
            assert_eq!(std::fs::read(folder.join(RunJournal::FILE)).unwrap(), file);
            return None;
        }
    };
    let before = journal.len();
    let one_more = finished("one more", Outcome::Failed(String::new()));
    let known = usize::from(journal.get(&one_more.id).is_some());
    journal.append(&[one_more]).unwrap();
    drop(journal);
    let mut again = RunJournal::open(&folder).unwrap();
    let damaged = again.damaged;
    assert_eq!(again.len(), before + 1 - known);
    assert!(again.get("one more").is_some());
    assert_eq!(again.merge(&folder).unwrap(), 0);
    again.damaged = damaged;
    Some(again)
}
