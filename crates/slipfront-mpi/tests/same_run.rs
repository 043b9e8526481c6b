//! Ranks with different inputs: all of them end before anything is written, with one sentence that names the
//! difference and the rank. Inputs that do not affect the results may differ.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod support;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;

use rstest::rstest;
use slipfront::Execution;
use slipfront::communicator::Alone;
use slipfront_case::case::{Case, Ranks};
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::running::Running;
use slipfront_run::{clock, results as run_results};
use tempfile::TempDir;

use crate::support::results::{assert_same, results};
use crate::support::{launcher, output, printed, run_plain, run_plain_command};

const PROGRAM: &str = env!("CARGO_BIN_EXE_slipfront-mpi");

const CASE: &str = "slider = { blocks = [12, 10], edges = ['periodic', 'free'] }\ndrive.v_star = 0.1\ntime.duration_star = 60\n\
                    friction.mu_static_field = 'mu.csv'\n";

const RUN: &str = "run m.toml -q -o ../k";

#[test]
#[ignore = "runs in a process of its own"]
fn plain_command() {
    run_plain_command();
}

/// A number for each block of [`CASE`].
fn table() -> String {
    let row = |j: usize| {
        (0..12)
            .map(|i| format!("0.{}", 400 + 7 * i + 3 * j))
            .collect::<Vec<_>>()
    };
    (0..10).map(|j| row(j).join(",") + "\n").collect()
}

/// A folder with a subfolder for each of two ranks, both with the same case and the same file that it reads.
fn two_places() -> TempDir {
    let folder = TempDir::new().unwrap();
    for place in ["a", "b"] {
        let place = folder.path().join(place);
        std::fs::create_dir(&place).unwrap();
        std::fs::write(place.join("m.toml"), CASE).unwrap();
        std::fs::write(place.join("mu.csv"), table()).unwrap();
    }
    folder
}

/// Runs two ranks, each with its own program and arguments, one in `a` and one in `b`.
fn two_ranks(folder: &Path, ranks: [(&str, &str); 2]) -> Output {
    let mut command = launcher();
    for ((program, line), (place, begin)) in ranks.into_iter().zip([("a", &[][..]), ("b", &[":"])]) {
        command.args(begin).args(["-n", "1", "-wdir"]);
        command
            .arg(folder.join(place))
            .arg(program)
            .args(line.split_whitespace());
    }
    output(&mut command)
}

/// Every file and folder below a folder, with the contents of the files.
fn tree(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut tree = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            tree.append(&mut self::tree(&path));
        }
        tree.insert(path.clone(), std::fs::read(&path).unwrap_or_default());
    }
    tree
}

/// Asserts that both ranks refuse, with one sentence in total, and have written nothing.
fn assert_refused(folder: &Path, ranks: [(&str, &str); 2], wanted: &[&str]) {
    let before = tree(folder);
    let refused = two_ranks(folder, ranks);
    let text = printed(&refused);
    // No rank has waited until the `--timeout` of mpirun.
    assert!(!text.contains("mpirun --timeout"), "{text}");
    assert_eq!(refused.status.code(), Some(2), "{text}");
    let sentences: Vec<&str> = text.lines().filter(|line| line.starts_with("error: ")).collect();
    assert_eq!(sentences.len(), 1, "{text}");
    for wanted in wanted {
        assert!(sentences[0].contains(wanted), "{wanted}: {text}");
    }
    assert!(!text.contains("MPI_ERR") && !text.contains("panicked"), "{text}");
    let after = tree(folder);
    assert!(before == after, "{:?}", after.keys());
}

#[rstest]
#[case::speed("drive.v_star=0.2", "`drive.v_star` is 0.2 on rank 1 and 0.1 on rank 0")]
#[case::seed("friction.seed=7", "`friction.seed` is 7 on rank 1 and 1 on rank 0")]
#[case::direction("drive.direction=30", "`drive.direction` is 30.0 on rank 1 and 0.0 on rank 0")]
#[case::snapshots("output.snapshots=[3,40]", "`output.snapshots` is [3.0, 40.0] on rank 1 and")]
#[case::duration("time.duration_star=90", "`time.duration_star` is 90.0 on rank 1 and 60.0")]
#[case::blocks(
    "slider.blocks=[12,9]",
    "`slider.blocks` is [12, 9] on rank 1 and [12, 10] on rank 0"
)]
#[case::fewer_rows_than_ranks("slider.blocks=[12,1]", "`slider.blocks` is [12, 1] on rank 1 and")]
#[case::edges("slider.edges=['free','free']", "`slider.edges` is")]
#[case::texture(
    "texture=[{shape='cavity',coverage=5}]",
    "`texture.0.shape` is \"cavity\" on rank 1 and not given on rank 0"
)]
#[case::time_step("time.step=0.01", "`time.step` is 0.01 on rank 1")]
#[case::law("friction.law='reversal'", "`friction.law` is \"reversal\" on rank 1")]
#[case::wrong_value("drive.v_star=-1", "rank 1: --set drive.v_star=-1")]
#[case::unknown_key("drive.v=1", "rank 1: --set drive.v=1")]
fn another_case_is_refused(#[case] change: &str, #[case] sentence: &str) {
    let folder = two_places();
    let changed = format!("{RUN} --set {change}");
    assert_refused(folder.path(), [(PROGRAM, RUN), (PROGRAM, &changed)], &[sentence]);
    // The sentence is the same if the ranks are swapped.
    let key = sentence.split_inclusive('`').take(2).collect::<String>();
    let key = if key.starts_with('`') {
        key.as_str()
    } else {
        "--set"
    };
    assert_refused(folder.path(), [(PROGRAM, &changed), (PROGRAM, RUN)], &[key]);
}

#[rstest]
#[case::value("mu.csv", Some(table().replace("0.400", "0.401")), "mu.csv (`friction.mu_static_field`) is a file of 720 bytes")]
#[case::length("mu.csv", Some(table() + "# edited\n"), "is a file of 729 bytes")]
#[case::no_input("mu.csv", None, "rank 1: m.toml:4")]
#[case::case_file("m.toml", Some(CASE.replace("0.1", "0.05")), "`drive.v_star` is 0.05 on rank 1 and 0.1 on rank 0")]
#[case::no_case_file("m.toml", None, "rank 1: cannot read m.toml")]
#[case::no_case("m.toml", Some("slider = 3".to_owned()), "rank 1: m.toml:1")]
fn another_file_is_refused(#[case] name: &str, #[case] contents: Option<String>, #[case] sentence: &str) {
    let folder = two_places();
    let path = folder.path().join("b").join(name);
    match contents {
        Some(contents) => std::fs::write(path, contents).unwrap(),
        None => std::fs::remove_file(path).unwrap(),
    }
    assert_refused(folder.path(), [(PROGRAM, RUN); 2], &[sentence]);
}

#[rstest]
#[case::unknown_option(
    "run m.toml -q -o ../k --nonsense",
    "rank 1: unexpected argument '--nonsense'"
)]
#[case::no_arguments("", "rank 1: a subcommand is missing")]
#[case::other_command("check m.toml", "rank 1: unrecognized subcommand 'check'")]
#[case::help("run --help", "what is asked for is help on rank 1 and a run on rank 0")]
#[case::version("--version", "what is asked for is the version on rank 1")]
#[case::embedded_case("run -q -o ../k", "`slider.blocks` is [25, 25] on rank 1 and [12, 10]")]
#[case::embedded_case_wrong("run -q -o ../k --set foo=1", "rank 1: --set foo=1")]
#[case::resume("run --resume ../k", "--resume is given on rank 1 and not given on rank 0")]
#[case::json("run m.toml --json -o ../k", "--json is given on rank 1")]
#[case::checkpoints(
    "run m.toml -q -o ../k --checkpoint off",
    "--checkpoint is off on rank 1 and 300s on rank 0"
)]
#[case::interval("run m.toml -q -o ../k --checkpoint 1s", "--checkpoint is 1s on rank 1")]
#[case::force(
    "run m.toml -q -o ../k --force",
    "--force is given on rank 1 and not given on rank 0"
)]
#[case::folder("run m.toml -q -o k", "rank 1: the folder k is not the folder ../k of rank 0")]
#[case::no_folder(
    "run m.toml -q -o nowhere/new",
    "rank 1: the folder nowhere/new is not the folder ../k of rank 0"
)]
fn another_command_is_refused(#[case] line: &str, #[case] sentence: &str) {
    let folder = two_places();
    assert_refused(folder.path(), [(PROGRAM, RUN), (PROGRAM, line)], &[sentence]);
}

/// A rank of another build is refused: builds are compared by the hash of their sources, in every digit.
#[test]
fn another_build_is_refused() {
    let folder = two_places();
    let mut program = std::fs::read(PROGRAM).unwrap();
    let hash = slipfront_case::SOURCE_HASH.as_bytes();
    let places: Vec<usize> = (0..program.len() - hash.len())
        .filter(|&begin| program[begin..].starts_with(hash))
        .collect();
    assert!(!places.is_empty());
    for place in places {
        program[place] = if hash[0] == b'0' { b'1' } else { b'0' };
    }
    let other = folder.path().join("other");
    std::fs::copy(PROGRAM, &other).unwrap();
    std::fs::write(&other, program).unwrap();
    // The builds are compared first, before an option that only one of them knows.
    let line = format!("{RUN} --new-option");
    let ranks = [(PROGRAM, RUN), (other.to_str().unwrap(), &line)];
    assert_refused(
        folder.path(),
        ranks,
        &["the build is slipfront ", "on rank 1 and slipfront "],
    );
}

/// A folder that only one rank would replace keeps its contents.
#[test]
fn results_are_not_replaced_by_a_run_that_is_refused() {
    let folder = two_places();
    run_plain(&folder.path().join("a"), RUN);
    let forced = format!("{RUN} --force");
    let elsewhere = "run m.toml -q -o other --force";
    let sentence = "rank 1: the folder other is not the folder ../k of rank 0";
    assert_refused(
        folder.path(),
        [(PROGRAM, &forced), (PROGRAM, elsewhere)],
        &[sentence],
    );
    assert_refused(
        folder.path(),
        [(PROGRAM, elsewhere), (PROGRAM, &forced)],
        &["rank 1: the folder"],
    );
}

/// A run of [`CASE`] that was stopped after two checkpoints, the first at step `first`.
fn stopped_run(place: &Path, overrides: &[String], first: u64) {
    let case = Case::load(&place.join("m.toml"), overrides, &mut |_| true, Ranks::ALONE).unwrap();
    let case = Arc::new(case);
    let path = place.join("k");
    let mut run = RunFolder::prepare(&path, false, &case.inputs).unwrap();
    run_results::write_case(&case, &mut run).unwrap();
    let mut running = Running::start(&case, None, Execution::default());
    let mut checkpoints = Checkpoints::new(&path, &case, clock::now());
    for steps in [first, 20] {
        running.advance(steps).unwrap();
        checkpoints.save(&running, &Alone).unwrap();
    }
}

fn copy(from: &Path, to: &Path) {
    let copied = Command::new("cp").arg("-a").args([from, to]).status();
    assert!(copied.unwrap().success());
}

/// Folders of the same name on different machines can have different contents.
#[rstest]
#[case::other_step("", "the step of the checkpoint is 55 on rank 1 and 50 on rank 0")]
#[case::other_case("", "`drive.v_star` is 0.2 on rank 1 and 0.1 on rank 0")]
#[case::no_run("rm -r k", "rank 1: k is not the folder of a run that can be resumed")]
#[case::no_checkpoint(
    "rm k/.slipfront/*.bin",
    "checkpoint.bin is missing on rank 1 and there on rank 0"
)]
#[case::other_input(
    "echo '# edited' >> k/inputs/mu.csv",
    "mu.csv (`friction.mu_static_field`) is a file of 729 bytes"
)]
#[case::cut(
    "truncate -s 900 k/.slipfront/checkpoint.bin",
    "the length of the checkpoint is 900 bytes on rank 1"
)]
#[case::damaged(
    "printf x | dd of=k/.slipfront/checkpoint.bin bs=1 seek=900 conv=notrunc",
    "its checksum is wrong"
)]
#[case::equal("true", "rank 1: the folder k is not the folder k of rank 0")]
fn another_folder_is_not_resumed(#[case] change: &str, #[case] sentence: &str) {
    let folder = two_places();
    let [a, b] = ["a", "b"].map(|place| folder.path().join(place));
    stopped_run(&a, &[], 30);
    if change.is_empty() {
        let is_other = sentence.contains("v_star");
        let other: &[String] = if is_other {
            &["drive.v_star=0.2".to_owned()]
        } else {
            &[]
        };
        stopped_run(&b, other, if is_other { 30 } else { 35 });
    } else {
        copy(&a.join("k"), &b.join("k"));
        let changed = Command::new("sh").args(["-c", change]).current_dir(&b).output();
        assert!(changed.unwrap().status.success());
    }
    assert_refused(folder.path(), [(PROGRAM, "run -q --resume k"); 2], &[sentence]);
    let previous = "run -q --resume k --previous";
    assert_refused(
        folder.path(),
        [(PROGRAM, "run -q --resume k"), (PROGRAM, previous)],
        &["--previous is given on rank 1"],
    );
    run_plain(&a, "run -q --resume k");
}

/// Threads, spellings of the folder, names of the case and printed output may differ: the results are those
/// of a run on one rank.
#[rstest]
#[case::threads("run m.toml -q -o ../k --threads 1", "run m.toml -q -o ../k --threads 2")]
#[case::spelling("run m.toml -q -o ../k", "run m.toml -q -o ABSOLUTE/k")]
#[case::slash("run m.toml -q -o ../k/", "run m.toml -q -o .././a/../k")]
#[case::link("run m.toml -q -o ../k", "run m.toml -q -o link/k")]
#[case::quiet("run m.toml -o ../k", "run m.toml -q -o ../k")]
#[case::name("run m.toml -q -o ../k", "run ../b/m.toml -q -o ../k")]
#[case::notation(
    "run m.toml -q -o ../k --set drive.v_star=1e-1",
    "run m.toml -q -o ../k --seed 1"
)]
fn what_need_not_be_the_same_may_differ(#[case] line: &str, #[case] other: &str) {
    let folder = two_places();
    let place = folder.path().to_str().unwrap();
    std::os::unix::fs::symlink(place, folder.path().join("b/link")).unwrap();
    let other = other.replace("ABSOLUTE", place);
    let run = two_ranks(folder.path(), [(PROGRAM, line), (PROGRAM, &other)]);
    assert!(run.status.success(), "{}", printed(&run));
    run_plain(&folder.path().join("a"), "run m.toml -q -o plain");
    let found = results(&folder.path().join("k"));
    assert_same(&results(&folder.path().join("a/plain")), &found);
}

/// Two ranks resume one run under two names, which are links to the same folder.
#[test]
fn a_run_is_resumed_under_two_names() {
    let folder = two_places();
    let [a, b] = ["a", "b"].map(|place| folder.path().join(place));
    stopped_run(&a, &[], 30);
    std::os::unix::fs::symlink(a.join("k"), b.join("other")).unwrap();
    let ranks = [
        (PROGRAM, "run -q --resume k"),
        (PROGRAM, "run -q --resume other/"),
    ];
    let run = two_ranks(folder.path(), ranks);
    assert!(run.status.success(), "{}", printed(&run));
    run_plain(&a, "run m.toml -q -o plain");
    assert_same(&results(&a.join("plain")), &results(&a.join("k")));
}
