//! Runs that are stopped and resumed: the same bytes as without a stop, and never from a checkpoint that is not theirs.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rstest::rstest;

use super::{Bench, program};

/// Around a second: long enough to be stopped several times.
const SLOW: &str = "[slider]\nblocks = [60, 50]\nedges = ['periodic', 'free']\n[drive]\nv_star = 0.01\n\
                    [[texture]]\nshape = 'mask'\nfile = 'spot.png'\n";

/// The reference kernel, and snapshots by the step.
const REVERSAL: &str = "[slider]\nblocks = [60, 50]\n[drive]\nv_star = 0.004\n[friction]\nlaw = 'reversal'\n\
                       [output]\nsnapshots = { every = 75 }\n";

/// Enough blocks for two threads, until the onset.
const WIDE: &str = "[slider]\nblocks = [400, 350]\n[drive]\nv_star = 0.1\n[time]\nstop = 'after_onset'\n";

fn bench() -> Bench {
    let bench = Bench::new();
    for (name, text) in [
        ("slow.toml", SLOW),
        ("reversal.toml", REVERSAL),
        ("wide.toml", WIDE),
    ] {
        bench.write(name, text);
    }
    let cavity = "texture small.toml -o spot.png --set texture.0={shape=\"cavity\",coverage=15}";
    bench.done(&format!("{cavity} --set slider.blocks=[60,50]"));
    bench
}

fn start(bench: &Bench, line: &str) -> Child {
    Command::new(program())
        .args(line.split_whitespace())
        .current_dir(bench.path())
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

fn send(child: &Child, signal: &str) {
    let kill = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Waits until the child has caught the signals: before, they end it.
fn wait_for_signals(child: &Child) {
    let status = format!("/proc/{}/status", child.id());
    // SIGXCPU, number 24, is caught last; who has ended needs no waiting for.
    let caught = || {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let mask = text.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.is_none_or(|mask| mask >> 23 & 1 == 1)
    };
    if cfg!(target_os = "linux") {
        wait_for("signals to be caught", caught);
    } else {
        sleep(Duration::from_millis(300));
    }
}

/// Waits until it is so.
fn wait_for(what: &str, so: impl Fn() -> bool) {
    let began = Instant::now();
    while !so() {
        assert!(began.elapsed() < Duration::from_secs(60), "no {what}");
        sleep(Duration::from_millis(1));
    }
}

/// Begins a run and stops it so many times, each of which saves a checkpoint.
fn stopped(bench: &Bench, line: &str, folder: &str, times: usize) {
    let mut line = line.to_owned();
    for _ in 0..times {
        let child = start(bench, &line);
        wait_for_signals(&child);
        sleep(Duration::from_millis(60));
        send(&child, "-INT");
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        line = format!("run --resume {folder}");
    }
}

#[rstest]
#[case("slow.toml", "-INT", 130)]
#[case("reversal.toml", "-TERM", 143)]
#[case("wide.toml", "-INT", 130)]
fn stopped_any_number_of_times_it_writes_the_same_bytes(
    #[case] case: &str,
    #[case] signal: &str,
    #[case] status: i32,
) {
    let bench = bench();
    bench.done(&format!("run {case} -o whole --threads 1"));
    let mut stops = 0;
    let mut line = format!("run {case} -o stopped");
    loop {
        // Any number of threads, each time another one.
        let child = start(&bench, &format!("{line} --threads {}", 1 + stops % 3));
        wait_for_signals(&child);
        sleep(Duration::from_millis(40 + 37 * (stops % 4)));
        let _ = Command::new("kill")
            .args([signal, &child.id().to_string()])
            .output();
        let output = child.wait_with_output().unwrap();
        if output.status.success() {
            break;
        }
        assert_eq!(output.status.code(), Some(status), "{}", said(&output));
        assert!(
            said(&output).contains("run --resume stopped"),
            "{}",
            said(&output)
        );
        stops += 1;
        line = "run --resume stopped".to_owned();
    }
    assert!(stops >= 2, "it was stopped {stops} times only");
    bench.assert_same("whole", "stopped");
    bench.done("verify stopped");
}

/// Signals with which queues warn before they kill.
#[cfg(target_os = "linux")]
#[rstest]
#[case("-USR2", 140)]
#[case("-XCPU", 152)]
fn a_warning_of_the_queue_stops_it(#[case] signal: &str, #[case] status: i32) {
    let bench = bench();
    let child = start(&bench, "run slow.toml --quiet -o warned");
    wait_for_signals(&child);
    send(&child, signal);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(status), "{}", said(&output));
    assert!(
        said(&output).contains("`slipfront run --resume warned` goes on"),
        "{}",
        said(&output)
    );
    bench.done("run --resume warned");
    bench.done("verify warned");
}

/// A full disk under the log, or a terminal that has gone, costs what would have been said, and nothing else.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_said_is_no_failure() {
    let bench = bench();
    let full = || File::options().write(true).open("/dev/full").unwrap();
    let start = |line: &str| {
        let mut command = std::process::Command::new(super::program());
        command.current_dir(bench.path()).args(line.split_whitespace());
        command.stdout(Stdio::null()).stderr(full()).spawn().unwrap()
    };
    let status = |line: &str, signal: Option<&str>| {
        let mut child = start(line);
        if let Some(signal) = signal {
            wait_for("case", || bench.exists("mute/case.toml"));
            wait_for_signals(&child);
            send(&child, signal);
        }
        child.wait().unwrap().code()
    };
    assert_eq!(status("run nowhere.toml", None), Some(2));
    assert_eq!(status("run slow.toml -o mute", Some("-TERM")), Some(143));
    assert_eq!(status("run --resume mute", Some("-USR1")), Some(0));
    bench.done("verify mute");
}

#[test]
fn a_signal_saves_and_the_run_goes_on() {
    let bench = bench();
    bench.done("run slow.toml -o whole");
    let child = start(&bench, "run slow.toml -o saved");
    wait_for("case.toml", || bench.exists("saved/case.toml"));
    send(&child, "-USR1");
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(
        said(&output).contains("saved a checkpoint of step "),
        "{}",
        said(&output)
    );
    // A complete run needs no checkpoint.
    bench.assert_same("whole", "saved");
}

#[test]
fn by_the_clock_it_saves_now_and_then() {
    let bench = bench();
    let mut child = start(
        &bench,
        "run slow.toml -o clocked --checkpoint 10ms --set time.duration_star=20000",
    );
    wait_for("two checkpoints", || {
        bench.exists("clocked/.slipfront/checkpoint-previous.bin")
    });
    child.kill().unwrap();
    child.wait().unwrap();
    // Without them, a signal has nothing to save.
    let mut child = start(
        &bench,
        "run slow.toml -o off --checkpoint off --set time.duration_star=20000",
    );
    wait_for("case.toml", || bench.exists("off/case.toml"));
    send(&child, "-USR1");
    let mut lines = BufReader::new(child.stderr.take().unwrap())
        .lines()
        .map(Result::unwrap);
    assert!(lines.any(|line| line.contains("no checkpoint is saved")));
    send(&child, "-INT");
    assert!(lines.any(|line| line.contains("nothing is saved")));
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(!bench.exists("off/.slipfront/checkpoint.bin"));
    for wrong in ["soon", "-5min", "5"] {
        let said = bench.refused(&format!("run small.toml --checkpoint={wrong}"), 2);
        assert!(said.contains("5min, 30s or 1h") && said.contains("off"), "{said}");
    }
}

#[test]
fn what_is_complete_or_has_not_begun() {
    let bench = bench();
    bench.done("run small.toml -o whole");
    let before = bench.files("whole");
    assert!(bench.done("run --resume whole").contains("is complete"));
    let summary = bench.done("run --resume whole --json");
    assert_eq!(summary.as_bytes(), before["summary.json"]);
    assert!(bench.files("whole") == before);
    // Killed before its first checkpoint, or while it wrote its results.
    let case = String::from_utf8(before["case.toml"].clone()).unwrap();
    bench.write("begun/case.toml", &case);
    bench.write("begun/series.csv", "half of");
    bench.write("begun/.slipfront/tmp/123abc", "half of");
    let said = bench.done("run --resume begun");
    assert!(said.contains("goes on from the start"), "{said}");
    bench.assert_same("whole", "begun");
    // Where no run was begun there is none to resume, and nothing is touched.
    bench.write("other/notes.txt", "mine");
    for (folder, why) in [
        ("other", "it has no case.toml"),
        ("nowhere", "there is none of this name"),
        ("whole/case.toml", "it is a file: name its folder"),
    ] {
        let said = bench.refused(&format!("run --quiet --resume {folder}"), 2);
        assert!(said.contains(why), "{said}");
    }
    assert_eq!(bench.files("other").len(), 1);
    assert!(!bench.exists("nowhere"));
    // Numbers that are not those of the run are not given out as such.
    let summary = summary.replacen("\": 0.", "\": 9.", 1);
    bench.write("whole/summary.json", summary);
    let said = bench.refused("run --resume whole --json", 2);
    assert!(said.contains("whole/summary.json differs"), "{said}");
    bench.write("whole/summary.json", &before["summary.json"]);
    // Whoever wants more of it may have changed its case.
    bench.write("whole/case.toml", case.replace("v_star = 0.1", "v_star = 0.2"));
    let said = bench.refused("run --quiet --resume whole", 2);
    assert!(said.contains("whole/case.toml differs"), "{said}");
    assert!(said.contains("is complete"), "{said}");
    bench.write("whole/case.toml", &case);
    // A run that was complete is not taken for one that was not.
    bench.write("whole/manifest.json", "{}");
    assert!(
        bench
            .refused("run --quiet --resume whole", 2)
            .contains("manifest.json is damaged")
    );
    assert_eq!(bench.files("whole").len(), before.len());
    for line in [
        "run small.toml --resume whole",
        "run --resume whole --seed 2",
        "run --previous",
    ] {
        bench.refused(line, 2);
    }
}

#[test]
fn an_interrupted_run_is_not_begun_again_by_mistake() {
    let bench = bench();
    stopped(&bench, "run slow.toml -o halted", "halted", 1);
    let said = bench.refused("run slow.toml --quiet -o halted", 2);
    assert!(
        said.contains("slipfront run --resume halted") && said.contains("--force"),
        "{said}"
    );
    let said = bench.refused("verify halted", 2);
    assert!(said.contains("slipfront run --resume halted"), "{said}");
    bench.done("run slow.toml -o whole");
    bench.done("run slow.toml -o halted --force");
    bench.assert_same("whole", "halted");
}

#[test]
fn one_process_at_a_time_goes_on_with_a_run() {
    let bench = bench();
    let mut child = start(&bench, "run slow.toml -o busy");
    wait_for("case.toml", || bench.exists("busy/case.toml"));
    for line in [
        "run --quiet --resume busy",
        "run slow.toml --quiet -o busy --force",
    ] {
        let said = bench.refused(line, 2);
        assert!(
            said.contains("another process is running in the folder busy"),
            "{said}"
        );
    }
    assert!(child.wait().unwrap().success());
}

/// A checkpoint with its checksum made to fit again.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len() - blake3::OUT_LEN);
    let seal = blake3::hash(&bytes);
    bytes.extend(seal.as_bytes());
    bytes
}

/// Everything that can be wrong with the latest checkpoint, each refused with its sentence; the one before it goes on.
#[test]
fn a_checkpoint_that_is_not_whole_or_not_its_own_is_refused() {
    let bench = bench();
    bench.done("run slow.toml -o whole");
    stopped(&bench, "run slow.toml -o halted", "halted", 2);
    let latest = bench.read("halted/.slipfront/checkpoint.bin");
    let refused = |bytes: &[u8], why: &str| {
        bench.write("halted/.slipfront/checkpoint.bin", bytes);
        let said = bench.refused("run --quiet --resume halted", 2);
        assert!(
            said.contains("halted/.slipfront/checkpoint.bin") && said.contains(why),
            "{why}: {said}"
        );
        said
    };
    let n = latest.len();
    for cut in [0, 1, 100, n / 2, n - 33, n - 32, n - 1] {
        refused(&latest[..cut], "is damaged");
    }
    for place in [0, 30, 150, 300, n / 3, n / 2, n - 40, n - 1] {
        let mut flipped = latest.clone();
        flipped[place] ^= 4;
        let said = refused(&flipped, "is damaged");
        assert!(said.contains("add --previous to go on from there"), "{said}");
    }
    refused(&[&latest[..], b"more"].concat(), "is damaged");
    refused(&bench.read("whole/fields.nc"), "is damaged");
    // Whole, and not its own.
    let text = |from: &str, to: &str| {
        let line = latest.iter().position(|&byte| byte == b'\n').unwrap();
        let header = String::from_utf8(latest[..line].to_vec()).unwrap();
        assert!(header.contains(from), "{header}");
        sealed([header.replacen(from, to, 1).as_bytes(), &latest[line..]].concat())
    };
    refused(
        &text("slipfront 0.", "slipfront 7."),
        "was written by slipfront 7.",
    );
    refused(
        &text("\"slipfront_checkpoint\":1", "\"slipfront_checkpoint\":2"),
        "has layout 2, and this version reads layout 1",
    );
    refused(
        &sealed(latest[..n - 8].to_vec()),
        "is damaged: it holds no state of a run",
    );
    let case = String::from_utf8(bench.read("halted/case.toml")).unwrap();
    bench.write("halted/case.toml", case.replace("seed = 1", "seed = 2"));
    refused(&latest, "belongs to another case");
    bench.write("halted/case.toml", &case);

    // A damaged one does not take the place of the one before, however often the run is stopped.
    bench.write("halted/.slipfront/checkpoint.bin", &latest[..n / 2]);
    let before = bench.read("halted/.slipfront/checkpoint-previous.bin");
    let child = start(&bench, "run --resume halted --previous");
    wait_for_signals(&child);
    send(&child, "-INT");
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    assert!(bench.read("halted/.slipfront/checkpoint-previous.bin") == before);
    bench.done("run --resume halted");
    bench.assert_same("whole", "halted");
}

/// A run that diverges does so again: there is nothing to go on with, and nothing of what others wrote is removed.
#[test]
fn a_resumed_run_that_diverges_leaves_its_case() {
    let bench = Bench::new();
    bench.write("wild.toml", super::broken::DIVERGING);
    bench.refused("run wild.toml --quiet -o gone", 1);
    assert!(bench.files("gone").is_empty());
    // As a study leaves a failed run that it keeps.
    bench.write(
        "study.toml",
        "base = 'wild.toml'\n[study]\nkeep = 'failed'\nreplicates = 1\n",
    );
    bench.refused("study study.toml --quiet -o out", 1);
    let kept = bench.files("out/runs");
    let folder = kept.keys().next().unwrap().split('/').next().unwrap().to_owned();
    let said = bench.refused(&format!("run --quiet --resume out/runs/{folder}"), 1);
    assert!(said.contains("step"), "{said}");
    assert!(bench.files("out/runs") == kept);
}

/// A kill between the two renames leaves the one before alone: it is the latest then.
#[test]
fn where_only_the_one_before_is_left_it_is_taken() {
    let bench = bench();
    bench.done("run slow.toml -o whole");
    stopped(&bench, "run slow.toml -o halted", "halted", 2);
    std::fs::remove_file(bench.path().join("halted/.slipfront/checkpoint.bin")).unwrap();
    assert!(bench.done("run --resume halted").contains("goes on from step "));
    bench.assert_same("whole", "halted");
    let said = bench.done("run --quiet --resume halted --previous");
    assert!(said.is_empty(), "{said}");
}

/// The manifest says what made the results: it is not written over another case than was run.
#[test]
fn a_case_that_is_changed_during_the_run_is_not_called_its_own() {
    let bench = bench();
    bench.done("run slow.toml -o whole");
    for file in ["case.toml", "inputs/spot.png"] {
        let child = start(&bench, "run slow.toml --quiet -o edited");
        wait_for_signals(&child);
        wait_for("case", || bench.exists("edited/inputs/spot.png"));
        let path = format!("edited/{file}");
        let before = bench.read(&path);
        bench.write(&path, [&before[..], b"\n# more"].concat());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", said(&output));
        let changed = format!("{path} was changed while the run went on");
        assert!(said(&output).contains(&changed), "{}", said(&output));
        assert!(!bench.exists("edited/manifest.json"));
        bench.write(&path, before);
        bench.done("run --resume edited");
        bench.assert_same("whole", "edited");
        std::fs::remove_dir_all(bench.path().join("edited")).unwrap();
    }
}

/// A terminal that closes saves the run, unless it was told not to mind.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_closes_loses_nothing() {
    let bench = bench();
    bench.done("run slow.toml -o whole");
    let child = start(&bench, "run slow.toml --quiet -o halted");
    wait_for_signals(&child);
    wait_for("case", || bench.exists("halted/inputs/spot.png"));
    send(&child, "-HUP");
    let output = child.wait_with_output().unwrap();
    // Whoever started these tests under `nohup` has told the runs in them as well.
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let ignored = status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:"))
        .unwrap();
    if u64::from_str_radix(ignored.trim(), 16).unwrap() & 1 == 0 {
        assert_eq!(output.status.code(), Some(129), "{}", said(&output));
        assert!(said(&output).contains("which is saved"), "{}", said(&output));
        bench.done("run --resume halted");
    }
    bench.assert_same("whole", "halted");
    let child = Command::new("nohup")
        .arg(program())
        .args("run slow.toml --quiet -o ignored".split(' '))
        .current_dir(bench.path())
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    wait_for_signals(&child);
    wait_for("case", || bench.exists("ignored/inputs/spot.png"));
    send(&child, "-HUP");
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    bench.assert_same("whole", "ignored");
}

/// A job script must not take a run that could not be saved for one that has only to be repeated.
#[test]
fn a_stop_that_saves_nothing_is_a_failure() {
    let bench = bench();
    let child = start(&bench, "run slow.toml --quiet -o gone");
    wait_for_signals(&child);
    wait_for("case", || bench.exists("gone/inputs/spot.png"));
    std::fs::remove_dir_all(bench.path().join("gone")).unwrap();
    send(&child, "-TERM");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(
        said(&output).contains("which cannot be saved in gone")
            && said(&output).contains("goes on from the start when that is mended"),
        "{}",
        said(&output)
    );
}
