//! The command under mpirun: what it writes, prints and leaves behind, whatever ends it.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod support;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::LazyLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

use rstest::rstest;
use tempfile::TempDir;

use crate::support::{mpirun, output, plain, printed, run_plain_command};

/// Files by their names, with their bytes.
type Files = BTreeMap<String, Vec<u8>>;

/// Some seconds: long enough to be stopped.
const SLOW: &str = "[slider]\nblocks = [60, 50]\nedges = ['periodic', 'free']\n[drive]\nv_star = 0.002\n";

/// The command on so many ranks, in a folder.
fn on_ranks(ranks: usize, folder: &TempDir, line: &str) -> Command {
    let mut command = mpirun(ranks, env!("CARGO_BIN_EXE_slipfront-mpi"));
    command.args(line.split_whitespace()).current_dir(folder);
    command
}

/// Runs the plain command, which must succeed, in a folder.
fn run_plain(folder: &TempDir, line: &str) {
    let output = output(plain("plain_command", line).current_dir(folder));
    assert!(output.status.success(), "{}", printed(&output));
}

#[test]
#[ignore = "runs in a process of its own"]
fn plain_command() {
    run_plain_command();
}

/// Every file of a run that is complete but the manifest, which tells of machines and dates.
fn results(folder: &Path) -> Files {
    let mut files = Files::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(path.is_file(), "{name}");
        files.insert(name, std::fs::read(path).unwrap());
    }
    assert!(files.remove("manifest.json").is_some(), "no manifest");
    files
}

/// What [`SLOW`] gives by the plain command.
static SLOW_RESULTS: LazyLock<Files> = LazyLock::new(|| {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("slow.toml"), SLOW).unwrap();
    run_plain(&folder, "run slow.toml --quiet -o plain");
    results(&folder.path().join("plain"))
});

fn assert_same(one: &Files, other: &Files) {
    assert!(one.keys().eq(other.keys()));
    for (name, bytes) in one {
        assert!(*bytes == other[name], "{name} differs");
    }
}

/// Waits until a run has saved its first checkpoint.
fn wait_for_checkpoint(folder: &Path) {
    let began = Instant::now();
    while !folder.join(".slipfront/checkpoint.bin").exists() {
        assert!(began.elapsed() < Duration::from_secs(60), "no checkpoint");
        sleep(Duration::from_millis(5));
    }
}

/// Whom a signal is sent to.
#[derive(Clone, Copy)]
enum Target {
    Mpirun,
    LastRank,
}

/// Which command goes on with a run.
#[derive(Clone, Copy)]
enum Resumed {
    OnRanks,
    Plain,
}

/// Sends a signal to the mpirun that was started, or to one of the ranks that it has started.
fn send(signal: &str, target: Target, child: &Child) {
    let mut process = child.id().to_string();
    if let Target::LastRank = target {
        let ranks = Command::new("pgrep").args(["-P", &process]).output().unwrap();
        let ranks = String::from_utf8(ranks.stdout).unwrap();
        process = ranks.lines().last().unwrap().to_owned();
    }
    let kill = Command::new("kill").args([signal, &process]).status();
    assert!(kill.unwrap().success(), "{signal} cannot be sent");
}

/// Usage, help and refusals are the same for every rank, and printed by one.
#[rstest]
#[case("run --nonsense", 2, "unexpected argument '--nonsense'")]
#[case("--help", 0, "byte for byte")]
#[case(
    "run -o results",
    2,
    "error: a lattice cannot be divided over several ranks yet"
)]
fn several_ranks_speak_with_one_voice(#[case] line: &str, #[case] status: i32, #[case] sentence: &str) {
    let folder = TempDir::new().unwrap();
    let output = output(&mut on_ranks(3, &folder, line));
    assert_eq!(output.status.code(), Some(status), "{}", printed(&output));
    assert_eq!(
        printed(&output).matches(sentence).count(),
        1,
        "{}",
        printed(&output)
    );
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
}

#[rstest]
fn a_run_on_ranks_writes_the_bytes_of_the_plain_command(#[values(1)] ranks: usize) {
    let folder = TempDir::new().unwrap();
    run_plain(&folder, "run -o plain");
    let output = output(&mut on_ranks(ranks, &folder, "run -o ranks"));
    assert!(output.status.success(), "{}", printed(&output));
    assert!(
        printed(&output).contains("static friction"),
        "{}",
        printed(&output)
    );
    let [plain, ranks] = ["plain", "ranks"].map(|name| results(&folder.path().join(name)));
    assert_same(&plain, &ranks);
}

/// mpirun passes on SIGUSR2 as it is; after SIGINT and SIGTERM it sends SIGTERM to the ranks, and has status 1 whatever they say.
#[rstest]
#[case(Target::Mpirun, "-USR2", 140, Resumed::OnRanks)]
#[case(Target::Mpirun, "-TERM", 1, Resumed::Plain)]
#[case(Target::Mpirun, "-INT", 1, Resumed::OnRanks)]
#[case(Target::LastRank, "-TERM", 143, Resumed::Plain)]
fn a_run_that_is_stopped_by_a_signal_goes_on_in_either_command(
    #[values(1)] ranks: usize,
    #[case] target: Target,
    #[case] signal: &str,
    #[case] status: i32,
    #[case] resumed: Resumed,
) {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("slow.toml"), SLOW).unwrap();
    let mut command = on_ranks(ranks, &folder, "run slow.toml --checkpoint 0s -o stopped");
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    wait_for_checkpoint(&folder.path().join("stopped"));
    send(signal, target, &child);
    let stopped = child.wait_with_output().unwrap();
    let text = printed(&stopped);
    let sentence = "which is saved: `slipfront-mpi run --resume stopped` goes on";
    assert_eq!(text.matches(sentence).count(), 1, "{text}");
    assert_eq!(stopped.status.code(), Some(status), "{text}");
    let line = "run --quiet --resume stopped";
    match resumed {
        Resumed::Plain => run_plain(&folder, line),
        Resumed::OnRanks => {
            let output = output(&mut on_ranks(ranks, &folder, line));
            assert!(output.status.success(), "{}", printed(&output));
        }
    }
    assert_same(&SLOW_RESULTS, &results(&folder.path().join("stopped")));
}
