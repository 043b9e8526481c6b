//! Tests of `slipfront paper`, on the cheapest figures.

use std::process::Output;

use crate::support::process::{stderr, stdout};
use crate::support::workspace::Workspace;

/// Makes figures into the folder `paper`.
fn paper(workspace: &Workspace, figures: &str) -> Output {
    workspace.output(&format!("paper --reduced --out paper {figures}"))
}

#[test]
fn figures_are_made_judged_and_reported() {
    let workspace = Workspace::new();
    // The second call replaces the files of the first.
    for _ in 0..2 {
        let output = paper(&workspace, "fig13 table1 --docs docs");
        let text = stdout(&output);
        assert!(output.status.success(), "{text}");
        assert!(
            text.contains("3 claims: 1 holds, 0 hold with a condition, 0 are not reproduced as stated, 2 are misprints or slips of algebra, 0 do not hold"),
            "{text}"
        );
        assert!(text.contains("report.html"));
        let headings: Vec<&str> = text.lines().next().unwrap().split_whitespace().collect();
        assert_eq!(headings, ["no.", "verdict", "measured", "claim"]);
    }
    for name in [
        "fig13.svg",
        "fig13.png",
        "fig13.csv",
        "table1.csv",
        "claims.csv",
        "numbers.csv",
        "report.html",
    ] {
        assert!(workspace.exists(&format!("paper/{name}")), "{name}");
    }
    assert!(workspace.exists("docs/paper.md"));
    let report = workspace.read_text("paper/report.html");
    assert!(
        report.contains("Table 1, Fig. 13, and 3 claims about them, of <cite>")
            && !report.contains("Every figure and claim"),
        "{report:.2000}"
    );
    let claims = workspace.read_text("paper/claims.csv");
    assert_eq!(claims.lines().count(), 4);
    // A call for some figures keeps the others in the report.
    assert!(paper(&workspace, "table1").status.success());
    assert_eq!(workspace.read_text("paper/claims.csv"), claims);
}

#[test]
fn quiet_says_nothing() {
    let output = paper(&Workspace::new(), "fig13 --quiet");
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty());
}

/// Asserts that the figures are refused with this message and status 2.
fn refused(workspace: &Workspace, figures: &str, sentence: &str) {
    let output = paper(workspace, figures);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains(sentence), "{said}");
}

#[test]
fn what_cannot_be_done_is_said_before_anything_is_written() {
    let workspace = Workspace::new();
    refused(&workspace, "fig19", "the paper has no `fig19`");
    assert!(!workspace.exists("paper"));
    workspace.write("paper/notes.txt", "mine");
    refused(
        &workspace,
        "fig13",
        "contains files other than figures of the paper",
    );
    assert_eq!(std::fs::read_dir(workspace.path("paper")).unwrap().count(), 1);
}

/// Files of others stay: figures replace neither a page of the user nor a study, and a study replaces no
/// figures.
#[test]
fn what_others_have_written_stays() {
    let workspace = Workspace::new();
    workspace.write("docs/paper.md", "# My manuscript");
    refused(
        &workspace,
        "fig13 --docs docs",
        "paper.md was not written by an earlier call",
    );
    assert!(!workspace.exists("paper"));
    workspace.write("paper/runs.jsonl", "");
    workspace.write("paper/study.toml", "study.replicates = 1");
    refused(
        &workspace,
        "fig13",
        "contains files other than figures of the paper",
    );
    workspace.remove("paper/study.toml");
    std::fs::create_dir(workspace.path("paper/found")).unwrap();
    workspace.write("study.toml", "base.slider.blocks = [2, 2]");
    let output = workspace.output("study study.toml --out paper");
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("is not the folder of a study"), "{said}");
}
