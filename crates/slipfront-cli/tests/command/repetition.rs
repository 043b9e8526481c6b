//! The same case gives the same bytes, however often, wherever and by however many threads it is run.

use super::Bench;

/// A texture from a picture, coefficients from a table, in folders of their own.
fn with_inputs(bench: &Bench) {
    bench.write(
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
    bench.write("data/mu.csv", rows.join("\n"));
    std::fs::create_dir_all(bench.path().join("cases/masks")).unwrap();
    let line = "texture small.toml -o cases/masks/spot.png --set texture.0={shape=\"cavity\",coverage=15}";
    bench.done(line);
}

#[test]
fn the_baseline_repeats_to_the_byte() {
    let bench = Bench::new();
    bench.done("run -o first");
    bench.done("run -o one --threads 1");
    bench.done("run -o two --threads 2");
    bench.done("run first/case.toml -o again");
    for other in ["one", "two", "again"] {
        bench.assert_same("first", other);
    }
}

#[test]
fn a_run_folder_holds_its_inputs_and_repeats_from_them() {
    let bench = Bench::new();
    with_inputs(&bench);
    let said = bench.done("run cases/given.toml -o a");
    assert!(said.contains("inputs/"), "{said}");
    assert_eq!(bench.read("a/inputs/mu.csv"), bench.read("data/mu.csv"));
    assert_eq!(
        bench.read("a/inputs/spot.png"),
        bench.read("cases/masks/spot.png")
    );
    // Elsewhere, and without the originals.
    std::fs::remove_dir_all(bench.path().join("cases")).unwrap();
    std::fs::remove_dir_all(bench.path().join("data")).unwrap();
    std::fs::create_dir(bench.path().join("moved")).unwrap();
    std::fs::rename(bench.path().join("a"), bench.path().join("moved/a")).unwrap();
    bench.done("run moved/a/case.toml -o b");
    bench.assert_same("moved/a", "b");
    let percent = bench.summary("b")["texture_percent"].as_f64().unwrap();
    assert!((5.0..30.0).contains(&percent), "{percent}");
}

#[test]
fn two_inputs_of_one_name_stay_two() {
    let bench = Bench::new();
    for (folder, coverage) in [("one", 5), ("two", 40)] {
        std::fs::create_dir(bench.path().join(folder)).unwrap();
        bench.done(&format!(
            "texture small.toml -o {folder}/mask.png --set texture.0={{shape=\"cavity\",coverage={coverage}}}"
        ));
    }
    let masks =
        "[[texture]]\nshape='mask'\nfile='one/mask.png'\n[[texture]]\nshape='mask'\nfile='two/mask.png'\n";
    bench.write("both.toml", format!("{}{masks}", super::SMALL));
    bench.done("run both.toml -o a");
    bench.done("run a/case.toml -o b");
    bench.assert_same("a", "b");
    assert_eq!(bench.read("a/inputs/mask.png"), bench.read("one/mask.png"));
    assert_eq!(bench.read("a/inputs/2-mask.png"), bench.read("two/mask.png"));
}

#[test]
fn plot_draws_the_pictures_of_the_run_again() {
    let bench = Bench::new();
    bench.done("run small.toml -o a");
    let before = bench.files("a");
    for name in ["friction.svg", "friction.png", "stress.svg", "stress.png"] {
        std::fs::remove_file(bench.path().join("a").join(name)).unwrap();
    }
    let said = bench.done("plot a");
    assert_eq!(said.lines().count(), 4, "{said}");
    assert!(before == bench.files("a"));
    bench.done("plot a -o pictures");
    assert_eq!(bench.read("pictures/stress.svg"), before["stress.svg"]);
}

#[test]
fn plot_lays_two_runs_over_each_other() {
    let bench = Bench::new();
    bench.done("run small.toml -o slow");
    bench.done("run small.toml -o fast --set drive.v_star=0.2");
    let said = bench.done("plot slow fast");
    assert_eq!(
        said,
        "results/overlay/friction.svg\nresults/overlay/friction.png\n"
    );
    assert_eq!(bench.files("results/overlay").len(), 2);
    let svg = String::from_utf8(bench.read("results/overlay/friction.svg")).unwrap();
    assert!(svg.contains(">slow<") && svg.contains(">fast<"));
}

#[test]
fn plot_refuses_what_is_no_run() {
    let bench = Bench::new();
    assert!(bench.refused("plot nowhere", 2).contains("summary.json"));
    bench.done("run small.toml -o a");
    bench.write("a/fields.nc", "CDF");
    assert!(bench.refused("plot a", 2).contains("fields.nc"));
    bench.write("a/series.csv", "step,time_star\n1,2\n");
    assert!(bench.refused("plot a", 2).contains("series.csv"));
}
