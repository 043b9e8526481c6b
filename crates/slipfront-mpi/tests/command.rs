//! The command under mpirun: its files and messages, for every way in which it can end.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod support;

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::LazyLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

use rstest::rstest;
use tempfile::TempDir;

use crate::support::results::{Files, assert_same, results};
use crate::support::{SECONDS_TO_END, mpirun, output, printed, run_plain, run_plain_command};

/// Long enough to be stopped: `mpirun` waits a second before it passes a signal on to the ranks. With a
/// checkpoint at every step, one rank takes some eight seconds.
const SLOW: &str = "[slider]\nblocks = [240, 200]\nedges = ['periodic', 'free']\n[drive]\nv_star = 0.008\n\
    [time]\nduration_star = 800\n";

/// The command on `ranks` ranks, in a folder.
fn on_ranks(ranks: usize, folder: &TempDir, line: &str) -> Command {
    let mut command = mpirun(ranks, env!("CARGO_BIN_EXE_slipfront-mpi"));
    command.args(line.split_whitespace()).current_dir(folder);
    command
}

#[test]
#[ignore = "runs in a process of its own"]
fn plain_command() {
    run_plain_command();
}

/// Results of [`SLOW`] by the plain command.
static SLOW_RESULTS: LazyLock<Files> = LazyLock::new(|| {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("slow.toml"), SLOW).unwrap();
    run_plain(folder.path(), "run slow.toml --quiet -o plain");
    results(&folder.path().join("plain"))
});

/// Waits until a run has saved its first checkpoint.
fn wait_for_checkpoint(folder: &Path) {
    let began = Instant::now();
    while !folder.join(".slipfront/checkpoint.bin").exists() {
        assert!(began.elapsed() < Duration::from_secs(60), "no checkpoint");
        sleep(Duration::from_millis(5));
    }
}

/// Receiver of a signal.
#[derive(Clone, Copy)]
enum Target {
    Mpirun,
    LastRank,
}

/// Command that resumes a run.
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

/// All ranks produce the same usage, help and refusals, and only one prints them.
#[rstest]
#[case("run --nonsense", 2, "unexpected argument '--nonsense'")]
#[case("--help", 0, "bit-identical")]
#[case("licences", 0, "Copyright (c) The slipfront developers")]
#[case(
    "run --set slider.blocks=[40,2] -o results",
    2,
    "more ranks (3) than rows of blocks (2)"
)]
#[case(
    "run --set friction.contact='springs' --set friction.contact_stiffness_star=1 --set friction.redraw=true -o results",
    2,
    "takes the coefficient of any block"
)]
#[case("run nowhere.toml", 2, "nowhere.toml")]
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

/// Cases with shapes, edges, textures, masks and fields, directions, instants and snapshots at some rows,
/// sums at every step, slow drives, and other drives and laws in either kernel.
const CASES: [(&str, &str); 8] = [
    ("baseline", ""),
    (
        "oblique",
        "slider = { blocks = [33, 29], edges = ['periodic', 'periodic'] }\ndrive = { v_star = 0.1, direction = 25 }\n\
         time.duration_star = 60\noutput = { stride = 3, snapshots = { every = 10.0 } }\n\
         texture = [{ shape = 'cavity', coverage = 12 }, { shape = 'groove', orientation = 'along', width = '4 um' }]\n",
    ),
    (
        "given",
        "slider = { blocks = [17, 11], edges = ['free', 'periodic'] }\ndrive.v_star = 0.05\ntime.duration_star = 120\n\
         friction = { mu_static_field = 'mu.csv', mu_kinetic_field = 'half.csv' }\n\
         [[texture]]\nshape = 'mask'\nfile = 'mask.npy'\n",
    ),
    (
        "rows",
        "slider = { blocks = [300, 7], edges = ['periodic', 'free'] }\ndrive.v_star = 0.1\ntime.duration_star = 60\n\
         output.stride = 2\n",
    ),
    (
        "slow",
        "slider.blocks = [25, 24]\ndrive.v_star = 0.002\ntime.stop = 'after_onset'\n",
    ),
    (
        "narrow",
        "slider.blocks = [1, 40]\ndrive.v_star = 0.05\ntime.duration_star = 100\n",
    ),
    (
        "edge",
        "slider = { blocks = [21, 15], stiffness_grade = { along = 'y', from = 0.5, to = 1.5 } }\n\
         drive = { v_star = 0.2, attach = 'bottom', direction = 90 }\ntime.duration_star = 200\n",
    ),
    (
        "disc",
        "slider = { blocks = [19, 19], outline = 'disc', viscosity_time_star = 0.2 }\ndrive = { v_star = 0.1, motion = 'rotation' }\n\
         friction = { law = 'rate_and_state', a = 0.02, b = 0.03, d_c_star = 0.5, v_0_star = 0.1 }\ntime.duration_star = 60\n",
    ),
];

/// A folder with a case and the files that it reads.
fn folder_of(text: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    write("case.toml", text.as_bytes());
    let table = |mean: f64| {
        let value = |k: usize| format!("{:.4}", mean * (1.0 + 0.1 * (k as f64 * 1.7).sin()));
        let row = |j: usize| (0..17).map(|i| value(17 * j + i)).collect::<Vec<_>>().join(",") + "\n";
        (0..11).map(row).collect::<String>()
    };
    write("mu.csv", table(0.47).as_bytes());
    write("half.csv", table(0.28).as_bytes());
    let header = "{'descr': '|b1', 'fortran_order': False, 'shape': (11, 17), }";
    let mut mask = b"\x93NUMPY\x01\x00".to_vec();
    mask.extend((header.len() as u16).to_le_bytes());
    mask.extend(header.as_bytes());
    mask.extend((0..187).map(|k| u8::from(k % 17 > 5 && k % 17 < 11 && k > 50 && k < 130)));
    write("mask.npy", &mask);
    folder
}

#[rstest]
fn a_run_on_ranks_writes_the_bytes_of_the_plain_command(#[values(0, 1, 2, 3, 4, 5, 6, 7)] case: usize) {
    let (name, text) = CASES[case];
    let folder = folder_of(text);
    run_plain(folder.path(), "run case.toml -o plain");
    let plain = results(&folder.path().join("plain"));
    for ranks in [1, 2, 3, 4, 7] {
        let line = format!("run case.toml -o ranks-{ranks}");
        let output = output(&mut on_ranks(ranks, &folder, &line));
        let text = printed(&output);
        assert!(output.status.success(), "{name} on {ranks} ranks: {text}");
        assert_eq!(text.matches("static friction").count(), 1, "{text}");
        assert_same(&plain, &results(&folder.path().join(format!("ranks-{ranks}"))));
    }
}

/// Message of a run that was stopped and has saved its state.
const SAVED: &str = "the state is saved, and `slipfront-mpi run --resume stopped` resumes the run";

/// mpirun passes on SIGUSR2 unchanged. After SIGINT and SIGTERM it sends SIGTERM to the ranks, and exits with
/// status 1 whatever their status. mpirun itself reports a rank that was killed.
#[rstest]
#[case(Target::Mpirun, "-USR2", 140, SAVED, Resumed::OnRanks)]
#[case(Target::Mpirun, "-TERM", 1, SAVED, Resumed::Plain)]
#[case(Target::Mpirun, "-INT", 1, SAVED, Resumed::OnRanks)]
#[case(Target::LastRank, "-TERM", 143, SAVED, Resumed::Plain)]
#[case(Target::LastRank, "-KILL", 137, "signal 9", Resumed::OnRanks)]
fn a_run_that_is_stopped_by_a_signal_goes_on_in_either_command(
    #[values(1, 3)] ranks: usize,
    #[case] target: Target,
    #[case] signal: &str,
    #[case] status: i32,
    #[case] sentence: &str,
    #[case] resumed: Resumed,
) {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("slow.toml"), SLOW).unwrap();
    let mut command = on_ranks(ranks, &folder, "run slow.toml --checkpoint 0s -o stopped");
    // Users have this default: ranks that mpirun stops have time to save their state.
    command.env_remove(SECONDS_TO_END);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    wait_for_checkpoint(&folder.path().join("stopped"));
    send(signal, target, &child);
    let stopped = child.wait_with_output().unwrap();
    let text = printed(&stopped);
    assert_eq!(text.matches(sentence).count(), 1, "{text}");
    assert_eq!(stopped.status.code(), Some(status), "{text}");
    let line = "run --quiet --resume stopped";
    match resumed {
        Resumed::Plain => run_plain(folder.path(), line),
        Resumed::OnRanks => {
            // The run is resumed with another number of ranks.
            let output = output(&mut on_ranks(ranks + 1, &folder, line));
            assert!(output.status.success(), "{}", printed(&output));
        }
    }
    assert_same(&SLOW_RESULTS, &results(&folder.path().join("stopped")));
}
