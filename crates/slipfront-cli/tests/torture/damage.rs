//! A command never gives a wrong answer that looks right, whatever happens to the files that it reads.
//!
//! Files with a checksum (results, records, findings) are refused or computed again; files of a user (cases,
//! studies, masks, arrays) are read as they are now, and recorded as such.

use std::process::Command;
use std::sync::OnceLock;

use crate::bounded::ExitedProcess;
use crate::jobs::{JOBS, Job, expect_all, workspace};
use crate::support::process::{try_send, wait_for};
use crate::support::workspace::{Files, Workspace};
use crate::tally::{Chance, Tally, cases, long};

/// Longer than any disk, and empty.
const ENDLESS_BYTES: u64 = 1 << 40;

#[derive(Clone, Debug)]
enum Damage {
    /// Only this many bytes are left.
    Cut(usize),
    /// A bit is flipped.
    Flip(usize),
    /// Two bytes are exchanged.
    Swap(usize, usize),
    /// Sixteen bytes from this one on are zero.
    Zero(usize),
    /// Another file replaces this one.
    Other(String),
    Gone,
    Folder,
    /// A pipe without a writer.
    Pipe,
    /// A link to itself.
    Circle,
    /// A file of a TiB.
    Endless,
}

/// Names and contents of files of every kind.
type Others = Vec<(String, Vec<u8>)>;

/// Damage to a file: at most `most` cuts, flips and the like, and every replacement of the file, of which the
/// short form also takes at most `most`.
fn damages(bytes: &[u8], chance: &mut Chance, most: usize) -> Vec<Damage> {
    let len = bytes.len();
    let mut all: Vec<Damage> = Vec::new();
    if len * 9 <= most {
        all.extend((0..len).map(Damage::Cut));
        all.extend((0..8 * len).map(Damage::Flip));
    }
    while all.len() < most && len > 0 {
        all.push(match chance.below(8) {
            0 | 1 => Damage::Cut(chance.below(len)),
            2 => Damage::Swap(chance.below(len), chance.below(len)),
            3 => Damage::Zero(chance.below(len)),
            _ => Damage::Flip(chance.below(8 * len)),
        });
    }
    let mut places = vec![
        Damage::Cut(0),
        Damage::Gone,
        Damage::Folder,
        Damage::Pipe,
        Damage::Circle,
        Damage::Endless,
    ];
    places.extend(others().iter().map(|(name, _)| Damage::Other(name.clone())));
    let most = if long() { places.len() } else { most };
    all.extend(chance.some(places, most));
    all
}

impl Damage {
    /// The bytes after the damage; none if no bytes are left or they are unchanged.
    fn bytes(&self, whole: &[u8]) -> Option<Vec<u8>> {
        let mut bytes = whole.to_vec();
        match self {
            Self::Cut(len) => bytes.truncate(*len),
            Self::Flip(bit) => bytes[bit / 8] ^= 1 << (bit % 8),
            Self::Swap(one, other) => bytes.swap(*one, *other),
            Self::Zero(from) => {
                let to = (from + 16).min(bytes.len());
                bytes[*from..to].fill(0);
            }
            Self::Other(name) => bytes.clone_from(&others().iter().find(|(other, _)| other == name)?.1),
            Self::Gone | Self::Folder | Self::Pipe | Self::Circle | Self::Endless => return None,
        }
        (bytes != whole).then_some(bytes)
    }

    /// Damages a file; returns whether anything has changed.
    fn apply(&self, workspace: &Workspace, name: &str, whole: &[u8]) -> bool {
        let path = workspace.path(name);
        if let Some(bytes) = self.bytes(whole) {
            workspace.write(name, bytes);
            return true;
        }
        workspace.remove(name);
        match self {
            Self::Gone => {}
            Self::Folder => std::fs::create_dir(path).unwrap(),
            Self::Pipe => assert!(Command::new("mkfifo").arg(path).status().unwrap().success()),
            Self::Circle => std::os::unix::fs::symlink(&path, &path).unwrap(),
            Self::Endless => std::fs::File::create(path)
                .unwrap()
                .set_len(ENDLESS_BYTES)
                .unwrap(),
            _ => {
                workspace.write(name, whole);
                return false;
            }
        }
        true
    }

    /// Whether a command waits for the file: a user may pass a case through a pipe.
    fn is_waited_for(&self) -> bool {
        matches!(self, Self::Pipe)
    }
}

/// A file to damage, as `kind` in the tally, with at most `most` cuts and flips.
struct Target<'a> {
    kind: &'a str,
    name: &'a str,
    most: usize,
}

/// Damages a file in every way, judges the outcome each time, and restores the file.
fn torture(
    tally: &mut Tally,
    workspace: &Workspace,
    target: &Target,
    judge: &dyn Fn(&Damage) -> Result<&'static str, String>,
) {
    let Target { kind, name, most } = *target;
    let whole = workspace.read(name);
    for damage in damages(&whole, &mut Chance::new(), most) {
        if !damage.apply(workspace, name, &whole) {
            continue;
        }
        let ended = judge(&damage);
        let case = format!("{damage:?} of {name}");
        if long()
            && let Err(finding) = &ended
        {
            eprintln!("FOUND {kind}, {case}: {finding}");
        }
        tally.note(kind, &case, ended);
        workspace.remove(name);
        workspace.write(name, &whole);
    }
}

/// A file of every kind, to replace another file: from the same case and study, and from others.
fn others() -> &'static Others {
    static OTHERS: OnceLock<Others> = OnceLock::new();
    let make = || {
        let workspace = workspace();
        workspace.fill("out", &JOBS[0].undisturbed());
        let other = "run case.toml --quiet --threads 1 -o other --set drive.v_star=0.12";
        workspace.succeed_bounded(other).unwrap();
        let study = String::from_utf8(workspace.read("study.toml")).unwrap();
        workspace.write("other.toml", study.replace("[0.1, 0.2]", "[0.1, 0.25]"));
        workspace
            .succeed_bounded("study other.toml --quiet --threads 1 -o study")
            .unwrap();
        let names = [
            "case.toml",
            "study.toml",
            "mask.png",
            "mask.npy",
            "mu_s.csv",
            "mu_k.npy",
            "out/manifest.json",
            "out/summary.json",
            "out/kymograph.nc",
            "out/fields.nc",
            "other/case.toml",
            "other/manifest.json",
            "other/summary.json",
            "other/series.csv",
            "other/fields.nc",
            "other/friction.png",
            "study/runs.jsonl",
            "study/points.csv",
        ];
        names.map(|name| (name.to_owned(), workspace.read(name))).into()
    };
    OTHERS.get_or_init(make)
}

/// A workspace with the undamaged results of a job in `out`.
fn with_results(job: &Job) -> (Workspace, Files) {
    let workspace = workspace();
    let whole = job.undisturbed();
    workspace.fill("out", &whole);
    (workspace, whole)
}

fn refused(ended: &ExitedProcess) -> Result<&'static str, String> {
    match ended.status {
        2 => Ok("refused"),
        _ => Err(format!("{ended:?}")),
    }
}

const INPUTS: [&str; 5] = ["case.toml", "mask.png", "mask.npy", "mu_k.npy", "mu_s.csv"];

#[test]
fn of_what_a_case_reads() {
    let (workspace, whole) = with_results(&JOBS[0]);
    let mut tally = Tally::new("damage");
    for name in INPUTS {
        let read = |damage: &Damage| {
            if name == "case.toml" && damage.is_waited_for() {
                return Ok("not tried: waited for");
            }
            let ended = workspace.run_bounded("texture case.toml -o texture.png --force")?;
            if ended.status == 0 {
                Ok("taken as it is")
            } else {
                refused(&ended)
            }
        };
        let target = Target {
            kind: "inputs that are read",
            name,
            most: cases(12, 6_000),
        };
        torture(&mut tally, &workspace, &target, &read);
        workspace.remove("again");
        let run = |damage: &Damage| {
            if name == "case.toml" && damage.is_waited_for() {
                return Ok("not tried: waited for");
            }
            let ended = workspace.run_bounded("run case.toml --quiet --threads 1 -o again --force")?;
            match ended.status {
                0 => {}
                1 => return Ok("failed"),
                _ => return refused(&ended),
            }
            let now = workspace.files_if_any("again");
            let copy = now.get(&format!("inputs/{name}"));
            if copy.is_some_and(|copy| *copy != workspace.read(name)) {
                return Err("another file was recorded".to_owned());
            }
            let recorded = |files: &Files| {
                let mut files = files.clone();
                files.retain(|name, _| name == "case.toml" || name.starts_with("inputs/"));
                files
            };
            if recorded(&now) == recorded(&whole) {
                expect_all(&now, &whole)?;
                return Ok("the same case");
            }
            workspace.succeed_bounded("verify --rerun --quiet again")?;
            Ok("recorded as another case")
        };
        let target = Target {
            kind: "inputs of a run",
            name,
            most: cases(1, 300),
        };
        torture(&mut tally, &workspace, &target, &run);
    }
    tally.close();
}

#[test]
fn of_a_study_file() {
    let (workspace, _) = with_results(&JOBS[1]);
    let mut tally = Tally::new("damage");
    let read = |damage: &Damage| {
        if damage.is_waited_for() {
            return Ok("not tried: waited for");
        }
        let ended = workspace.run_bounded("study slurm study.toml")?;
        if ended.status == 0 {
            Ok("taken as it is")
        } else {
            refused(&ended)
        }
    };
    let target = Target {
        kind: "study files that are read",
        name: "study.toml",
        most: cases(25, 10_000),
    };
    torture(&mut tally, &workspace, &target, &read);
    let run = |damage: &Damage| {
        if damage.is_waited_for() {
            return Ok("not tried: waited for");
        }
        workspace.remove("again");
        let ended = workspace.run_bounded("study study.toml --quiet --threads 1 -o again")?;
        match ended.status {
            0 => workspace
                .succeed_bounded("verify again")
                .map(|_| "recorded as another study"),
            1 => Ok("failed"),
            _ => refused(&ended),
        }
    };
    let target = Target {
        kind: "study files that are run",
        most: cases(2, 500),
        ..target
    };
    torture(&mut tally, &workspace, &target, &run);
    tally.close();
}

/// Asserts that `line` notices every difference from the written files.
fn seen(workspace: &Workspace, line: &str) -> Result<&'static str, String> {
    let ended = workspace.run_bounded(line)?;
    match ended.status {
        0 => Err(format!("it is not seen: {}", ended.stdout)),
        _ => Ok("seen"),
    }
}

#[test]
fn of_a_run_folder() {
    let (workspace, whole) = with_results(&JOBS[0]);
    let mut tally = Tally::new("damage");
    for name in whole.keys() {
        let target = Target {
            kind: "results that are verified",
            name: &format!("out/{name}"),
            most: cases(4, if name.ends_with("json") { 8_000 } else { 1_000 }),
        };
        torture(&mut tally, &workspace, &target, &|_| {
            seen(&workspace, "verify out")
        });
    }
    workspace.succeed_bounded("plot out -o drawn").unwrap();
    let drawn = workspace.files_if_any("drawn");
    let of = |name: &str, most: usize| (format!("out/{name}"), most);
    let read = ["summary.json", "series.csv", "kymograph.nc", "fields.nc"];
    for (name, most) in read
        .iter()
        .chain(&["manifest.json"])
        .map(|name| of(name, cases(3, 1_000)))
    {
        let judge = |_: &Damage| {
            workspace.remove("drawn");
            let ended = workspace.run_bounded("plot out -o drawn")?;
            match ended.status {
                0 if workspace.files_if_any("drawn") == drawn => Ok("drawn as it was"),
                0 => Err("a wrong picture".to_owned()),
                _ => refused(&ended),
            }
        };
        let target = Target {
            kind: "results that are drawn",
            name: &name,
            most,
        };
        torture(&mut tally, &workspace, &target, &judge);
    }
    // Without a manifest, nothing records what the files were.
    workspace.remove("out/manifest.json");
    for (name, most) in read.iter().map(|name| of(name, cases(2, 500))) {
        let judge = |_: &Damage| {
            let ended = workspace.run_bounded("plot out -o drawn")?;
            if ended.status == 0 {
                Ok("drawn as it is")
            } else {
                refused(&ended)
            }
        };
        let target = Target {
            kind: "results of an unfinished run that are drawn",
            name: &name,
            most,
        };
        torture(&mut tally, &workspace, &target, &judge);
    }
    tally.close();
}

/// A damaged folder: the command that made it restores or refuses it.
fn mended(workspace: &Workspace, job: &Job, whole: &Files) -> Result<&'static str, String> {
    let ended = workspace.run_bounded(job.again)?;
    let outcome = match ended.status {
        0 => expect_all(&workspace.files_if_any("out"), whole).and_then(|()| {
            if job.verified {
                workspace.succeed_bounded("verify out")?;
            }
            Ok("mended")
        }),
        _ => Ok("refused"),
    };
    workspace.fill("out", whole);
    outcome
}

#[test]
fn of_a_study_folder() {
    let (workspace, whole) = with_results(&JOBS[1]);
    let mut tally = Tally::new("damage");
    for name in whole.keys() {
        let records = name == "runs.jsonl" || name == "study.toml";
        let target = Target {
            kind: "studies that are verified",
            name: &format!("out/{name}"),
            most: cases(if records { 2 } else { 1 }, if records { 1_000 } else { 100 }),
        };
        torture(&mut tally, &workspace, &target, &|_| {
            seen(&workspace, "verify out")
        });
        if !long() && !records && !name.ends_with("points.csv") {
            continue;
        }
        let target = Target {
            kind: "studies that go on",
            most: cases(1, if records { 300 } else { 20 }),
            ..target
        };
        torture(&mut tally, &workspace, &target, &|_| {
            mended(&workspace, &JOBS[1], &whole)
        });
    }
    tally.close();
}

#[test]
fn of_designs_and_calibrations() {
    let mut tally = Tally::new("damage");
    for job in [&JOBS[10], &JOBS[12]] {
        let (workspace, whole) = with_results(job);
        for name in whole.keys() {
            let target = Target {
                kind: "designs and calibrations that are verified",
                name: &format!("out/{name}"),
                most: cases(1, 100),
            };
            torture(&mut tally, &workspace, &target, &|_| {
                seen(&workspace, "verify --checksums out")
            });
            // Lines of journals are read one by one, and runs of damaged lines are made again.
            if name.ends_with(".jsonl") {
                continue;
            }
            let target = Target {
                kind: "designs and calibrations that go on",
                most: cases(1, 10),
                ..target
            };
            torture(&mut tally, &workspace, &target, &|_| {
                mended(&workspace, job, &whole)
            });
        }
    }
    tally.close();
}

#[test]
fn of_kept_runs() {
    let workspace = workspace();
    let mut tally = Tally::new("damage");
    workspace
        .succeed_bounded("study kept.toml --quiet --threads 1 -o out")
        .unwrap();
    let whole = workspace.files_if_any("out");
    let of_runs = whole.keys().filter(|name| name.starts_with("runs/")).collect();
    for name in Chance::new().some(of_runs, if long() { usize::MAX } else { 4 }) {
        let target = Target {
            kind: "kept runs that are verified",
            name: &format!("out/{name}"),
            most: cases(1, 100),
        };
        torture(&mut tally, &workspace, &target, &|_| {
            seen(&workspace, "verify --checksums out")
        });
    }
    tally.close();
}

#[test]
fn of_shards() {
    let (workspace, _) = with_results(&JOBS[1]);
    let mut tally = Tally::new("damage");
    for shard in ["1", "2"] {
        let line = format!("study study.toml --quiet --threads 1 --shard {shard}/2 -o part{shard}");
        workspace.succeed_bounded(&line).unwrap();
    }
    let line = "study merge part1 part2 --quiet -o merged";
    workspace.succeed_bounded(line).unwrap();
    let whole = workspace.files_if_any("merged");
    for name in ["part1/runs.jsonl", "part2/study.toml", "part1/study.toml"] {
        let judge = |_: &Damage| {
            workspace.remove("merged");
            let ended = workspace.run_bounded(line)?;
            match ended.status {
                0 => expect_all(&workspace.files_if_any("merged"), &whole).map(|()| "the same all the same"),
                _ => Ok("refused"),
            }
        };
        let target = Target {
            kind: "shards that are merged",
            name,
            most: cases(2, 500),
        };
        torture(&mut tally, &workspace, &target, &judge);
    }
    tally.close();
}

#[test]
fn of_a_paper() {
    let (workspace, whole) = with_results(&JOBS[2]);
    let mut tally = Tally::new("damage");
    for name in whole.keys() {
        let kept = name.starts_with("found/") || name == "runs.jsonl";
        let target = Target {
            kind: "the paper's folder",
            name: &format!("out/{name}"),
            most: cases(usize::from(kept), if kept { 200 } else { 5 }),
        };
        if !long() && !kept {
            continue;
        }
        torture(&mut tally, &workspace, &target, &|_| {
            mended(&workspace, &JOBS[2], &whole)
        });
    }
    tally.close();
}

/// Leaves a run that was stopped after it had saved two checkpoints.
fn stopped(workspace: &Workspace) -> Files {
    let mut child = workspace.start_silent(JOBS[3].line);
    let has_both = || {
        let mut names = ["checkpoint", "checkpoint-previous"].iter();
        names.all(|name| workspace.exists(&format!("out/.slipfront/{name}.bin")))
    };
    wait_for("two checkpoints", || {
        assert!(child.try_wait().unwrap().is_none(), "no checkpoints were saved");
        if workspace.exists("out/case.toml") {
            try_send(&child, "-USR1");
        }
        if !has_both() {
            return false;
        }
        // A stopped process can neither end nor replace a checkpoint before it is killed.
        try_send(&child, "-STOP");
        let is_between = !has_both();
        if is_between {
            try_send(&child, "-CONT");
        }
        !is_between
    });
    child.kill().unwrap();
    child.wait().unwrap();
    workspace.files_if_any("out")
}

#[test]
fn of_checkpoints() {
    let (workspace, whole) = with_results(&JOBS[3]);
    let mut tally = Tally::new("damage");
    workspace.remove("out");
    let interrupted = stopped(&workspace);
    let resumed = |line: &str| {
        let ended = workspace.run_bounded(line)?;
        let now = workspace.files_if_any("out");
        workspace.fill("out", &interrupted);
        match ended.status {
            0 => expect_all(&now, &whole).map(|()| "resumed to the same answer"),
            _ => refused(&ended),
        }
    };
    for (name, most) in [
        ("out/.slipfront/checkpoint.bin", cases(8, 3_000)),
        ("out/.slipfront/journal.jsonl", cases(3, 500)),
        ("out/case.toml", cases(4, 1_000)),
        ("out/inputs/mask.png", cases(2, 500)),
    ] {
        let target = Target {
            kind: "runs that are resumed",
            name,
            most,
        };
        torture(&mut tally, &workspace, &target, &|_| resumed(JOBS[3].again));
    }
    for (name, most) in [
        ("out/.slipfront/checkpoint.bin", cases(1, 50)),
        ("out/.slipfront/checkpoint-previous.bin", cases(1, 200)),
    ] {
        let target = Target {
            kind: "runs that are resumed from the checkpoint before",
            name,
            most,
        };
        let line = "run --resume out --previous --quiet --threads 1";
        torture(&mut tally, &workspace, &target, &|_| resumed(line));
    }
    tally.close();
}
