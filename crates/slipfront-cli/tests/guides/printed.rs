//! Runs every console block of the guides, and compares the printed output with the block.

use std::collections::BTreeMap;

use crate::support::book::{blocks, repository, without_machine};
use crate::support::process::{program, stderr, stdout};
use crate::support::workspace::Workspace;

/// Text blocks in the guides that are formulas, or that another test compares with results.
const OTHER_TEXTS: [(&str, &str); 8] = [
    // Tested by `the_guide_shows_what_is_printed` in `converge.rs`.
    (
        "experiment.md",
        "block   textured   static_reduction_percent   static_friction_star   kinetic",
    ),
    // Tested by `the_guides_have_the_reductions_of_their_studies` in `studies.rs`.
    (
        "experiment.md",
        "block   textured   static_reduction_percent   static_friction_star\n",
    ),
    ("experiment.md", "sigma*(l) = s a/l"),
    ("family.md", "max(mu_1, f R* mu_1 + (1 - f) mu_2)"),
    // Arithmetic with the numbers printed above it.
    ("getting-started.md", "100 (0.8763 - 0.6893)/0.8763 = 21.3 %"),
    // Tested by `tests/same_run.rs` of slipfront-mpi.
    ("long.md", "error: `drive.v_star` is 0.2 on rank 1"),
    // Tested by `tests/fields/check.py`.
    ("results.md", "displacement_x*iHat + displacement_y*jHat"),
    // Tested by `studies_show_what_is_printed` below.
    ("studies.md", "friction.sigma_static_star  0.00  0.05"),
];

/// The commands of a console, each with the output shown below it.
fn commands(lines: &[String]) -> Vec<(String, Vec<String>)> {
    let mut commands: Vec<(String, Vec<String>)> = Vec::new();
    for line in lines {
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(command), _) => commands.push((command.to_owned(), Vec::new())),
            (None, Some((_, shown))) => shown.push(line.clone()),
            (None, None) => panic!("a console begins with a command and not with {line:?}"),
        }
    }
    commands
}

/// Whether printed lines agree with the lines shown, in which a line `...` matches any lines.
fn agrees(shown: &[String], printed: &[&str]) -> bool {
    match (shown.split_first(), printed.split_first()) {
        (None, None) => true,
        (Some((first, rest)), _) if first == "..." => {
            (0..=printed.len()).any(|k| agrees(rest, &printed[k..]))
        }
        (Some((first, rest)), Some((line, others))) => {
            without_machine(first) == without_machine(line) && agrees(rest, others)
        }
        _ => false,
    }
}

fn guide(name: &str) -> String {
    std::fs::read_to_string(repository().join("docs/guide").join(name)).unwrap()
}

/// A folder with the cases of the repository.
fn with_cases() -> Workspace {
    let workspace = Workspace::new();
    let copied = std::process::Command::new("cp")
        .arg("-r")
        .arg(repository().join("cases"))
        .arg(workspace.path("cases"))
        .status();
    assert!(copied.unwrap().success());
    workspace
}

/// Runs a line of a console in the shell; returns stdout, or stderr if stdout is empty. Progress, which
/// depends on time, goes to stderr.
fn run(workspace: &Workspace, line: &str) -> String {
    let output = workspace.shell(&format!("slipfront() {{ '{}' \"$@\"; }}\n{line}", program()));
    if output.stdout.is_empty() {
        stderr(&output)
    } else {
        stdout(&output)
    }
}

/// Runs the consoles of a guide that show an output, or all of them, after writing the cases above them to
/// the files named in their first lines; returns the number of outputs.
fn check(name: &str, runs_all: bool) -> usize {
    check_in(&with_cases(), name, runs_all)
}

fn check_in(workspace: &Workspace, name: &str, runs_all: bool) -> usize {
    let mut n_outputs = 0;
    for (info, lines) in blocks(&guide(name)) {
        let file = lines
            .first()
            .and_then(|line| line.strip_prefix("# ")?.split([':', ' ']).next())
            .filter(|file| info.starts_with("toml") && file.ends_with(".toml"));
        if let Some(file) = file {
            workspace.write(file, lines.join("\n"));
        }
        // For a file of an instrument, its name and, if necessary, its encoding follow `text`.
        match info.split_whitespace().collect::<Vec<_>>()[..] {
            ["text", file] => workspace.write(file, lines.join("\n")),
            ["text", file, "utf-16"] => {
                let text = format!("\u{feff}{}\n", lines.join("\n"));
                let bytes: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
                workspace.write(file, bytes);
            }
            _ => {}
        }
        if info != "console" {
            continue;
        }
        let commands = commands(&lines);
        if !runs_all && commands.iter().all(|(_, shown)| shown.is_empty()) {
            continue;
        }
        for (command, shown) in commands {
            if !runs_all && shown.is_empty() && !command.starts_with("slipfront ") {
                continue;
            }
            if runs_all && command.starts_with("cargo ") {
                continue;
            }
            let printed = run(workspace, &command);
            if shown.is_empty() {
                assert!(
                    !printed.contains("error: "),
                    "docs/guide/{name}, {command}\n{printed}"
                );
                continue;
            }
            n_outputs += 1;
            let lines: Vec<&str> = printed.lines().collect();
            assert!(
                agrees(&shown, &lines),
                "docs/guide/{name} shows other lines than `{command}` prints:\n{printed}\n--- shown ---\n{}",
                shown.join("\n")
            );
        }
    }
    n_outputs
}

#[test]
fn getting_started_shows_what_is_printed() {
    let workspace = with_cases();
    assert!(check_in(&workspace, "getting-started.md", true) >= 6);
    // The example in the help of `verify`, on the folders that the page has made.
    let printed = run(&workspace, "slipfront verify results/*");
    assert!(
        printed.contains("results/cavity: ") && printed.contains("results/overlay holds only pictures"),
        "{printed}"
    );
    assert!(
        workspace
            .output("verify results/cavity results/overlay")
            .status
            .success()
    );
}

#[test]
fn textures_show_what_is_printed() {
    assert!(check("textures.md", false) >= 3);
}

#[test]
fn the_way_from_an_experiment_shows_what_is_printed() {
    assert!(check("experiment.md", false) >= 5);
}

#[test]
fn files_of_instruments_are_read_as_shown() {
    assert!(check("instruments.md", true) >= 12);
}

/// The five jobs, each from its first to its last command.
#[test]
fn jobs_show_what_is_printed() {
    let workspace = with_cases();
    assert!(check_in(&workspace, "jobs.md", true) >= 8);
    assert!(workspace.exists("results/dimples/mask.dxf") && workspace.exists("effect-as-crate/effect"));
}

#[test]
fn the_tutorial_of_a_workshop_shows_what_is_printed() {
    let workspace = with_cases();
    assert!(check_in(&workspace, "tutorials/laser-workshop.md", true) >= 5);
    assert!(workspace.exists("dimples.dxf") && workspace.exists("dimples.png"));
}

#[test]
fn the_tutorial_of_a_tester_shows_what_is_printed() {
    assert!(check("tutorials/testers-record.md", true) >= 3);
}

#[test]
fn the_tutorial_of_a_thesis_shows_what_is_printed() {
    let workspace = with_cases();
    assert!(check_in(&workspace, "tutorials/thesis.md", true) >= 6);
    assert!(workspace.exists("orientation-as-crate/orientation") && workspace.exists("orientation.bib"));
}

/// The command that makes the laboratory as one file is not run: it needs a module that is built from the
/// sources.
#[test]
fn the_tutorial_of_a_lecture_shows_what_is_printed() {
    assert!(check("tutorials/lecture.md", false) >= 4);
}

/// Every other guide; most of them show no output.
#[test]
fn other_guides_show_what_is_printed() {
    for entry in std::fs::read_dir(repository().join("docs/guide")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let have_a_test = [
            "getting-started.md",
            "textures.md",
            "experiment.md",
            "instruments.md",
            "jobs.md",
            "studies.md",
        ];
        if name.ends_with(".md") && !have_a_test.contains(&name.as_str()) {
            check(&name, false);
        }
    }
}

/// The first study and friction over directions, with the guide's statistics of the first study.
#[test]
fn studies_show_what_is_printed() {
    let workspace = with_cases();
    assert!(check_in(&workspace, "studies.md", false) >= 3);

    let number = |row: &BTreeMap<String, String>, column: &str| row[column].parse::<f64>().unwrap();
    let results = workspace.results("results/first");
    let reductions: Vec<f64> = results
        .table("points.csv")
        .iter()
        .filter(|row| row["quantity"] == "static_reduction_percent")
        .map(|row| number(row, "mean"))
        .collect();
    let mut runs: BTreeMap<(String, String), Vec<f64>> = BTreeMap::new();
    for row in results.table("runs.csv") {
        if row["role"] == "point" {
            let point = ["texture.0.coverage", "friction.sigma_static_star"].map(|axis| row[axis].clone());
            let [coverage, sigma] = point;
            runs.entry((coverage, sigma))
                .or_default()
                .push(number(&row, "static_friction_star"));
        }
    }
    let page = guide("studies.md");
    for (k, coverage) in ["1", "5", "10", "20"].into_iter().enumerate() {
        let line = format!(
            "{coverage:<27} {:.1}  {:.1}\n",
            reductions[2 * k],
            reductions[2 * k + 1]
        );
        assert!(page.contains(&line), "docs/guide/studies.md lacks\n{line}");
        let of = |sigma: &str| &runs[&(coverage.to_owned(), sigma.to_owned())];
        let differences: Vec<f64> = of("0.05")
            .iter()
            .zip(of("0"))
            .map(|(rough, even)| rough - even)
            .collect();
        let n = differences.len() as f64;
        let mean = differences.iter().sum::<f64>() / n;
        let variance = differences.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let line = format!("{coverage:<18} {mean:>7.4}  {:.4}\n", variance.sqrt());
        assert!(page.contains(&line), "docs/guide/studies.md lacks\n{line}");
    }
}

#[test]
fn no_text_in_the_guides_is_left_without_a_test() {
    let mut found = Vec::new();
    let names_in = |folder: &'static str| {
        let entries = std::fs::read_dir(repository().join("docs/guide").join(folder)).unwrap();
        entries.map(move |entry| format!("{folder}{}", entry.unwrap().file_name().to_str().unwrap()))
    };
    for name in names_in("").chain(names_in("tutorials/")) {
        if !name.ends_with(".md") {
            continue;
        }
        for (info, lines) in blocks(&guide(&name)) {
            let is_output = ["text", "json", "csv", ""].contains(&info.as_str());
            if is_output {
                let text = format!("{}\n", lines.join("\n").trim_start());
                let known = OTHER_TEXTS
                    .iter()
                    .find(|(page, start)| *page == name && text.starts_with(start));
                assert!(
                    known.is_some(),
                    "docs/guide/{name}: no command and no test gives\n{text}"
                );
                found.extend(known);
            }
        }
    }
    for text in &OTHER_TEXTS {
        assert!(found.contains(&text), "{} has no text {:?}", text.0, text.1);
    }
}

#[test]
fn dots_stand_for_any_lines_and_other_lines_must_be_equal() {
    let shown = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    assert!(agrees(&shown("a\n...\nd"), &["a", "b", "c", "d"]));
    assert!(agrees(&shown("a\n...\nb"), &["a", "b"]));
    assert!(!agrees(&shown("a\n...\nd"), &["a", "b", "c"]));
    assert!(!agrees(&shown("a"), &["a", "b"]));
    assert!(agrees(
        &shown("memory 3.5 MiB of 1 GiB"),
        &["memory 4 KiB of 2.2 GiB"]
    ));
    assert!(!agrees(&shown("disk 3.5 MiB"), &["disk 4 MiB"]));
}
