//! Each file-system call of a command fails in turn.

use crate::bounded::ExitedProcess;
use crate::jobs::{JOBS, Job, expect_all, expect_nothing_unfinished, workspace};
use crate::support::workspace::Workspace;
use crate::tally::{Chance, Tally, cases, long};
use crate::watcher::watcher;

/// A file-system call of a command.
#[derive(Clone, Debug)]
struct Call {
    number: usize,
    name: String,
    path: String,
}

/// A fault to inject into a call.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fault {
    action: &'static str,
    /// Whether all later calls fail as well.
    lasts: bool,
}

const FAULTS: [Fault; 9] = [
    once("EIO"),
    once("ENOSPC"),
    once("EACCES"),
    once("EINTR"),
    once("short"),
    once("kill"),
    once("torn"),
    from_then_on("ENOSPC"),
    from_then_on("EIO"),
];

const fn once(action: &'static str) -> Fault {
    Fault { action, lasts: false }
}

const fn from_then_on(action: &'static str) -> Fault {
    Fault { action, lasts: true }
}

impl Fault {
    fn kills(self) -> bool {
        ["kill", "torn"].contains(&self.action)
    }

    /// Whether the fault can occur at this call on a real system.
    fn can_hit(self, call: &Call) -> bool {
        let name = call.name.as_str();
        match self.action {
            "ENOSPC" => [
                "openat",
                "open",
                "mkdir",
                "mkdirat",
                "write",
                "pwrite64",
                "writev",
                "fsync",
                "fdatasync",
                "rename",
                "renameat",
                "renameat2",
                "link",
                "linkat",
                "ftruncate",
                "fallocate",
                "copy_file_range",
                "close",
            ]
            .contains(&name),
            "EACCES" => !["read", "write", "pwrite64", "fsync", "fdatasync", "close"].contains(&name),
            "EINTR" => [
                "open",
                "openat",
                "read",
                "write",
                "pwrite64",
                "fsync",
                "fdatasync",
                "flock",
            ]
            .contains(&name),
            "short" => ["read", "write", "pread64", "pwrite64"].contains(&name),
            "torn" => ["write", "pwrite64"].contains(&name),
            _ => true,
        }
    }
}

/// Outcome of a line with a fault.
struct Hit {
    /// Exit of the command; none if it was killed.
    ended: Result<Option<ExitedProcess>, String>,
    /// The first call that failed, if one did.
    call: Option<Call>,
    calls: Vec<Call>,
}

/// Runs a line with a fault from the call with this number on.
fn hit(workspace: &Workspace, line: &str, fault: Fault, number: usize) -> Hit {
    let log = tempfile::NamedTempFile::new().unwrap();
    let (from, to) = (
        number.to_string(),
        if fault.lasts { 0 } else { number }.to_string(),
    );
    let (work, log_path) = (workspace.path(""), log.path().display().to_string());
    let work = work.to_str().unwrap().trim_end_matches('/');
    let watcher = [watcher().unwrap(), work, fault.action, &from, &to, &log_path];
    let ended = workspace.run_watched(&watcher, line);
    let (mut call, mut calls) = (None, Vec::new());
    for line in std::fs::read_to_string(log.path()).unwrap_or_default().lines() {
        let mut words = line.trim_start_matches('*').splitn(3, ' ');
        let mut word = || words.next().unwrap_or_default().to_owned();
        let made = Call {
            number: word().parse().unwrap_or_default(),
            name: word(),
            path: word(),
        };
        if line.starts_with('*') && call.is_none() {
            call = Some(made.clone());
        }
        calls.push(made);
    }
    Hit { ended, call, calls }
}

/// Function that describes the outcome of a fault at a call, or reports a finding.
type Judge<'a> = dyn Fn(Fault, Option<ExitedProcess>, &Call) -> Result<&'static str, String> + 'a;

/// The text of a system error.
fn cause(action: &str) -> &'static str {
    match action {
        "EIO" => "Input/output error",
        "ENOSPC" => "No space left on device",
        "EACCES" => "Permission denied",
        _ => "Interrupted system call",
    }
}

/// Whether a message names a file: its name, or its folder if it has no final name yet.
fn names(said: &str, path: &str) -> bool {
    let path = path.split("/.slipfront/tmp/").next().unwrap_or_default();
    let mut parts = path.rsplit('/').filter(|part| !part.starts_with('.'));
    parts.next().is_none_or(|part| said.contains(part))
}

/// Tries every fault at every call of a line, or a sample of them; `judge` describes each outcome.
fn every_fault(
    tally: &mut Tally,
    workspace: &Workspace,
    kind: &str,
    line: &str,
    short: usize,
    judge: &Judge,
    prepare: &dyn Fn(),
) {
    prepare();
    let Hit { ended, calls, .. } = hit(workspace, line, once("EIO"), 0);
    ended.unwrap();
    assert!(
        calls.len() > 10,
        "only {} calls of `{line}` were seen",
        calls.len()
    );
    let mut tried = Vec::new();
    for fault in FAULTS {
        tried.extend(
            calls
                .iter()
                .filter(|call| fault.can_hit(call))
                .map(|call| (fault, call.number)),
        );
    }
    let most = cases(short, tried.len());
    let tried = Chance::new().some(tried, most);
    for (fault, number) in tried {
        prepare();
        let Hit { ended, call, .. } = hit(workspace, line, fault, number);
        let Some(call) = call else {
            tally.note(kind, "", Ok("had ended before"));
            continue;
        };
        let case = format!("{fault:?} at call {number}, {} of {}", call.name, call.path);
        let ended = ended.and_then(|ended| judge(fault, ended, &call));
        if long()
            && let Err(finding) = &ended
        {
            eprintln!("FOUND {kind}, {case}: {finding}");
        }
        tally.note(kind, &case, ended);
    }
}

/// Checks that a failed command names a file and the cause.
fn expect_sentence(said: &str, fault: Fault, call: &Call) -> Result<(), String> {
    if fault.lasts || (said.contains(cause(fault.action)) && names(said, &call.path)) {
        return Ok(());
    }
    Err(format!("the sentence does not name both file and cause: {said}"))
}

fn torture(job: &Job, short: usize) {
    if watcher().is_none() {
        return;
    }
    let workspace = workspace();
    let mut tally = Tally::new("faults");
    let whole = job.undisturbed();
    let judge = |fault: Fault, ended: Option<ExitedProcess>, call: &Call| {
        let outcome = match &ended {
            None if fault.kills() => "killed",
            None => return Err("it was killed".to_owned()),
            Some(ended) if ended.status == 0 => {
                expect_all(&workspace.files_if_any("out"), &whole)?;
                "harmless"
            }
            Some(ended) => {
                // Differences that `verify` reports are the expected answer.
                expect_sentence(&format!("{}{}", ended.stdout, ended.stderr), fault, call)?;
                "refused"
            }
        };
        job.expect_honest(&workspace, &whole)?;
        job.finish(&workspace, &whole)?;
        Ok(outcome)
    };
    let prepare = || job.prepare(&workspace);
    every_fault(
        &mut tally, &workspace, job.name, job.line, short, &judge, &prepare,
    );
    tally.close();
}

#[test]
fn of_a_run() {
    torture(&JOBS[0], 5);
}

#[test]
fn of_a_study() {
    torture(&JOBS[1], 4);
}

#[test]
fn of_a_paper() {
    torture(&JOBS[2], 3);
}

#[test]
fn of_a_run_with_checkpoints() {
    torture(&JOBS[3], 4);
}

#[test]
fn of_a_plot() {
    torture(&JOBS[4], 4);
}

#[test]
fn of_a_movie() {
    torture(&JOBS[5], 3);
}

#[test]
fn of_a_texture() {
    torture(&JOBS[6], 3);
}

#[test]
fn of_a_repeated_run() {
    torture(&JOBS[7], 3);
}

#[test]
fn of_an_export() {
    torture(&JOBS[8], 3);
}

#[test]
fn of_a_merge() {
    torture(&JOBS[9], 3);
}

#[test]
fn of_a_calibration() {
    torture(&JOBS[10], 3);
}

#[test]
fn of_a_comparison_of_meshes() {
    torture(&JOBS[11], 3);
}

#[test]
fn of_a_design() {
    torture(&JOBS[12], 3);
}

/// A kill at the worst moment: a file is complete, but does not have its final name yet.
#[test]
fn a_file_that_was_not_renamed_goes_with_the_next() {
    if watcher().is_none() {
        return;
    }
    let workspace = workspace();
    for job in &JOBS[4..7] {
        let whole = job.undisturbed();
        job.prepare(&workspace);
        let Hit { calls, .. } = hit(&workspace, job.line, once("EIO"), 0);
        let rename = calls.iter().find(|call| call.name.starts_with("rename"));
        job.prepare(&workspace);
        let Hit { ended, call, .. } = hit(&workspace, job.line, once("kill"), rename.unwrap().number);
        assert!(ended.unwrap().is_none() && call.unwrap().name.starts_with("rename"));
        expect_nothing_unfinished(&workspace.files("out")).unwrap_err();
        job.finish(&workspace, &whole).unwrap();
    }
}

/// A command that only reads gives the right answer or none.
#[test]
fn of_those_who_read() {
    if watcher().is_none() {
        return;
    }
    let workspace = workspace();
    let mut tally = Tally::new("faults");
    let mut whole = JOBS[0].undisturbed();
    workspace.fill("out", &whole);
    let series = whole.get_mut("series.csv").unwrap();
    let middle = series.len() / 2;
    series[middle] ^= 1;
    workspace.fill("damaged", &whole);
    workspace
        .succeed_bounded("study study.toml --quiet -o study")
        .unwrap();
    workspace
        .succeed_bounded("study kept.toml --quiet -o kept")
        .unwrap();
    let series = workspace
        .files_if_any("kept")
        .into_keys()
        .find(|name| name.ends_with("series.csv"));
    workspace.write(&format!("kept/{}", series.unwrap()), "changed");
    for (line, status, short) in [
        ("verify out", 0, 8),
        ("verify study", 0, 3),
        ("verify damaged", 1, 8),
        ("verify kept", 1, 3),
    ] {
        let judge = |fault: Fault, ended: Option<ExitedProcess>, _: &Call| match ended {
            None if fault.kills() => Ok("killed"),
            Some(ended) if ended.status == status => Ok("harmless"),
            Some(ended) if ended.status != 0 => Ok("refused"),
            ended => Err(format!("{ended:?}")),
        };
        let prepare = || {
            workspace.remove("temporary");
            std::fs::create_dir(workspace.path("temporary")).unwrap();
        };
        every_fault(&mut tally, &workspace, line, line, short, &judge, &prepare);
    }
    tally.close();
}

/// A failed `stat` is not taken for a missing file: a resumed run reports the cause, or writes all of its
/// files.
#[test]
fn of_a_look_of_a_run_that_goes_on() {
    if watcher().is_none() {
        return;
    }
    let (workspace, job, fault) = (workspace(), &JOBS[0], once("EIO"));
    let whole = job.undisturbed();
    job.prepare(&workspace);
    let Hit { calls, .. } = hit(&workspace, job.line, fault, 0);
    // Number of files before the results: the case, and the files that it reads.
    let before = 1 + whole.keys().filter(|name| name.starts_with("inputs/")).count();
    let mut placed = calls.iter().filter(|call| call.name.starts_with("rename"));
    let stopped_at = placed.nth(before).unwrap().number;
    job.prepare(&workspace);
    hit(&workspace, job.line, once("kill"), stopped_at);
    let stopped = workspace.files("out");
    let prepare = || {
        job.prepare(&workspace);
        workspace.fill("out", &stopped);
    };
    let line = "run --resume out --quiet --threads 1";
    prepare();
    let Hit { ended, calls, .. } = hit(&workspace, line, fault, 0);
    assert_eq!(ended.unwrap().unwrap().status, 0);
    // A random sample may miss these: the hidden folder, the run folder, and the file without which a picture
    // is left out.
    let is_tried = |path: &str| {
        let places = ["out", ".slipfront", "journal.jsonl", "tmp", "kymograph.nc"];
        long() || places.iter().any(|place| path.ends_with(place))
    };
    let looks = calls
        .iter()
        .filter(|call| call.name.contains("stat") && is_tried(&call.path));
    let looks: Vec<usize> = looks.map(|call| call.number).collect();
    assert!(looks.len() > 20, "only {looks:?} were seen");
    let mut findings = Vec::new();
    for number in looks {
        prepare();
        let Hit { ended, call, .. } = hit(&workspace, line, fault, number);
        let (ended, call) = (ended.unwrap().unwrap(), call.unwrap());
        let as_it_should = match ended.status {
            0 => expect_all(&workspace.files("out"), &whole),
            _ => expect_sentence(&format!("{}{}", ended.stdout, ended.stderr), fault, &call),
        };
        if let Err(finding) = as_it_should {
            findings.push(format!("{call:?}: {finding}"));
        }
    }
    assert!(findings.is_empty(), "{}", findings.join("\n"));
}

/// The watcher sees the program's calls however they are made: this program renames without libc.
#[test]
fn renames_are_seen() {
    if watcher().is_none() {
        return;
    }
    let workspace = workspace();
    let Hit { ended, calls, .. } = hit(&workspace, JOBS[0].line, once("EIO"), 0);
    assert_eq!(ended.unwrap().unwrap().status, 0);
    let count = |start: &str| calls.iter().filter(|call| call.name.starts_with(start)).count();
    let files = workspace.files_if_any("out").len();
    // Folders are synced too: the parent of the new run folder; the hidden folder, and the run folder with
    // the journal; the run folder with the new folder of inputs, then with its case, and the folder of
    // inputs; both again before the manifest, and the complete run folder after it; and the hidden folder
    // before its journal is removed. The journal itself is synced for every file, before that file gets its
    // name.
    assert_eq!((count("rename"), count("fsync")), (files, files + 10));
    let places = |start: &str| {
        let calls = calls.iter().enumerate();
        let places = calls
            .filter(|(_, call)| call.name.starts_with(start))
            .map(|(place, _)| place);
        places.collect::<Vec<usize>>()
    };
    let synced = places("fdatasync");
    assert_eq!(synced.len(), files);
    assert!(
        synced
            .iter()
            .zip(places("rename"))
            .all(|(synced, renamed)| *synced < renamed)
    );
}
