//! Help, version, completions, and the output of `check` and `run`.

use crate::fixtures::{SMALL, unwrapped};
use crate::support::process::{stderr, stdout};
use crate::support::workspace::Workspace;

#[test]
fn help_names_every_subcommand_and_says_what_it_does() {
    let workspace = Workspace::small();
    let help = workspace.succeed("--help");
    for command in [
        "run",
        "check",
        "texture",
        "plot",
        "completions",
        "man",
        "licences",
    ] {
        assert!(help.contains(&format!("\n  {command} ")), "{command}: {help}");
        let own = workspace.succeed(&format!("{command} --help"));
        assert!(
            own.contains("Usage: slipfront ") && own.contains("Example"),
            "{own}"
        );
    }
    // The table of exit statuses is the same for all commands, so it is printed once.
    assert!(help.contains("\nExit status:\n"), "{help}");
    assert!(!workspace.succeed("run --help").contains("Exit status"));
    let version = format!("slipfront {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(workspace.succeed("-V"), version);
    let told = workspace.succeed("--version");
    assert!(told.starts_with(&version), "{told}");
    workspace.succeed("run small.toml -o a");
    let manifest: serde_json::Value = serde_json::from_slice(&workspace.read("a/manifest.json")).unwrap();
    for key in ["build", "revision", "simd_width"] {
        // A build outside of git has no revision.
        let said = manifest[key].as_str().unwrap_or("not known");
        assert!(told.contains(said), "{key}: {said}: {told}");
    }
    let architecture = std::env::consts::ARCH;
    assert!(told.contains(&format!("platform  {architecture}-")), "{told}");
}

#[test]
fn wrong_usage_is_bad_input() {
    let workspace = Workspace::small();
    for line in [
        "",
        "rum",
        "run --sed 3",
        "run --threads 0",
        "texture small.toml",
        "plot",
    ] {
        let said = workspace.fail(line, 2);
        assert!(
            said.contains("Usage") || said.contains("--help"),
            "{line}: {said}"
        );
    }
}

#[test]
fn completions_know_subcommands_and_options() {
    let workspace = Workspace::small();
    for shell in ["bash", "zsh", "fish"] {
        let script = workspace.succeed(&format!("completions {shell}"));
        for word in ["slipfront", "texture", "threads"] {
            assert!(script.contains(word), "{shell} lacks {word}");
        }
    }
    assert!(workspace.fail("completions dos", 2).contains("bash"));
}

/// Every subcommand has a manual page, with its options and examples.
#[test]
fn manual_pages_have_options_and_examples() {
    let workspace = Workspace::small();
    for (line, words) in [
        (
            "man",
            &[
                ".TH slipfront 1",
                "slipfront\\-study",
                "Friction of micro\\-textured surfaces",
            ][..],
        ),
        (
            "man run",
            &[".TH slipfront-run 1", "\\-\\-checkpoint", "Examples:"],
        ),
        (
            "man study merge",
            &[".TH slipfront-study-merge 1  \"slipfront ", "Merge the shards"],
        ),
    ] {
        let page = workspace.succeed(line);
        for word in words {
            assert!(page.contains(word), "{line} lacks {word}:\n{page}");
        }
    }
    assert!(
        workspace
            .fail("man rum", 2)
            .contains("there is no subcommand \"rum\": it can be run, check, study")
    );
    assert!(
        workspace
            .fail("man run fast", 2)
            .contains("`run` has no subcommands")
    );
}

/// Prints the licences of slipfront and its parts; `tests/licences/run.sh` checks that they cover every
/// crate.
#[test]
fn licences_are_told_of_slipfront_and_of_what_it_contains() {
    let workspace = Workspace::small();
    let told = workspace.succeed("licences");
    for words in [
        "Copyright (c) The slipfront developers",
        "TERMS AND CONDITIONS FOR USE, REPRODUCTION, AND DISTRIBUTION",
        "\nrayon 1.",
        "Bitstream Vera Fonts Copyright",
        "Copyright (c) 2022 Leon Sorokin",
        "The Rust Project Developers",
    ] {
        assert!(told.contains(words), "{words}");
    }
}

/// The JSON report has the numbers of the run's summary and of the printed report.
#[test]
fn check_prints_json() {
    let workspace = Workspace::small();
    let report: serde_json::Value =
        serde_json::from_str(&workspace.succeed("check small.toml --json")).unwrap();
    let summary = workspace.succeed("run small.toml --json --no-pictures");
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    for key in [
        "v_star",
        "r_star",
        "omega_star",
        "epsilon",
        "n_blocks",
        "texture_percent",
        "dt_star",
        "steps",
        "seed",
    ] {
        assert_eq!(report[key], summary[key], "{key}");
    }
    for key in [
        "time_unit_s",
        "displacement_unit_m",
        "stress_unit_pa",
        "block_size_m",
    ] {
        assert_eq!(report[key], summary["si"][key], "{key}");
    }
    // A run may have further warnings.
    let [before, of_run] = [&report, &summary].map(|of| of["warnings"].as_array().unwrap());
    assert!(
        !before.is_empty() && before.iter().all(|warning| of_run.contains(warning)),
        "{of_run:?}"
    );
    let lengths = report["lengths"].as_array().unwrap();
    assert!(
        lengths
            .iter()
            .any(|length| length["name"] == "screening length along")
    );
    for key in ["memory_bytes", "disk_bytes", "block_steps"] {
        assert!(report[key].as_f64().unwrap() > 0.0, "{key}");
    }
    let [least, most] = [0, 1].map(|bound| report["seconds"][bound].as_f64().unwrap());
    assert!(0.0 < least && least <= most);
    // 0.375 V* N_x = 0.005 gives V* = 0.0022, rounded down.
    let speeds = &report["speeds"];
    assert_eq!(speeds["slow"]["v_star"], 0.002);
    assert!(speeds["all"].as_array().unwrap().contains(&speeds["slow"]));
    assert!(!workspace.succeed("check small.toml --json").contains('\u{251c}'));
}

/// A case from standard input is the same as from a file, except for its name; errors say where it came from.
#[test]
fn a_case_can_come_from_standard_input() {
    let workspace = Workspace::small();
    let from = |script: &str| {
        let command = crate::support::process::program();
        workspace.shell(&script.replace("slipfront", &format!("'{command}'")))
    };
    let said = from("slipfront check - --set drive.v_star=0.2 < small.toml");
    let printed = String::from_utf8(said.stdout).unwrap();
    assert!(
        printed.starts_with("stdin\n") && printed.contains("V* = 0.2"),
        "{printed}"
    );
    assert!(from("cat small.toml | slipfront run - --quiet").status.success());
    workspace.succeed("run small.toml --quiet");
    for file in ["summary.json", "series.csv", "case.toml"] {
        assert_eq!(
            workspace.read(&format!("results/stdin/{file}")),
            workspace.read(&format!("results/small/{file}")),
            "{file}"
        );
    }
    let said = from("echo 'drive.vstar = 1' | slipfront check -");
    let errors = String::from_utf8(said.stderr).unwrap();
    assert_eq!(said.status.code(), Some(2));
    assert!(
        errors.contains("standard input:1:7: unknown key `vstar`"),
        "{errors}"
    );
    let said = from("printf '\\377' | slipfront check -");
    let errors = String::from_utf8(said.stderr).unwrap();
    assert!(
        errors.contains("standard input:1: the file is not UTF-8 text"),
        "{errors}"
    );
}

#[test]
fn check_prints_groups_onset_and_cost_and_runs_nothing() {
    let workspace = Workspace::small();
    let said = workspace.succeed("check small.toml");
    for words in [
        "6 x 5 blocks of 1 um",
        "Omega* = 0.1",
        "V* = 0.1",
        "mu_s = 1 (spread 0.05), R* = 0.5 (spread 0.05), seed 1",
        "onset expected    about t* = 25",
        "loading           V* N_x = 0.6: ",
        "stability         dt* = 0.1 of at most 0.9058",
        "cost ",
        "note: 30 blocks are few",
    ] {
        assert!(said.contains(words), "{words:?} is missing:\n{said}");
    }
    // The duration of the rests of a held drive is unknown.
    let said = unwrapped(&workspace.succeed("check small.toml --set drive.loading=held"));
    let least = "block-steps, not counting steps in which the drive stops, at least ";
    assert!(said.contains(least), "{said}");
    // I^2 with a = 3, and the product of I with a = 3/6 and I with a = 3/5 along the axes.
    let said = unwrapped(&workspace.succeed("check small.toml --set friction.correlation_length=3um"));
    let alike = "correlation length 3 3 um 0.5 means over a block have 96.41 % of the variance, means over the slider 44.97 %";
    let words: Vec<&str> = said.split_whitespace().collect();
    assert!(words.join(" ").contains(alike), "{said}");
    assert_eq!(workspace.files(".").len(), 1, "check has written something");
}

/// Only blocks along the drive count, an edge drive loads more slowly with fewer springs, and a front crosses
/// stiff blocks faster.
#[test]
fn check_compares_crossing_and_loading() {
    let workspace = Workspace::small();
    let note = "above 1: while a slip front crosses the slider, the drive continues to load";
    for (set, line, slow) in [
        (
            "drive.v_star=0.16",
            "V* N_x = 0.96: time for a front to cross the 6 blocks",
            None,
        ),
        (
            "drive.v_star=0.2",
            "V* N_x = 1.2: ",
            Some("is 1 at V* = 0.1667, and loading is slow well below this speed"),
        ),
        ("drive.direction=90", "V* N_y = 0.5: ", None),
        ("drive.direction=45", "V* N = 0.7778: ", None),
        ("drive.motion=rotation", "V* N = ", None),
        ("drive.attach=left", "V* N_x = 0.1: ", None),
        // Four times the modulus means twice the V* of the material itself.
        (
            "slider.stiffness_grade={along=\"x\",from=4,to=4}",
            "V* N_x = 1.2: ",
            Some("is 1 at V* = 0.08333, and loading is slow well below this speed"),
        ),
        (
            "slider.blocks=[20,20]",
            "V* N_x = 2: ",
            Some("is 1 at V* = 0.05, and loading is slow well below this speed"),
        ),
    ] {
        let said = unwrapped(&workspace.succeed(&format!("check small.toml --set {set}")));
        assert!(said.contains(line), "{set}: {said}");
        assert_eq!(said.contains(note), slow.is_some(), "{set}: {said}");
        assert!(slow.is_none_or(|slow| said.contains(slow)), "{set}: {said}");
    }
}

#[test]
fn check_warns_where_the_model_leaves_its_validity() {
    let workspace = Workspace::small();
    let groove = "[[texture]]\nshape = 'groove'\nwidth = '2 um'\noffset = '2.5 um'\n";
    workspace.write("odd.toml", format!("{SMALL}{groove}"));
    let said = workspace.succeed(
        "check odd.toml --set drive.v_star=0.3 --set time.step=0.6 --set load.pressure=3GPa \
         --set friction.sigma_static_star=0.9",
    );
    let said = unwrapped(&said);
    for words in [
        "texture 1 extends beyond a free edge",
        "negative draws",
        "the load strains the slider by 0.030",
        "V* = 0.3 is above 0.2",
        "dt* = 0.6 is stable but coarse",
        "30 blocks are few",
    ] {
        assert!(said.contains(words), "{words:?} is missing:\n{said}");
    }
    // Textures that are too fine for the blocks, or off the slider. There are further notes on the small
    // number of blocks and on the drag, and for the first two textures on sufficient block sizes.
    for (texture, notes) in [
        ("coverage=50,array=[1000,1000]", 4),
        ("lambda=\"1e-30m\"", 4),
        ("lambda=\"2um\",center=[\"-9um\",\"0um\"]", 3),
    ] {
        let said = unwrapped(&workspace.succeed(&format!(
            "check small.toml --set texture.0={{shape=\"cavity\",{texture}}}"
        )));
        assert!(
            said.contains("texture 1 covers no block: it lies off the slider"),
            "{said}"
        );
        assert_eq!(said.matches("note:").count(), notes, "{said}");
    }
    let said = unwrapped(&workspace.succeed(
        "check small.toml --set texture.0={shape=\"cavity\",coverage=60} --set texture.1={shape=\"cavity\",coverage=60}",
    ));
    assert!(said.contains("% of the blocks instead of 120.00 %"), "{said}");
    // Friction that does not fall when a block slips, and coefficients that contradict their keys.
    for (set, means) in [
        ("r_star=1", "1.0000, is not below the static one, 1.0000"),
        ("r_star=10", "10.0000, is not below the static one, 1.0000"),
        ("mu_kinetic=1.5", "1.5000, is not below the static one, 1.0000"),
    ] {
        let said = unwrapped(&workspace.succeed(&format!("check small.toml --set friction.{set}")));
        assert!(
            said.contains(&format!("the mean kinetic coefficient, {means}")),
            "{said}"
        );
    }
    workspace.write("mu_k.csv", "5,5,5\n5,5,5\n");
    let said = unwrapped(
        &workspace
            .succeed("check small.toml --set slider.blocks=[3,2] --set friction.mu_kinetic_field=mu_k.csv"),
    );
    for words in [
        "the given kinetic coefficients have a mean of 5.0000, but R* mu_static is 0.5000",
        "the mean kinetic coefficient, 5.0000, is not below the static one, 1.0000",
    ] {
        assert!(said.contains(words), "{words:?} is missing:\n{said}");
    }
    workspace.write("mu.csv", "0.4,0.5,0.6\n0.4,0.5,0.6\n");
    let given = "check small.toml --set slider.blocks=[3,2] --set friction.mu_static_field=mu.csv";
    let said = unwrapped(&workspace.succeed(given));
    assert!(said.contains("a mean of 0.5000, but mu_static is 1:"), "{said}");
    // With none of these problems and a slow drive, only the note on the size remains.
    let calm = workspace.succeed("check small.toml --set drive.v_star=0.05");
    assert_eq!(calm.matches("note:").count(), 1, "{calm}");
}

#[test]
fn run_prints_physics_summary_and_where_everything_is() {
    let workspace = Workspace::small();
    let said = workspace.succeed("run small.toml");
    for words in [
        "small\n",
        "texture   none",
        "static friction",
        "mu_s* = ",
        "kinetic friction",
        "files in results/small",
        "friction.svg",
    ] {
        assert!(said.contains(words), "{words:?} is missing:\n{said}");
    }
}

/// Textured blocks slide from the start, and a run says so; with springs in contact they do not count,
/// because they have no springs.
#[test]
fn a_run_says_that_textured_blocks_slide_from_the_start() {
    let workspace = Workspace::small();
    let sentence = "% are textured, have no friction, and count as sliding from the start";
    let groove = "texture.0={shape=\"groove\",width=\"2um\"}";
    let n_star = |name: &str| {
        let series = workspace.read_text(&format!("{name}/series.csv"));
        let column = series
            .lines()
            .next()
            .unwrap()
            .split(',')
            .position(|name| name == "sliding_percent");
        let second = series
            .lines()
            .nth(2)
            .unwrap()
            .split(',')
            .nth(column.unwrap())
            .unwrap();
        second.parse::<f64>().unwrap()
    };
    let said = workspace.succeed(&format!("run small.toml -o textured --set {groove}"));
    assert!(said.contains(&format!("; 33.3 {sentence}")), "{said}");
    assert_eq!(n_star("textured"), 100.0 / 3.0);
    let springs =
        "--set friction.contact=springs --set friction.contact_stiffness_star=1 --set time.duration_star=10";
    let said = workspace.succeed(&format!("run small.toml -o springs --set {groove} {springs}"));
    assert!(!said.contains(sentence), "{said}");
    assert_eq!(n_star("springs"), 0.0);
    let said = workspace.succeed("run small.toml -o plain");
    assert!(!said.contains(sentence), "{said}");
}

/// A total stiffness is reported as it is distributed: springs of different stiffness share it in proportion
/// to the modulus of their blocks.
#[test]
fn a_total_stiffness_is_told_as_it_is_shared() {
    let workspace = Workspace::small();
    let total = "check small.toml --set drive.total_stiffness_star=3";
    let said = workspace.succeed(total);
    assert!(said.contains(", 30 springs of k_s* = 0.1\n"), "{said}");
    let said = workspace.succeed(&format!(
        "{total} --set slider.stiffness_grade={{along=\"x\",from=1,to=0.1}}"
    ));
    // The mean modulus is 0.55.
    let shared = ", springs of k_s* = 0.1818 times the modulus of their blocks, 3 together\n";
    assert!(said.contains(shared), "{said}");
}

#[test]
fn a_run_says_what_its_numbers_are_worth() {
    let workspace = Workspace::small();
    let stuck = workspace.succeed("run small.toml -o stuck --set time.duration_star=5");
    assert!(stuck.contains("no block in contact slipped"), "{stuck}");
    assert!(workspace.summary("stuck")["kinetic_friction_star"].is_null());
    let coarse = workspace.succeed("run small.toml -o coarse --set time.step=0.9");
    assert!(
        coarse.contains("of the input energy is missing from the balance"),
        "{coarse}"
    );
    let fine = workspace.succeed("run small.toml -o fine");
    assert!(
        !fine.contains("of the input energy is missing from the balance"),
        "{fine}"
    );
    // The largest pull so far is only a bound of the coefficient; after a transition it is the coefficient.
    assert!(stuck.contains("static friction   at least mu_s* = "), "{stuck}");
    assert!(fine.contains("static friction   mu_s* = "), "{fine}");
    assert_eq!(workspace.summary("stuck")["transition"], false);
    assert!(workspace.summary("stuck")["first_slip_time_star"].is_null());
}

/// The command recognises a file or a folder in place of a subcommand, and a misspelt file.
#[test]
fn a_forgotten_subcommand_and_a_misspelt_file_are_understood() {
    let workspace = Workspace::small();
    workspace.write("study.toml", "base = 'small.toml'\n");
    workspace.write("results/a/case.toml", SMALL);
    for (line, meant) in [
        (
            "small.toml",
            "`slipfront run small.toml` or `slipfront check small.toml`",
        ),
        ("study.toml", "`slipfront study study.toml`"),
        (
            "results/a",
            "`slipfront plot results/a` or `slipfront verify results/a`",
        ),
        (
            "run smal.toml",
            "there is no file smal.toml: did you mean small.toml?",
        ),
        ("check small", "there is no file small: did you mean small.toml?"),
        ("run results/a", "did you mean results/a/case.toml?"),
        (
            "study studdy.toml",
            "there is no file studdy.toml: did you mean study.toml?",
        ),
    ] {
        let said = workspace.fail(line, 2);
        assert!(said.contains(meant), "{line}: {said}");
    }
    // A seed is checked like its key.
    for seed in ["-1", "soon"] {
        let said = workspace.fail(&format!("run small.toml --seed {seed}"), 2);
        let expected = format!("`friction.seed` is {seed}: it must be a whole number from 0 to");
        assert!(said.contains(&expected), "{said}");
    }
    // Other words remain errors.
    assert!(workspace.fail("slide", 2).contains("unrecognized subcommand"));
}

#[test]
fn plot_says_what_it_takes() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    workspace.write("measured.csv", "t,mu\n0,0\n");
    let said = workspace.fail("plot a measured.csv", 2);
    assert!(
        said.contains(
            "measured.csv is a file: give the folder of a finished run; a measured record is given with `plot --data`"
        ),
        "{said}"
    );
}

/// The error for a refused folder names a free one.
#[test]
fn a_folder_that_is_free_is_named() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml");
    let again = "run small.toml --set drive.v_star=0.2 --out results/small";
    let said = workspace.fail(again, 2);
    assert!(said.contains("`--out results/small-2` is free"), "{said}");
    workspace.succeed(&format!("{again}-2"));
    assert!(
        workspace
            .fail(again, 2)
            .contains("`--out results/small-3` is free")
    );
}

/// Without a given folder, a run takes the next free one and says so; a run that was stopped is not skipped.
#[test]
fn the_next_free_folder_is_taken() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml");
    for next in ["results/small-2", "results/small-3"] {
        let said = stderr(&workspace.output("run small.toml --seed 2"));
        let note = format!("the folder results/small is not empty: results go to {next}");
        assert!(said.contains(&note), "{said}");
        assert!(workspace.path(next).join("manifest.json").is_file());
    }
    assert_eq!(
        workspace.succeed("run small.toml --quiet --json").lines().next(),
        Some("{")
    );
    assert!(workspace.path("results/small-4").is_dir());
    std::fs::remove_file(workspace.path("results/small/manifest.json")).unwrap();
    let said = workspace.fail("run small.toml", 2);
    assert!(said.contains("results/small"), "{said}");
}

/// A case that is run again from its results has the name of their folder, wherever that folder is.
#[test]
fn a_recorded_case_keeps_the_name_of_its_folder() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o results/circle");
    let again = workspace.output("run results/circle/case.toml");
    let note = "the folder results/circle is not empty: results go to results/circle-2";
    assert!(stderr(&again).contains(note), "{}", stderr(&again));
    assert!(stdout(&again).starts_with("circle\n"), "{}", stdout(&again));
    workspace.assert_same_run("results/circle", "results/circle-2");
    let refused = workspace.fail("run results/circle/case.toml --force", 2);
    assert!(
        refused.contains("would replace results/circle/case.toml"),
        "{refused}"
    );
    std::fs::rename(workspace.path("results"), workspace.path("kept")).unwrap();
    workspace.succeed("run kept/circle/case.toml --quiet");
    workspace.assert_same_run("kept/circle", "results/circle");
    // A file of the user keeps its own name.
    workspace.write("mine/case.toml", workspace.read("small.toml"));
    workspace.succeed("run mine/case.toml --quiet");
    assert!(workspace.exists("results/case/manifest.json"));
}

/// Lines of notes end between words, within the width of a terminal.
#[test]
fn notes_are_broken_between_words() {
    let workspace = Workspace::small();
    let said = workspace.succeed("run small.toml --set time.duration_star=5");
    let notes = said.lines().skip_while(|line| !line.starts_with("note: "));
    let notes: Vec<&str> = notes.take_while(|line| !line.starts_with("files in")).collect();
    assert!(notes.iter().any(|line| line.starts_with("      ")), "{said}");
    assert!(notes.iter().all(|line| line.chars().count() <= 80), "{said}");
}

#[test]
fn one_block_is_no_blocks() {
    let workspace = Workspace::small();
    let said = workspace.succeed("check small.toml --set slider.blocks=[1,1]");
    assert!(said.contains("1 x 1 block of 1 um"), "{said}");
    assert!(said.contains("note: 1 block is few"), "{said}");
}

/// The help of the command lists its subcommands in groups, each on one line, and a misspelt subcommand gets
/// a suggestion.
#[test]
fn subcommands_are_found() {
    let workspace = Workspace::new();
    let help = workspace.succeed("--help");
    for line in [
        "Several runs:",
        "  study        Vary keys and seeds of a case, and tabulate the results",
        "  help         Print this help, or the help of a subcommand",
    ] {
        assert!(help.lines().any(|shown| shown == line), "{line}\n{help}");
    }
    let said = workspace.fail("rnu", 2);
    assert!(
        said.contains("\"rnu\" is not a subcommand: did you mean `slipfront run`?"),
        "{said}"
    );
    let said = workspace.fail("check --set texture.coverage=5", 2);
    assert!(
        said.contains("`texture.0.coverage` is that of the first one"),
        "{said}"
    );
}
