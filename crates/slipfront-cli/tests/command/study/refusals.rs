//! Errors that are reported before any run.

use super::results::SMALL;
use crate::support::process::{output, stderr};
use crate::support::workspace::Workspace;

#[test]
fn bad_studies_are_refused_with_a_sentence() {
    let axis = |text: &str| format!("base.slider.blocks = [4, 4]\n[[axes]]\n{text}");
    let study = |text: &str| format!("base.slider.blocks = [4, 4]\n[study]\n{text}");
    for (text, sentence) in [
        (
            axis("key = 'drive.v_star'\nlist = []"),
            "the axis of `drive.v_star` is empty",
        ),
        (
            axis("name = 'shape'\nvariants = {}"),
            "the axis of `shape` is empty",
        ),
        (axis("zip = {}"), "is empty"),
        // The second replicate would have the seed 0.
        (
            "base.slider.blocks = [4, 4]\nbase.friction.seed = 9223372036854775807\nstudy.replicates = 2"
                .to_owned(),
            "`friction.seed` = 9223372036854775807 is too large for 2 replicates",
        ),
        (
            axis("key = 'drive.v_star'"),
            "needs one of `list`, `linspace` and `logspace`",
        ),
        (
            axis("key = 'drive.v_star'\nlist = [0.1]\nlogspace = [0.1, 1, 2]"),
            "needs one of",
        ),
        (
            axis("key = 'drive.v_star'\nlist = [0.1]\nname = 'speed'"),
            "no other combination",
        ),
        (
            axis("key = 'drive.v_star'\nlist = [0.1, 0.1]"),
            "is twice on the axis",
        ),
        (
            axis("key = 'drive.v_star'\nlogspace = [0, 1, 3]"),
            "must lie above 0",
        ),
        (axis("key = 'drive.v_star'\nlinspace = [0.1, 1, 1]"), "give 2 to"),
        (axis("key = 'drive.v_star'\nlits = [0.1]"), "did you mean `list`?"),
        // Sixty axes that would make six million levels.
        (
            axis(&vec!["key = 'drive.v_star'\nlinspace = [0.1, 1, 100000]"; 60].join("\n[[axes]]\n")),
            "give more than 1000000 points",
        ),
        (
            axis(&vec!["key = 'drive.v_star'\nlist = [0.1]"; 65].join("\n[[axes]]\n")),
            "the study has 65 axes, more than 64",
        ),
        (
            axis("key = 'drive.v_sar'\nlist = [0.1]"),
            "did you mean `v_star`?",
        ),
        (
            axis("zip = { 'drive.v_star' = [0.1], 'friction.r_star' = [0.5, 0.6] }"),
            "equally long",
        ),
        (
            axis("zip = { drive.v_star = [0.1] }"),
            "write keys with a dot in quotes",
        ),
        (
            axis("name = 'mean'\nvariants = { a = {} }"),
            "have a column `mean` already",
        ),
        (
            axis("key = 'drive.v_star'\nlist = [0.1]\n[[axes]]\nkey = 'drive.v_star'\nlist = [0.2]"),
            "is on two axes",
        ),
        (
            axis(
                "key = 'texture.0.coverage'\nlist = [5]\n[[axes]]\nname = 'shape'\n\
                 variants = { groove = { texture = [{ shape = 'groove', coverage = 10 }] } }",
            ),
            "overwrites `texture.0.coverage`",
        ),
        (
            axis("key = 'drive.v_star'\nlist = [0.1]\n[[axes]]\nkey = 'drive.speed'\nlist = ['1 mm/s']"),
            "overwrites `drive.v_star`",
        ),
        (
            axis("key = 'drive.v_star'\nlist = [0.1, -1]"),
            "the point drive.v_star = -1 is not a valid case",
        ),
        (
            format!(
                "study.reference = {{ friction.r_star = -1 }}\n{}",
                axis("key = 'drive.v_star'\nlist = [0.1]")
            ),
            "the reference of the point drive.v_star = 0.1 is not a valid case",
        ),
        (
            "base.slider.blocks = [4, 4]\nstudy.reference = { friction.r_star = -1 }".to_owned(),
            "the reference of the point of the base case is not a valid case",
        ),
        (
            axis("zip = { 'texture.0.coverage' = [5], texture = [[{ shape = 'groove', coverage = 30 }]] }"),
            "and one overwrites the other",
        ),
        (
            axis("name = 'a'\nvariants = { b = { drive.v_star = 0.1, drive.speed = '1 mm/s' } }"),
            "and one overwrites the other",
        ),
        (axis("key = 'drive.v_star '\nlist = [0.1]"), "contains a blank"),
        (
            axis("key = 'output.stride'\nlist = [1, 2]"),
            "changes only the output, not the results of a run",
        ),
        (
            study("reference = { friction.seed = 77 }"),
            "leave `friction.seed` out of the reference",
        ),
        (
            "[[texture]]\nshape = 'cavity'".to_owned(),
            "in a study file, write [[base.texture]]",
        ),
        (study("replicates = 0"), "must lie between 1 and"),
        (study("replicate = 2"), "did you mean `replicates`?"),
        (study("keep = 'al'"), "did you mean \"all\"?"),
        (study("reference = { textur = [] }"), "did you mean [[texture]]?"),
        (
            study("until = { key = 'static_reduction_percent', half_width = 1, max = 9 }"),
            "needs a `reference`",
        ),
        (
            study("until = { key = 'mu_s', half_width = 0.1, max = 9 }"),
            "`mu_s` is not a quantity of the summary",
        ),
        (
            study("until = { key = 'static_friction_star', half_width = 0.1, mim = 2, max = 9 }"),
            "did you mean `min`?",
        ),
        (
            study("until = { key = 'static_friction_star', half_width = 0, max = 9 }"),
            "must be more than 0",
        ),
        (
            study("until = { key = 'static_friction_star', half_width = 0.1, min = 1, max = 9 }"),
            "a single run has no interval",
        ),
        (
            study("until = { key = 'static_friction_star', half_width = 0.1, confidence = 95, max = 9 }"),
            "must lie between 0 and 1",
        ),
        (
            study("replicates = 3\nuntil = { key = 'static_friction_star', half_width = 0.1, max = 9 }"),
            "exclude each other",
        ),
        ("[studdy]\nreplicates = 2".to_owned(), "did you mean `study`?"),
        ("replicates = 2".to_owned(), "it belongs in [study]"),
        ("base = 'nowhere.toml'".to_owned(), "cannot read nowhere.toml"),
        ("base = 3".to_owned(), "`base` must be the path of a case file"),
        (
            "[base.slider]\nbloks = [4, 4]".to_owned(),
            "did you mean `blocks`?",
        ),
        ("axes = 3".to_owned(), "`axes` must be a list of tables"),
        ("[study".to_owned(), "not valid TOML"),
    ] {
        let workspace = Workspace::with_study(&text);
        let output = workspace.output("study study.toml -o out");
        assert_eq!(output.status.code(), Some(2), "{text}\n{}", stderr(&output));
        assert!(stderr(&output).contains(sentence), "{text}\n{}", stderr(&output));
        assert!(!workspace.path("out").exists(), "{text}");
    }
}

/// Errors of a base inside the study file refer to the lines of this file.
#[test]
fn errors_of_the_base_show_the_lines_of_the_study_file() {
    let large = "study.replicates = 2\n\n[base]\ndrive.v_star = 0.1\nslider.blocks = [60000, 60000]\n";
    for (text, place) in [
        (large, "study.toml:5:17: this case needs about"),
        (
            "study.replicates = 2\n\n[base.slider]\nomega_star = 0.1\nbloks = [4, 4]\n",
            "study.toml:5:9: unknown key `bloks`",
        ),
    ] {
        let workspace = Workspace::with_study(text);
        let said = workspace.fail("study study.toml -o out", 2);
        assert!(said.contains(place), "{said}");
        let line = text.lines().nth(4).unwrap();
        assert!(said.contains(&format!("\n  {line}\n")), "{said}");
    }
}

/// A key that an axis sets cannot also be set by `--set`.
#[test]
fn keys_of_axes_are_not_set() {
    let workspace = Workspace::with_study(SMALL);
    for key in ["drive.v_star=0.2", "drive.speed=1 mm/s"] {
        let output = output(workspace.process("study study.toml -o out --set").arg(key));
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert_eq!(
            said,
            format!(
                "error: --set {key}: an axis of the study sets `drive.v_star`: change its levels, or remove the axis\n"
            )
        );
    }
    let said = workspace.fail("study study.toml -o out --set slider.bloks=[4,4]", 2);
    assert!(
        said.contains("--set slider.bloks=[4,4]: unknown key `bloks`"),
        "{said}"
    );
    assert!(
        workspace
            .fail("study study.toml --json --dry-run", 2)
            .contains("--dry-run")
    );
    assert!(!workspace.exists("out"));
}

#[test]
fn a_very_large_study_is_asked_for() {
    let text = "base.slider.blocks = [2, 2]\nstudy.replicates = 101\n\
                [[axes]]\nkey = 'drive.v_star'\nlinspace = [0.1, 0.2, 100]";
    let workspace = Workspace::with_study(text);
    let output = workspace.output("study study.toml -o out");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("10100 runs, more than 10000: confirm with --yes"),
        "{}",
        stderr(&output)
    );
    assert!(!workspace.path("out").exists());
    assert!(
        workspace
            .succeed("study study.toml --dry-run")
            .contains("10100 runs")
    );
    assert_eq!(workspace.output("study slurm study.toml").status.code(), Some(2));
    // With --yes the study starts; its first shard is small.
    workspace.succeed("study study.toml --yes --quiet --shard 1/100 -o out");
    workspace.results("out").assert_each_run_once(101);
}

/// The command that tests build lacks the feature `gpu`; one with that feature names the remedy as well.
/// Folders of all runs are made only on the CPU.
#[test]
fn a_device_that_is_missing_is_refused_or_replaced_by_the_cpu() {
    let workspace = Workspace::with_study(SMALL);
    let refused = workspace.fail("study study.toml -o out --device gpu", 2);
    assert!(
        refused.contains("; `--device cpu` gives the same results"),
        "{refused}"
    );
    assert!(!workspace.exists("out"));
    let output = workspace.output("study study.toml -o out --device auto");
    let said = stderr(&output);
    assert!(
        output.status.success() && said.contains("note: runs are computed on the CPU"),
        "{said}"
    );
    let kept = SMALL.replace("replicates = 3", "replicates = 3\nkeep = 'all'");
    assert_ne!(kept, SMALL);
    workspace.write("kept.toml", kept);
    let refused = workspace.fail("study kept.toml -o kept --device gpu", 2);
    assert!(refused.contains("`study.keep = \"all\"`"), "{refused}");
}
