//! Runs that are stopped and resumed write the same bytes as without a stop, and never resume from another
//! run's checkpoint.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use std::thread::sleep;
use std::time::Duration;

use test_case::test_case;

use crate::broken::DIVERGING;
use crate::support::process::{
    Running, ignores_hangup, program, send, stderr, try_send, unset, wait_for_signal_handlers,
};
use crate::support::workspace::{Files, Workspace};

/// Takes around a second, and long enough to be stopped several times also on a fast machine.
const SLOW: &str = "[slider]\nblocks = [60, 50]\nedges = ['periodic', 'free']\n[drive]\nv_star = 0.01\n\
                    [time]\nduration_star = 3200\n[friction]\ncorrelation_length = '2.5 um'\n[[texture]]\nshape = 'mask'\nfile = 'spot.png'\n";

/// Uses the general kernel, with frequent snapshots.
const REVERSAL: &str = "[slider]\nblocks = [60, 50]\n[drive]\nv_star = 0.01\n[friction]\nlaw = 'reversal'\n\
                       [output]\nsnapshots = { every = 75 }\n";

/// Uses a law with a state variable for every block.
const SPRINGS: &str = "[slider]\nblocks = [60, 50]\n[drive]\nv_star = 0.01\n[friction]\ncontact = 'springs'\n\
                       contact_stiffness_star = 0.3\nredraw = true\n";

/// Enough blocks for two threads, until the onset.
const WIDE: &str = "[slider]\nblocks = [400, 350]\n[drive]\nv_star = 0.05\n[time]\nstop = 'after_onset'\n";

/// A drive that is at rest for many steps while blocks slip.
const HELD: &str = "[slider]\nblocks = [60, 50]\n[drive]\nv_star = 0.02\nloading = 'held'\n[time]\nduration_star = 160\n[[texture]]\nshape = 'cavity'\ncoverage = 10\n";

fn slow_workspace() -> Workspace {
    let workspace = Workspace::small();
    for (name, text) in [
        ("slow.toml", SLOW),
        ("reversal.toml", REVERSAL),
        ("springs.toml", SPRINGS),
        ("wide.toml", WIDE),
        ("held.toml", HELD),
    ] {
        workspace.write(name, text);
    }
    workspace.write("spot.png", &*SPOT);
    workspace
}

/// The texture of `slow.toml`.
static SPOT: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let workspace = Workspace::small();
    let cavity = "texture small.toml -o spot.png --set texture.0={shape=\"cavity\",coverage=15}";
    workspace.succeed(&format!("{cavity} --set slider.blocks=[60,50]"));
    workspace.read("spot.png")
});

/// The folder of a run of `slow.toml` without a stop, computed once: stopped and resumed runs must have the
/// same bytes.
static WHOLE: LazyLock<Files> = LazyLock::new(|| {
    let workspace = slow_workspace();
    workspace.succeed("run slow.toml -o whole");
    workspace.files("whole")
});

/// Begins a run and stops it `times` times; each stop saves a checkpoint.
fn stopped(workspace: &Workspace, line: &str, folder: &str, times: usize) {
    let mut line = line.to_owned();
    for _ in 0..times {
        let child = workspace.start_run(&line);
        sleep(Duration::from_millis(60));
        send(&child, "-INT");
        let output = child.ended();
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        line = format!("run --resume {folder}");
    }
}

#[test_case("slow.toml", "-INT", 130)]
#[test_case("reversal.toml", "-TERM", 143)]
#[test_case("springs.toml", "-TERM", 143)]
#[test_case("wide.toml", "-INT", 130)]
#[test_case("held.toml", "-TERM", 143)]
fn stopped_any_number_of_times_it_writes_the_same_bytes(case: &str, signal: &str, status: i32) {
    let workspace = slow_workspace();
    workspace.succeed(&format!("run {case} -o whole --threads 1"));
    let mut stops = 0;
    let mut line = format!("run {case} -o stopped");
    loop {
        // Each call uses a different number of threads.
        let child = workspace.start_run(&format!("{line} --threads {}", 1 + stops % 3));
        sleep(Duration::from_millis(20 + 20 * (stops % 4)));
        try_send(&child, signal);
        let output = child.ended();
        if output.status.success() {
            break;
        }
        assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("run --resume stopped"),
            "{}",
            stderr(&output)
        );
        stops += 1;
        assert!(stops < 1000, "it does not get on");
        line = "run --resume stopped".to_owned();
    }
    assert!(stops >= 2, "it was stopped {stops} times only");
    workspace.assert_same_run("whole", "stopped");
    workspace.succeed("verify stopped");
}

/// Signals by which queues warn before they kill.
#[cfg(target_os = "linux")]
#[test_case("-USR2", 140)]
#[test_case("-XCPU", 152)]
fn a_warning_of_the_queue_stops_it(signal: &str, status: i32) {
    let workspace = slow_workspace();
    let child = workspace.start_run("run slow.toml -o warned");
    send(&child, signal);
    let output = child.ended();
    assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("`slipfront run --resume warned` resumes the run"),
        "{}",
        stderr(&output)
    );
    workspace.succeed("run --resume warned");
    workspace.succeed("verify warned");
}

/// The case is read from a pipe without a writer, so the command never checks for the first signal.
#[cfg(unix)]
#[test]
fn a_second_signal_ends_it_at_once() {
    let workspace = Workspace::small();
    let pipe = Command::new("mkfifo").arg(workspace.path("pipe.toml")).status();
    assert!(pipe.unwrap().success());
    let child = workspace.start("check pipe.toml");
    wait_for_signal_handlers(&child);
    for signal in ["-INT", "-TERM"] {
        send(&child, signal);
    }
    let status = child.ended().status.code();
    // The second signal may overtake the first.
    assert!(matches!(status, Some(130 | 143)), "{status:?}");
}

/// Messages that cannot be printed are no failure: a full disk under the log or a closed terminal has no
/// other effect.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_said_is_no_failure() {
    let workspace = slow_workspace();
    let full = || File::options().write(true).open("/dev/full").unwrap();
    let start = |line: &str| {
        let mut process = workspace.process(line);
        Running::start(process.stdout(Stdio::null()).stderr(full()))
    };
    let status = |line: &str, signal: Option<&str>| {
        let child = start(line);
        if let Some(signal) = signal {
            // A signal that comes while inputs are copied leaves nothing to resume.
            workspace.wait_for("mute/inputs/spot.png");
            wait_for_signal_handlers(&child);
            send(&child, signal);
        }
        child.ended().status.code()
    };
    assert_eq!(status("run nowhere.toml", None), Some(2));
    assert_eq!(status("run slow.toml -o mute", Some("-TERM")), Some(143));
    assert_eq!(status("run --resume mute", Some("-USR1")), Some(0));
    workspace.succeed("verify mute");
}

#[test]
fn a_signal_saves_and_the_run_goes_on() {
    let workspace = slow_workspace();
    workspace.fill("whole", &WHOLE);
    let child = workspace.start("run slow.toml -o saved");
    workspace.wait_for("saved/case.toml");
    send(&child, "-USR1");
    let output = child.ended();
    assert!(output.status.success());
    assert!(
        stderr(&output).contains("saved a checkpoint of step "),
        "{}",
        stderr(&output)
    );
    // A complete run needs no checkpoint.
    workspace.assert_same_run("whole", "saved");
}

#[test]
fn by_the_clock_it_saves_now_and_then() {
    let workspace = slow_workspace();
    let mut child =
        workspace.start("run slow.toml -o clocked --checkpoint 10ms --set time.duration_star=20000");
    workspace.wait_for("clocked/.slipfront/checkpoint-previous.bin");
    child.kill().unwrap();
    child.wait().unwrap();
    // Without checkpoints, a signal cannot save the state.
    let mut child = workspace.start("run slow.toml -o off --checkpoint off --set time.duration_star=20000");
    workspace.wait_for("off/case.toml");
    send(&child, "-USR1");
    let mut lines = BufReader::new(child.stderr.take().unwrap())
        .lines()
        .map(Result::unwrap);
    assert!(lines.any(|line| line.contains("no checkpoint is saved")));
    send(&child, "-INT");
    assert!(lines.any(|line| line.contains("nothing is saved")));
    assert_eq!(child.ended().status.code(), Some(130));
    assert!(!workspace.exists("off/.slipfront/checkpoint.bin"));
    for wrong in ["soon", "-5min", "5"] {
        let said = workspace.fail(&format!("run small.toml --checkpoint={wrong}"), 2);
        assert!(said.contains("5min, 30s or 1h") && said.contains("off"), "{said}");
    }
}

#[test]
fn what_is_complete_or_has_not_begun() {
    let workspace = slow_workspace();
    workspace.succeed("run small.toml -o whole");
    let before = workspace.files("whole");
    assert!(workspace.succeed("run --resume whole").contains("is complete"));
    let summary = workspace.succeed("run --resume whole --json");
    assert_eq!(summary.as_bytes(), before["summary.json"]);
    assert!(workspace.files("whole") == before);
    // A run that was killed before its first checkpoint, or while it wrote its results.
    let case = String::from_utf8(before["case.toml"].clone()).unwrap();
    workspace.write("begun/case.toml", &case);
    workspace.write("begun/.slipfront/journal.jsonl", "");
    workspace.write("begun/.slipfront/tmp/123abc", "half of");
    let said = workspace.succeed("run --resume begun");
    assert!(said.contains("goes on from the start"), "{said}");
    workspace.assert_same_run("whole", "begun");
    // In a folder without a run there is nothing to resume, and no file is touched.
    workspace.write("other/notes.txt", "mine");
    for (folder, why) in [
        (
            "other",
            "it has no case.toml; start the run again in this folder with --force",
        ),
        ("nowhere", "it does not exist; start the run again"),
        ("whole/case.toml", "it is a file: give its folder"),
    ] {
        let said = workspace.fail(&format!("run --quiet --resume {folder}"), 2);
        assert!(said.contains(why), "{said}");
    }
    assert_eq!(workspace.files("other").len(), 1);
    assert!(!workspace.exists("nowhere"));
    // Changed numbers are not printed as results of the run.
    let summary = summary.replacen("\": 0.", "\": 9.", 1);
    workspace.write("whole/summary.json", summary);
    let said = workspace.fail("run --resume whole --json", 2);
    assert!(said.contains("whole/summary.json differs"), "{said}");
    workspace.write("whole/summary.json", &before["summary.json"]);
    // A user who wants a longer run may have changed its case.
    workspace.write("whole/case.toml", case.replace("v_star = 0.1", "v_star = 0.2"));
    let said = workspace.fail("run --quiet --resume whole", 2);
    assert!(said.contains("whole/case.toml differs"), "{said}");
    assert!(said.contains("is complete"), "{said}");
    workspace.write("whole/case.toml", &case);
    // A complete run with a damaged manifest is not taken for an unfinished run.
    workspace.write("whole/manifest.json", "{}");
    assert!(
        workspace
            .fail("run --quiet --resume whole", 2)
            .contains("manifest.json is damaged")
    );
    assert_eq!(workspace.files("whole").len(), before.len());
    for line in [
        "run small.toml --resume whole",
        "run --resume whole --seed 2",
        "run --previous",
    ] {
        workspace.fail(line, 2);
    }
}

#[test]
fn an_interrupted_run_is_not_begun_again_by_mistake() {
    let workspace = slow_workspace();
    stopped(&workspace, "run slow.toml -o halted", "halted", 1);
    let said = workspace.fail("run slow.toml --quiet -o halted", 2);
    assert!(
        said.contains("slipfront run --resume halted") && said.contains("--force"),
        "{said}"
    );
    let said = workspace.fail("verify halted", 2);
    assert!(said.contains("slipfront run --resume halted"), "{said}");
    workspace.fill("whole", &WHOLE);
    workspace.succeed("run slow.toml -o halted --force");
    workspace.assert_same_run("whole", "halted");
}

#[test]
fn one_process_at_a_time_goes_on_with_a_run() {
    let workspace = slow_workspace();
    let child = workspace.start("run slow.toml -o busy");
    workspace.wait_for("busy/case.toml");
    // However long the others take, it has not ended.
    send(&child, "-STOP");
    for line in [
        "run --quiet --resume busy",
        "run slow.toml --quiet -o busy --force",
    ] {
        let said = workspace.fail(line, 2);
        assert!(
            said.contains("another process is running in the folder busy"),
            "{said}"
        );
    }
    send(&child, "-CONT");
    assert!(child.ended().status.success());
}

/// Gives a changed checkpoint a valid checksum.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len() - blake3::OUT_LEN);
    // The checkpoint has a single piece.
    assert!(bytes.len() < 4 << 20);
    let seal = blake3::hash(blake3::hash(&bytes).as_bytes());
    bytes.extend(seal.as_bytes());
    bytes
}

/// Every possible defect of the latest checkpoint is refused with its own message; the run can be resumed
/// from the previous checkpoint.
#[test]
fn a_checkpoint_that_is_not_whole_or_not_its_own_is_refused() {
    let workspace = slow_workspace();
    workspace.fill("whole", &WHOLE);
    stopped(&workspace, "run slow.toml -o halted", "halted", 2);
    let latest = workspace.read("halted/.slipfront/checkpoint.bin");
    let refused = |bytes: &[u8], why: &str| {
        workspace.write("halted/.slipfront/checkpoint.bin", bytes);
        let said = workspace.fail("run --quiet --resume halted", 2);
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
        assert!(said.contains("add --previous to resume from it"), "{said}");
    }
    refused(&[&latest[..], b"more"].concat(), "is damaged");
    refused(&workspace.read("whole/fields.nc"), "is damaged");
    // These checkpoints are complete, but belong to another run.
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
        &text("\"slipfront_checkpoint\":6", "\"slipfront_checkpoint\":1"),
        "has layout 1, but this version reads layout 6",
    );
    for (from, to) in [
        ("\"rows\":50", "\"rows\":51"),
        ("\"rows\":50", "\"rows\":9007199254740993"),
    ] {
        refused(&text(from, to), "is damaged");
    }
    refused(
        &text("\"row_length\":60", "\"row_length\":59"),
        "is damaged: it does not contain the state of a run",
    );
    refused(
        &sealed(latest[..n - 8].to_vec()),
        "is damaged: it does not contain the state of a run",
    );
    let case = String::from_utf8(workspace.read("halted/case.toml")).unwrap();
    workspace.write("halted/case.toml", case.replace("seed = 1", "seed = 2"));
    refused(&latest, "does not belong to the case.toml");
    workspace.write("halted/case.toml", &case);

    // A damaged checkpoint does not replace the previous one, however often the run is stopped.
    workspace.write("halted/.slipfront/checkpoint.bin", &latest[..n / 2]);
    let before = workspace.read("halted/.slipfront/checkpoint-previous.bin");
    let child = workspace.start_run("run --resume halted --previous");
    send(&child, "-INT");
    assert_eq!(child.ended().status.code(), Some(130));
    assert!(workspace.read("halted/.slipfront/checkpoint-previous.bin") == before);
    workspace.succeed("run --resume halted");
    workspace.assert_same_run("whole", "halted");
}

/// A run that diverges would diverge again: there is nothing to resume, and no file from others is removed.
#[test]
fn a_resumed_run_that_diverges_leaves_its_case() {
    let workspace = Workspace::small();
    workspace.write("wild.toml", DIVERGING);
    workspace.fail("run wild.toml --quiet -o gone", 1);
    assert!(workspace.files("gone").is_empty());
    // A study leaves a failed run like this if it keeps it.
    workspace.write(
        "study.toml",
        "base = 'wild.toml'\n[study]\nkeep = 'failed'\nreplicates = 1\n",
    );
    workspace.fail("study study.toml --quiet -o out", 1);
    let kept = workspace.files("out/runs");
    let folder = kept.keys().next().unwrap().split('/').next().unwrap().to_owned();
    let said = workspace.fail(&format!("run --quiet --resume out/runs/{folder}"), 1);
    assert!(said.contains("step"), "{said}");
    assert!(workspace.files("out/runs") == kept);
}

/// A kill between the two renames leaves only the previous checkpoint, which then counts as the latest.
#[test]
fn where_only_the_one_before_is_left_it_is_taken() {
    let workspace = slow_workspace();
    workspace.fill("whole", &WHOLE);
    stopped(&workspace, "run slow.toml -o halted", "halted", 2);
    std::fs::remove_file(workspace.path("halted/.slipfront/checkpoint.bin")).unwrap();
    assert!(
        workspace
            .succeed("run --resume halted")
            .contains("goes on from step ")
    );
    workspace.assert_same_run("whole", "halted");
    let said = workspace.succeed("run --quiet --resume halted --previous");
    assert!(said.is_empty(), "{said}");
}

/// The manifest says which case made the results: it is not written if the case was changed during the run.
#[test]
fn a_case_that_is_changed_during_the_run_is_not_called_its_own() {
    let workspace = slow_workspace();
    workspace.fill("whole", &WHOLE);
    for file in ["case.toml", "inputs/spot.png"] {
        let child = workspace.start("run slow.toml --quiet -o edited");
        wait_for_signal_handlers(&child);
        workspace.wait_for("edited/inputs/spot.png");
        let path = format!("edited/{file}");
        let before = workspace.read(&path);
        workspace.write(&path, [&before[..], b"\n# more"].concat());
        let output = child.ended();
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        let changed = format!("{path} was changed during the run");
        assert!(stderr(&output).contains(&changed), "{}", stderr(&output));
        assert!(!workspace.exists("edited/manifest.json"));
        workspace.write(&path, before);
        if file == "case.toml" {
            std::fs::remove_dir_all(workspace.path("edited")).unwrap();
        }
    }
    workspace.succeed("run --resume edited");
    workspace.assert_same_run("whole", "edited");
}

/// A run saves its state if its terminal closes, unless it was started to ignore that signal.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_closes_loses_nothing() {
    let workspace = slow_workspace();
    workspace.fill("whole", &WHOLE);
    let child = workspace.start("run slow.toml --quiet -o halted");
    wait_for_signal_handlers(&child);
    workspace.wait_for("halted/inputs/spot.png");
    send(&child, "-HUP");
    let output = child.ended();
    if !ignores_hangup() {
        assert_eq!(output.status.code(), Some(129), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("the state is saved"),
            "{}",
            stderr(&output)
        );
        workspace.succeed("run --resume halted");
    }
    workspace.assert_same_run("whole", "halted");
    let mut nohup = unset("nohup");
    nohup
        .arg(program())
        .args("run slow.toml --quiet -o ignored".split(' '))
        .current_dir(workspace.path(""))
        .stderr(Stdio::piped())
        .stdout(Stdio::null());
    let child = Running::start(&mut nohup);
    wait_for_signal_handlers(&child);
    workspace.wait_for("ignored/inputs/spot.png");
    send(&child, "-HUP");
    let output = child.ended();
    assert!(output.status.success(), "{}", stderr(&output));
    workspace.assert_same_run("whole", "ignored");
}

/// The status of a run that could not save its state must differ from the status of a saved one, so that a
/// job script does not simply resume it.
#[test]
fn a_stop_that_saves_nothing_is_a_failure() {
    let workspace = slow_workspace();
    let child = workspace.start("run slow.toml --quiet -o gone");
    wait_for_signal_handlers(&child);
    workspace.wait_for("gone/inputs/spot.png");
    std::fs::remove_dir_all(workspace.path("gone")).unwrap();
    send(&child, "-TERM");
    let output = child.ended();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("the state cannot be saved in gone")
            && stderr(&output).contains("resumes from the start"),
        "{}",
        stderr(&output)
    );
}
