//! Tables of the guides with results of studies.

use std::collections::BTreeMap;
use std::path::Path;

use crate::support::workspace::Workspace;

/// The tables of the guides on slow loading, soft springs, smaller blocks and dimples on steel contain the
/// results of their studies.
#[test]
fn the_guides_have_the_reductions_of_their_studies() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let guide = |name: &str| std::fs::read_to_string(repository.join("docs/guide").join(name)).unwrap();
    let workspace = Workspace::new();
    let reductions = |study: &str, axes: &[&str]| {
        let file = repository.join("cases/studies").join(format!("{study}.toml"));
        workspace.succeed(&format!("study {} -q -o {study}", file.display()));
        let points = workspace.results(study).table("points.csv");
        let rows = points
            .iter()
            .filter(|row| row["quantity"] == "static_reduction_percent");
        rows.map(|row| {
            let levels = axes.iter().map(|axis| row[*axis].clone()).collect::<Vec<_>>();
            let mean = row["mean"].parse::<f64>().ok();
            // Either all runs have a transition, or none has.
            assert_eq!(row["runs_without_transition"] == "0", mean.is_some());
            (
                levels,
                mean.map_or("none".to_owned(), |mean| format!("{mean:.1}")),
            )
        })
        .collect::<Vec<_>>()
    };
    let slow = reductions("slow_loading", &["drive.v_star", "slider.omega_star"]);
    let text = guide("studies.md");
    for damped in slow.chunks(3) {
        let cells: Vec<&str> = damped.iter().map(|(_, cell)| cell.as_str()).collect();
        let row = format!("| {} | {} |", damped[0].0[0], cells.join(" | "));
        assert!(text.contains(&row), "{row}");
    }
    let text = guide("experiment.md");
    let cells = |reductions: &[(Vec<String>, String)]| {
        let cells: Vec<&str> = reductions.iter().map(|(_, cell)| cell.as_str()).collect();
        cells.join(" | ")
    };
    let row = format!(
        "| reduction in % | {} |",
        cells(&reductions("soft_springs", &["softer"]))
    );
    assert!(text.contains(&row), "{row}");
    for slider in reductions("one_cavity_three_sliders", &["held"]).chunks(3) {
        let row = format!(" | {} |\n", cells(slider));
        assert!(text.contains(&row), "{row}");
    }
    let row = format!(
        "| reduction in % | {} |",
        cells(&reductions("dimples_by_block", &["slider.blocks"]))
    );
    assert!(text.contains(&row), "{row}");
    for (study, axis) in [
        ("pad_as_sheet", "slider"),
        ("steel_part", "friction.slip_weakening.length"),
    ] {
        let row = format!("| reduction in % | {} |", cells(&reductions(study, &[axis])));
        assert!(text.contains(&row), "{row}");
    }
    let mount = repository.join("cases/studies/soft_mount.toml");
    workspace.succeed(&format!("study {} -q -o soft_mount", mount.display()));
    let points = workspace.results("soft_mount").table("points.csv");
    let of_static = points
        .iter()
        .filter(|row| row["quantity"] == "static_friction_star");
    let with_half = |row: &BTreeMap<String, String>| {
        let [mean, low, high] = ["mean", "low", "high"].map(|name| row[name].parse::<f64>().unwrap());
        format!("{mean:.3} \u{b1} {:.3}", (high - low) / 2.0)
    };
    let cells: Vec<String> = of_static.map(with_half).collect();
    for of_surface in cells.chunks(4) {
        let row = format!(" | {} |\n", of_surface.join(" | "));
        assert!(text.contains(&row), "{row}");
    }
    // This is the coarsest of three meshes; the others take minutes.
    let coarsest = |case: &str, blocks: u32, size: &str, replicates: u32| {
        workspace.write(
            "coarsest.toml",
            format!(
                "base = '{}'\n[study]\nreplicates = {replicates}\nreference = {{ texture = [] }}\n[[axes]]\n\
                 zip = {{ \"slider.blocks\" = [[{blocks}, {blocks}]], \"slider.block_size\" = ['{size}'] }}\n",
                repository.join("cases").join(case).display()
            ),
        );
        workspace.succeed(&format!("study coarsest.toml -q -o {case}"));
        let points = workspace.results(case).table("points.csv");
        let mut rows = points.into_iter();
        rows.find(|row| row["quantity"] == "static_reduction_percent")
            .unwrap()
    };
    let number = |point: &BTreeMap<String, String>, name: &str| point[name].parse::<f64>().unwrap();
    let steel = coarsest("steel.toml", 100, "20 um", 5);
    let half = (number(&steel, "high") - number(&steel, "low")) / 2.0;
    let mean = number(&steel, "mean");
    let row = format!("  20 um    13.46 % {mean:>19.2} \u{b1} {half:.2} ");
    assert!(text.contains(&row), "{row}");
    let pad = coarsest("pdms_pad.toml", 48, "50 um", 1);
    let row = "\n    50 um    18.75 % ";
    let (_, rest) = text.split_once(row).expect("the guide has the row");
    let told: f64 = rest.split_whitespace().next().unwrap().parse().unwrap();
    // `converge` keeps the damping of the case, where "auto" follows the block; the last increments of the
    // drive are 0.08/4^4 of the load.
    assert!((told - number(&pad, "mean")).abs() < 0.03, "{told} {pad:?}");
}
