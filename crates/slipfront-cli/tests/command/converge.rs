//! One slider on several meshes.

use serde_json::Value;

use crate::fixtures::{list_as_written, unwrapped};
use crate::support::process::stdout;
use crate::support::workspace::Workspace;

/// All lengths are properties of the material; small enough for a test.
pub(crate) const SHEET: &str = "[slider]\nblocks = [20, 20]\nblock_size = '50 um'\nthickness = '20 um'\n\
    [drive]\nv_star = 0.02\nstiffness_per_area = '1875 MPa/um'\n\
    [friction]\nsigma_static_star = 0\nsigma_kinetic_star = 0\nslip_weakening = { length_star = 0.4 }\n\
    [time]\nstop = 'after_onset'\n\
    [[texture]]\nshape = 'cavity'\ncoverage = 10\n";

fn found(workspace: &Workspace, folder: &str) -> Value {
    serde_json::from_slice(&workspace.read(&format!("{folder}/convergence.json"))).unwrap()
}

/// The value on each mesh is the one of the case with its blocks, and the mesh error follows from the three
/// values.
#[test]
fn a_sheet_is_told_with_the_error_of_its_mesh() {
    let workspace = Workspace::new();
    workspace.write("sheet.toml", SHEET);
    let said = unwrapped(&workspace.succeed("converge sheet.toml -o meshes"));
    let found = found(&workspace, "meshes");
    let sizes: Vec<&str> = found["meshes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|mesh| mesh["block_size"].as_str().unwrap())
        .collect();
    assert_eq!(sizes, ["100 um", "50 um", "25 um"]);
    assert_eq!(found["lengths_of_a_block"], Value::Array(Vec::new()));
    let quantities = found["quantities"].as_array().unwrap();
    let of = |name: &str| quantities.iter().find(|one| one["quantity"] == name).unwrap();
    let static_friction = of("static_friction_star");
    // The second mesh is the mesh of the case itself.
    let summary = workspace.succeed("run sheet.toml -o run --json");
    let summary: Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(static_friction["means"][1], summary["static_friction_star"]);
    assert!(said.contains("static_reduction_percent:"), "{said}");
    assert!(
        workspace
            .read_text("meshes/convergence.txt")
            .contains("static_friction_star")
    );
    // A second call finds all runs and writes the same files; the JSON output equals the file in the folder.
    let before = workspace.files("meshes");
    let printed = workspace.succeed("converge sheet.toml -o meshes --json");
    assert!(workspace.files("meshes") == before);
    assert_eq!(serde_json::from_str::<Value>(&printed).unwrap(), found);
    // A case from a results folder has the name of this folder.
    workspace.succeed("converge run/case.toml --replicates 1 --quiet");
    assert!(workspace.exists("results/run-meshes/convergence.json"));
    // The plan lists every mesh, and nothing is run.
    let plan = workspace.succeed("converge sheet.toml -o plan --dry-run");
    for words in ["100 um   [10, 10]", "25 um   [40, 40]", "at most 6 runs"] {
        assert!(plan.contains(words), "{plan}");
    }
    assert!(!workspace.exists("plan"));
}

/// The comparison of the meshes follows from the records, like the tables.
#[test]
fn verify_holds_what_meshes_found_against_the_records() {
    let workspace = Workspace::new();
    workspace.write("sheet.toml", SHEET);
    workspace.succeed("converge sheet.toml -o meshes");
    workspace.succeed("converge sheet.toml -o other --set texture.0.coverage=20");
    assert!(!workspace.succeed("verify meshes").contains("not slipfront's"));
    let written = ["convergence.json", "convergence.txt"]
        .map(|name| (name, workspace.read_text(&format!("meshes/{name}"))));
    let is_told = |name: &str, how: &str| {
        let output = workspace.output("verify meshes");
        assert_eq!(output.status.code(), Some(1), "{name}");
        let said = stdout(&output);
        assert!(said.contains(&format!("meshes/{name} {how}")), "{name}: {said}");
        let others = written.iter().filter(|(other, _)| *other != name);
        assert!(others.clone().all(|(other, _)| !said.contains(other)), "{said}");
    };
    for (name, text) in &written {
        let path = format!("meshes/{name}");
        // Changes a digit of a mean.
        let place = text.rfind("1.00").unwrap();
        let mut digit = text.clone();
        digit.replace_range(place..=place, "2");
        workspace.write(&path, digit);
        is_told(name, "differs: other bytes were written");
        list_as_written(&workspace, "meshes", name);
        is_told(name, "differs: other bytes follow from its runs");
        workspace.write(&path, workspace.read_text(&format!("other/{name}")));
        is_told(name, "differs: ");
        workspace.remove(&path);
        is_told(name, "is missing");
        workspace.write(&path, text);
        list_as_written(&workspace, "meshes", name);
    }
    workspace.succeed("verify meshes");
    // `slipfront study` on the study file computes only tables, and that folder is complete.
    workspace.succeed("study meshes/study.toml -o again");
    assert!(!workspace.exists("again/convergence.json"));
    workspace.succeed("verify again");
}

/// A study without meshes has no such file.
#[test]
fn verify_notes_a_convergence_in_a_study_without_meshes() {
    let workspace = Workspace::new();
    workspace.write("sheet.toml", SHEET);
    workspace.write(
        "speeds.toml",
        "base = 'sheet.toml'\n[[axes]]\nkey = 'drive.v_star'\nlist = [0.02, 0.03, 0.04]\n",
    );
    workspace.succeed("study speeds.toml -o speeds");
    workspace.write("speeds/convergence.json", "{}");
    assert!(unwrapped(&workspace.succeed("verify speeds")).contains("convergence.json is not slipfront's"));
}

/// The output in the guide is what the command prints for the case.
#[test]
fn the_guide_shows_what_is_printed() {
    let workspace = Workspace::new();
    let repository = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    workspace.succeed(&format!("converge {repository}/cases/sheet.toml -o sheet"));
    let printed = workspace.read_text("sheet/convergence.txt");
    let shown = printed.split("note:").next().unwrap();
    let guide = std::fs::read_to_string(format!("{repository}/docs/guide/experiment.md")).unwrap();
    assert!(guide.contains(shown), "docs/guide/experiment.md lacks:\n{shown}");
    // The same case without a length for slip weakening.
    let sheet = std::fs::read_to_string(format!("{repository}/cases/sheet.toml")).unwrap();
    let lines: Vec<&str> = sheet
        .lines()
        .filter(|line| !line.starts_with("slip_weakening"))
        .collect();
    workspace.write("crack.toml", lines.join("\n"));
    workspace.succeed("converge crack.toml -o crack");
    let found = found(&workspace, "crack");
    let reduction = &found["quantities"][0]["means"];
    let means: Vec<String> = reduction
        .as_array()
        .unwrap()
        .iter()
        .map(|mean| format!("{:.1}", mean.as_f64().unwrap()))
        .collect();
    let shown = format!("| {} |", means.join(" | "));
    assert!(guide.contains(&shown), "docs/guide/experiment.md lacks: {shown}");
}

/// A mask is placed by its case on every mesh, and copied to the folder as in any study.
#[test]
fn a_mask_is_laid_over_every_mesh() {
    let workspace = Workspace::new();
    let cases = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases");
    for (case, file) in [("mask", "herringbone.png"), ("ground", "ground.gsf")] {
        workspace.succeed(&format!(
            "converge {cases}/{case}.toml -o {case} --replicates 1 --set time.stop=after_onset"
        ));
        assert!(workspace.exists(&format!("{case}/inputs/{file}")));
        let found = found(&workspace, case);
        let meshes = found["meshes"].as_array().unwrap();
        let coverages = meshes
            .iter()
            .map(|mesh| mesh["coverage_percent"].as_f64().unwrap());
        // The slider is neither bare nor fully textured.
        assert!(coverages.clone().all(|percent| (10.0..90.0).contains(&percent)));
        assert_eq!(coverages.count(), 3);
    }
}

/// Without lengths of the material no limit is given, because it would look like a material property.
#[test]
fn no_limit_is_given_where_a_block_is_a_length_of_the_material() {
    let workspace = Workspace::new();
    workspace.write(
        "naive.toml",
        "slider.blocks = [20, 20]\ntime.stop = 'after_onset'",
    );
    let said = unwrapped(&workspace.succeed("converge naive.toml -o naive --replicates 2"));
    assert!(
        said.contains("no limit is given") && !said.contains("of which the mesh"),
        "{said}"
    );
    for key in [
        "thickness",
        "stiffness_per_area",
        "slip_weakening",
        "correlation_length",
    ] {
        assert!(said.contains(key), "{key}: {said}");
    }
}

/// A case that cannot be put on several meshes is refused before the first run, and before a folder is made.
#[test]
fn what_cannot_be_put_on_meshes_is_refused() {
    let workspace = Workspace::new();
    workspace.write("sheet.toml", SHEET);
    for (arguments, expected) in [
        (
            "--set slider.blocks=[25,25]",
            "use multiples of 2, such as [26, 26]",
        ),
        ("--set texture.0.coverage=0.01", "no block is textured"),
        ("--max-memory 0.001", "more than --max-memory 0.001;"),
        ("--max-memory nan", "a number of GB from 0.001 to 1000000"),
        ("--max-time 1ns", "longer than --max-time"),
        ("--set drive.attach=left", "give `drive.total_stiffness`"),
        ("--levels 2", "2 is not in 3..=7"),
    ] {
        let said = unwrapped(&workspace.fail(&format!("converge sheet.toml -o out {arguments}"), 2));
        assert!(said.contains(expected), "{arguments}: {said}");
        assert!(!workspace.exists("out"), "{arguments}");
    }
}

/// Runs that end before any slip give no value to compare between meshes.
#[test]
fn meshes_without_a_number_have_status_1() {
    let workspace = Workspace::new();
    workspace.write(
        "sheet.toml",
        SHEET.replace("stop = 'after_onset'", "duration_star = 2"),
    );
    let said = workspace.fail("converge sheet.toml -o meshes --quiet", 1);
    assert!(
        unwrapped(&said).contains("no quantity has a value on every mesh: meshes/runs.csv contains"),
        "{said}"
    );
    assert!(workspace.exists("meshes/convergence.json"));
}
