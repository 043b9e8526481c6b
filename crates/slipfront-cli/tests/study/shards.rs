//! Parts of a study on several machines.

use crate::bench::{Bench, SMALL, SMALL_RUNS, errors};

#[test]
fn two_shards_merged_are_one_study() {
    let bench = Bench::with(SMALL);
    let whole = bench.study("whole");
    for part in ["1", "2"] {
        bench.run(&[
            "study.toml",
            "--shard",
            &format!("{part}/2"),
            "-o",
            &format!("part{part}"),
        ]);
        bench
            .results(&format!("part{part}"))
            .assert_each_run_once(SMALL_RUNS / 2);
    }
    let missing = bench.output(&["merge", "part1", "-o", "half"]);
    assert_eq!(missing.status.code(), Some(1));
    assert!(
        errors(&missing).contains("18 runs are in none of the shards"),
        "{}",
        errors(&missing)
    );

    for merged in ["merged", "merged", "half"] {
        let output = bench.output(&["merge", "part1", "part2", "-o", merged]);
        assert!(output.status.success(), "{}", errors(&output));
        bench.results(merged).assert_same(&whole);
        bench.results(merged).assert_each_run_once(SMALL_RUNS);
    }
    let again = bench.output(&["merge", "part2", "part1", "-o", "merged"]);
    assert!(errors(&again).contains("0 runs taken over"), "{}", errors(&again));
    // A united folder is a study folder like any other.
    bench.run(&["merged/study.toml", "-o", "merged"]);
    bench.results("merged").assert_each_run_once(SMALL_RUNS);
}

#[test]
fn run_folders_that_shards_kept_are_taken_over() {
    let kept = SMALL
        .replace("replicates = 3", "replicates = 1\nkeep = 'all'")
        .replace("[0.08, 0.1, 0.12, 0.14, 0.16, 0.18]", "[0.1, 0.12]");
    let bench = Bench::with(&kept);
    bench.study("whole");
    for part in ["1", "2"] {
        let out = format!("part{part}");
        bench.run(&["study.toml", "--shard", &format!("{part}/2"), "-o", &out]);
    }
    // What kills left: of an earlier try, of a run in the folder, and of one in a shard which another one holds whole.
    bench.write("merged/records.jsonl", "");
    for run in std::fs::read_dir(bench.path("part2/runs")).unwrap() {
        let run = run.unwrap().file_name().into_string().unwrap();
        for out in ["merged", "part1"] {
            bench.write(&format!("{out}/runs/{run}/case.toml"), "half of");
            bench.write(&format!("{out}/runs/{run}/.slipfront/tmp/AbCdEf"), "half of");
        }
    }
    for _ in 0..2 {
        bench.run(&["merge", "part1", "part2", "-o", "merged"]);
        let names = |out: &str| -> std::collections::BTreeSet<_> {
            let runs = std::fs::read_dir(bench.path(out).join("runs")).unwrap();
            runs.map(|entry| entry.unwrap().file_name()).collect()
        };
        assert_eq!(names("merged"), names("whole"));
        for run in names("whole") {
            for file in ["fields.nc", "summary.json", "case.toml"] {
                let read =
                    |out: &str| std::fs::read(bench.path(out).join("runs").join(&run).join(file)).unwrap();
                assert!(read("merged") == read("whole"), "{run:?}/{file}");
            }
            assert!(!bench.path("merged/runs").join(&run).join(".slipfront").exists());
        }
    }
    let verify = assert_cmd::Command::new(env!("CARGO_BIN_EXE_slipfront"))
        .current_dir(bench.path(""))
        .args(["verify", "merged"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&verify.stdout);
    assert!(
        verify.status.success() && said.contains("4 run folders") && !said.contains("note"),
        "{said}"
    );
}

#[test]
fn foreign_shards_are_refused() {
    let bench = Bench::with(SMALL);
    bench.write("other.toml", SMALL.replace("0.08", "0.09"));
    bench.run(&["study.toml", "--shard", "1/2", "-o", "ours"]);
    bench.run(&["other.toml", "--shard", "2/2", "-o", "theirs"]);
    for (shards, out) in [(["ours", "theirs"], "merged"), (["ours", "ours"], "theirs")] {
        let output = bench.output(&["merge", shards[0], shards[1], "-o", out]);
        assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
        assert!(
            errors(&output).contains("belongs to another study"),
            "{}",
            errors(&output)
        );
    }
    let output = bench.output(&["merge", "nowhere", "-o", "merged"]);
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
}

#[test]
fn adaptive_shards_merged_are_one_study() {
    let until = "until = { key = 'static_friction_star', half_width = 0.02, min = 3, max = 12 }";
    let bench = Bench::with(&SMALL.replace("replicates = 3", until));
    let whole = bench.study("whole");
    for part in ["1/3", "2/3", "3/3"] {
        bench.run(&[
            "study.toml",
            "--shard",
            part,
            "-o",
            &format!("part{}", &part[..1]),
        ]);
    }
    bench.run(&["merge", "part1", "part2", "part3", "-o", "merged"]);
    bench.results("merged").assert_same(&whole);
}

#[test]
fn a_shard_of_slurm_is_read_from_its_environment() {
    let bench = Bench::with(SMALL);
    bench.run(&["study.toml", "--shard", "2/3", "-o", "given"]);
    let task = |out: &str, id: &str| {
        let mut command = bench.command(&["study.toml", "--shard", "slurm", "-o", out]);
        command
            .env("SLURM_ARRAY_TASK_ID", id)
            .env("SLURM_ARRAY_TASK_COUNT", "3");
        command
    };
    // An array may begin at any number; without one it is taken to begin at 1.
    task("one", "2").assert().success();
    task("zero", "1")
        .env("SLURM_ARRAY_TASK_MIN", "0")
        .assert()
        .success();
    for out in ["one", "zero"] {
        bench.results(out).assert_same(&bench.results("given"));
    }
    let outside = task("outside", "4").assert().code(2);
    let said = String::from_utf8_lossy(&outside.get_output().stderr).into_owned();
    assert!(said.contains("there is no part 4 of 3"), "{said}");
    let nowhere = bench.output(&["study.toml", "--shard", "slurm", "-o", "nowhere"]);
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(
        errors(&nowhere).contains("SLURM_ARRAY_TASK_ID is not set"),
        "{}",
        errors(&nowhere)
    );
    assert!(!bench.path("nowhere").exists());
}

#[test]
fn more_shards_than_points_leave_some_with_nothing_to_do() {
    let bench = Bench::with(SMALL);
    bench.run(&["study.toml", "--shard", "7/7", "-o", "none"]);
    assert_eq!(bench.results("none").recorded().len(), 0);
    assert_eq!(bench.results("none").table("runs.csv").len(), 0);
}

#[test]
fn a_batch_script_asks_for_no_more_tasks_than_points() {
    let bench = Bench::with(SMALL);
    let script = bench.run(&["slurm", "study.toml", "--tasks", "9", "-o", "there"]);
    let out = bench.path("there");
    for line in [
        "#SBATCH --array=1-6\n",
        "#SBATCH --requeue\n",
        "--shard \"$SLURM_ARRAY_TASK_ID/6\"",
        &format!("--out {}/shard-", out.display()),
    ] {
        assert!(script.contains(line), "{line} is not in\n{script}");
    }
    bench.write("wrong.toml", SMALL.replace("0.08", "-1"));
    assert_eq!(bench.output(&["slurm", "wrong.toml"]).status.code(), Some(2));
}
