//! The search for a texture.

use serde_json::Value;

use crate::fixtures::unwrapped;
use crate::support::process::{send, stderr, stdout, wait_for};
use crate::support::workspace::Workspace;

pub(crate) const WISH: &str = "[base]\nslider.blocks = [16, 16]\ndrive.v_star = 0.1\n\
    [design]\nwish = { least = 'static_friction' }\ncoverage = [0, 15]\nfeature_blocks = 2\ngap_blocks = 2\nruns = 120\n";

fn verdict(workspace: &Workspace, folder: &str) -> Value {
    serde_json::from_slice(&workspace.read(&format!("{folder}/design.json"))).unwrap()
}

/// The printed text equals the written one, the case can be run with the texture, and other calls give the
/// same files.
#[test]
fn a_design_is_a_texture_that_other_commands_read() {
    let workspace = Workspace::new();
    workspace.write("wish.toml", WISH);
    let said = workspace.succeed("design wish.toml -o found --threads 1");
    let found = verdict(&workspace, "found");
    let text = workspace.read_text("found/design.txt");
    assert!(
        said.starts_with(&text) && said.trim_end().ends_with("found"),
        "{said}"
    );
    assert!(text.starts_with("reduction of static friction: "), "{text}");
    let loss = found["design"]["loss"].as_f64().unwrap();
    assert!(loss < 0.9, "{found}");
    // On the surface of the search, the case gives about the same value as the verdict on other surfaces.
    workspace.succeed("run found/case.toml -o run --no-pictures");
    let summary: Value = serde_json::from_slice(&workspace.read("run/summary.json")).unwrap();
    let mean = &found["design"]["cases"][0]["static_friction_star"];
    let told = mean["mean"].as_f64().unwrap();
    let largest = summary["mu_star_max"].as_f64().unwrap();
    assert!((largest / told - 1.0).abs() < 0.1, "{largest} {told}");
    assert_eq!(summary["texture_percent"], found["as_meshed"]["coverage_percent"]);
    // The picture of the mask can be read as the same mask.
    workspace.write(
        "again.toml",
        workspace
            .read_text("found/case.toml")
            .replace("mask.png", "mask.npy"),
    );
    workspace.write("mask.npy", workspace.read("found/mask.npy"));
    workspace.succeed("run again.toml -o again --no-pictures");
    assert_eq!(
        workspace.read("again/summary.json"),
        workspace.read("run/summary.json")
    );
    // The mask can also be meshed on other meshes.
    workspace.succeed("converge found/case.toml --replicates 1 -o meshes --quiet");
    // Its pictures can be drawn in any size, except the mask, which is no diagram.
    workspace.succeed("plot found --width 89 --font-size 8 --format pdf -o figures");
    let figures = workspace.files("figures");
    assert!(
        figures.keys().eq(["first_slips.pdf", "friction.pdf"]),
        "{:?}",
        figures.keys()
    );
    // The design in the folder can be repeated, on two threads.
    workspace.succeed("design found/design.toml -o twice --threads 2 --quiet");
    for name in [
        "design.json",
        "design.txt",
        "evaluations.csv",
        "mask.npy",
        "mask.dxf",
        "friction.svg",
    ] {
        assert_eq!(
            workspace.read(&format!("found/{name}")),
            workspace.read(&format!("twice/{name}")),
            "{name}"
        );
    }
    let said = workspace.succeed("verify twice");
    assert!(said.contains("a design as its"), "{said}");
    workspace.write(
        "found/design.json",
        workspace.read_text("found/design.json").replacen("0.", "1.", 1),
    );
    let differs = workspace.output("verify found");
    assert!(differs.status.code() == Some(1) && stdout(&differs).contains("design.json differs"));
    // A second call runs nothing and changes nothing.
    let before = workspace.files("twice");
    workspace.succeed("design wish.toml -o twice");
    assert!(workspace.files("twice") == before);
    // The copy in the folder is a design with the name of the folder.
    std::fs::create_dir(workspace.path("results")).unwrap();
    std::fs::rename(workspace.path("twice"), workspace.path("results/twice")).unwrap();
    workspace.succeed("design results/twice/design.toml --quiet");
    assert!(workspace.files("results/twice") == before && !workspace.exists("results/design"));
}

/// A search without time for runs reports the best named pattern, marked as such.
#[test]
fn a_search_without_time_is_none() {
    let workspace = Workspace::new();
    workspace.write("wish.toml", WISH);
    let said = unwrapped(&workspace.succeed("design wish.toml -o found --time 0s"));
    assert!(said.contains("no texture of the search is better"), "{said}");
    assert_eq!(verdict(&workspace, "found")["is_named"], Value::Bool(true));
}

#[test]
fn folders_of_others_are_left_alone() {
    let workspace = Workspace::new();
    workspace.write("wish.toml", WISH);
    workspace.write("mine/notes.txt", "kept");
    let said = workspace.fail("design wish.toml -o mine", 2);
    assert!(said.contains("is not the folder of a design"), "{said}");
    workspace.succeed("design wish.toml -o found --time 0s --quiet");
    workspace.write("other.toml", WISH.replace("15]", "12]"));
    let said = workspace.fail("design other.toml -o found", 2);
    assert!(said.contains("contains another design"), "{said}");
    let said = workspace.fail("study found/design.toml -o found", 2);
    assert!(said.contains("design"), "{said}");
    workspace.write(
        "none.toml",
        WISH.replace("feature_blocks = 2", "feature_blocks = 8"),
    );
    let said = workspace.fail("design none.toml -o none", 2);
    assert!(said.contains("no texture satisfies these limits"), "{said}");
}

/// A front never gets worse with more texture, because smaller coverages are also allowed.
#[test]
fn a_front_tells_what_less_texture_gives() {
    let workspace = Workspace::new();
    let smooth = "[base]\nfriction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n";
    let wish = WISH
        .replace("[base]\n", smooth)
        .replace("runs = 120", "runs = 60\nfront = [5, 10, 15]");
    workspace.write("wish.toml", wish);
    let said = workspace.succeed("design wish.toml -o found");
    assert!(said.contains("With less texture:"), "{said}");
    let table = workspace.read_text("found/front.csv");
    let losses: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(2).unwrap().parse().unwrap())
        .collect();
    assert!(
        losses.len() == 3 && losses.is_sorted_by(|one, next| one >= next),
        "{table}"
    );
    assert!(workspace.exists("found/front.png") && workspace.exists("found/front.svg"));
}

/// A signal keeps the best texture so far, which can be run, and the same command continues.
#[cfg(unix)]
#[test]
fn a_signal_keeps_the_best() {
    let workspace = Workspace::new();
    workspace.write("wish.toml", WISH.replace("runs = 120", "runs = 1000000"));
    let child = workspace.start("design wish.toml -o found");
    let has_runs =
        || workspace.exists("found/design.jsonl") && workspace.read("found/design.jsonl").len() > 10_000;
    wait_for("a few batches of runs", has_runs);
    let beside_it = workspace.fail("design wish.toml -o found", 2);
    assert!(
        beside_it.contains("another slipfront is running in found"),
        "{beside_it}"
    );
    send(&child, "-INT");
    let output = child.ended();
    let said = unwrapped(&stderr(&output));
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(
        said.contains("the best texture so far is in found/mask.npy"),
        "{said}"
    );
    workspace.succeed("run found/case.toml -o run --no-pictures --quiet");
    let said = workspace.fail("verify found", 2);
    assert!(said.contains("the design in found is not finished"), "{said}");
    let said = workspace.output("design wish.toml -o found --time 0s");
    assert!(stderr(&said).contains("of an earlier call, which are not repeated"));
}

/// A target curve does not come from an instrument: lines without numbers are refused.
#[test]
fn lines_without_numbers_are_no_wish() {
    let workspace = Workspace::new();
    workspace.write("wanted.csv", "X (um),mu (1)\n0,0\n1,0.4\nEnd of test\n");
    let curve = "{ curve = { file = 'wanted.csv', x = 'X', y = 'mu' } }";
    workspace.write("wish.toml", WISH.replace("{ least = 'static_friction' }", curve));
    let said = unwrapped(&workspace.fail("design wish.toml -o found", 2));
    assert!(
        said.contains(
            "wanted.csv ends with 1 line without numbers, starting at line 4: remove them, or begin them with #"
        ),
        "{said}"
    );
    assert!(!workspace.exists("found"));
}

/// The plan shows the target and the cost, and writes nothing; the printed verdict equals its file.
#[test]
fn a_design_is_planned_and_read_by_programs() {
    let workspace = Workspace::new();
    let numbers = "[base]\nslider.blocks = [16, 16]\ndrive.v_star = 0.1\n\
        texture = [{ shape = 'cavity', lambda = '2 um', pitch = '8 um' }]\n\
        [design]\nwish = { least = 'static_friction' }\nruns = 60\ncoverage = [0, 40]\n\
        unknowns = { 'texture.0.lambda' = ['1 um', '3 um'] }\n";
    workspace.write("numbers.toml", numbers);
    let said = unwrapped(&workspace.succeed("design numbers.toml --dry-run --threads 1"));
    for words in [
        "texture.0.lambda: 1 um to 3 um",
        "shapes that cover 0 to 40 % of 16 x 16 blocks, in 1 case, compared with ",
        "60 runs of the search, at most ",
        " of the verdict",
        "block-steps, ",
        " on 1 thread of this machine",
    ] {
        assert!(said.contains(words), "{words:?} is missing:\n{said}");
    }
    let plan: Value =
        serde_json::from_str(&workspace.succeed("design numbers.toml --dry-run --json")).unwrap();
    assert_eq!(workspace.files(".").len(), 1, "a plan has written something");
    let [least, most] = [0, 1].map(|end| plan["seconds"][end].as_f64().unwrap());
    assert!(0.0 < least && least <= most, "{plan}");
    let printed = workspace.succeed("design numbers.toml --json -o found");
    let printed: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(printed, verdict(&workspace, "found"));
    // The number of runs is the planned one, except that a generation of the search may exceed it.
    let made = workspace.read_text("found/design.jsonl").lines().count() as f64;
    let planned = (plan["search_runs"].as_f64().unwrap()) + plan["verdict_runs"].as_f64().unwrap();
    assert!(made < 1.1 * planned, "{made} runs, {planned} planned");
    // The duration of the rests of a held drive is unknown.
    let held = numbers.replace("drive.v_star = 0.1", "drive = { v_star = 0.1, loading = 'held' }");
    workspace.write("held.toml", held);
    let said = unwrapped(&workspace.succeed("design held.toml --dry-run"));
    assert!(
        said.contains("block-steps, not counting steps in which the drive stops, at least"),
        "{said}"
    );
}

#[test]
fn a_device_is_refused_for_a_target_curve_and_where_it_is_missing() {
    let workspace = Workspace::new();
    workspace.write("wish.toml", WISH);
    workspace.write("wanted.csv", "X,mu\n0,0\n0.1,0.3\n0.2,0.2\n");
    let curve = "{ curve = { file = 'wanted.csv', x = 'X', y = 'mu', x_unit = 'um', y_unit = '1' } }";
    workspace.write("curve.toml", WISH.replace("{ least = 'static_friction' }", curve));
    let cases = [
        (
            "wish",
            "was built without the feature `gpu`; `--device cpu` gives",
        ),
        (
            "curve",
            "the runs of a target curve are computed on the CPU alone; `--device cpu` gives",
        ),
    ];
    for (name, sentence) in cases {
        let refused = workspace.fail(&format!("design {name}.toml -o {name} --device gpu"), 2);
        assert!(refused.contains(sentence), "{refused}");
        assert!(!workspace.exists(name));
    }
}
