//! The paper on two random surfaces in place of five: every figure is drawn and every verdict is the expected
//! one.

// A helper that cannot do its work fails its test.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use slipfront_paper::{ClaimVerdict, FIGURES, Paper, PaperOptions};
use slipfront_study::project_folder::Extent;
use slipfront_study::project_folder::{Others, ResultFiles};
use slipfront_study::{RunJournal, StudyError};

fn options<'a>(folder: &'a Path, stop: &'a AtomicBool) -> PaperOptions<'a> {
    PaperOptions {
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        stop,
        reduced: true,
        folder,
    }
}

fn run(names: &[&str], folder: &Path, stop: &AtomicBool) -> Result<Paper, slipfront_paper::PaperError> {
    let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
    let records = RunJournal::open(folder)?;
    slipfront_paper::run(
        &slipfront_paper::figures(&names)?,
        &records,
        &options(folder, stop),
        &|_| {},
    )
}

/// A folder of figures equals its list and the results that follow from its data, until a file or the data
/// are changed.
fn verified(folder: &Path) {
    let verify = |extent| slipfront_paper::verify(folder, extent, &AtomicBool::new(false)).unwrap();
    let whole = verify(Extent::Derived);
    assert_eq!((whole.differences, whole.not_derived), (Vec::new(), None));
    // If the list fits a changed file, the results that follow from the data show the change.
    let mut spoilt = ResultFiles::new(folder, "paper", true).begin();
    spoilt.write("claims.csv", |to| to.write_all(b"spoilt")).unwrap();
    spoilt.place(Others::Stay, Vec::new()).unwrap();
    assert!(verify(Extent::Checksums).differences.is_empty());
    let differences = verify(Extent::Derived).differences;
    assert_eq!(differences.len(), 1);
    assert!(differences[0].contains("claims.csv"), "{differences:?}");
    std::fs::write(folder.join("numbers.csv"), "spoilt").unwrap();
    let differences = verify(Extent::Checksums).differences;
    assert!(
        differences.len() == 1 && differences[0].contains("numbers.csv"),
        "{differences:?}"
    );
}

#[test]
fn every_verdict_is_the_expected_one_and_the_documentation_tells_it() {
    let folder = tempfile::tempdir().unwrap();
    let never = AtomicBool::new(false);
    let paper = run(&["all"], folder.path(), &never).unwrap();
    let unexpected_verdicts: Vec<String> = paper
        .unexpected_verdicts()
        .map(|(_, result)| {
            format!(
                "{}: {} {}",
                result.claim.number,
                result.verdict.words(),
                result.measured()
            )
        })
        .collect();
    assert!(unexpected_verdicts.is_empty(), "{unexpected_verdicts:#?}");
    assert!(paper.results.len() >= 60);

    slipfront_paper::write(
        &paper,
        &ResultFiles::new(folder.path(), "paper", false),
        Vec::new(),
    )
    .unwrap();
    let report = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(report.contains("Every figure and claim of <cite>"));
    let pictures: usize = paper.figures.iter().map(|(_, found)| found.panels.len()).sum();
    assert_eq!(report.matches("data:image/png;base64,").count(), pictures);
    // The report loads nothing from the network.
    assert!(!report.contains("src=\"http") && !report.contains("<link") && !report.contains("<script"));
    for (_, found) in &paper.figures {
        for panel in &found.panels {
            for ending in ["svg", "png", "csv"] {
                assert!(
                    folder.path().join(format!("{}.{ending}", panel.name)).exists(),
                    "{}",
                    panel.name
                );
            }
        }
    }

    verified(folder.path());

    // docs/validation/paper.md comes from a full run, but its claims, criteria and verdicts must equal these.
    let page = slipfront_paper::docs_page(&paper);
    let (here, told) = (
        rows(&page),
        rows(include_str!("../../../../docs/validation/paper.md")),
    );
    for claim in slipfront_paper::claims().unwrap() {
        let told = &told[&claim.number];
        assert!(
            told[5].starts_with(claim.expected.words()),
            "claim {}",
            claim.number
        );
        if let Some(here) = here.get(&claim.number) {
            // Number, claim, place, criterion, verdict: all except the measured numbers.
            for column in [0, 1, 2, 4, 5] {
                assert_eq!(here[column], told[column], "claim {}", claim.number);
            }
        }
    }
    assert_eq!(told.len(), slipfront_paper::claims().unwrap().len());
}

/// Counts of claims in the documentation agree with the list.
#[test]
fn the_documentation_counts_the_claims() {
    let claims = slipfront_paper::claims().unwrap();
    let all = claims.len();
    let of = |verdict| claims.iter().filter(|claim| claim.expected == verdict).count();
    let counted = ClaimVerdict::ALL.map(|verdict| verdict.counted(of(verdict)));
    let pages = [
        (
            include_str!("../../../../docs/validation/paper.md"),
            format!("{all} claims: {}.", counted.join(", ")),
        ),
        (
            include_str!("../../../../README.md"),
            format!("{all} of its claims"),
        ),
        (
            include_str!("../../../../CHANGELOG.md"),
            format!("{all} claims of the text"),
        ),
    ];
    for (page, sentence) in pages {
        // A page may have line breaks anywhere.
        let words: Vec<&str> = page.split_whitespace().collect();
        assert!(words.join(" ").contains(&sentence), "{sentence}");
    }
}

/// Eq. 18 has N^2 in place of N: the cavity is N = 2500 times too large.
#[test]
fn the_cavity_as_printed_is_too_large_by_the_number_of_blocks() {
    let folder = tempfile::tempdir().unwrap();
    let paper = run(&["fig13"], folder.path(), &AtomicBool::new(false)).unwrap();
    let printed = paper
        .results
        .iter()
        .find(|result| result.claim.number == 61)
        .unwrap();
    // Rounding of a few products.
    assert!(
        (printed.number.value / 100.0 - 2500.0).abs() < 1e-9,
        "{}",
        printed.measured()
    );
    assert_eq!(printed.verdict, ClaimVerdict::Misprint);
}

/// The rows of the claims table, each by its number.
fn rows(page: &str) -> BTreeMap<u32, Vec<&str>> {
    let table = page.split("\n## ").next().unwrap_or_default();
    let cells = |line| -> Option<Vec<&str>> { Some(str::strip_prefix(line, "| ")?.split(" | ").collect()) };
    let rows = table.lines().filter_map(cells);
    rows.filter_map(|cells| Some((cells[0].parse().ok()?, cells)))
        .collect()
}

#[test]
fn finished_runs_of_a_figure_that_was_not_finished_are_not_run_again() {
    let folder = tempfile::tempdir().unwrap();
    let never = AtomicBool::new(false);
    let first = run(&["fig8"], folder.path(), &never).unwrap();
    let runs = RunJournal::open(folder.path()).unwrap().len();
    std::fs::remove_dir_all(folder.path().join("found")).unwrap();
    let names = ["fig08".to_owned()];
    let records = RunJournal::open(folder.path()).unwrap();
    let here = AtomicUsize::new(0);
    let figures = slipfront_paper::figures(&names).unwrap();
    let second = slipfront_paper::run(&figures, &records, &options(folder.path(), &never), &|stage| {
        here.fetch_max(stage.study.map_or(0, |study| study.here), Ordering::Relaxed);
    });
    assert_eq!((here.into_inner(), records.len()), (0, runs));
    assert_eq!(second.unwrap().results, first.results);
    assert!(
        first
            .results
            .iter()
            .all(|result| result.claim.figure() == "fig08")
    );
}

#[test]
fn a_stop_flag_ends_it() {
    let folder = tempfile::tempdir().unwrap();
    for figure in ["fig4", "fig8"] {
        let error = run(&[figure], folder.path(), &AtomicBool::new(true)).unwrap_err();
        assert!(error.is_interruption(), "{figure}: {error}");
    }
    assert!(matches!(
        run(&["fig8"], folder.path(), &AtomicBool::new(true)),
        Err(slipfront_paper::PaperError::Study(StudyError::Interrupted))
    ));
}

#[test]
fn figures_are_known_by_their_short_names_too() {
    let names = |given: &[&str]| -> Vec<&str> {
        let given: Vec<String> = given.iter().map(|&name| name.to_owned()).collect();
        slipfront_paper::figures(&given)
            .unwrap()
            .iter()
            .map(|figure| figure.name)
            .collect()
    };
    assert_eq!(names(&["fig15", "fig3"]), ["fig03", "fig15"]);
    assert_eq!(names(&["table1"]), ["table1"]);
    assert_eq!(names(&[]).len(), FIGURES.len());
    let error = slipfront_paper::figures(&["fig19".to_owned()])
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("the paper has no `fig19`: choose fig01, fig02, table1, fig03"),
        "{error}"
    );
}

/// A stopped call loses no finished figure: a stored figure is not run again, so a signal cannot interrupt
/// it.
#[test]
fn a_finished_figure_is_not_run_again() {
    let folder = tempfile::tempdir().unwrap();
    let (never, at_once) = (AtomicBool::new(false), AtomicBool::new(true));
    let first = run(&["fig4"], folder.path(), &never).unwrap();
    let second = run(&["fig4"], folder.path(), &at_once).unwrap();
    assert_eq!(first.figures[0].1.numbers, second.figures[0].1.numbers);
    assert_eq!(first.figures[0].1.panels.len(), second.figures[0].1.panels.len());
}
