//! `slipfront paper` from outside, on the figures that cost least.

use assert_cmd::Command;

fn paper(out: &std::path::Path) -> Command {
    let mut command = Command::cargo_bin("slipfront").expect("the command is built");
    command.args(["paper", "--reduced", "--out"]).arg(out);
    command
}

#[test]
fn figures_are_made_judged_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("paper");
    let docs = folder.path().join("docs");
    // Twice: what is there is replaced.
    for _ in 0..2 {
        let output = paper(&out)
            .args(["fig13", "table1", "--docs"])
            .arg(&docs)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{text}");
        assert!(
            text.contains("4 claims: 2 hold, 0 hold with a condition, 2 do not hold"),
            "{text}"
        );
        assert!(text.contains("report.html"));
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
        assert!(out.join(name).exists(), "{name}");
    }
    assert!(docs.join("paper.md").exists());
    let claims = std::fs::read_to_string(out.join("claims.csv")).unwrap();
    assert_eq!(claims.lines().count(), 5);
}

#[test]
fn quiet_says_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let output = paper(&folder.path().join("paper"))
        .args(["fig13", "--quiet"])
        .output()
        .unwrap();
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty());
}

#[test]
fn what_cannot_be_done_is_said_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("paper");
    let refused = |figure: &str, sentence: &str| {
        let output = paper(&out).arg(figure).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            output.status.code() == Some(2) && text.contains(sentence),
            "{text}"
        );
    };
    refused("fig19", "the paper has no `fig19`");
    assert!(!out.exists());
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("notes.txt"), "mine").unwrap();
    refused("fig13", "holds other things");
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 1);
}
