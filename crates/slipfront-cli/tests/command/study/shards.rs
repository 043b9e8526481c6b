//! Shards of a study on several machines.

use super::results::{SMALL, SMALL_RUNS};
use crate::support::process::{ended_with, stderr, stdout};
use crate::support::workspace::Workspace;

#[test]
fn two_shards_merged_are_one_study() {
    let workspace = Workspace::with_study(SMALL);
    let whole = workspace.study("whole");
    for part in ["1", "2"] {
        workspace.succeed(&format!("study study.toml --shard {part}/2 -o part{part}"));
        workspace
            .results(&format!("part{part}"))
            .assert_each_run_once(SMALL_RUNS / 2);
    }
    let missing = workspace.output("study merge part1 -o half");
    assert_eq!(missing.status.code(), Some(1));
    assert!(
        stderr(&missing).contains("18 runs are in none of the shards"),
        "{}",
        stderr(&missing)
    );

    for merged in ["merged", "merged", "half"] {
        let output = workspace.output(&format!("study merge part1 part2 -o {merged}"));
        assert!(output.status.success(), "{}", stderr(&output));
        workspace.results(merged).assert_same(&whole);
        workspace.results(merged).assert_each_run_once(SMALL_RUNS);
    }
    let again = workspace.output("study merge part2 part1 -o merged");
    assert!(stderr(&again).contains("0 runs taken over"), "{}", stderr(&again));
    // A merged folder is a study folder like any other.
    workspace.succeed("study merged/study.toml -o merged");
    workspace.results("merged").assert_each_run_once(SMALL_RUNS);
}

#[test]
fn run_folders_that_shards_kept_are_taken_over() {
    let kept = SMALL
        .replace("replicates = 3", "replicates = 1\nkeep = 'all'")
        .replace("[0.08, 0.1, 0.12, 0.14, 0.16, 0.18]", "[0.1, 0.12]");
    let workspace = Workspace::with_study(&kept);
    workspace.study("whole");
    for part in ["1", "2"] {
        let out = format!("part{part}");
        workspace.succeed(&format!("study study.toml --shard {part}/2 -o {out}"));
    }
    // Leftovers of kills: of an earlier merge, of a run in the folder, and of a run in one shard that another
    // shard has completed.
    workspace.write("merged/runs.jsonl", "");
    let hash = blake3::hash(b"an old case").to_hex();
    let journal = format!("{{\"name\":\"case.toml\",\"bytes\":11,\"blake3\":\"{hash}\"}}\n");
    for run in std::fs::read_dir(workspace.path("part2/runs")).unwrap() {
        let run = run.unwrap().file_name().into_string().unwrap();
        for out in ["merged", "part1"] {
            workspace.write(&format!("{out}/runs/{run}/case.toml"), "an old case");
            workspace.write(&format!("{out}/runs/{run}/.slipfront/journal.jsonl"), &journal);
            workspace.write(&format!("{out}/runs/{run}/.slipfront/tmp/AbCdEf"), "half of");
        }
    }
    for _ in 0..2 {
        workspace.succeed("study merge part1 part2 -o merged");
        let names = |out: &str| -> std::collections::BTreeSet<_> {
            let runs = std::fs::read_dir(workspace.path(out).join("runs")).unwrap();
            runs.map(|entry| entry.unwrap().file_name()).collect()
        };
        assert_eq!(names("merged"), names("whole"));
        for run in names("whole") {
            for file in ["fields.nc", "summary.json", "case.toml"] {
                let read = |out: &str| {
                    std::fs::read(workspace.path(out).join("runs").join(&run).join(file)).unwrap()
                };
                assert!(read("merged") == read("whole"), "{run:?}/{file}");
            }
            assert!(
                !workspace
                    .path("merged/runs")
                    .join(&run)
                    .join(".slipfront")
                    .exists()
            );
        }
    }
    let verify = workspace.output("verify merged");
    let said = stdout(&verify);
    assert!(
        verify.status.success() && said.contains("4 run folders") && !said.contains("note"),
        "{said}"
    );
}

/// The case of a run that failed is taken over; a run folder that its journal does not name is refused.
#[test]
fn kept_folders_of_shards_are_those_of_their_runs() {
    let workspace = Workspace::with_study(
        "[base]\nslider = { blocks = [6, 6], omega_star = 0 }\ndrive = { v_star = 10 }\n\
         friction = { r_star = 0, sigma_static_star = 1 }\ntime = { step = 0.9, duration_star = 2000 }\n\
         [study]\nkeep = 'failed'\n\
         [[axes]]\nkey = 'load.pressure'\nlist = ['50 GPa', '100 kPa', '49 GPa']\n",
    );
    for part in ["1", "2"] {
        let out = workspace.output(&format!("study study.toml --shard {part}/2 -q -o part{part}"));
        assert_eq!(out.status.code(), Some(if part == "1" { 1 } else { 0 }));
    }
    workspace.fail("study merge part1 part2 -q -o merged", 1);
    let of_failed = |folder: &str| {
        let mut files = workspace.files(&format!("{folder}/runs"));
        files.retain(|name, _| name.ends_with("case.toml"));
        files
    };
    let kept = of_failed("part1");
    assert_eq!(kept.len(), 2);
    assert!(of_failed("merged") == kept);
    let names: Vec<&String> = kept.keys().collect();
    for folder in ["merged", "part1"] {
        workspace.write(&format!("{folder}/runs/{}", names[0]), &kept[names[1]]);
        let said = stdout(&workspace.output(&format!("verify --checksums {folder}")));
        assert!(
            said.contains("is not the folder of the run that the journal names"),
            "{said}"
        );
    }
    workspace.remove("merged");
    let said = workspace.fail("study merge part1 part2 -q -o merged", 1);
    assert!(
        said.contains("is not the folder of the run that the journal names"),
        "{said}"
    );
}

#[test]
fn foreign_shards_are_refused() {
    let workspace = Workspace::with_study(SMALL);
    workspace.write("other.toml", SMALL.replace("0.08", "0.09"));
    workspace.succeed("study study.toml --shard 1/2 -o ours");
    workspace.succeed("study other.toml --shard 2/2 -o theirs");
    for (shards, out) in [(["ours", "theirs"], "merged"), (["ours", "ours"], "theirs")] {
        let output = workspace.output(&format!("study merge {} {} -o {out}", shards[0], shards[1]));
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("belong to different studies"),
            "{}",
            stderr(&output)
        );
    }
    let output = workspace.output("study merge nowhere -o merged");
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
}

#[test]
fn adaptive_shards_merged_are_one_study() {
    let until = "until = { key = 'static_friction_star', half_width = 0.02, min = 3, max = 12 }";
    let workspace = Workspace::with_study(&SMALL.replace("replicates = 3", until));
    let whole = workspace.study("whole");
    for part in ["1/3", "2/3", "3/3"] {
        workspace.succeed(&format!("study study.toml --shard {part} -o part{}", &part[..1]));
    }
    workspace.succeed("study merge part1 part2 part3 -o merged");
    workspace.results("merged").assert_same(&whole);
}

#[test]
fn a_shard_of_slurm_is_read_from_its_environment() {
    let workspace = Workspace::with_study(SMALL);
    workspace.succeed("study study.toml --shard 2/3 -o given");
    let task = |out: &str, id: &str| {
        let mut command = workspace.process(&format!("study study.toml --shard slurm -o {out}"));
        command
            .env("SLURM_ARRAY_TASK_ID", id)
            .env("SLURM_ARRAY_TASK_COUNT", "3");
        command
    };
    // An array may begin at any number; by default it begins at 1.
    ended_with(&mut task("one", "2"), 0);
    ended_with(task("zero", "1").env("SLURM_ARRAY_TASK_MIN", "0"), 0);
    for out in ["one", "zero"] {
        workspace.results(out).assert_same(&workspace.results("given"));
    }
    // One task that is submitted alone is all of the study to Slurm.
    let alone = &mut task("given", "2");
    let alone = alone
        .env("SLURM_ARRAY_TASK_MIN", "2")
        .env("SLURM_ARRAY_TASK_COUNT", "1");
    let said = stderr(&ended_with(alone, 2));
    assert!(
        said.contains("given holds part 2/3 of this study, not part 1/1"),
        "{said}"
    );
    workspace.succeed("study study.toml --shard 2/3 -o given");
    let gaps = &mut task("gaps", "5");
    let said = stderr(&ended_with(gaps.env("SLURM_ARRAY_TASK_MAX", "5"), 2));
    assert!(said.contains("the indices of the array have gaps"), "{said}");
    let said = stderr(&ended_with(&mut task("outside", "4"), 2));
    assert!(said.contains("there is no part 4 of 3"), "{said}");
    let nowhere = workspace.output("study study.toml --shard slurm -o nowhere");
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(
        stderr(&nowhere).contains("SLURM_ARRAY_TASK_ID is not set"),
        "{}",
        stderr(&nowhere)
    );
    assert!(!workspace.path("nowhere").exists());
}

#[test]
fn more_shards_than_points_leave_some_with_nothing_to_do() {
    let workspace = Workspace::with_study(SMALL);
    workspace.succeed("study study.toml --shard 7/7 -o none");
    assert_eq!(workspace.results("none").recorded().len(), 0);
    assert_eq!(workspace.results("none").table("runs.csv").len(), 0);
}

#[test]
fn a_batch_script_asks_for_no_more_tasks_than_points() {
    let workspace = Workspace::with_study(SMALL);
    let script = workspace.succeed("study slurm study.toml --tasks 9 -o there");
    let out = workspace.path("there");
    for line in [
        "#SBATCH --array=1-6\n",
        "#SBATCH --requeue\n",
        "--shard \"$SLURM_ARRAY_TASK_ID/6\"",
        &format!("--out {}/shard-", out.display()),
    ] {
        assert!(script.contains(line), "{line} is not in\n{script}");
    }
    workspace.write("wrong.toml", SMALL.replace("0.08", "-1"));
    assert_eq!(workspace.output("study slurm wrong.toml").status.code(), Some(2));
}
