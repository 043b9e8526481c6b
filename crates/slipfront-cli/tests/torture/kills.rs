//! Killed at random moments, a command leaves nothing wrong behind, and goes on to the same answer.

use std::process::Command;
use std::time::{Duration, Instant};

use crate::bench::{Bench, Files};
use crate::jobs::{JOBS, Job, bench, expect_all};
use crate::tally::{Chance, Tally, cases};

/// Kills after which a job goes on to its end.
const IN_A_ROW: usize = 4;

fn kill_and_look(bench: &Bench, job: &Job, whole: &Files, after: Duration) -> Result<&'static str, String> {
    let line = job.next(bench, whole);
    let mut child = bench.start(line);
    for _ in 0..4 {
        std::thread::sleep(after / 4);
        if job.saves {
            let _ = Command::new("kill")
                .args(["-USR1", &child.id().to_string()])
                .output();
        }
    }
    child.kill().unwrap();
    match child.wait().unwrap().code() {
        None => job.expect_honest(bench, whole).map(|()| "killed"),
        Some(0) => expect_all(&bench.files("out"), whole).map(|()| "had ended"),
        Some(status) => Err(format!("`{line}` ends with status {status} by itself")),
    }
}

fn torture(job: &Job, kills: usize) {
    let bench = bench();
    let mut tally = Tally::new("kills at random moments");
    let mut chance = Chance::new();
    let whole = job.undisturbed();
    let began = Instant::now();
    bench.done(job.line).unwrap();
    let takes = began.elapsed();
    for round in 0..kills.div_ceil(IN_A_ROW) {
        // Every second time a finished folder is worked on again.
        if round % 2 == 1 {
            bench.remove("out");
        }
        for _ in 0..IN_A_ROW {
            let after = takes.mul_f64(chance.below(1000) as f64 / 1000.0);
            let ended = kill_and_look(&bench, job, &whole, after);
            tally.note(job.name, &format!("killed after {after:?}"), ended);
        }
        let ended = job.finish(&bench, &whole).map(|()| "went on to the same answer");
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
