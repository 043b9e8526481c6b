//! Killed, stopped, without disk: nothing is lost and nothing repeated.

use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::bench::{Bench, Results, errors};

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

fn start(bench: &Bench, out: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_slipfront"))
        .args(["study", "study.toml", "--quiet", "--out", out])
        .current_dir(bench.path(""))
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn count(results: &Results) -> usize {
    if results.records().exists() {
        results.recorded().len()
    } else {
        0
    }
}

/// Waits until `more` runs are recorded beyond those that are.
fn wait_for(results: &Results, more: usize) -> usize {
    let (before, began) = (count(results), Instant::now());
    while count(results) < before + more {
        assert!(began.elapsed() < Duration::from_secs(60), "nothing happens");
        sleep(Duration::from_millis(1));
    }
    before
}

/// A small generator, so that the random moments are the same ones every time.
fn random(state: &mut u64) -> u64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    *state >> 33
}

#[test]
fn killed_ten_times_the_answer_is_the_same_to_the_byte() {
    let bench = Bench::with(LONG);
    let whole = bench.study("whole");
    whole.assert_each_run_once(LONG_RUNS);

    let killed = bench.results("killed");
    let mut state = 42;
    for kill in 0..10 {
        let mut child = start(&bench, "killed");
        if kill > 0 {
            // The first is killed at any moment, however early.
            wait_for(&killed, 1 + (random(&mut state) % 5) as usize);
        }
        sleep(Duration::from_micros(random(&mut state) % 12_000));
        child.kill().unwrap();
        let status = child.wait().unwrap();
        assert_eq!(status.code(), None, "kill {kill} came too late: {status}");
    }
    let before = count(&killed);
    assert!((9..LONG_RUNS).contains(&before), "{before}");
    bench.study("killed").assert_same(&whole);
    killed.assert_each_run_once(LONG_RUNS);
}

#[test]
fn signals_stop_it_with_their_status_and_it_goes_on() {
    let bench = Bench::with(LONG);
    for (signal, status) in [("-INT", 130), ("-TERM", 143)] {
        let results = bench.results("stopped");
        let child = start(&bench, "stopped");
        wait_for(&results, 3);
        // The first of them is no reason to stop.
        for signal in ["-USR1", signal] {
            let kill = Command::new("kill")
                .args([signal, &child.id().to_string()])
                .status();
            assert!(kill.unwrap().success());
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(status), "{}", errors(&output));
        assert!(
            errors(&output).contains("goes on from there"),
            "{}",
            errors(&output)
        );
    }
    let stopped = count(&bench.results("stopped"));
    assert!((6..LONG_RUNS).contains(&stopped), "{stopped}");
    bench.study("stopped").assert_each_run_once(LONG_RUNS);
    bench.results("stopped").assert_same(&bench.study("whole"));
}

/// Runs `study.toml` under a limit of `ulimit`.
fn limited(bench: &Bench, limit: &str, arguments: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_slipfront");
    let script = format!("ulimit {limit}; exec {program} study study.toml --quiet {arguments}");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).current_dir(bench.path(""));
    shell.output().unwrap()
}

#[test]
fn a_full_disk_ends_it_with_a_sentence_and_it_goes_on() {
    let bench = Bench::with(crate::bench::SMALL);
    let output = limited(&bench, "-f 16", "-o full");
    assert_eq!(output.status.code(), Some(1), "{}", errors(&output));
    let said = errors(&output);
    assert!(
        said.contains("records.jsonl") && said.contains("finished runs are safe"),
        "{said}"
    );
    let before = count(&bench.results("full"));
    assert!((1..crate::bench::SMALL_RUNS).contains(&before), "{before}");
    let full = bench.study("full");
    full.assert_each_run_once(crate::bench::SMALL_RUNS);
    full.assert_same(&bench.study("whole"));
}

/// As `run` does, and not with an abort in the middle.
#[cfg(target_os = "linux")]
#[test]
fn what_the_system_does_not_give_is_refused_before_it_begins() {
    let bench =
        Bench::with("base.slider.blocks = [1500, 1500]\nbase.time.duration_star = 1\nstudy.replicates = 1");
    let output = limited(&bench, "-v 200000", "--threads 1 -o out");
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    assert!(
        errors(&output).contains("are available to this process: lower `slider.blocks`"),
        "{}",
        errors(&output)
    );
    assert!(!bench.path("out").exists());
}

#[test]
fn two_processes_do_not_share_a_folder() {
    let bench = Bench::with(LONG);
    let mut first = start(&bench, "shared");
    wait_for(&bench.results("shared"), 1);
    let second = bench.output(&["study.toml", "-o", "shared"]);
    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(second.status.code(), Some(2));
    assert!(
        errors(&second).contains("another study is running"),
        "{}",
        errors(&second)
    );
}
