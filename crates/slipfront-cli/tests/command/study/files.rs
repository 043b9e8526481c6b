//! Contents of a study file.

use crate::support::process::stderr;
use crate::support::workspace::Workspace;

const BASE: &str = "[base.slider]\nblocks = [4, 4]\n[base.time]\nstop = 'after_onset'\n";

/// The levels in the columns of `runs.csv` between `role` and `seed`, row by row.
fn levels(axes: &str) -> Vec<String> {
    let workspace = Workspace::with_study(&format!("{BASE}{axes}"));
    let table = std::fs::read_to_string(workspace.study("out").path.join("runs.csv")).unwrap();
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let header = rows.headers().unwrap().clone();
    let seed = header.iter().position(|name| name == "seed").unwrap();
    rows.records()
        .map(|row| {
            row.unwrap()
                .iter()
                .take(seed)
                .skip(3)
                .collect::<Vec<_>>()
                .join(" ")
        })
        .collect()
}

#[test]
fn every_kind_of_axis() {
    for (axes, expected) in [
        (
            "[[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.05]",
            vec!["0.1", "0.05"],
        ),
        (
            "[[axes]]\nkey = 'drive.v_star'\nlinspace = [0.1, 0.2, 3]",
            vec!["0.1", "0.15", "0.2"],
        ),
        (
            "[[axes]]\nkey = 'drive.v_star'\nlogspace = [0.05, 0.2, 3]",
            vec!["0.05", "0.1", "0.2"],
        ),
        (
            "[[axes]]\nkey = 'friction.seed'\nlinspace = [1, 3, 3]",
            vec!["1", "2", "3"],
        ),
        (
            "[[axes]]\nkey = 'load.pressure'\nlist = ['50 kPa', '0.1 MPa']",
            vec!["50 kPa", "0.1 MPa"],
        ),
        (
            "[[axes]]\nzip = { 'drive.v_star' = [0.1, 0.2], 'friction.r_star' = [0.4, 0.6] }",
            vec!["0.1 0.4", "0.2 0.6"],
        ),
        (
            "[[axes]]\nname = 'edges'\nvariants = { free = {}, periodic = { slider.edges = 'periodic' } }\n\
             [[axes]]\nkey = 'slider.blocks'\nlist = [[4, 4], [5, 5]]",
            vec!["free [4, 4]", "free [5, 5]", "periodic [4, 4]", "periodic [5, 5]"],
        ),
        (
            "[[axes]]\nname = 'shape'\n[axes.variants]\ngroove = { texture = [{ shape = 'groove', coverage = 25 }] }\n\
             dot = { texture = [{ shape = 'cavity', coverage = 20 }] }\n\
             [[axes]]\nkey = 'texture.0.coverage'\nlist = [25, 50]",
            vec!["groove 25", "groove 50", "dot 25", "dot 50"],
        ),
    ] {
        assert_eq!(levels(axes), expected, "{axes}");
    }
}

#[test]
fn a_base_is_a_path_a_table_or_the_baseline() {
    let workspace = Workspace::new();
    let axis = "[[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2]";
    workspace.write("cases/small.toml", BASE.replace("base.", ""));
    workspace.write("path.toml", format!("base = 'cases/small.toml'\n{axis}"));
    workspace.write("table.toml", format!("{BASE}{axis}"));
    workspace.succeed("study path.toml -o path");
    workspace.succeed("study table.toml -o table");
    workspace.results("path").assert_same(&workspace.results("table"));
    workspace.write("absent.toml", axis);
    let said = workspace.succeed("study absent.toml --dry-run");
    // 625 blocks to t* = 80 and 40 in steps of 0.1: the baseline of Fig. 3.
    assert!(said.contains("7.50e5 block-steps"), "{said}");
}

#[test]
fn without_axes_the_base_is_repeated() {
    let workspace = Workspace::with_study(&format!("{BASE}[study]\nreplicates = 4"));
    workspace.succeed("study study.toml -o out");
    let results = workspace.results("out");
    results.assert_each_run_once(4);
    assert_eq!(results.table("points.csv")[0]["n"], "4");
}

#[test]
fn a_reference_may_set_what_an_axis_sets() {
    let workspace = Workspace::with_study(&format!(
        "{BASE}[study]\nreference = {{ drive.speed = '0.5 mm/s' }}\n[[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2]"
    ));
    let results = workspace.study("out");
    let speeds: Vec<f64> = (0..2)
        .flat_map(|point| results.numbers(point, "reference", "v_star"))
        .collect();
    assert!(
        speeds[0] == speeds[1] && (speeds[0] - 0.158).abs() < 1e-3,
        "{speeds:?}"
    );
    results.assert_each_run_once(3);
}

/// A study in its own results folder may read a file from a place to which another copy goes.
#[test]
fn copies_do_not_overwrite_what_is_still_to_be_copied() {
    let workspace = Workspace::new();
    let table = |value: f64| format!("{value},{value},{value},{value}\n").repeat(4);
    workspace.write("one/mu.csv", table(1.0));
    workspace.write("two/mu.csv", table(0.9));
    let study = |files: &str| format!("{BASE}[[axes]]\nkey = 'friction.mu_static_field'\nlist = [{files}]\n");
    let twice = |files: &str| format!("[study]\nreplicates = 2\n{}", study(files));
    workspace.write("first/study.toml", study("'../two/mu.csv'"));
    workspace.succeed("study first/study.toml -o out");
    workspace.write("out/study.toml", twice("'../one/mu.csv', 'inputs/mu.csv'"));
    workspace.succeed("study out/study.toml -o out");
    for (copy, value) in [("mu.csv", 1.0), ("2-mu.csv", 0.9)] {
        let copied = std::fs::read_to_string(workspace.path("out/inputs").join(copy)).unwrap();
        assert_eq!(copied, table(value), "{copy}");
    }
    // From then on a copy had another name, and the remaining runs read the files that they are recorded
    // with.
    workspace.write("fresh/study.toml", twice("'../one/mu.csv', '../two/mu.csv'"));
    workspace.succeed("study fresh/study.toml -o fresh_out");
    let points = |folder: &str| std::fs::read_to_string(workspace.path(folder).join("points.csv")).unwrap();
    assert_eq!(points("out"), points("fresh_out"));
}

/// Copies are not written through a link, because its target may belong to somebody else.
#[cfg(unix)]
#[test]
fn copies_do_not_go_behind_a_link() {
    let workspace = Workspace::new();
    let table = |value: f64| format!("{value},{value},{value},{value}\n").repeat(4);
    workspace.write("mu.csv", table(1.0));
    workspace.write("theirs/mu.csv", table(0.9));
    workspace.write(
        "study.toml",
        format!("{BASE}[[axes]]\nkey = 'friction.mu_static_field'\nlist = ['mu.csv']\n"),
    );
    workspace.succeed("study study.toml -o out");
    std::fs::remove_dir_all(workspace.path("out/inputs")).unwrap();
    std::os::unix::fs::symlink("../theirs", workspace.path("out/inputs")).unwrap();
    let output = workspace.output("study study.toml -o out");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("out/inputs is not a file of an earlier run"),
        "{}",
        stderr(&output)
    );
    assert_eq!(
        std::fs::read_to_string(workspace.path("theirs/mu.csv")).unwrap(),
        table(0.9)
    );
}
