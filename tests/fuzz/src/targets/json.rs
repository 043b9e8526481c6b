//! The JSON files of a run folder: the summary, the manifest with its checksum, and the journal of a run that
//! is not complete.

use std::sync::atomic::AtomicBool;

use slipfront_calibrate::CALIBRATIONS;
use slipfront_design::DESIGNS;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::{Manifest, ManifestFile, Random};
use slipfront_run::run_folder::RunFolder;
use slipfront_run::run_folder::inspection::Inspection;
use slipfront_run::summary::{InstantSummary, Summary, read_summary, summary_json};
use slipfront_study::project_folder::Extent;
use slipfront_study::verify::verify;

use crate::checks::readable;
use crate::long::{many, nested};
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// The summary of a run.
pub(crate) const SUMMARY: Target = Target {
    name: "summary",
    check: check_summary,
    generated: || {
        vec![
            summary_json(&summary()).into_bytes(),
            summary_json(&Summary::default()).into_bytes(),
        ]
    },
    files: &[],
    dictionary: Some("json.dict"),
    max_bytes: 8192,
    memory: Memory {
        bytes: 256 << 10,
        per_byte: 64,
    },
    time: Time::READING,
    mutations: 2000,
    repetitions: 20,
    long: || long_objects("", ""),
};

/// The manifest as it is, then with the right checksum, in a folder that is verified and replaced.
pub(crate) const MANIFEST: Target = Target {
    name: "manifest",
    check: check_manifest,
    generated: manifests,
    files: &[],
    dictionary: Some("json.dict"),
    max_bytes: 8192,
    memory: Memory {
        bytes: 1 << 20,
        per_byte: 256,
    },
    time: Time::READING,
    mutations: 500,
    repetitions: 15,
    long: long_manifests,
};

/// The journal of a run that is not complete, in a folder whose files are replaced.
pub(crate) const JOURNAL: Target = Target {
    name: "journal",
    check: check_journal,
    generated: journals,
    long: long_journals,
    ..MANIFEST
};

/// Objects with many keys, values and brackets, between these texts.
pub(crate) fn long_objects(before: &str, after: &str) -> Vec<Vec<u8>> {
    let around = |begin: &str, piece: &str, end: &str| {
        many(&format!("{before}{begin}"), piece, &format!("{end}{after}"))
    };
    let (open, close) = (format!("{before}{{\"a\": "), format!("}}{after}"));
    vec![
        around("{", "\"a#\": 1, ", "\"b\": 1}"),
        around("{", "\"id\": #, ", "\"b\": 1}"),
        around("{\"", "a", "\": 1}"),
        around("{\"warnings\": [", "\"a#\", ", "\"\"]}"),
        around("{\"warnings\": [", "#, ", "1]}"),
        around("{\"version\": \"", "\\u00e9\\n", "\"}"),
        around("{\"version\": \"", "\\ud800", "\"}"),
        around("{\"dt_star\": 1", "0", "}"),
        around("{\"dt_star\": 0.", "0", "1}"),
        around("{\"dt_star\": 0.", "123456789", "e9}"),
        around("", " \n", "{}"),
        around("", "{}\n", "{}"),
        around("", "\"", ""),
        nested(&open, "[", "", "]", &close),
        nested(&open, "{\"a\": ", "1", "}", &close),
        nested(before, "[", "", "]", after),
    ]
}

/// A file of zeros as a manifest or a journal lists it.
fn long_entry(name: &str) -> String {
    let zeros = "0".repeat(64);
    format!("{{\"name\": \"{name}\", \"bytes\": 0, \"blake3\": \"{zeros}\"}}")
}

/// Manifests of many files.
fn long_manifests() -> Vec<Vec<u8>> {
    let files = |name: &str| {
        let entry = format!("{},", long_entry(name));
        many("{\"files\": [", &entry, "{}], \"seal\": \"\"}")
    };
    let mut all = long_objects("", "");
    all.extend(long_objects("{\"files\": [], \"a\": ", ", \"seal\": \"\"}"));
    all.extend(["inputs/a#", "inputs/a", "summary.json", "a/a/a/a/a/a#", ".."].map(files));
    all.push(many("", "{\"seal\": ", ""));
    all
}

/// Journals of many files.
fn long_journals() -> Vec<Vec<u8>> {
    let line = |name: &str| many("", &format!("{}\n", long_entry(name)), "");
    let mut all = long_objects("", "\n");
    all.extend(["inputs/a#", "inputs/a", "summary.json", "a/a/a/a/a/a#"].map(line));
    all
}

/// A summary with a value for every key.
pub(crate) fn summary() -> Summary {
    Summary {
        static_friction_star: 0.912_345_678_901_234_5,
        static_friction: 0.91,
        onset_time_star: 30.5,
        onset_time_s: 9.6e-9,
        first_slip_time_star: Some(20.25),
        first_slip_time_s: Some(6.4e-9),
        kinetic_friction_star: Some(0.5),
        kinetic_friction_star_uncertainty: Some(1e-3),
        kinetic_friction: Some(0.5),
        kinetic_window_star: Some([100.0, 260.0]),
        sliding_percent_kinetic: Some(97.5),
        sliding_percent_max: 100.0,
        mu_star_max: 0.95,
        transition: true,
        instants: vec![InstantSummary {
            instant: 'A',
            time_star: 16.0,
            drive_time_star: None,
            mu_star: 0.25,
            sliding_percent: 0.0,
        }],
        v_star: 0.03,
        n_blocks: 625,
        dt_star: 0.1,
        steps: 2667,
        texture_percent_asked: Some(10.0),
        seed: 1,
        energy_error: -1e-16,
        warnings: vec!["16 blocks are few".to_owned()],
        version: "0.1.0".to_owned(),
        ..Summary::default()
    }
}

/// A summary that is written and read again has the same bytes.
fn check_summary(input: &[u8]) {
    let path = scratch::file("run/summary.json", input);
    match read_summary(path.parent().unwrap()) {
        Err(error) => readable(&error),
        Ok(summary) => {
            let printed = summary_json(&summary);
            scratch::file("run/summary.json", printed.as_bytes());
            let again = read_summary(path.parent().unwrap()).unwrap();
            assert_eq!(summary_json(&again), printed);
            assert_eq!(again, summary);
        }
    }
}

/// A file as a manifest or a journal lists it.
fn file(name: &str, bytes: &[u8]) -> ManifestFile {
    ManifestFile {
        name: name.to_owned(),
        bytes: bytes.len() as u64,
        blake3: blake3::hash(bytes).to_hex().to_string(),
    }
}

fn manifests() -> Vec<Vec<u8>> {
    let whole = Manifest {
        version: "0.1.0".to_owned(),
        revision: Some("0123abc".to_owned()),
        build: "slipfront 0.1.0, sources 0123456789abcdef".to_owned(),
        kernel: "fused".to_owned(),
        simd_width: "avx2".to_owned(),
        threads: 2,
        device: Some("GPU".to_owned()),
        host: "host".to_owned(),
        platform: "linux x86_64".to_owned(),
        started: "2026-01-01T00:00:00Z".to_owned(),
        finished: "2026-01-01T00:00:01Z".to_owned(),
        wall_time_s: 1.25,
        case_blake3: file("case.toml", CASE).blake3,
        random: Random {
            generator: "ChaCha8".to_owned(),
            seed: 1,
            streams: [("mu_static".to_owned(), 0)].into(),
        },
        without_pictures: None,
        files: vec![
            file("case.toml", CASE),
            file("inputs/mask.png", b"mask"),
            file("../keep", b"kept"),
        ],
        checksum: String::new(),
    };
    let mut odd = whole.clone();
    let long = format!("inputs/{}", "a".repeat(300));
    let names = [
        "inputs/..",
        "inputs/.",
        "inputs/",
        "inputs/a\0b",
        "inputs/a/../../keep",
        "/dev/zero",
        &long,
    ];
    odd.files.extend(names.map(|name| file(name, b"")));
    let with_checksum = |manifest: &Manifest| with_checksum(&serde_json::to_vec_pretty(manifest).unwrap());
    vec![
        with_checksum(&whole),
        with_checksum(&Manifest::default()),
        with_checksum(&odd),
    ]
}

const CASE: &[u8] = b"[drive]\nv_star = 0.1\n";

/// The manifest with the right checksum, if it has one.
fn with_checksum(manifest: &[u8]) -> Vec<u8> {
    let name = b"\"seal\"";
    let Some(at) = manifest.windows(name.len()).rposition(|bytes| bytes == name) else {
        return manifest.to_vec();
    };
    let before = &manifest[..at];
    let seal = format!("\"seal\": \"{}\"\n}}\n", blake3::hash(before).to_hex());
    [before, seal.as_bytes()].concat()
}

fn check_manifest(input: &[u8]) {
    manifest(input);
    manifest(&with_checksum(input));
}

/// A manifest that can be read is equal when written and read again; no file outside of its folder is
/// touched, whatever it lists.
fn manifest(bytes: &[u8]) {
    let folder = scratch::folder("manifests/run");
    let beside = scratch::file("manifests/keep", b"kept");
    scratch::file("manifests/run/inputs/mask.png", b"mask");
    scratch::file("manifests/run/case.toml", CASE);
    scratch::file("manifests/run/manifest.json", bytes);
    match Manifest::read(&folder) {
        Err(error) => readable(&error),
        Ok(manifest) => {
            let printed = serde_json::to_vec_pretty(&manifest).unwrap();
            let again: Manifest = serde_json::from_slice(&printed).unwrap();
            assert_eq!(again, manifest);
            readable(&manifest.program());
        }
    }
    match verify(
        &folder,
        &[DESIGNS, CALIBRATIONS],
        Extent::Derived,
        &AtomicBool::new(false),
    ) {
        Err(error) => readable(&error),
        Ok(verdict) => {
            for line in [vec![verdict.what], verdict.differences, verdict.notes].concat() {
                if !line.is_empty() {
                    expect_printable(&line);
                }
            }
        }
    }
    Inspection::read(&folder).unwrap().managed_bytes().unwrap();
    let case = folder.join("case.toml");
    match RunFolder::prepare(&folder, true, &[]) {
        Ok(_) => assert!(!folder.join("manifest.json").exists() && !case.exists()),
        // Without a manifest that knows them they may be a user's.
        Err(
            error @ (FolderError::Foreign { .. } | FolderError::Edited { .. } | FolderError::Manifest(_)),
        ) => {
            readable(&error);
            assert_eq!(std::fs::read(case).unwrap(), CASE);
        }
        Err(error) => panic!("{error}"),
    }
    assert_eq!(std::fs::read(beside).unwrap(), b"kept");
}

fn journals() -> Vec<Vec<u8>> {
    let lines = |files: &[ManifestFile]| -> Vec<u8> {
        let line = |file| serde_json::to_string(file).unwrap() + "\n";
        files.iter().map(line).collect::<String>().into_bytes()
    };
    let (case, summary) = (file("case.toml", CASE), file("summary.json", FINISHED));
    vec![
        lines(&[case.clone(), summary.clone(), file("../keep", b"kept")]),
        lines(&[
            case,
            file("summary.json", b"other"),
            file("inputs/../../keep", b"kept"),
        ]),
        lines(&[summary]),
    ]
}

const FINISHED: &[u8] = b"{}\n";

/// No file outside of the folder of a journal is touched, whatever it lists, and none in it that is not
/// listed as it is.
fn check_journal(input: &[u8]) {
    let folder = scratch::folder("journals/run");
    let beside = scratch::file("journals/keep", b"kept");
    let summary = scratch::file("journals/run/summary.json", FINISHED);
    scratch::file("journals/run/case.toml", CASE);
    scratch::file("journals/run/.slipfront/journal.jsonl", input);
    Inspection::read(&folder).unwrap().managed_bytes().unwrap();
    match RunFolder::prepare(&folder, true, &[]) {
        Ok(_) => {
            let hash = file("", FINISHED).blake3;
            let is_listed = input.windows(hash.len()).any(|bytes| bytes == hash.as_bytes());
            assert!(is_listed && !summary.exists());
        }
        Err(error @ (FolderError::Foreign { .. } | FolderError::Edited { .. })) => {
            readable(&error);
            assert_eq!(std::fs::read(summary).unwrap(), FINISHED);
        }
        Err(error) => panic!("{error}"),
    }
    assert_eq!(std::fs::read(beside).unwrap(), b"kept");
}

/// Demands that a line of a report has no control characters, whatever names the manifest lists.
fn expect_printable(line: &str) {
    let odd = line.chars().find(|c| c.is_control());
    assert!(odd.is_none(), "a line with the character {odd:?}: {line:?}");
}
