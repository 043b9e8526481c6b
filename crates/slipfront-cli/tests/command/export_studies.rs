//! The command `slipfront export` for folders of many runs: their runs, tables and files as one crate.

use std::collections::BTreeSet;

use serde_json::Value;
use slipfront_study::project_folder::{Others, ResultFiles};

use crate::calibrate;
use crate::converge::SHEET;
use crate::design::WISH;
use crate::export::{DESCRIPTION, entries, expect_complete, links};
use crate::support::workspace::Workspace;
use crate::verify::verified;

/// A study in which one run fails and all runs are kept.
const STUDY: &str = "[base]\nslider = { blocks = [6, 5], omega_star = 0 }\ndrive = { v_star = 10 }\n\
    friction = { r_star = 0, sigma_static_star = 1 }\ntime = { step = 0.9, duration_star = 2000 }\n\
    texture = [{ shape = 'mask', file = 'spot.png' }]\n[study]\nkeep = 'all'\n\
    [[axes]]\nkey = 'load.pressure'\nlist = ['50 GPa', '100 kPa']\n";

#[test]
fn a_study_is_described_with_its_runs() {
    let workspace = Workspace::masked();
    workspace.write("study.toml", STUDY);
    assert_eq!(
        workspace.output("study study.toml -o first").status.code(),
        Some(1)
    );
    let mut before = workspace.files("first");
    before.retain(|name, _| !name.contains("/.slipfront/"));
    workspace.succeed("export first --ro-crate");
    let described = expect_complete(&workspace, "first");
    assert_eq!(described.of_type("File").len(), before.len());
    let (_, said, errors) = verified(&workspace, "first");
    assert_eq!(
        (said.contains(DESCRIPTION), errors.as_str()),
        (false, ""),
        "{said}"
    );

    let actions = described.of_type("CreateAction");
    assert_eq!(actions.len(), 3);
    let action = |begin: &str| {
        let mut found = actions.iter();
        *found
            .find(|action| action["name"].as_str().unwrap().contains(begin))
            .unwrap_or_else(|| panic!("{begin}"))
    };
    let study = action("The study first");
    let given = BTreeSet::from(["study.toml", "inputs/spot.png"].map(str::to_owned));
    assert_eq!(links(&study["object"]), given);
    let results = links(&study["result"]);
    assert!(
        results.contains("points.csv") && results.contains("runs.jsonl"),
        "{results:?}"
    );
    let repeats = study["description"].as_str().unwrap();
    assert!(
        repeats.starts_with("`slipfront study study.toml` repeats it"),
        "{repeats}"
    );
    let done = action("load.pressure = 100 kPa");
    let ends_with = |property: &Value, end: &str| links(property).iter().any(|id| id.ends_with(end));
    assert!(ends_with(&done["object"], "/case.toml") && ends_with(&done["result"], "/series.csv"));
    let failed = action("load.pressure = 50 GPa");
    assert_eq!(failed["actionStatus"], "http://schema.org/FailedActionStatus");
    assert!(failed["error"].as_str().unwrap().contains("diverged"), "{failed}");
    assert!(ends_with(&failed["object"], "/case.toml") && ends_with(&failed["result"], "runs.csv"));
    let pressure = format!("{}/load.pressure", failed["@id"].as_str().unwrap());
    let pressure = described.entity(&pressure);
    assert_eq!(
        (&pressure["value"], &pressure["unitText"]),
        (&5e10.into(), &"Pa".into())
    );

    let title = "Friction computed with slipfront: first (study from 2 recorded runs)";
    let entry = &entries(&workspace.succeed("export first --bibtex"))[0];
    assert_eq!(entry["title"], format!("{{{title}}}"));
    assert!(entry["note"].contains("BLAKE3 hash of study.toml"), "{entry:?}");
    let cff = workspace.succeed("export first --cff --author A");
    assert!(cff.contains(&format!("title: \"{title}\"\n")), "{cff}");

    // The description does not match other results in its place.
    workspace.write("study.toml", STUDY.replace("0.9", "0.8"));
    workspace.output("study study.toml -o first");
    let (_, said, _) = verified(&workspace, "first");
    assert!(
        said.contains("ro-crate-metadata.json does not describe the results"),
        "{said}"
    );
}

#[test]
fn studies_and_runs_are_one_crate() {
    let workspace = Workspace::masked();
    // Without run folders, runs are rows of the table.
    workspace.write(
        "study.toml",
        STUDY.replace("keep = 'all'", "").replace("'50 GPa', ", ""),
    );
    workspace.succeed("study study.toml -o first --quiet");
    workspace.succeed("run small.toml -o run --quiet");
    workspace.succeed("export first run --ro-crate -o both");
    let described = expect_complete(&workspace, "both");
    assert_eq!(described.of_type("CreateAction").len(), 3);
    for folder in ["first", "run"] {
        assert!(workspace.files(&format!("both/{folder}")) == workspace.files(folder));
        let said = workspace.succeed(&format!("verify both/{folder}"));
        assert!(!said.contains("note:"), "{said}");
    }
    let said = workspace.succeed("verify both");
    assert!(said.contains("both: a crate of 2 folders, unchanged"), "{said}");
    workspace.succeed("run small.toml -o other --quiet --set drive.v_star=0.2");
    let whole = workspace.files("both");
    for (damage, sentence) in [
        (
            "rm -r both/run && cp -r other both/run",
            "both/run has other results than both/ro-crate-metadata.json describes",
        ),
        ("rm -r both/first", "both/first is missing"),
        ("echo > both/first/points.csv", "both/first/points.csv differs"),
        (
            "echo >> both/run/manifest.json",
            "both/run/manifest.json is damaged",
        ),
        (
            "echo > both/ro-crate-metadata.json",
            "both/ro-crate-metadata.json is damaged",
        ),
    ] {
        assert!(workspace.shell(damage).status.success());
        let (status, said, _) = verified(&workspace, "both");
        assert!(status == 1 && said.contains(sentence), "{said}");
        workspace.remove("both");
        workspace.fill("both", &whole);
    }
    let study = described.of_type("CreateAction")[0]["description"]
        .as_str()
        .unwrap();
    assert!(
        study.starts_with("`slipfront study first/study.toml` repeats it"),
        "{study}"
    );
}

#[test]
fn only_whole_studies_are_exported() {
    let workspace = Workspace::masked();
    workspace.write("study.toml", STUDY.replace("'50 GPa', ", ""));
    workspace.succeed("study study.toml -o first --quiet");
    let files = workspace.files("first");
    let series = files.keys().find(|name| name.ends_with("series.csv")).unwrap();
    for name in ["points.csv", "study.toml", series] {
        workspace.write(&format!("first/{name}"), "changed");
        let refused = workspace.fail("export first --ro-crate", 1);
        assert!(refused.contains(&format!("first/{name} differs")), "{refused}");
        workspace.write(&format!("first/{name}"), &files[name]);
    }
    let mut batch = ResultFiles::new(&workspace.path("first"), "study", false).begin();
    batch.write("points.csv", |_| Ok(())).unwrap();
    batch.place_so_far(Others::Stay).unwrap();
    let refused = workspace.fail("export first --bibtex", 2);
    assert!(
        refused.contains("the study in first is not finished"),
        "{refused}"
    );
    std::fs::create_dir_all(workspace.path("paper/found")).unwrap();
    let refused = workspace.fail("export paper --bibtex", 2);
    assert!(
        refused.contains("contains figures of `slipfront paper`"),
        "{refused}"
    );
}

#[test]
fn designs_calibrations_and_convergences_are_exported() {
    let workspace = calibrate::workspace();
    workspace.write("wish.toml", WISH);
    workspace.write("sheet.toml", SHEET);
    workspace.succeed("design wish.toml -o design --quiet");
    workspace.succeed("calibrate fit.toml record.csv -o calibration --quiet");
    workspace.succeed("converge sheet.toml -o convergence --replicates 1 --quiet");
    workspace.succeed("export design calibration convergence --ro-crate -o all");
    let described = expect_complete(&workspace, "all");
    let action = |name: &str| {
        let actions = described.of_type("CreateAction");
        let found = actions.into_iter().find(|action| action["name"] == name);
        found.unwrap_or_else(|| panic!("{name}")).clone()
    };
    let design = action("The design design");
    assert!(links(&design["result"]).contains("design/mask.svg"));
    let calibration = action("The calibration calibration");
    let inputs = ["calibration.toml", "record-1.csv"].map(|name| format!("calibration/{name}"));
    assert_eq!(links(&calibration["object"]), BTreeSet::from(inputs));
    let repeats = calibration["description"].as_str().unwrap();
    let command = "`slipfront calibrate calibration/calibration.toml calibration/record-1.csv` repeats it";
    assert!(repeats.starts_with(command), "{repeats}");
    let convergence = action("The convergence convergence");
    assert!(links(&convergence["result"]).contains("convergence/convergence.json"));
    let runs = described.of_type("CreateAction").into_iter();
    let on_meshes = runs.filter(|action| action["name"].as_str().unwrap().starts_with("Run "));
    assert_eq!(on_meshes.count(), 6);
    for folder in ["design", "calibration", "convergence"] {
        workspace.succeed(&format!("verify all/{folder}"));
    }
}
