//! Runs that cannot end well: diverged, interrupted, on a full disk, or with nobody to read their output.

use std::collections::BTreeSet;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::fixtures::RUN_FILES;
use crate::support::process::{Running, program, send, stderr, unset, wait_for};
use crate::support::workspace::Workspace;

/// The step is just below the limit of the linear lattice, and the strains stiffen its springs beyond it.
pub(super) const DIVERGING: &str = "[slider]\nomega_star = 0\n[load]\npressure = '50 GPa'\n[drive]\nv_star = 10\n\
    [friction]\nr_star = 0\nsigma_static_star = 1\n[time]\nstep = 0.9\nduration_star = 2000\n";

#[test]
fn a_run_that_diverges_says_where_and_leaves_no_results() {
    let workspace = Workspace::small();
    workspace.write("wild.toml", DIVERGING);
    let said = workspace.fail("run wild.toml --quiet -o a", 1);
    let words = ["displacement of block (", "at step ", "t* = ", "diverged"];
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
    assert!(workspace.files("a").is_empty());
}

/// A command that does not end would stop all tests.
#[cfg(unix)]
#[test]
fn what_hangs_is_killed_and_its_words_are_told() {
    let mut process = unset("sh");
    process
        .args(["-c", "echo begun; exec sleep 1000"])
        .stdout(Stdio::piped());
    let hang = Running::start(&mut process).ended_within(Duration::from_millis(300));
    let said = hang.unwrap_err();
    assert!(
        said.contains("sleep 1000") && said.ends_with("300ms:\nbegun\n"),
        "{said}"
    );
}

/// A reader such as `head -1` that closes the pipe early.
#[test]
fn a_closed_pipe_is_no_failure() {
    let workspace = Workspace::small();
    for line in [
        "run small.toml",
        "check small.toml",
        "completions zsh",
        "licences",
        "--help",
    ] {
        let mut process = workspace.process(line);
        let mut child = Running::start(process.stdout(Stdio::piped()).stderr(Stdio::piped()));
        drop(child.stdout.take());
        let output = child.ended();
        let said = stderr(&output);
        assert!(
            output.status.success() && said.is_empty(),
            "{line}: {} {said}",
            output.status
        );
    }
    assert!(workspace.exists("results/small/manifest.json"));
}

/// With a full disk behind stdout, messages are lost and nothing else; a command that only prints reports the
/// error.
#[cfg(target_os = "linux")]
#[test]
fn a_full_stdout_stops_no_work() {
    let workspace = Workspace::masked();
    workspace.write(
        "study.toml",
        "base.slider.blocks = [2, 2]\n[study]\nreplicates = 2\n",
    );
    workspace.succeed("run small.toml -o whole");
    workspace.succeed("study study.toml -o study-whole");
    workspace.fill("begun", &workspace.files("whole"));
    workspace.interrupt("begun");
    let full = |line: &str| {
        let mut process = workspace.process(line);
        process.stdout(std::fs::File::create("/dev/full").unwrap());
        let output = process.output().unwrap();
        (output.status.code().unwrap(), stderr(&output))
    };
    for line in [
        "run small.toml -o a",
        "run --resume begun",
        "run --resume a",
        "study study.toml -o study-a",
        "study merge study-whole -o merged",
        "plot whole -o drawn",
        "texture masked.toml -o texture.png",
    ] {
        let (status, said) = full(line);
        assert_eq!(status, 0, "{line}: {said}");
        assert!(!said.contains("error"), "{line}: {said}");
    }
    workspace.assert_same_run("whole", "a");
    workspace.assert_same_run("whole", "begun");
    for table in ["runs.csv", "points.csv", "study.toml"] {
        let whole = workspace.read(&format!("study-whole/{table}"));
        assert!(workspace.read(&format!("study-a/{table}")) == whole, "{table}");
        assert!(workspace.read(&format!("merged/{table}")) == whole, "{table}");
    }
    assert!(workspace.exists("drawn/stress.png") && workspace.exists("texture.png"));
    for line in [
        "check small.toml",
        "completions zsh",
        "licences",
        "study study.toml --dry-run",
        "study slurm study.toml",
        "verify whole",
        "run small.toml --json -o b",
        "run --resume whole --json",
        "--help",
        "run --help",
        "--version",
    ] {
        let (status, said) = full(line);
        assert_eq!(status, 1, "{line}: {said}");
        assert!(
            said.contains("error: cannot write to standard output: No space left"),
            "{line}: {said}"
        );
    }
    workspace.assert_same_run("whole", "b");
}

/// A limit on address space ends in an error message, or in fewer threads, and never in an abort.
#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_addresses_ends_nothing_in_an_abort() {
    let workspace = Workspace::small();
    workspace.write(
        "study.toml",
        "base.slider.blocks = [2, 2]\nbase.time.stop = 'after_onset'\n[[axes]]\nkey = 'drive.v_star'\n\
         linspace = [0.1, 0.2, 8]\n[[axes]]\nkey = 'drive.direction'\nlinspace = [0, 45, 6]\n",
    );
    workspace.succeed("run small.toml -o a");
    workspace.succeed("study study.toml --quiet -o whole");
    let limited = |mib: u64, line: &str| {
        workspace.shell(&format!("ulimit -v {}; exec {} {line}", 1024 * mib, program()))
    };
    // Below this limit, the system cannot load the program.
    let loads = |mib: &u64| limited(*mib, "--version").status.success();
    let least = (16..512).step_by(4).find(loads).unwrap();
    let mut statuses = BTreeSet::new();
    for mib in [least, least + 16, 96, 256, 1024] {
        for line in [
            "plot a -o drawn --force",
            "verify whole",
            "verify a",
            "study merge whole -o merged --quiet",
            "study study.toml -o again --quiet",
            "run small.toml --quiet -o b --force",
            // Random numbers of more blocks than these are drawn on all threads.
            "check small.toml --set slider.blocks=[101,100]",
            "texture small.toml --set slider.blocks=[101,100] -o texture.png --force",
        ] {
            let output = limited(mib, line);
            let (said, status) = (stderr(&output), output.status.code());
            assert!(
                matches!(status, Some(0..=2)),
                "{line}, {mib} MiB: {status:?} {said}"
            );
            assert!(!said.contains("panicked"), "{line}, {mib} MiB: {said}");
            assert_eq!(
                status != Some(0),
                said.contains("error: "),
                "{line}, {mib} MiB: {said}"
            );
            statuses.insert((mib, status));
        }
    }
    // Some commands were refused, and none with a GiB.
    assert!(statuses.contains(&(least, Some(2))), "{statuses:?}");
    let of_a_gib: Vec<_> = statuses.iter().filter(|(mib, _)| *mib == 1024).collect();
    assert_eq!(of_a_gib, [&(1024, Some(0))]);
}

/// There are no more threads than cores, whatever number is requested, and fewer if the system refuses some.
#[cfg(target_os = "linux")]
#[test]
fn threads_that_cannot_be_had_are_done_without() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    let output = workspace.output("run small.toml --quiet --threads 65535 -o many");
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    assert!(
        said.starts_with("note: ") && said.contains(" of 65535 threads are used"),
        "{said}"
    );
    workspace.assert_same_run("a", "many");
    let mut process = workspace.process("plot a -o drawn");
    let output = process.env("RAYON_NUM_THREADS", "99999").output().unwrap();
    assert!(output.status.success() && stderr(&output).is_empty());
    // A user with no other process and a limit of one. Becoming this user takes rights that few users have;
    // without them this part is skipped.
    let anyone = "chmod 777 . && cp -R a of-anyone && chmod -R a+rwX of-anyone";
    assert!(workspace.shell(anyone).status.success());
    let as_other = "setpriv --reuid 64321 --clear-groups prlimit --nproc=1";
    if !workspace.shell(&format!("{as_other} true")).status.success() {
        return;
    }
    // That user may have no access to the folder of the program. If this process wrote the copy, another
    // thread could start a process that holds it open, and it could not be run.
    let copy = format!("cp '{}' slipfront", program());
    assert!(workspace.shell(&copy).status.success());
    for (line, status) in [
        ("plot of-anyone -o drawn-by-one", 0),
        ("verify of-anyone", 0),
        ("run small.toml --quiet -o run-by-one", 0),
        ("check small.toml --set slider.blocks=[101,100]", 0),
        (
            "texture small.toml --set slider.blocks=[101,100] -o texture.png",
            0,
        ),
        ("study study.toml -o study-by-one", 1),
    ] {
        workspace.write("study.toml", "base.slider.blocks = [2, 2]\n");
        let output = workspace.shell(&format!("{as_other} ./slipfront {line}"));
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(status), "{line}: {said}");
        assert!(said.contains("the system refuses"), "{line}: {said}");
    }
    workspace.assert_same_run("a", "run-by-one");
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_the_run_and_leaves_it_incomplete() {
    use std::os::unix::process::ExitStatusExt;
    let workspace = Workspace::small();
    let long =
        "run --quiet -o a --set slider.blocks=[100,100] --set time.duration_star=1e6 --set output.series=1e3";
    let mut child = workspace.start(long);
    wait_for("folder of the run", || {
        assert!(child.try_wait().unwrap().is_none(), "the run has ended");
        workspace.exists("a")
    });
    std::thread::sleep(Duration::from_millis(100));
    send(&child, "-INT");
    let status = child.ended().status;
    // A shell shows a death by signal as 128 + its number.
    let seen = status.code().or(status.signal().map(|signal| 128 + signal));
    assert_eq!(seen, Some(130));
    assert!(!workspace.exists("a/manifest.json"));
}

/// Asserts that every file is either missing or complete.
fn assert_incomplete_but_sound(workspace: &Workspace, whole: &str, broken: &str) {
    let whole = workspace.files(whole);
    for (name, bytes) in workspace.files(broken) {
        assert_ne!(name, "manifest.json", "an incomplete run looks complete");
        if name == ".slipfront/journal.jsonl" {
            continue;
        }
        assert!(
            whole.get(&name) == Some(&bytes),
            "{name} is half written or unknown"
        );
    }
}

/// A limit on file size stops the run at each of its files in turn, whatever code writes the file.
#[cfg(unix)]
#[test]
fn a_file_that_cannot_be_written_whole_is_not_there_at_all() {
    let workspace = Workspace::small();
    // The series is short, so that it is not always the file that grows too large.
    let run = "run small.toml --quiet --set output.series=1000 -o";
    workspace.succeed(&format!("{run} whole"));
    let mut sizes: Vec<usize> = workspace.run_files("whole").values().map(Vec::len).collect();
    sizes.sort_unstable();
    let mut failed = Vec::new();
    for (number, size) in sizes.iter().enumerate() {
        // The limit is in units of 512 bytes.
        let limit = (size - 1) / 512;
        let script = format!("ulimit -f {limit}; exec {} {run} broken{number}", program());
        let output = workspace.shell(&script);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "limit {limit}: {said}");
        assert!(
            said.starts_with("error: cannot write ") && said.lines().count() == 1,
            "{said}"
        );
        let folder = format!("broken{number}");
        assert_incomplete_but_sound(&workspace, "whole", &folder);
        let named = RUN_FILES
            .iter()
            .find(|name| said.contains(&format!("{folder}/{name}")));
        failed.push(*named.unwrap_or_else(|| panic!("no file is named: {said}")));
    }
    failed.sort_unstable();
    failed.dedup();
    assert!(failed.len() >= 5, "only {failed:?} were hit");
}

/// Runs a line in a folder `disk` with its own limits on size and number of files; returns the status and the
/// messages. Mounting such a disk takes rights that few users have; without them nothing is tested.
#[cfg(target_os = "linux")]
fn on_a_small_disk(workspace: &Workspace, options: &str, line: &str) -> Option<(i32, String)> {
    // A mount in its own namespace disappears by itself.
    let script = format!(
        "mkdir disk && mount -t tmpfs -o {options} tmpfs disk || exit 77
         {} {line} 2> said
         status=$?
         cp -R disk/. left
         exit $status",
        program()
    );
    let status = Command::new("unshare")
        .args(["--mount", "sh", "-c", &script])
        .current_dir(workspace.path(""))
        .stderr(Stdio::null())
        .status();
    if !workspace.exists("said") {
        return None;
    }
    Some((status.unwrap().code().unwrap(), workspace.read_text("said")))
}

#[cfg(target_os = "linux")]
#[test]
fn a_disk_without_room_is_said_before_the_run() {
    let workspace = Workspace::small();
    let Some((status, said)) = on_a_small_disk(&workspace, "size=1m", "run small.toml --quiet -o disk/a")
    else {
        return;
    };
    assert_eq!(status, 2, "{said}");
    for word in [
        "the files of this run need about 2.",
        "but 1.0 MiB are free in disk/a",
        "choose another folder",
    ] {
        assert!(said.contains(word), "{said}");
    }
    assert!(!workspace.exists("left/a"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_study_without_room_is_said_before_its_runs() {
    let workspace = Workspace::small();
    workspace.write(
        "study.toml",
        "base.slider.blocks = [2, 2]\n[study]\nreplicates = 100\n",
    );
    let line = "study study.toml --quiet -o disk/a";
    let Some((status, said)) = on_a_small_disk(&workspace, "size=64k", line) else {
        return;
    };
    assert_eq!(status, 2, "{said}");
    for word in ["need about 400.0 KiB, but ", "are free in disk/a", "study.keep"] {
        assert!(said.contains(word), "{said}");
    }
    assert!(workspace.read("left/a/runs.jsonl").is_empty());
}

/// A disk with enough bytes but too few inodes.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_no_half_results() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o whole");
    // Inodes: the root, the run folder, the hidden folder in it with a subfolder and the journal, and four
    // files.
    let run = "run small.toml --quiet -o disk/a";
    let Some((status, said)) = on_a_small_disk(&workspace, "size=8m,nr_inodes=9", run) else {
        return;
    };
    assert_eq!(status, 1, "{said}");
    assert!(
        said.contains("cannot write") && said.contains("No space left"),
        "{said}"
    );
    assert!(workspace.exists("left/a/case.toml"));
    assert_incomplete_but_sound(&workspace, "whole", "left/a");
}
