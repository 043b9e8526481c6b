//! Killed at random moments, a command leaves nothing wrong behind, and goes on to the same answer.

use std::time::{Duration, Instant};

use crate::jobs::{JOBS, Job, expect_all, workspace};
use crate::support::process::try_send;
use crate::support::workspace::{Files, Workspace};
use crate::tally::{Chance, Tally, cases};

/// Kills after which a job goes on to its end.
const IN_A_ROW: usize = 4;

fn kill_and_look(
    workspace: &Workspace,
    job: &Job,
    whole: &Files,
    after: Duration,
) -> Result<&'static str, String> {
    let line = job.next(workspace, whole);
    let mut child = workspace.start_silent(line);
    for _ in 0..4 {
        std::thread::sleep(after / 4);
        if job.saves {
            try_send(&child, "-USR1");
        }
    }
    child.kill().unwrap();
    match child.wait().unwrap().code() {
        None => job.expect_honest(workspace, whole).map(|()| "killed"),
        Some(0) => expect_all(&workspace.files_if_any("out"), whole).map(|()| "had ended"),
        Some(status) => Err(format!("`{line}` ends with status {status} by itself")),
    }
}

fn torture(job: &Job, kills: usize) {
    let workspace = workspace();
    let mut tally = Tally::new("kills at random moments");
    let mut chance = Chance::new();
    let whole = job.undisturbed();
    let began = Instant::now();
    workspace.succeed_bounded(job.line).unwrap();
    let takes = began.elapsed();
    for round in 0..kills.div_ceil(IN_A_ROW) {
        // Every second time a finished folder is worked on again.
        if round % 2 == 1 {
            workspace.remove("out");
        }
        for _ in 0..IN_A_ROW {
            let after = takes.mul_f64(chance.below(1000) as f64 / 1000.0);
            let ended = kill_and_look(&workspace, job, &whole, after);
            tally.note(job.name, &format!("killed after {after:?}"), ended);
        }
        let ended = job
            .finish(&workspace, &whole)
            .map(|()| "went on to the same answer");
        tally.note(job.name, "after kills", ended);
    }
    tally.close();
}

#[test]
fn a_killed_run_is_repeated() {
    torture(&JOBS[0], cases(4, 200));
}

#[test]
fn a_killed_study_goes_on() {
    torture(&JOBS[1], cases(4, 200));
}

#[test]
fn a_killed_paper_goes_on() {
    torture(&JOBS[2], cases(4, 200));
}

#[test]
fn a_killed_run_is_resumed() {
    torture(&JOBS[3], cases(4, 200));
}
