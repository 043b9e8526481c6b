//! File-system calls of one of two ranks fail or kill it, while both resume a run from its checkpoint. Both
//! ranks end with one error message, and the run that they leave can be resumed and gives the same bytes.
//!
//! By default a few calls are tried, each fault with one law; with `SLIPFRONT_TORTURE=long`, every call with
//! every law.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod support;
#[path = "../../slipfront-cli/tests/torture/watcher.rs"]
mod watcher;

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Output;
use std::sync::Arc;

use rstest::rstest;
use slipfront::Execution;
use slipfront::communicator::Alone;
use slipfront_case::case::Case;
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::running::Running;
use slipfront_run::{clock, results as run_results};
use tempfile::TempDir;

use crate::support::results::{Files, assert_same, results};
use crate::support::{launcher, mpirun, output, printed, run_plain, run_plain_command};
use crate::watcher::watcher;

/// Takes some tenths of a second, with frames before and after the checkpoint.
const CASE: &str = "slider = { blocks = [60, 50], edges = ['periodic', 'free'] }\ndrive.v_star = 0.05\n\
                    output = { snapshots = [20, 55], series = 5 }\n";

/// Laws of friction and a drive that each keep other numbers in a checkpoint, with the end of [`CASE`].
const LAWS: [&str; 6] = [
    "friction.slip_weakening = { length_star = 0.4 }\ntime.duration_star = 200\n",
    "friction.velocity = { law = 'weakening', v_c_star = 0.1, ratio = 0.2 }\ntime.duration_star = 200\n",
    "friction.ageing = { law = 'logarithmic', beta = 0.07, time_star = 1 }\ntime.duration_star = 200\n",
    "friction = { law = 'rate_and_state', a = 0.02, b = 0.06, d_c_star = 0.05, v_0_star = 0.01, mu_0 = 0.6 }\ntime.duration_star = 200\n",
    "friction.correlation_length = '3 um'\ntime.duration_star = 200\n",
    // The steps in which the drive is held come in addition; for 200 t* they would be a hundred thousand.
    "drive.loading = 'held'\ntime.duration_star = 60\n",
];

const RESUME: &str = "run --resume run --checkpoint 0s";

#[test]
#[ignore = "runs in a process of its own"]
fn plain_command() {
    run_plain_command();
}

/// Results of the plain command for [`CASE`] with a law.
fn undisturbed(law: &str) -> Files {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("case.toml"), format!("{CASE}{law}")).unwrap();
    run_plain(folder.path(), "run case.toml --quiet -o run");
    results(&folder.path().join("run"))
}

/// A folder with a run under a law, stopped halfway.
fn stopped_run(law: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("run");
    let case = Arc::new(Case::parse(&format!("{CASE}{law}"), "run", "", &[]).unwrap());
    let mut run = RunFolder::prepare(&path, false, &case.inputs).unwrap();
    run_results::write_case(&case, &mut run).unwrap();
    let mut running = Running::start(&case, None, Execution::default());
    running.advance(case.time_plan.last_step / 2).unwrap();
    let mut checkpoints = Checkpoints::new(&path, &case, clock::now());
    checkpoints.save(&running, &Alone).unwrap();
    folder
}

/// Resumes the run on two ranks. On one of them, the calls with numbers `from` to `to` that concern the run
/// folder are met with an action; 0 as `to` means no end. Also returns all of these calls.
fn resume_disturbed(folder: &Path, rank: usize, [action, from, to]: [&str; 3]) -> (Output, Vec<String>) {
    let log = folder.join("log");
    let mut command = launcher();
    for each in 0..2 {
        command
            .args(if each > 0 { &[":"][..] } else { &[] })
            .args(["-n", "1"]);
        if each == rank {
            let run = folder.join("run").canonicalize().unwrap();
            command
                .arg(watcher().unwrap())
                .arg(run)
                .args([action, from, to])
                .arg(&log);
        }
        command
            .arg(env!("CARGO_BIN_EXE_slipfront-mpi"))
            .args(RESUME.split(' '));
    }
    let output = output(command.current_dir(folder));
    let log = std::fs::read_to_string(log).unwrap();
    (output, log.lines().map(str::to_owned).collect())
}

/// Number of kinds of calls to try in the short form.
const SHORT: usize = 5;

/// Whether the long form was requested.
fn is_long() -> bool {
    std::env::var("SLIPFRONT_TORTURE").is_ok()
}

/// Numbers of the calls to try with an action: all in the long form, otherwise the first call of each of some
/// kinds. A kind is a name and a file.
fn calls_to_try(calls: &[String], action: &str) -> Vec<usize> {
    let long = is_long();
    let mut kinds = BTreeSet::new();
    let mut is_tried = |call: &str| {
        let mut words = call.splitn(3, ' ').skip(1);
        let (name, path) = (words.next().unwrap(), words.next().unwrap());
        let writes = ["write", "fsync", "fdatasync", "rename", "renameat", "mkdir"].contains(&name);
        // Names of temporary files contain the step of a checkpoint, or are random.
        let is_checkpoint = path.ends_with("checkpoint.bin");
        let path = path.split_inclusive("/tmp/").next().unwrap();
        let is_new = kinds.insert((name.to_owned(), path.to_owned(), is_checkpoint));
        // A full disk can still be read.
        (writes || action != "ENOSPC") && (is_new || long)
    };
    let tried = calls.iter().zip(1..).filter(|(call, _)| is_tried(call));
    let tried: Vec<usize> = tried.map(|(_, number)| number).collect();
    let step = if long { 1 } else { tried.len().div_ceil(SHORT) };
    tried.into_iter().step_by(step).collect()
}

#[rstest]
#[case::full_disk(0, "ENOSPC", true, "No space left on device")]
#[case::failing_disk(1, "EIO", false, "Input/output error")]
#[case::kill(2, "kill", false, "signal 9")]
fn a_fault_of_one_rank_is_the_answer_of_all(
    #[values(0, 1)] rank: usize,
    #[case] number: usize,
    #[case] action: &str,
    #[case] lasts: bool,
    #[case] cause: &str,
) {
    if watcher().is_none() {
        return;
    }
    // In the short form each fault of each rank has one law; in the long form all laws.
    let laws = if is_long() {
        &LAWS
    } else {
        &LAWS[2 * number + rank..][..1]
    };
    for law in laws {
        try_faults(rank, action, lasts, cause, law);
    }
}

fn try_faults(rank: usize, action: &str, lasts: bool, cause: &str, law: &str) {
    let whole = undisturbed(law);
    let folder = stopped_run(law);
    let (undisturbed, calls) = resume_disturbed(folder.path(), rank, [action, "0", "0"]);
    assert!(undisturbed.status.success(), "{}", printed(&undisturbed));
    for number in calls_to_try(&calls, action) {
        let folder = stopped_run(law);
        let run = folder.path().join("run");
        let from = number.to_string();
        let to = if lasts { "0" } else { &from };
        let (disturbed, calls) = resume_disturbed(folder.path(), rank, [action, &from, to]);
        let text = printed(&disturbed);
        eprintln!("{action} of rank {rank}: {:?}", disturbed.status.code());
        let met = calls.iter().find(|call| call.starts_with('*'));
        let case = format!("{law}{action} at {met:?}: {text}");
        // No rank has waited until the `--timeout` of mpirun.
        assert!(!text.contains("mpirun --timeout"), "{case}");
        let sentences: Vec<&str> = text.lines().filter(|line| line.starts_with("error: ")).collect();
        if disturbed.status.success() {
            // A checkpoint that cannot be saved causes only a warning, and the number of checkpoints depends
            // on the clock.
            assert!(action != "kill" || met.is_none(), "{case}");
            assert_same(&whole, &results(&run));
            continue;
        }
        if action == "kill" {
            assert_eq!(text.matches(cause).count(), 1, "{case}");
            assert!(sentences.is_empty(), "{case}");
        } else {
            assert_eq!(sentences.len(), 1, "{case}");
            assert!(
                sentences[0].contains(cause) && sentences[0].contains(" run"),
                "{case}"
            );
            // Bad input, such as an unreadable file, has other remedies.
            let has_remedy = sentences[0].contains("`slipfront-mpi run --resume run` resumes from");
            assert!(has_remedy || disturbed.status.code() == Some(2), "{case}");
        }
        if number % 2 == 0 {
            run_plain(folder.path(), "run --quiet --resume run");
        } else {
            let mut resumed = mpirun(3, env!("CARGO_BIN_EXE_slipfront-mpi"));
            resumed.args(["run", "--quiet", "--resume", "run"]);
            let resumed = output(resumed.current_dir(folder.path()));
            assert!(resumed.status.success(), "{case}\n{}", printed(&resumed));
        }
        assert_same(&whole, &results(&run));
        assert!(!run.join(".slipfront").exists(), "{case}");
    }
}
