//! The same case gives the same bytes, in every repetition, in every folder and with any number of threads.

use crate::fixtures::SMALL;
use crate::support::workspace::{Files, Workspace};

/// A texture from a picture and coefficients from a table, in separate folders.
fn with_inputs(workspace: &Workspace) {
    workspace.write(
        "cases/given.toml",
        "[slider]\nblocks = [6, 5]\n[drive]\nv_star = 0.1\n[friction]\nmu_static_field = '../data/mu.csv'\n\
         [[texture]]\nshape = 'mask'\nfile = 'masks/spot.png'\n",
    );
    let rows: Vec<String> = (0..5)
        .map(|j| {
            (0..6)
                .map(|i| format!("{}", 0.9 + 0.01 * f64::from(i + j)))
                .collect::<Vec<_>>()
                .join(",")
        })
        .collect();
    workspace.write("data/mu.csv", rows.join("\n"));
    std::fs::create_dir_all(workspace.path("cases/masks")).unwrap();
    let line = "texture small.toml -o cases/masks/spot.png --set texture.0={shape=\"cavity\",coverage=15}";
    workspace.succeed(line);
}

#[test]
fn the_baseline_repeats_to_the_byte() {
    let workspace = Workspace::small();
    workspace.succeed("run -o first");
    workspace.succeed("run -o one --threads 1");
    workspace.succeed("run -o two --threads 2");
    workspace.succeed("run first/case.toml -o again");
    for other in ["one", "two", "again"] {
        workspace.assert_same_run("first", other);
    }
}

/// Whether `--no-pictures` omits this file of a run.
fn is_drawn(name: &str) -> bool {
    [".svg", ".png", ".gif"]
        .iter()
        .any(|ending| name.ends_with(ending))
}

#[test]
fn a_run_without_pictures_has_the_bytes_of_every_other_file() {
    let workspace = Workspace::small();
    let case = "small.toml --set output.movie=true";
    workspace.succeed(&format!("run {case} -o drawn"));
    let said = workspace.succeed(&format!("run {case} --no-pictures -o plain"));
    assert!(said.contains("series.csv") && !said.contains(".svg"), "{said}");
    let (pictures, others): (Files, Files) = workspace
        .run_files("drawn")
        .into_iter()
        .partition(|(name, _)| is_drawn(name));
    assert_eq!(pictures.len(), 7, "{:?}", pictures.keys());
    assert!(workspace.run_files("plain") == others);
    // They can be drawn later at any time.
    workspace.succeed("plot plain --out later");
    workspace.succeed("movie plain --out later/movie.gif");
    assert!(workspace.files("later") == pictures);
}

#[test]
fn a_run_without_pictures_is_repeated_and_resumed_without_them() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml --no-pictures -o a");
    workspace.succeed("verify --rerun a");
    workspace.succeed("run small.toml --no-pictures -o b");
    workspace.interrupt("b");
    workspace.succeed("run --resume b --no-pictures");
    workspace.assert_same_run("a", "b");
    // The option belongs to the command, not to the case.
    workspace.succeed("run small.toml -o c");
    workspace.interrupt("b");
    workspace.succeed("run --resume b");
    workspace.assert_same_run("c", "b");
}

#[test]
fn a_run_folder_holds_its_inputs_and_repeats_from_them() {
    let workspace = Workspace::small();
    with_inputs(&workspace);
    let said = workspace.succeed("run cases/given.toml -o a");
    assert!(said.contains("inputs/"), "{said}");
    assert_eq!(workspace.read("a/inputs/mu.csv"), workspace.read("data/mu.csv"));
    assert_eq!(
        workspace.read("a/inputs/spot.png"),
        workspace.read("cases/masks/spot.png")
    );
    // The folder is moved, and the originals are removed.
    std::fs::remove_dir_all(workspace.path("cases")).unwrap();
    std::fs::remove_dir_all(workspace.path("data")).unwrap();
    std::fs::create_dir(workspace.path("moved")).unwrap();
    std::fs::rename(workspace.path("a"), workspace.path("moved/a")).unwrap();
    workspace.succeed("run moved/a/case.toml -o b");
    workspace.assert_same_run("moved/a", "b");
    let percent = workspace.summary("b")["texture_percent"].as_f64().unwrap();
    assert!((5.0..30.0).contains(&percent), "{percent}");
}

#[test]
fn two_inputs_of_one_name_stay_two() {
    let workspace = Workspace::small();
    for (folder, coverage) in [("one", 5), ("two", 40)] {
        std::fs::create_dir(workspace.path(folder)).unwrap();
        workspace.succeed(&format!(
            "texture small.toml -o {folder}/mask.png --set texture.0={{shape=\"cavity\",coverage={coverage}}}"
        ));
    }
    let masks =
        "[[texture]]\nshape='mask'\nfile='one/mask.png'\n[[texture]]\nshape='mask'\nfile='two/mask.png'\n";
    workspace.write("both.toml", format!("{SMALL}{masks}"));
    workspace.succeed("run both.toml -o a");
    workspace.succeed("run a/case.toml -o b");
    workspace.assert_same_run("a", "b");
    assert_eq!(
        workspace.read("a/inputs/mask.png"),
        workspace.read("one/mask.png")
    );
    assert_eq!(
        workspace.read("a/inputs/2-mask.png"),
        workspace.read("two/mask.png")
    );
}
