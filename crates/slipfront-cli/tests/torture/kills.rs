//! A command that is killed at random moments leaves nothing wrong behind, and continues to the same answer.

use std::time::{Duration, Instant};

use crate::jobs::{
    JOBS, Job, expect_all, expect_nothing_temporary, expect_nothing_unfinished, expect_sound, workspace,
};
use crate::support::process::try_send;
use crate::support::workspace::{Files, Workspace};
use crate::tally::{Chance, Tally, cases};

/// Number of kills after which a job continues to its end.
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
    match child.ended().status.code() {
        None => job.expect_honest(workspace, whole).map(|()| "killed"),
        Some(0) => expect_all(&workspace.files_if_any("out"), whole).map(|()| "had ended"),
        Some(status) => Err(format!("`{line}` ends with status {status} by itself")),
    }
}

/// Duration of an undisturbed job.
fn time_of(workspace: &Workspace, job: &Job) -> Duration {
    job.prepare(workspace);
    let began = Instant::now();
    workspace.succeed_bounded(job.line).unwrap();
    began.elapsed()
}

fn torture(job: &Job, kills: usize) {
    let workspace = workspace();
    let mut tally = Tally::new("kills at random moments");
    let mut chance = Chance::new();
    let whole = job.undisturbed();
    let takes = time_of(&workspace, job);
    for round in 0..kills.div_ceil(IN_A_ROW) {
        // Every second round works on a finished folder again.
        if round % 2 == 1 {
            job.prepare(&workspace);
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

#[test]
fn a_killed_plot_is_repeated() {
    torture(&JOBS[4], cases(8, 200));
}

#[test]
fn a_killed_movie_is_repeated() {
    torture(&JOBS[5], cases(8, 200));
}

#[test]
fn a_killed_texture_is_repeated() {
    torture(&JOBS[6], cases(8, 200));
}

#[test]
fn a_killed_repetition_of_a_run_is_repeated() {
    torture(&JOBS[7], cases(8, 200));
}

#[test]
fn a_killed_export_is_repeated() {
    torture(&JOBS[8], cases(4, 200));
}

#[test]
fn a_killed_merge_goes_on() {
    torture(&JOBS[9], cases(4, 200));
}

#[test]
fn a_killed_calibration_goes_on() {
    torture(&JOBS[10], cases(4, 200));
}

#[test]
fn a_killed_comparison_of_meshes_goes_on() {
    torture(&JOBS[11], cases(4, 200));
}

#[test]
fn a_killed_design_goes_on() {
    torture(&JOBS[12], cases(4, 200));
}

/// Names in the folder of the workspace that are not inputs of an export.
fn made(workspace: &Workspace) -> Vec<String> {
    let names = std::fs::read_dir(workspace.path("")).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names
        .filter(|name| name == "crate" || name.starts_with('.'))
        .collect()
}

/// A crate is complete or absent, however the command ends; a kill leaves only a hidden name, which the next
/// call removes.
#[test]
fn a_killed_export_leaves_no_crate() {
    let workspace = workspace();
    let export = &JOBS[4];
    let line = "export done --ro-crate -o crate";
    export.prepare(&workspace);
    let began = Instant::now();
    workspace.succeed_bounded(line).unwrap();
    let takes = began.elapsed();
    // The description contains the date, which may change during the test.
    let files = || {
        let mut files = workspace.files("crate");
        files.remove("ro-crate-metadata.json").map(|_| files)
    };
    let whole = files();
    let mut tally = Tally::new("kills of an export at random moments");
    let mut chance = Chance::new();
    for signal in ["-KILL", "-KILL", "-TERM", "-INT"] {
        for _ in 0..cases(3, 100) {
            workspace.remove("crate");
            let child = workspace.start_silent(line);
            let after = takes.mul_f64(chance.below(1000) as f64 / 1000.0);
            std::thread::sleep(after);
            try_send(&child, signal);
            let had_ended = child.ended().status.success();
            let now = made(&workspace);
            let ended = match now.iter().position(|name| name == "crate") {
                Some(_) if files() != whole => Err("half of a crate has its name".to_owned()),
                None if had_ended => Err("there is no crate".to_owned()),
                None if signal != "-KILL" && !now.is_empty() => Err(format!("{now:?} is left behind")),
                Some(_) => Ok("had ended"),
                None => workspace
                    .succeed_bounded(line)
                    .map(|_| "stopped, and made by the next call"),
            };
            let ended = ended.and_then(|ended| match (made(&workspace).as_slice(), files() == whole) {
                ([_], true) => Ok(ended),
                (now, _) => Err(format!("{now:?} is there after the next call")),
            });
            tally.note("export", &format!("{signal} after {after:?}"), ended);
        }
    }
    tally.close();
}

/// A signal that a command handles leaves nothing that the next command would have to remove.
#[test]
fn what_a_signal_stops_leaves_nothing_behind() {
    let workspace = workspace();
    let mut tally = Tally::new("signals at random moments");
    let mut chance = Chance::new();
    // The other jobs may leave files: a run saves a checkpoint, and a design the best texture so far.
    for job in &JOBS[4..12] {
        let whole = job.undisturbed();
        let takes = time_of(&workspace, job);
        for signal in ["-INT", "-TERM"] {
            for _ in 0..cases(5, 100) {
                job.prepare(&workspace);
                let child = workspace.start_silent(job.line);
                let after = takes.mul_f64(chance.below(1000) as f64 / 1000.0);
                std::thread::sleep(after);
                try_send(&child, signal);
                let ended = match child.ended().status.code() {
                    None | Some(130 | 143) => Ok("stopped"),
                    Some(0) => Ok("had ended"),
                    Some(status) => Err(format!("`{}` ends with status {status}", job.line)),
                };
                let ended = ended.and_then(|ended| {
                    let now = workspace.files_if_any("out");
                    expect_sound(&now, &whole)?;
                    expect_nothing_unfinished(&now)?;
                    expect_nothing_temporary(&workspace)?;
                    Ok(ended)
                });
                tally.note(job.name, &format!("{signal} after {after:?}"), ended);
            }
        }
    }
    tally.close();
}
