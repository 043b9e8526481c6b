//! A study that is killed, stopped or out of disk space loses nothing and repeats nothing.

use std::process::Output;
use std::thread::sleep;
use std::time::Duration;

use super::results::{SMALL, SMALL_RUNS};
use crate::support::process::{Running, program, send, stderr};
use crate::support::workspace::Workspace;

/// Long enough to be interrupted: 90 runs of some ten milliseconds.
const LONG: &str = r#"
[base.slider]
blocks = [14, 14]
[[base.texture]]
shape = "cavity"
coverage = 10
[study]
replicates = 5
reference = { texture = [] }
[[axes]]
key = "drive.v_star"
logspace = [0.03, 0.06, 3]
[[axes]]
key = "friction.r_star"
list = [0.4, 0.5, 0.6]
"#;
const LONG_RUNS: usize = 90;

fn start(workspace: &Workspace, out: &str) -> Running {
    workspace.start(&format!("study study.toml --quiet --out {out}"))
}

/// A small generator, so that the random moments are the same in every test run.
fn random(state: &mut u64) -> u64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    *state >> 33
}

#[test]
fn killed_ten_times_the_answer_is_the_same_to_the_byte() {
    let workspace = Workspace::with_study(LONG);
    let whole = workspace.study("whole");
    whole.assert_each_run_once(LONG_RUNS);

    let killed = workspace.results("killed");
    let mut state = 42;
    for kill in 0..10 {
        let mut child = start(&workspace, "killed");
        if kill > 0 {
            // The first one is killed at any moment, however early.
            killed.wait_for_runs(1 + (random(&mut state) % 5) as usize);
        }
        sleep(Duration::from_micros(random(&mut state) % 12_000));
        child.kill().unwrap();
        let status = child.wait().unwrap();
        assert_eq!(status.code(), None, "kill {kill} came too late: {status}");
    }
    let before = killed.recorded().len();
    assert!((9..LONG_RUNS).contains(&before), "{before}");
    workspace.study("killed").assert_same(&whole);
    killed.assert_each_run_once(LONG_RUNS);
}

#[test]
fn signals_stop_it_with_their_status_and_it_goes_on() {
    let workspace = Workspace::with_study(LONG);
    for (signal, status) in [("-INT", 130), ("-TERM", 143)] {
        let results = workspace.results("stopped");
        let child = start(&workspace, "stopped");
        results.wait_for_runs(3);
        // SIGUSR1, the first of them, does not stop the study.
        for signal in ["-USR1", signal] {
            send(&child, signal);
        }
        let output = child.ended();
        assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("resumes from there"),
            "{}",
            stderr(&output)
        );
    }
    let stopped = workspace.results("stopped").recorded().len();
    assert!((6..LONG_RUNS).contains(&stopped), "{stopped}");
    workspace.study("stopped").assert_each_run_once(LONG_RUNS);
    workspace
        .results("stopped")
        .assert_same(&workspace.study("whole"));
}

/// Runs `study.toml` under a limit set with `ulimit`.
fn limited(workspace: &Workspace, limit: &str, arguments: &str) -> Output {
    let program = program();
    workspace.shell(&format!(
        "ulimit {limit}; exec {program} study study.toml --quiet {arguments}"
    ))
}

#[test]
fn a_full_disk_ends_it_with_a_sentence_and_it_goes_on() {
    let workspace = Workspace::with_study(SMALL);
    let output = limited(&workspace, "-f 16", "-o full");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let said = stderr(&output);
    assert!(
        said.contains("runs.jsonl") && said.contains("finished runs are safe"),
        "{said}"
    );
    let before = workspace.results("full").recorded().len();
    assert!((1..SMALL_RUNS).contains(&before), "{before}");
    let full = workspace.study("full");
    full.assert_each_run_once(SMALL_RUNS);
    full.assert_same(&workspace.study("whole"));
}

/// A study for which the system refuses memory or threads is refused before it begins, like a run, and does
/// not abort later.
#[cfg(target_os = "linux")]
#[test]
fn what_the_system_does_not_give_is_refused_before_it_begins() {
    let workspace = Workspace::with_study(
        "base.slider.blocks = [2000, 2000]\nbase.time.duration_star = 1\nstudy.replicates = 1",
    );
    // There is memory for a thread, but not for the blocks.
    let output = limited(&workspace, "-v 400000", "--threads 1 -o out");
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("are available to this process: reduce `slider.blocks`"),
        "{}",
        stderr(&output)
    );
    assert!(!workspace.path("out").exists());
}

#[test]
fn two_processes_do_not_share_a_folder() {
    let workspace = Workspace::with_study(&LONG.replace("replicates = 5", "replicates = 100"));
    let first = start(&workspace, "shared");
    workspace.results("shared").wait_for_runs(1);
    // However long the second one takes, the first one has not ended.
    send(&first, "-STOP");
    let second = workspace.output("study study.toml -o shared");
    drop(first);
    assert_eq!(second.status.code(), Some(2));
    assert!(
        stderr(&second).contains("another slipfront is running"),
        "{}",
        stderr(&second)
    );
}
