//! Figures for a journal: pictures of studies and runs in the requested size, font size and format.

use crate::fixtures;
use crate::study::results::SMALL;
use crate::support::workspace::Workspace;

/// Names of the files in a folder.
fn names(workspace: &Workspace, folder: &str) -> Vec<String> {
    workspace.files(folder).into_keys().collect()
}

/// The pictures of a study can be redrawn unchanged, or in another look in another folder, which leaves the
/// study folder unchanged.
#[test]
fn a_study_is_drawn_in_the_look_that_is_asked_for() {
    let workspace = Workspace::with_study(SMALL);
    workspace.succeed("study study.toml -o out --quiet");
    let before = workspace.files("out");
    let pictures: Vec<&str> = before
        .keys()
        .filter_map(|name| name.strip_suffix(".svg"))
        .collect();
    assert!(pictures.contains(&"static_friction_star"), "{pictures:?}");
    workspace.remove("out/static_friction_star.svg");
    workspace.succeed("plot out");
    assert!(workspace.files("out") == before);

    workspace.succeed("plot out --width 89 --font-size 8");
    for name in &pictures {
        let drawn = workspace.read_text(&format!("results/overlay/{name}.svg"));
        assert!(drawn.contains("width=\"89.00mm\""), "{name}: {drawn:.300}");
        assert!(workspace.exists(&format!("results/overlay/{name}.png")));
    }
    let asked = "plot out --picture static_friction_star --width 60 --height 45 --format pdf -o inset";
    workspace.succeed(asked);
    assert_eq!(names(&workspace, "inset"), ["static_friction_star.pdf"]);
    let pdf = String::from_utf8_lossy(&workspace.read("inset/static_friction_star.pdf")).into_owned();
    // The size 60 mm x 45 mm in points.
    assert!(pdf.contains("/MediaBox [0 0 170.07874 127.55905]"), "{pdf:.600}");
    workspace.succeed("verify out inset");
    assert!(workspace.files("out") == before);
}

#[test]
fn what_cannot_be_drawn_of_a_folder_is_refused() {
    let workspace = Workspace::with_study(SMALL);
    workspace.succeed("study study.toml -o out --quiet");
    workspace.succeed("study study.toml --shard 1/2 -o part --quiet");
    workspace.write("small.toml", fixtures::SMALL);
    workspace.succeed("run small.toml -o run --quiet");
    for (line, sentence) in [
        (
            "plot out --picture static_friction",
            "there is no picture static_friction: did you mean static_friction_star? The name can be ",
        ),
        (
            "plot out --picture volcano",
            "there is no picture volcano: the name can be ",
        ),
        (
            "plot run --picture fornt",
            "did you mean front? The name can be friction, stress, front, precursors, events",
        ),
        (
            "plot run --picture precursors",
            "run has no picture precursors: the run has no data for it",
        ),
        (
            "plot run --units si --picture front",
            "there is no picture front: the name can be friction",
        ),
        (
            "plot out --units si",
            "--units applies to pictures of runs, but out is not a folder of a run",
        ),
        ("plot out --field traction", "--field applies to pictures of runs"),
        (
            "plot run out",
            "out is not a folder of a run, and only curves of runs can be combined",
        ),
        (
            "plot part",
            "the study in part lacks 18 runs: finish it first, or merge it",
        ),
        (
            "plot run --height 60 -o none",
            "the height of a map follows from the shape of the slider",
        ),
        ("plot run --width 80 -o run", "run contains another run"),
        (
            "plot out --width 80 -o out",
            "exists: choose another place with --out",
        ),
        (
            "movie out",
            "out is the folder of a study: give the folder of a run",
        ),
    ] {
        let said = workspace.fail(line, 2);
        assert!(said.contains(sentence), "{line}: {said}");
    }
    assert!(!workspace.exists("none"));
}

/// All text of a picture has the requested font size, except subscripts.
#[test]
fn all_text_has_the_size_that_is_asked_for() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o run --quiet");
    workspace.succeed("plot run --font-size 9 --width 89 -o figures");
    let svg = workspace.read_text("figures/friction.svg");
    let attribute = |tag: &str, name: &str| -> f64 {
        let (_, rest) = tag.split_once(&format!(" {name}=\"")).unwrap();
        rest.split_once('"').unwrap().0.parse().unwrap()
    };
    let texts = svg.lines().filter(|line| line.starts_with("<text "));
    let mut sizes: Vec<f64> = texts.map(|tag| attribute(tag, "font-size")).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    // Subscripts have 0.72 of this size, rounded to whole units.
    assert_eq!(sizes, [24.0, 33.0]);
    let (_, view) = svg.split_once("viewBox=\"0 0 ").unwrap();
    let units: f64 = view.split_once(' ').unwrap().0.parse().unwrap();
    // A point is 25.4 mm / 72; coordinates are rounded to hundredths.
    let points = 33.0 / units * 89.0 / 25.4 * 72.0;
    assert!((points - 9.0).abs() < 1e-3, "{points}");
}

/// Every call writes the same PDF, with its own extension.
#[test]
fn a_pdf_stands_beside_the_pictures_of_its_run() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o run --quiet");
    let said = workspace.succeed("plot run --format pdf --picture friction");
    assert_eq!(said, "run/friction.pdf\n");
    let before = workspace.read("run/friction.pdf");
    assert!(before.starts_with(b"%PDF-1.7"));
    workspace.succeed("plot run --format pdf --picture friction");
    assert_eq!(workspace.read("run/friction.pdf"), before);
    let said = workspace.succeed("verify run");
    assert!(said.contains("friction.pdf"), "{said}");
    let said = workspace.fail("plot run -o run.pdf", 2);
    assert!(
        said.contains("run.pdf is the name of a picture: write --out run"),
        "{said}"
    );
}
