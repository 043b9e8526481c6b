//! `slipfront plot`: redrawn pictures, several curves in one picture, axes with units, and a measured record
//! over the curves.

use crate::support::workspace::Workspace;

#[test]
fn plot_draws_the_pictures_of_the_run_again() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    let before = workspace.files("a");
    for name in ["friction", "stress", "front"] {
        for ending in ["svg", "png"] {
            std::fs::remove_file(workspace.path(&format!("a/{name}.{ending}"))).unwrap();
        }
    }
    let said = workspace.succeed("plot a");
    assert_eq!(said.lines().count(), 6, "{said}");
    assert!(before == workspace.files("a"));
    workspace.succeed("plot a -o pictures");
    assert_eq!(workspace.read("pictures/stress.svg"), before["stress.svg"]);
}

/// An output folder must not have the name of a picture.
#[test]
fn plot_refuses_the_name_of_a_picture() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    for out in ["tr.png", "maps/tr.SVG"] {
        let said = workspace.fail(&format!("plot a --field traction -o {out}"), 2);
        let (folder, _) = out.split_once('.').unwrap();
        let sentence = format!("{out} is the name of a picture: write --out {folder}\n");
        assert!(said.contains(&sentence), "{said}");
        assert!(!workspace.exists(out));
    }
    // A folder of that name may exist already.
    std::fs::create_dir(workspace.path("old.png")).unwrap();
    workspace.succeed("plot a --field traction -o old.png");
    assert!(workspace.exists("old.png/traction.png"));
}

#[test]
fn plot_lays_two_runs_over_each_other() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o slow");
    workspace.succeed("run small.toml -o fast --set drive.v_star=0.2");
    let said = workspace.succeed("plot slow fast");
    assert_eq!(
        said,
        "results/overlay/friction.svg\nresults/overlay/friction.png\n"
    );
    assert_eq!(workspace.files("results/overlay").len(), 2);
    let svg = String::from_utf8(workspace.read("results/overlay/friction.svg")).unwrap();
    assert!(svg.contains(">slow<") && svg.contains(">fast<"));
}

/// Long names are cut to fit the legend, but the runs remain distinguishable.
#[test]
fn long_names_of_runs_are_told_apart() {
    let workspace = Workspace::small();
    let long = "a_name_of_a_folder_that_no_legend_has_room_for_at_all";
    let folders = ["slow", "fast"].map(|speed| format!("{long}/{speed}/{long}"));
    for (folder, v_star) in folders.iter().zip([0.1, 0.2]) {
        workspace.succeed(&format!("run small.toml -o {folder} --set drive.v_star={v_star}"));
    }
    workspace.succeed(&format!("plot {}", folders.join(" ")));
    let svg = svg(&workspace, "results/overlay");
    // The common folder appears once above the names, and no full name appears.
    assert!(
        svg.contains(">slow/") && svg.contains(">fast/") && svg.matches(long).count() <= 1,
        "{svg}"
    );
}

#[test]
fn plot_draws_maps_of_a_field_that_was_kept() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a --set drive.direction=30");
    let title = |field: &str| {
        workspace.succeed(&format!("plot a --field {field} -o maps"));
        let svg = String::from_utf8(workspace.read(&format!("maps/{field}.svg"))).unwrap();
        assert!(workspace.exists(&format!("maps/{field}.png")) && svg.matches("<image").count() > 4);
        svg
    };
    assert!(title("traction").contains(">traction \u{3c4}</text>"));
    assert!(title("displacement_y").contains(">displacement along y from rest (pm)</text>"));
    assert!(title("sliding").contains(">sliding fraction</text>"));
    let said = workspace.fail("plot a --field velocity_x", 2);
    assert!(
        said.contains("has no maps of velocity_x: add it to `output.fields`"),
        "{said}"
    );
    assert!(
        workspace
            .fail("plot a --field speed", 2)
            .contains("[possible values: contact_stress_star")
    );
    let said = workspace.fail("plot a a --field traction", 2);
    assert!(said.contains("--field draws the maps of one run"), "{said}");
    // With one block, two instants coincide; the fields file joins their letters.
    let equal = "--set friction.sigma_static_star=0 --set friction.sigma_kinetic_star=0";
    workspace.succeed(&format!(
        "run small.toml -o single --set slider.blocks=[1,1] {equal}"
    ));
    assert!(workspace.read_text("single/stress.svg").contains(">C, D: t* = "));
}

#[test]
fn plot_refuses_what_is_no_run() {
    let workspace = Workspace::small();
    assert_eq!(
        workspace.fail("plot nowhere", 2),
        "error: there is no folder nowhere\n"
    );
    workspace.write("results/first/note.txt", "");
    assert!(
        workspace
            .fail("plot first", 2)
            .contains("there is no folder first: did you mean results/first?")
    );
    assert!(workspace.fail("plot results/first", 2).contains("summary.json"));
    workspace.succeed("run small.toml -o a");
    workspace.write("a/fields.nc", "CDF");
    assert!(workspace.fail("plot a", 2).contains("fields.nc"));
    workspace.write("a/series.csv", "step,time_star\n1,2\n");
    assert!(workspace.fail("plot a", 2).contains("series.csv"));
}

fn svg(workspace: &Workspace, folder: &str) -> String {
    String::from_utf8(workspace.read(&format!("{folder}/friction.svg"))).unwrap()
}

/// A column of the series of a run.
fn column(workspace: &Workspace, folder: &str, name: &str) -> Vec<f64> {
    let text = String::from_utf8(workspace.read(&format!("{folder}/series.csv"))).unwrap();
    let mut lines = text.lines();
    let place = lines
        .next()
        .unwrap()
        .split(',')
        .position(|column| column == name)
        .unwrap();
    lines
        .map(|line| line.split(',').nth(place).unwrap().parse().unwrap())
        .collect()
}

#[test]
fn curves_are_drawn_in_newtons_and_metres() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    workspace.succeed("plot a --units si -o si");
    // 0.89 of 100 kPa times 30 um^2, in about 8 ns.
    assert!(
        svg(&workspace, "si").contains(">friction force (\u{b5}N)<")
            && svg(&workspace, "si").contains(">time (ns)<")
    );
    workspace.succeed("plot a --units si --against displacement -o path");
    assert!(svg(&workspace, "path").contains(">drive displacement (pm)<"));
    workspace.succeed("plot a --against displacement -o star");
    assert!(svg(&workspace, "star").contains(">drive displacement in units of P"));
    workspace.succeed("run small.toml --set drive.motion=rotation -o turned");
    workspace.succeed("plot turned --units si -o torque");
    assert!(svg(&workspace, "torque").contains(">torque (pN m)<"));
    let said = workspace.fail("plot a turned --units si", 2);
    assert!(
        said.contains("forces and torques cannot share an axis: turned"),
        "{said}"
    );
    // The run's own pictures are unchanged.
    workspace.succeed("verify a");
}

#[test]
fn runs_of_different_materials_are_drawn_where_they_can_be_compared() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    let steel = "slider = { blocks = [6, 5], young_modulus = '210 GPa' }\ndrive.v_star = 0.1\nfriction.mu_static = 0.6\n";
    workspace.write("steel.toml", steel);
    workspace.succeed("run steel.toml -o steel");
    let said = workspace.succeed("plot a steel");
    assert!(
        said.contains("note: the runs have different materials: friction is drawn as mu"),
        "{said}"
    );
    let svg = svg(&workspace, "results/overlay");
    assert!(
        svg.contains(">friction \u{3bc}<") && svg.contains(">drive displacement in units of P"),
        "{svg}"
    );
}

/// A record made from a run fits that run after shifting, with another sign, in other units and with decimal
/// commas.
#[test]
fn a_measured_record_finds_its_place() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    let (times, forces) = (
        column(&workspace, "a", "time_s"),
        column(&workspace, "a", "friction_force_n"),
    );
    let rows = times.iter().zip(&forces).skip(100).take(500);
    let rows = rows.map(|(time, force)| format!("{};{}\n", 1e9 * time - 3.0, -1e6 * force).replace('.', ","));
    workspace.write(
        "force.csv",
        "t [ns];F [uN]\n".to_owned() + &rows.collect::<String>(),
    );
    let said = workspace.succeed("plot a --data force.csv --x t --y F --y-factor -1 -o both");
    assert!(said.contains("force.csv: shifted by 3 ns\n"), "{said}");
    let misfit = said
        .lines()
        .find_map(|line| line.strip_prefix("  a: RMS misfit "))
        .unwrap();
    let (misfit, points) = misfit.split_once(" over ").unwrap();
    assert_eq!(points, "500 of 500 points");
    // The misfit left by the search for the shift is far below the friction of micrometre-sized sliders.
    assert!(
        misfit.ends_with(" fN") || misfit.ends_with(" aN") || misfit.ends_with(" pN"),
        "{misfit}"
    );
    assert!(svg(&workspace, "both").contains(">force.csv<"));
    let said = workspace.succeed("plot a --data force.csv --x 1 --y 2 --y-factor -1 --shift 0 -o apart");
    assert!(
        said.contains("shifted by 0 s") && !said.contains("RMS misfit 0"),
        "{said}"
    );
    let said = workspace.fail("plot a --data force.csv --x t --y load", 2);
    assert!(
        said.contains("has no column `load`: its columns are t [ns], F [uN], or 1 to 2"),
        "{said}"
    );
    let said = workspace.fail("plot a --units star --data force.csv --x t --y F", 2);
    assert!(said.contains("leave `--units star` out"), "{said}");
}

/// A record smoothed by a filter matches the filtered curve, not the curve itself.
#[test]
fn a_filtered_record_is_compared_with_filtered_curves() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    let (times, forces) = (
        column(&workspace, "a", "time_s"),
        column(&workspace, "a", "friction_force_n"),
    );
    let (constant, offset) = (times.last().unwrap() / 20.0, 2e-6);
    // Exact for a force that is linear between its values: F = f + g t gives x = F - constant g + C
    // exp(-t/constant).
    let mut filtered = forces[0];
    let mut rows = format!("{:e},{:e}\n", times[0], filtered + offset);
    for k in 1..times.len() {
        let step = times[k] - times[k - 1];
        let lag = constant * (forces[k] - forces[k - 1]) / step;
        filtered = forces[k] - lag + (filtered - forces[k - 1] + lag) * (-step / constant).exp();
        rows += &format!("{:e},{:e}\n", times[k], filtered + offset);
    }
    workspace.write("filtered.csv", format!("t [s],F [N]\n{rows}"));
    let rig = format!("[instrument]\nfilter = 'first_order'\ntime = '{constant:e} s'\noffset = '2 uN'\n");
    workspace.write("rig.toml", &rig);
    let line = "plot a --data filtered.csv --x t --y F --shift 0";
    let misfit = |said: &str| -> String {
        let found = said
            .lines()
            .find_map(|line| line.strip_prefix("  a: RMS misfit "));
        let (misfit, _) = found.and_then(|rest| rest.split_once(" over ")).unwrap();
        misfit.to_owned()
    };
    let said = workspace.succeed(&format!("{line} --instrument rig.toml -o as_written"));
    // This is the rounding of forces of some uN over some thousand steps.
    assert!(misfit(&said).ends_with(" aN"), "{said}");
    let said = workspace.succeed(&format!("{line} -o as_it_is"));
    // Most of this misfit is the offset.
    assert!(misfit(&said).ends_with(" uN"), "{said}");
    // Instants such as C are marked only on unfiltered friction.
    assert!(svg(&workspace, "as_it_is").contains(">C<") && !svg(&workspace, "as_written").contains(">C<"));

    let said = workspace.fail("plot a --instrument rig.toml", 2);
    assert!(said.contains("--data <FILE>"), "{said}");
    workspace.write("none.toml", "[base]\n");
    let said = workspace.fail(&format!("{line} --instrument none.toml -o none"), 2);
    assert!(
        said.contains("none.toml: there is no table [instrument]"),
        "{said}"
    );
    workspace.write("wrong.toml", "[instrument]\ngain = 0\n");
    let said = workspace.fail(&format!("{line} --instrument wrong.toml -o none"), 2);
    assert!(said.contains("wrong.toml: `gain` of the instrument: "), "{said}");
    workspace.succeed("run small.toml --set drive.loading=held -o held");
    let held = line.replace(" a ", " held ");
    let said = workspace.fail(&format!("{held} --instrument rig.toml -o none"), 2);
    assert!(
        said.contains("held: a held drive has no time while blocks slide"),
        "{said}"
    );
    assert!(!workspace.exists("none"));
    workspace.write("offset.toml", "[instrument]\noffset = '1 uN'\n");
    workspace.succeed(&format!("{held} --instrument offset.toml -o of_held"));
}

/// Size, font size, titles and names are as requested: in millimetres in the SVG, and in pixels at 300 dots
/// per inch in the PNG.
#[test]
fn pictures_have_the_size_and_the_names_that_are_asked_for() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o results/a");
    workspace.succeed("run small.toml --seed 2 -o results/b");
    let pixels = |folder: &str| {
        let bytes = workspace.read(&format!("{folder}/friction.png"));
        [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
    };
    workspace.succeed("plot results/a results/b -o usual");
    let usual = svg(&workspace, "usual");
    // The common beginning of both names appears once.
    assert!(
        usual.contains(">results/<") && usual.contains(">a<") && usual.contains(">b<"),
        "{usual}"
    );
    assert!(usual.contains("width=\"85.00mm\"") && pixels("usual")[0] == 1004);
    workspace.succeed(
        "plot results/a results/b --width 120 --height 90 --name plain --name other --x-label time --y-label F_T -o sized",
    );
    let sized = svg(&workspace, "sized");
    for words in [">plain<", ">other<", ">time<", ">F<", ">T<"] {
        assert!(sized.contains(words), "{words}: {sized}");
    }
    assert!(
        sized.contains("width=\"120.00mm\" height=\"90.00mm\""),
        "{sized:.300}"
    );
    assert_eq!(pixels("sized"), [1417, 1063]);
    // The font is half as large again, at the same width.
    workspace.succeed("plot results/a results/b --font-size 12 -o large");
    let large = svg(&workspace, "large");
    assert!(
        large.contains("width=\"85.00mm\"") && large.contains("viewBox=\"0 0 662.6 "),
        "{large:.300}"
    );
    assert!((1003..=1005).contains(&pixels("large")[0]));
    // All pictures of one run are drawn, but not in its folder.
    workspace.succeed("plot results/a --width 60 --font-size 7 -o narrow");
    assert_eq!(workspace.files("narrow").len(), 6);
    for name in workspace
        .files("narrow")
        .keys()
        .filter(|name| name.ends_with("svg"))
    {
        let drawn = workspace.read_text(&format!("narrow/{name}"));
        assert!(drawn.contains("width=\"60.00mm\""), "{name}");
    }
    workspace.succeed("verify results/a");
    for (options, sentence) in [
        (
            "--width 30 --font-size 12",
            "a width of 30 mm leaves no room for curves with text of 12 pt: use at least 65 mm",
        ),
        ("--width 1000", "a number of mm from 20 to 400"),
        ("--font-size big", "a number of pt from 3 to 40"),
        ("--name one", "1 name for 2 runs: give --name once for each"),
        ("--field traction --name a", "cannot be used with"),
        ("--field traction --picture stress", "cannot be used with"),
        ("--format eps", "[possible values: svg, png, pdf]"),
    ] {
        let said = workspace.fail(&format!("plot results/a results/b {options} -o none"), 2);
        assert!(said.contains(sentence), "{options}: {said}");
    }
    assert!(!workspace.exists("none"));
}

#[test]
fn the_kymograph_is_a_field() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    workspace.succeed("plot a --field kymograph -o picture");
    let svg = workspace.read_text("picture/kymograph.svg");
    assert!(
        svg.contains("position along drive") && svg.contains("sliding fraction"),
        "{svg}"
    );
    assert!(workspace.exists("picture/kymograph.png"));
    workspace.remove("a/kymograph.nc");
    workspace.remove("a/manifest.json");
    assert!(
        workspace
            .fail("plot a --field kymograph -o none", 2)
            .contains("kymograph.nc")
    );
}

/// A record that does not overlap the curves is refused, and so is one with an ambiguous shift, because it
/// also fits another run at another shift, or is a plateau.
#[test]
fn the_place_of_a_record_is_found_or_asked_for() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    workspace.succeed("run small.toml --set drive.v_star=0.05 -o slow");
    let record = |rows: &mut dyn Iterator<Item = (f64, f64)>| {
        let rows = rows.map(|(time, force)| format!("{time:e},{force:e}\n"));
        "t [s],F [N]\n".to_owned() + &rows.collect::<String>()
    };
    let of = |folder: &str, shift: f64| {
        let times = column(&workspace, folder, "time_s");
        let forces = column(&workspace, folder, "friction_force_n");
        record(
            &mut times
                .into_iter()
                .zip(forces)
                .map(|(time, force)| (time - shift, force)),
        )
    };
    workspace.write("slow.csv", of("slow", 3e-9));
    let line = "--data slow.csv --x t --y F -o both";
    let said = workspace.fail(&format!("plot a slow {line}"), 2);
    assert!(
        said.contains("slow.csv fits a best with a shift of ")
            && said.contains(", but slow with 3 ns: give the shift with --shift"),
        "{said}"
    );
    assert!(!workspace.exists("both"));
    // The first run decides, although the other one fits worse.
    assert!(
        workspace
            .succeed(&format!("plot slow a {line}"))
            .contains("shifted by 3 ns\n")
    );
    let said = workspace.succeed(&format!("plot a slow {line} --force --shift 3e-9"));
    assert!(said.contains("  slow: RMS misfit "), "{said}");
    let said = workspace.fail("plot a --data slow.csv --x t --y F --shift 1 -o none", 2);
    assert!(
        said.contains(
            "slow.csv and the curve of a run overlap too little, by less than a tenth of the shorter one or of the points of the record: after the shift the \
             record covers 1 s to 1 s, and a covers 0 s to "
        ),
        "{said}"
    );
    // Times of a calendar are not those of a test, and picoseconds not the times of a run.
    let at = |times: [&str; 3]| format!("t (s),F (N)\n{},1\n{},2\n{},3\n", times[0], times[1], times[2]);
    workspace.write("unix.csv", at(["1706695471", "1706695471.1", "1706695471.2"]));
    let said = workspace.fail("plot a --data unix.csv --x t --y F -o none", 2);
    assert!(
        said.contains("begins at 1706695471 s") && said.contains("`--shift -1706695471` begins it at 0"),
        "{said}"
    );
    workspace.write("short.csv", at(["0", "1e-20", "2e-20"]));
    let said = workspace.fail("plot a --data short.csv --x t --y F --shift 0 -o none", 2);
    assert!(said.contains("short.csv lasts 0.02 as, and a lasts "), "{said}");
    for bound in [
        "--y-factor nan",
        "--y-factor 0",
        "--y-factor inf",
        "--y-offset nan",
        "--shift inf",
    ] {
        let said = workspace.fail(&format!("plot a --data short.csv --x t --y F {bound} -o none"), 2);
        assert!(said.contains("invalid value"), "{said}");
    }
    // The record is shifted to the last twentieth of its own curve, and then to the last fifth.
    let times = column(&workspace, "slow", "time_s");
    let end = times.last().unwrap();
    let shifted = |share: f64| {
        let shift = 3e-9 + share * end;
        format!("plot slow --data slow.csv --x t --y F --shift {shift:e} -o part")
    };
    let said = workspace.fail(&shifted(0.95), 2);
    assert!(said.contains("overlap too little"), "{said}");
    let said = workspace.succeed(&shifted(0.8));
    let points = said
        .split_once(" over ")
        .and_then(|(_, rest)| rest.split_once(" of "));
    let (points, of) = points.unwrap_or_else(|| panic!("{said}"));
    assert!(of.starts_with(&format!("{} points\n", times.len())), "{said}");
    // The steps of the series are equal, except where a stride ends.
    let share = points.parse::<f64>().unwrap() / times.len() as f64;
    assert!((share - 0.2).abs() < 0.01, "{said}");
    let plateau = column(&workspace, "a", "friction_force_n").pop().unwrap();
    workspace.write(
        "flat.csv",
        record(&mut (0..50).map(|k| (1e-10 * f64::from(k), plateau))),
    );
    let said = workspace.fail("plot a --data flat.csv --x t --y F -o none", 2);
    assert!(
        said.contains("flat.csv fits about equally well with a shift of ") && said.contains("--shift"),
        "{said}"
    );
    assert!(!workspace.exists("none"));
}

/// A line that cannot be read is an error inside a record, and a note at its end.
#[test]
fn lines_without_numbers_are_not_passed_over_in_silence() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    let series = workspace.read_text("a/series.csv");
    let ended = format!("{series}End of test\nOperator: N. N.\n");
    workspace.write("ended.csv", &ended);
    let data = "--x time_s --y friction_force_n";
    let said = workspace.succeed(&format!("plot a --data ended.csv {data} -o ended"));
    let from = series.lines().count() + 1;
    assert!(
        said.starts_with(&format!(
            "note: ended.csv ends with 2 lines without numbers, starting at line {from}: passed over\n"
        )),
        "{said}"
    );
    let overload = series.replacen("\n", "\n*** sensor overload ***\n", 20);
    workspace.write("overload.csv", overload);
    let said = workspace.fail(&format!("plot a --data overload.csv {data} -o overload"), 2);
    assert!(
        said.contains(
            "line 2 of overload.csv, \"*** sensor overload ***\", has no number in column `time_s`"
        ),
        "{said}"
    );
    assert!(!workspace.exists("overload"));
}
