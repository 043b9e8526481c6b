//! Records of finished runs, one line each with a checksum.

use slipfront_study::{FinishedRun, Outcome, RunJournal};

use super::json::{long_objects, summary};
use crate::checks::readable;
use crate::long::many;
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// The file as it is, then with the right checksum in every line.
pub(crate) const RECORDS: Target = Target {
    name: "records",
    check: records,
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
    repetitions: 40,
    long,
};

fn record(id: &str, outcome: Outcome) -> FinishedRun {
    FinishedRun {
        id: id.to_owned(),
        wall_time_s: 0.25,
        outcome,
    }
}

fn generated() -> Vec<Vec<u8>> {
    let done = record("0123456789abcdef", Outcome::Done(Box::new(summary())));
    let plain = record("a", Outcome::Done(Box::default()));
    let failed = record("b", Outcome::Failed("the run diverged at step 12".to_owned()));
    let line = |record: &FinishedRun| with_checksum(serde_json::to_string(record).unwrap().as_bytes());
    vec![
        line(&done),
        line(&failed),
        [line(&failed), line(&plain)].concat(),
        [line(&failed), line(&failed), b"0123456789abcdef {\"id\"".to_vec()].concat(),
        b"some notes\nof mine\n".to_vec(),
    ]
}

/// Files of many records and of long ones.
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

fn records(input: &[u8]) {
    drop(open(input));
    let lines: Vec<&[u8]> = input.split(|&byte| byte == b'\n').map(without_checksum).collect();
    let file: Vec<u8> = lines.iter().flat_map(|json| with_checksum(json)).collect();
    let Some(records) = open(&file) else { return };
    let mut whole = 0;
    for json in &lines {
        let Ok(record) = serde_json::from_slice::<FinishedRun>(json) else {
            continue;
        };
        whole += 1;
        assert!(records.get(&record.id).is_some(), "{}", record.id);
        // A record is written as it was read.
        let printed = serde_json::to_string(&record).unwrap();
        let again: FinishedRun = serde_json::from_str(&printed).unwrap();
        assert_eq!(again, record);
        assert_eq!(serde_json::to_string(&again).unwrap(), printed);
    }
    assert_eq!(records.damaged, lines.len() - whole);
}

/// Opens a file of records, appends a record, and demands that all records are there when it is opened again.
fn open(file: &[u8]) -> Option<RunJournal> {
    let folder = scratch::folder("records");
    std::fs::write(folder.join(RunJournal::FILE), file).unwrap();
    let records = match RunJournal::open(&folder) {
        Ok(records) => records,
        Err(error) => {
            readable(&error);
            // A file that is refused is left unchanged.
            assert_eq!(std::fs::read(folder.join(RunJournal::FILE)).unwrap(), file);
            return None;
        }
    };
    let before = records.len();
    let one_more = record("one more", Outcome::Failed(String::new()));
    let known = usize::from(records.get(&one_more.id).is_some());
    records.append(&[one_more]).unwrap();
    drop(records);
    let mut again = RunJournal::open(&folder).unwrap();
    let damaged = again.damaged;
    assert_eq!(again.len(), before + 1 - known);
    assert!(again.get("one more").is_some());
    assert_eq!(again.merge(&folder).unwrap(), 0);
    again.damaged = damaged;
    Some(again)
}
