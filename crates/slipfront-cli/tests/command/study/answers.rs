//! Contents of tables and pictures, which must not depend on how they were made.

use std::collections::{BTreeMap, BTreeSet};

use super::results::{SMALL, SMALL_RUNS, deviation, mean};
use crate::fixtures::unwrapped;
use crate::support::process::{stderr, stdout};
use crate::support::workspace::Workspace;

/// Replicates until the interval of mu_s* is narrow: some points need more than the minimum, and none the
/// maximum.
fn adaptive(half_width: &str, max: &str) -> String {
    let until = format!(
        "until = {{ key = 'static_friction_star', half_width = {half_width}, min = 3, max = {max} }}"
    );
    SMALL.replace("replicates = 3", &until)
}

/// A key of the base changed by `--set` gives the same bytes as a study file with that key, and the folder
/// contains that study.
#[test]
fn keys_of_the_base_can_be_set() {
    let workspace = Workspace::with_study(SMALL);
    workspace.write(
        "other.toml",
        SMALL.replace("blocks = [6, 6]", "blocks = [6, 7]\nomega_star = 0.2"),
    );
    workspace.succeed("study other.toml -o other");
    workspace.succeed("study study.toml -o set --set slider.blocks=[6,7] --set slider.omega_star=0.2");
    workspace.results("set").assert_same(&workspace.results("other"));
    assert_eq!(
        workspace.read_text("set/study.toml"),
        workspace.read_text("other/study.toml")
    );
    workspace.succeed("verify set");
    assert_ne!(
        workspace.study("plain").answer()["points.csv"],
        workspace.results("set").answer()["points.csv"]
    );
}

/// The JSON output has the numbers of `points.csv`, and nothing else is printed.
#[test]
fn the_answer_is_printed_as_json() {
    let workspace = Workspace::with_study(SMALL);
    let printed = workspace.succeed("study study.toml -o out --json");
    let answer: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(answer["study"], "study");
    assert_eq!(answer["main_quantity"], "static_reduction_percent");
    let points = answer["points"].as_array().unwrap();
    assert_eq!(points.len(), 6);
    let rows = workspace.results("out").table("points.csv");
    for row in &rows {
        let point = &points[row["point"].parse::<usize>().unwrap()];
        assert_eq!(point["levels"]["drive.v_star"], row["drive.v_star"].as_str());
        let quantity = &point[&row["quantity"]];
        for column in ["n", "mean", "deviation", "low", "high", "min", "max"] {
            assert_eq!(
                quantity[column].as_f64(),
                row[column].parse::<f64>().ok(),
                "{row:?}"
            );
        }
    }
    assert!(rows.len() > 6 && answer["failures"].as_array().unwrap().is_empty());
    // A complete study prints the same output again.
    assert_eq!(
        workspace.succeed("study study.toml -o out --json --quiet"),
        printed
    );
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let workspace = Workspace::with_study(SMALL);
    workspace.write("adaptive.toml", adaptive("0.012", "12"));
    for study in ["study", "adaptive"] {
        for threads in ["1", "2", "7"] {
            let (file, out) = (format!("{study}.toml"), format!("{study}-{threads}"));
            workspace.succeed(&format!("study {file} -o {out} --threads {threads}"));
            workspace
                .results(&out)
                .assert_same(&workspace.results(&format!("{study}-1")));
        }
    }
    workspace.results("study-7").assert_each_run_once(SMALL_RUNS);
    let counts: Vec<usize> = (0..6)
        .map(|point| {
            workspace
                .results("adaptive-2")
                .numbers(point, "point", "seed")
                .len()
        })
        .collect();
    assert!(
        counts.iter().any(|&count| (4..12).contains(&count)),
        "nothing was decided: {counts:?}"
    );
}

/// Tables have columns of precursors if some run has precursors, with the values of its summary.
#[test]
fn tables_tell_of_precursors() {
    let study = |list: &str| {
        format!(
            "base.slider = {{ blocks = [12, 1], omega_star = 0, viscosity_time_star = 0.3 }}\nbase.time = {{ step = 0.3, duration_star = 900 }}\n\
             base.friction.r_star = 0.2\nbase.drive = {{ v_star = 0.5, total_stiffness_star = 0.03 }}\nstudy.keep = 'all'\n\
             [[axes]]\nkey = 'drive.attach'\nlist = {list}"
        )
    };
    let workspace = Workspace::with_study(&study("['all', 'left']"));
    workspace.succeed("study study.toml -o both");
    let rows = workspace.results("both").table("runs.csv");
    let columns = ["precursor_count", "precursor_length_max", "nucleation_load_ratio"];
    for column in columns {
        assert_eq!(rows[0][column], "", "{column} of a drive at all blocks");
        let summary = workspace.read_text(&format!("both/runs/{}/summary.json", rows[1]["run"]));
        let (_, number) = summary.split_once(&format!("\"{column}\": ")).unwrap();
        let number = number.split([',', '\n']).next().unwrap();
        assert_eq!(
            rows[1][column].parse::<f64>().unwrap(),
            number.parse::<f64>().unwrap(),
            "{column}"
        );
    }
    assert!(rows[1]["precursor_count"].parse::<f64>().unwrap() > 1.0);
    let ratio: f64 = rows[1]["nucleation_load_ratio"].parse().unwrap();
    assert!(0.0 < ratio && ratio < 1.0, "{ratio}");
    workspace.succeed("verify both");
    workspace.write("study.toml", study("['all']"));
    workspace.succeed("study study.toml -o none");
    let row = &workspace.results("none").table("runs.csv")[0];
    assert!(columns.iter().all(|column| !row.contains_key(*column)));
}

#[test]
fn where_the_interval_stays_wide_it_is_said() {
    let workspace = Workspace::with_study(&adaptive("1e-6", "4"));
    let said = workspace.succeed("study study.toml -o wide");
    assert_eq!(said.matches("interval still too wide").count(), 6, "{said}");
    let decided: Vec<String> = workspace
        .results("wide")
        .table("points.csv")
        .iter()
        .filter(|row| row["quantity"] == "static_friction_star")
        .map(|row| row["narrow_enough"].clone())
        .collect();
    assert_eq!(decided, ["false"; 6]);
}

#[test]
fn the_same_replicate_has_the_same_surface_at_every_point() {
    // The first slip of a bare surface is at t* = (8/3) min(mu)/V*, up to a step: it identifies the surface.
    let workspace = Workspace::with_study(
        "base.slider.blocks = [6, 6]\nbase.time.stop = 'after_onset'\n[study]\nreplicates = 8\n[[axes]]\nkey = 'drive.v_star'\nlist = [0.05, 0.1]",
    );
    let results = workspace.study("out");
    let scaled = |point, v_star: f64| -> Vec<f64> {
        let times = results.numbers(point, "point", "first_slip_time_star");
        times.into_iter().map(|time| time * v_star).collect()
    };
    let (slow, fast) = (scaled(0, 0.05), scaled(1, 0.1));
    let step = 0.1 * 0.1;
    for (slow, fast) in slow.iter().zip(&fast) {
        assert!((slow - fast).abs() < step, "{slow} {fast}");
    }
    assert!(
        deviation(&slow) > 5.0 * step,
        "all replicates are alike: {slow:?}"
    );
    assert_eq!(
        results.numbers(1, "point", "seed"),
        (1..=8).map(f64::from).collect::<Vec<_>>()
    );
}

#[test]
fn reductions_are_paired_and_their_statistics_those_of_the_pairs() {
    // A small change of speed has little effect compared with another surface.
    let workspace = Workspace::with_study(
        "base.slider.blocks = [6, 6]\nbase.time.stop = 'after_onset'\n[study]\nreplicates = 12\n\
         reference = { drive.v_star = 0.12 }\n[[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.08]",
    );
    let results = workspace.study("out");
    let column = |role, name| results.numbers(0, role, name);
    let (slow, fast) = (
        column("point", "static_friction_star"),
        column("reference", "static_friction_star"),
    );
    let reduction = |slow: f64, fast: f64| 100.0 * (fast - slow) / fast;
    let paired: Vec<f64> = slow.iter().zip(&fast).map(|(s, f)| reduction(*s, *f)).collect();
    assert_eq!(column("point", "static_reduction_percent"), paired);

    let elsewhere = fast.iter().cycle().skip(1);
    let unpaired: Vec<f64> = slow
        .iter()
        .zip(elsewhere)
        .map(|(s, f)| reduction(*s, *f))
        .collect();
    assert!(
        deviation(&paired) < 0.5 * deviation(&unpaired),
        "{} {}",
        deviation(&paired),
        deviation(&unpaired)
    );

    let points = results.table("points.csv");
    let row = points
        .iter()
        .find(|row| row["point"] == "0" && row["quantity"] == "static_reduction_percent")
        .unwrap();
    let number = |name: &str| -> f64 { row[name].parse().unwrap() };
    assert_eq!(number("n"), 12.0);
    // t(11, 97.5 %) from a printed table.
    let half = 2.200985 * deviation(&paired) / 12f64.sqrt();
    for (name, expected) in [
        ("mean", mean(&paired)),
        ("deviation", deviation(&paired)),
        ("low", mean(&paired) - half),
        ("high", mean(&paired) + half),
        ("min", paired.iter().copied().fold(f64::INFINITY, f64::min)),
        ("max", paired.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
    ] {
        assert!(
            (number(name) - expected).abs() < 1e-5 * expected.abs(),
            "{name}: {} {expected}",
            number(name)
        );
    }
}

#[test]
fn a_reference_that_points_share_is_run_once() {
    let workspace = Workspace::with_study(&SMALL.replace(
        "0.12, 0.14, 0.16, 0.18]",
        "]\n[[axes]]\nkey = 'texture.0.coverage'\nlist = [17, 34]",
    ));
    // 2 speeds, 2 coverages, 3 surfaces; the bare slider does not depend on the coverage.
    workspace.study("out").assert_each_run_once(12 + 6);
}

#[test]
fn a_failed_run_is_told_and_neither_repeated_nor_in_the_way() {
    let workspace = Workspace::with_study(SMALL);
    let results = workspace.study("out");
    // No valid case diverges, so one run is changed to a failed one: the sixth line is some run of a point.
    let text = std::fs::read_to_string(results.records()).unwrap();
    let failed: String = text
        .lines()
        .map(|line| {
            let mut record: serde_json::Value = serde_json::from_str(&line[17..]).unwrap();
            let id = record["id"].as_str().unwrap();
            let first = &results.table("runs.csv")[0]["run"];
            if id.starts_with(first.as_str()) {
                record["outcome"] = serde_json::json!({ "failed": "block (3, 2) diverged" });
            }
            let json = record.to_string();
            format!("{} {json}\n", &blake3::hash(json.as_bytes()).to_hex()[..16])
        })
        .collect();
    std::fs::write(results.records(), failed).unwrap();
    let output = workspace.output("study study.toml -o out");
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(
        said.contains(" runs failed") && said.contains("block (3, 2) diverged"),
        "{said}"
    );
    results.assert_each_run_once(SMALL_RUNS);
    let rows = results.table("runs.csv");
    assert_eq!(
        (rows[0]["status"].as_str(), rows[0]["reason"].as_str()),
        ("failed", "block (3, 2) diverged")
    );
    assert_eq!(
        rows.iter().filter(|row| row["status"] == "done").count(),
        SMALL_RUNS - 1
    );
    let counts: Vec<String> = results
        .table("points.csv")
        .iter()
        .filter(|row| row["quantity"] == "static_reduction_percent")
        .map(|row| row["n"].clone())
        .collect();
    assert_eq!(counts, ["2", "3", "3", "3", "3", "3"]);
}

#[test]
fn a_dry_run_tells_the_plan_and_runs_nothing() {
    let workspace = Workspace::with_study(SMALL);
    let said = workspace.succeed("study study.toml --dry-run -o out");
    for part in [
        "6 points",
        "3 replicates",
        "36 runs",
        "block-steps, ",
        " of memory for ",
        // One line in the records and one in the tables for each run.
        "144.0 KiB on the disk",
        "drive.v_star: 0.08, 0.1, 0.12, 0.14, 0.16, 0.18",
    ] {
        assert!(said.contains(part), "{part} is not in\n{said}");
    }
    assert!(!workspace.path("out").exists());
}

#[test]
fn pictures_are_those_that_the_axes_ask_for() {
    let workspace = Workspace::with_study(&SMALL.replace(
        "0.12, 0.14, 0.16, 0.18]",
        "]\n[[axes]]\nkey = 'friction.r_star'\nlist = [0.4, 0.5]",
    ));
    workspace.write(
        "names.toml",
        "base.slider.blocks = [4, 4]\nbase.time.stop = 'after_onset'\n[[axes]]\nname = 'damping'\n\
         variants = { weak = { slider.omega_star = 0.1 }, strong = { slider.omega_star = 1 } }",
    );
    let two_numbers = workspace.study("numbers");
    for name in ["static_friction_star", "static_reduction_percent"] {
        for file in [format!("{name}.svg"), format!("{name}_map.png")] {
            assert!(two_numbers.has(&file), "{file}");
        }
    }
    // A changed study keeps no picture of the previous one.
    workspace.succeed("study names.toml -o numbers");
    assert!(two_numbers.has("static_friction_star.svg"));
    assert!(
        !two_numbers.has("static_friction_star_map.svg") && !two_numbers.has("static_reduction_percent.png")
    );
}

/// Quantities are numbers: there are curves and a map with the unit of their ticks and the meaning of the
/// intervals. If there are no curves, the plan and the results say why.
#[test]
fn axes_of_quantities_are_drawn_in_their_unit() {
    let study = |levels: [usize; 2]| {
        format!(
            "base.slider.blocks = [4, 4]\nbase.time.stop = 'after_onset'\nbase.drive.speed = '0.4 mm/s'\nstudy.replicates = 2\n\
             [[axes]]\nkey = 'load.pressure'\nlinspace = ['50 kPa', '0.2 MPa', {}]\n\
             [[axes]]\nkey = 'slider.young_modulus'\nlogspace = ['10 GPa', '100 GPa', {}]",
            levels[0], levels[1]
        )
    };
    let workspace = Workspace::with_study(&study([4, 3]));
    let said = workspace.succeed("study study.toml -o out");
    assert!(!said.contains("no pictures of curves"), "{said}");
    let pressures: BTreeSet<String> = workspace
        .results("out")
        .table("runs.csv")
        .iter()
        .map(|row| row["load.pressure"].clone())
        .collect();
    assert_eq!(
        pressures,
        ["100 kPa", "150 kPa", "200 kPa", "50 kPa"]
            .map(str::to_owned)
            .into()
    );
    let curves = workspace.read_text("out/static_friction_star.svg");
    let map = workspace.read_text("out/static_friction_star_map.svg");
    for picture in [&curves, &map] {
        for text in ["pressure P (kPa)", "100", "95 % interval of the mean, n = 2"] {
            assert!(picture.contains(&format!(">{text}</text>")), "{text}");
        }
    }
    assert!(curves.contains(">E (GPa)</text>") && map.contains(">Young's modulus E (GPa)</text>"));
    assert!(map.contains(">\u{b1}0."), "{map}");

    workspace.write("study.toml", study([10, 10]));
    let why = "there are no pictures of curves: a picture would have 10 curves, one for each level of \
               `slider.young_modulus`, but at most 9 are possible; the map shows the values";
    for line in ["study study.toml --dry-run", "study study.toml -o out"] {
        let said = unwrapped(&workspace.succeed(line));
        assert_eq!(said.matches(why).count(), 1, "{said}");
    }
    assert!(!workspace.results("out").has("static_friction_star.svg"));
}

/// Directions have a polar picture and their own table, which belongs to the study like the other files.
#[test]
fn directions_have_a_polar_picture_and_their_table() {
    let study = |key: &str| {
        format!(
            "base.slider.blocks = [8, 8]\nbase.drive.v_star = 0.1\nbase.texture = [{{ shape = 'groove', coverage = 25 }}]\n\
             study.replicates = 3\n[[axes]]\nkey = '{key}'\nlinspace = [0, 1.5, 6]"
        )
    };
    let workspace = Workspace::with_study(&study("drive.direction").replace("1.5, 6", "300, 6"));
    let said = workspace.succeed("study study.toml -o out");
    assert!(said.contains("friction over the directions"), "{said}");
    let results = workspace.results("out");
    let rows = results.table("anisotropy.csv");
    let names: Vec<&str> = rows.iter().map(|row| row["quantity"].as_str()).collect();
    assert_eq!(names, ["static_friction_star", "kinetic_friction_star"]);
    assert_eq!(
        (rows[0]["directions"].as_str(), rows[0]["n"].as_str()),
        ("6", "3")
    );
    let picture = workspace.read_text("out/friction_polar.svg");
    for text in ["x 0\u{b0}", "friction \u{3bc}*"] {
        assert!(picture.contains(&format!(">{text}</text>")), "{text}");
    }
    // Friction is nearly the same in all directions.
    assert!(picture.contains(">95 % interval of the mean, n = 3; the centre is 0."));
    workspace.succeed("verify out");
    // Two surfaces are too few for these numbers, and a note says so.
    let two = study("drive.direction")
        .replace("1.5, 6", "300, 6")
        .replace("= 3", "= 2");
    workspace.write("two.toml", two);
    let said = unwrapped(&workspace.succeed("study two.toml -o two"));
    assert!(
        said.contains("note: static_friction_star: with 2 replicates")
            && !said.contains("friction over the directions"),
        "{said}"
    );
    let rows = workspace.results("two").table("anisotropy.csv");
    assert_eq!((rows.len(), rows[0]["n"].as_str()), (2, "2"));
    assert!(
        ["mean", "anisotropy", "p_value", "lateral"]
            .iter()
            .all(|column| rows[0][*column].is_empty())
    );
    // A study without directions keeps neither of them.
    workspace.write("study.toml", study("slider.omega_star"));
    workspace.succeed("study study.toml -o out");
    assert!(!results.has("anisotropy.csv") && !results.has("friction_polar.svg"));
    // Many textures are only in the table, with a note on the reason.
    let textures = "[[axes]]\nkey = 'texture.0.coverage'\nlinspace = [13, 63, 5]\n";
    workspace.write("many.toml", study("drive.direction") + "\n" + textures);
    let said = unwrapped(&workspace.succeed("study many.toml -o many"));
    assert!(
        said.contains("there is no polar picture: it would have 10 curves"),
        "{said}"
    );
    let many = workspace.results("many");
    assert!(!many.has("friction_polar.svg") && many.table("anisotropy.csv").len() == 10);
}

/// Runs without a transition are pointed out: the largest mu* of a run that never slid must not enter a mean.
#[test]
fn runs_without_a_transition_are_pointed_out() {
    let workspace = Workspace::with_study(&SMALL.replace("stop = \"after_onset\"", "duration_star = 25"));
    let said = workspace.succeed("study study.toml -o out");
    let row = |speed: &str| {
        let mut rows = said
            .lines()
            .filter(|line| line.trim_start().starts_with(&format!("{speed} ")));
        rows.next().unwrap_or_else(|| panic!("{said}")).to_owned()
    };
    assert!(row("0.08").contains("(no transition in 3 of 3 pairs)"), "{said}");
    assert!(!row("0.18").contains("no transition"), "{said}");
    // Points share references.
    let without: BTreeSet<String> = workspace
        .results("out")
        .table("runs.csv")
        .iter()
        .filter(|row| row["transition"].starts_with('0'))
        .map(|row| row["run"].clone())
        .collect();
    assert!(without.len() >= 6, "{without:?}");
    let note = format!("{} runs have no transition", without.len());
    assert!(unwrapped(&said).contains(&note), "{said}");
    // No table has a static friction for them: neither for the run, nor for a point where all runs are
    // without a transition.
    let results = workspace.results("out");
    for row in results.table("runs.csv") {
        let is_without = row["transition"].starts_with('0');
        for name in ["static_friction_star", "static_friction", "onset_time_star"] {
            assert_eq!(row[name].is_empty(), is_without, "{row:?}");
        }
        assert!(!row["mu_star_max"].is_empty());
    }
    let mut counted = BTreeSet::new();
    for row in results.table("points.csv") {
        let (count, n) = (
            &row["runs_without_transition"],
            row["n"].parse::<usize>().unwrap(),
        );
        match (row["quantity"].as_str(), row["drive.v_star"].as_str()) {
            ("static_friction_star" | "static_reduction_percent", speed) => {
                assert_eq!(count.parse::<usize>().unwrap() + n, 3, "{row:?}");
                assert_eq!(row["mean"].is_empty(), n == 0, "{row:?}");
                counted.insert((speed.to_owned(), count.clone()));
            }
            ("mu_star_max", _) => assert_eq!(n, 3, "{row:?}"),
            _ => {}
        }
    }
    assert!(
        counted.contains(&("0.08".to_owned(), "3".to_owned())),
        "{counted:?}"
    );
    assert!(
        counted.contains(&("0.18".to_owned(), "0".to_owned())),
        "{counted:?}"
    );
    let picture = workspace.read_text("out/static_friction_star.svg");
    assert!(picture.contains(" without transition"), "{picture}");
    assert!(row("0.08").contains("none"), "{said}");
}

/// A study fails if no run has a value of its main quantity; a shard of it may lack values.
#[test]
fn a_study_without_an_answer_has_status_1() {
    let workspace = Workspace::with_study(&SMALL.replace("stop = \"after_onset\"", "duration_star = 5"));
    let refused = |line: &str| {
        let said = unwrapped(&workspace.fail(line, 1));
        assert!(
            said.contains("no run has a value of static_reduction_percent, because none has a transition"),
            "{line}: {said}"
        );
    };
    refused("study study.toml --quiet -o out");
    assert!(workspace.exists("out/points.csv"));
    for part in 1..=2 {
        workspace.succeed(&format!(
            "study study.toml --quiet --shard {part}/2 -o part{part}"
        ));
    }
    refused("study merge part1 part2 --quiet -o whole");
    // The main quantity may exist even if no run has a transition, such as the largest mu*.
    let file = workspace.read_text("study.toml");
    let largest = "[study]\nuntil = { key = 'mu_star_max', half_width = 1.0, min = 2, max = 3 }";
    workspace.write(
        "study.toml",
        file.replacen("[study]", largest, 1)
            .replace("replicates = 3\n", ""),
    );
    workspace.succeed("study study.toml --quiet -o other");
}

/// A tenth of a random surface is in contact, and mu* fluctuates about the level of sliding for ever. On the
/// second seed mu* takes 130 t* to fall half-way, while the drive needs only 83 t* to load the slider: this
/// is creep, however long the run. `duration_star = "auto"` still leaves time for the kinetic window.
#[test]
fn a_slider_that_creeps_has_no_static_friction() {
    const SIDE: usize = 30;
    let workspace = Workspace::with_study(
        "[base]\nslider.blocks = [30, 30]\n[[base.texture]]\nshape = 'height_map'\nfile = 'heights.csv'\n\
         height_unit = '1 um'\npixel_size = '1 um'\nbearing_percent = 10\n[study]\nreplicates = 2\nreference = { texture = [] }\n",
    );
    // A multiplicative generator modulo a prime; heights are means over 2 x 2 of its numbers.
    let mut state = 1_u64;
    let drawn: Vec<u64> = (0..SIDE * SIDE)
        .map(|_| {
            state = state * 48_271 % 2_147_483_647;
            state
        })
        .collect();
    let at = |i: usize, j: usize| drawn[j % SIDE * SIDE + i % SIDE] as f64 / 2_147_483_647.0;
    let height = |i: usize, j: usize| 0.25 * (at(i, j) + at(i + 1, j) + at(i, j + 1) + at(i + 1, j + 1));
    let row = |j: usize| {
        let row: Vec<String> = (0..SIDE).map(|i| format!("{:.6}", height(i, j))).collect();
        row.join(",")
    };
    workspace.write("heights.csv", (0..SIDE).map(row).collect::<Vec<_>>().join("\n"));
    let said = workspace.succeed("study study.toml -o out");
    assert!(said.contains("(no transition in 1 of 2 pairs)"), "{said}");
    let results = workspace.results("out");
    let runs = results.table("runs.csv");
    let creeps = |row: &BTreeMap<String, String>| row["transition"].starts_with('0');
    let creeping: Vec<_> = runs.iter().filter(|row| creeps(row)).collect();
    assert_eq!(creeping.len(), 1);
    assert_eq!(
        (creeping[0]["role"].as_str(), creeping[0]["seed"].as_str()),
        ("point", "2")
    );
    // It did fall half-way from its peak, to 0.57: the largest mu* is listed, but no reduction is computed
    // from it.
    assert!(
        creeping[0]["static_friction_star"].is_empty() && creeping[0]["static_reduction_percent"].is_empty()
    );
    assert!(creeping[0]["mu_star_max"].parse::<f64>().unwrap() > 0.64);
    let points = results.table("points.csv");
    let reduction = points
        .iter()
        .find(|row| row["quantity"] == "static_reduction_percent")
        .unwrap();
    let counts = ["n", "runs_without_transition"].map(|column| reduction[column].as_str());
    assert_eq!(counts, ["1", "1"]);
    assert!(reduction["low"].is_empty(), "one value has no interval");
    // The run with a transition, with its onset at t* = 254, reaches its kinetic window.
    assert!(
        runs.iter()
            .all(|row| creeps(row) || !row["kinetic_friction_star"].is_empty())
    );
}

/// Remarks on the cases of a study are printed once, because they appear nowhere else.
#[test]
fn what_deserves_a_word_is_said_once() {
    let workspace = Workspace::with_study(
        "base.slider.blocks = [50, 50]\nbase.time.stop = 'after_onset'\n\
         base.texture = [{ shape = 'cavity', coverage = 5, array = [10, 10] }]\n[study]\nreplicates = 1\n\
         [[axes]]\nkey = 'texture.0.coverage'\nlist = [0.2, 4]",
    );
    for line in ["study study.toml --dry-run", "study study.toml -o out"] {
        let said = unwrapped(&workspace.succeed(line));
        let note = "of the blocks instead of 0.20 %: it is clipped, overlaps, or is too fine for the blocks \
                    (at the point texture.0.coverage = 0.2)";
        assert_eq!(said.matches(note).count(), 1, "{said}");
        let coarse = "; the outline needs 5, at least ";
        assert_eq!(said.matches(coarse).count(), 1, "{said}");
        assert!(
            said.contains("for a slider of the same size) (at every point)"),
            "{said}"
        );
        let merged = "`texture.0.coverage` = 0.2 and 4 have the same coverage on this mesh: use more blocks to distinguish them";
        assert_eq!(said.matches(merged).count(), 1, "{said}");
        // Both levels cover the same blocks, which is reported before anything has run.
        let idle = said.contains("the axis of `texture.0.coverage` changes nothing");
        assert_eq!(idle, line.ends_with("--dry-run"), "{said}");
        let small = "`coverage` = 0.2 of texture 1 means 0.2 percent of the area; for 20 percent write `coverage` = 20";
        assert_eq!(said.matches(small).count(), 1, "{said}");
        assert_eq!(said.matches("note: ").count(), 4 + usize::from(idle), "{said}");
    }
}

/// Coverages are drawn and listed as meshed: with 25 columns, 5 % are one column and 15 % are three, that is
/// 4 % and 12 %. A study with these values has the same runs and the same pictures.
#[test]
fn coverages_are_drawn_and_told_as_they_are_meshed() {
    let study = |axes: &str| {
        format!(
            "base.slider.blocks = [25, 8]\nbase.time.stop = 'after_onset'\nbase.texture = [{{ shape = 'groove', coverage = 10 }}]\n\
             [study]\nreplicates = 2\nreference = {{ texture = [] }}\n{axes}"
        )
    };
    let coverage = |list: &str| format!("[[axes]]\nkey = 'texture.0.coverage'\nlist = {list}\n");
    let speed = "[[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2]\n";
    let workspace = Workspace::with_study(&study(&(coverage("[5, 15]") + speed)));
    let said = workspace.succeed("study study.toml -o asked");
    let rows: Vec<Vec<&str>> = said
        .lines()
        .map(|line| line.split_whitespace().take(3).collect())
        .collect();
    for row in [
        ["5", "0.1", "4"],
        ["5", "0.2", "4"],
        ["15", "0.1", "12"],
        ["15", "0.2", "12"],
    ] {
        assert!(rows.iter().any(|found| *found == row), "{said}");
    }
    assert!(
        said.contains("texture.0.coverage   drive.v_star   meshed %"),
        "{said}"
    );
    for row in workspace.results("asked").table("points.csv") {
        let expected = if row["texture.0.coverage"] == "5" {
            "4.0"
        } else {
            "12.0"
        };
        assert_eq!(row["texture_percent"], expected);
    }
    // As curves over the coverage, as maps, and in the legend of curves over the speed.
    workspace.write("exact.toml", study(&(coverage("[4, 12]") + speed)));
    let exact = workspace.succeed("study exact.toml -o exact");
    assert!(!exact.contains("meshed %"), "{exact}");
    workspace.write("speed.toml", study(&(speed.to_owned() + &coverage("[5, 15]"))));
    workspace.write(
        "speed_exact.toml",
        study(&(speed.to_owned() + &coverage("[4, 12]"))),
    );
    for name in ["speed", "speed_exact"] {
        workspace.succeed(&format!("study {name}.toml -o {name}"));
    }
    for (one, other) in [("asked", "exact"), ("speed", "speed_exact")] {
        for picture in [
            "static_friction_star",
            "static_reduction_percent",
            "static_friction_star_map",
        ] {
            let [one, other] = [one, other].map(|folder| workspace.read(&format!("{folder}/{picture}.svg")));
            assert!(one == other, "{picture}");
            let picture = String::from_utf8(one).unwrap();
            assert!(picture.contains(">meshed "), "{picture}");
        }
    }
}

/// 5 % and 6 % of 25 columns are both one column: a note names the points that are drawn at the same place,
/// and a map keeps their columns separate.
#[test]
fn coverages_that_are_meshed_to_one_are_told() {
    let workspace = Workspace::with_study(
        "base.slider.blocks = [25, 8]\nbase.time.stop = 'after_onset'\nbase.texture = [{ shape = 'groove', coverage = 10 }]\n\
         [[axes]]\nkey = 'texture.0.coverage'\nlist = [5, 6, 15]\n[[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2]",
    );
    for line in ["study study.toml --dry-run", "study study.toml -o out"] {
        let said = unwrapped(&workspace.succeed(line));
        let told = "note: `texture.0.coverage` = 5 and 6 have the same coverage on this mesh: use more blocks to distinguish them";
        assert_eq!(said.matches(told).count(), 1, "{said}");
    }
    let picture = |name: &str| String::from_utf8(workspace.read(&format!("out/{name}.svg"))).unwrap();
    assert!(picture("static_friction_star").contains(">meshed texture coverage "));
    assert!(picture("static_friction_star_map").contains(">asked texture coverage "));
}

/// Different pressures at the same V* are the same dimensionless model: the study says so before it runs,
/// with the remedy.
#[test]
fn an_axis_that_changes_nothing_is_pointed_out() {
    let axes = "[[axes]]\nkey = 'load.pressure'\nlist = ['50 kPa', '100 kPa', '200 kPa']\n\
                [[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2, 0.3]\n";
    let workspace = Workspace::with_study(&format!("base.slider.blocks = [30, 30]\n{axes}"));
    let note = "note: the axis of `load.pressure` changes nothing but the units of results while `drive.v_star` is fixed: set \
                `drive.speed` instead";
    let said = unwrapped(&workspace.succeed("study study.toml --dry-run"));
    assert_eq!(said.matches(note).count(), 1, "{said}");
    assert!(said.contains("9 points, 1 replicate: at most 9 runs"), "{said}");
    let output = workspace.output("study study.toml -o out --threads 1");
    assert!(stderr(&output).contains(note), "{}", stderr(&output));
    // Of nine points, six repeat the results of others, except for digits that change with the strain under
    // the load.
    let rows = workspace.results("out").table("runs.csv");
    let found: BTreeSet<String> = rows
        .iter()
        .map(|row| format!("{:.5}", row["static_friction_star"].parse::<f64>().unwrap()))
        .collect();
    assert_eq!(found.len(), 3, "{found:?}");
    let quiet = workspace.output("study study.toml -o quiet --quiet");
    assert!(stderr(&quiet).is_empty(), "{}", stderr(&quiet));
}

/// An interval is printed to three digits, with the number of values if that is small.
#[test]
fn intervals_are_rounded_and_say_what_varies() {
    let study = "base.slider.blocks = [30, 30]\nbase.time.stop = 'after_onset'\nbase.drive.v_star = 0.2\n\
                 base.friction.sigma_static_star = 0\nstudy.replicates = 3\nstudy.reference = { texture = [] }\n\
                 base.texture = [{ shape = 'groove', coverage = 10 }]";
    let workspace = Workspace::with_study(study);
    let said = workspace.succeed("study study.toml -o out");
    let expected = "static_reduction_percent: mean of n replicates \u{b1} half width of its 95 % interval";
    assert_eq!(said.lines().next(), Some(expected));
    let mut rows = said.lines().skip(2);
    assert_eq!(
        rows.next().unwrap().split_whitespace().collect::<Vec<_>>(),
        ["mean", "n"]
    );
    let value: Vec<&str> = rows.next().unwrap().split_whitespace().collect();
    let [mean, "\u{b1}", _, "3"] = value[..] else {
        panic!("{said}")
    };
    assert!(mean.parse::<f64>().is_ok(), "{said}");
    assert!(mean.chars().filter(char::is_ascii_digit).count() <= 3, "{said}");
    assert!(
        unwrapped(&said).contains("only the kinetic coefficients differ from seed to seed"),
        "{said}"
    );
}

/// Few values may be close together by chance, and no values have no interval: neither counts as a narrow
/// interval.
#[test]
fn runs_without_the_number_that_decides_do_not_count_for_it() {
    let until = "base.slider.blocks = [4, 4]\nbase.time.stop = 'after_onset'\n\
                 study.until = { key = 'kinetic_friction_star', half_width = 1, min = 3, max = 50 }\n";
    let workspace = Workspace::with_study(until);
    let output = workspace.output("study study.toml -o out");
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("no run has a value of kinetic_friction_star: the tables"),
        "{}",
        stderr(&output)
    );
    assert!(said.contains("none   0   (interval still too wide)"), "{said}");
    let missing = "there is no picture of kinetic_friction_star: no run has a value";
    assert!(said.contains(missing), "{said}");
    let results = workspace.results("out");
    assert_eq!(results.recorded().len(), 3);
    let rows = results.table("points.csv");
    let row = rows
        .iter()
        .find(|row| row["quantity"] == "kinetic_friction_star")
        .unwrap();
    assert_eq!((row["n"].as_str(), row["narrow_enough"].as_str()), ("0", "false"));
}
