//! What `slipfront paper` leaves: pictures, tables, `claims.csv`, `report.html`, and the pages of `docs/validation`.

mod html;
mod markdown;

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::claims::{ClaimResult, Verdict};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::figures::Figure;
use crate::paper::Paper;
use crate::step_rule::StepRule;
use slipfront_case::disk::{begins_with, write_atomic};
use slipfront_plot::Picture;
use slipfront_run::run_folder::error::FolderError;

/// A drawn picture with its name and caption.
struct Drawn {
    name: String,
    caption: String,
    picture: Picture,
}

/// Writes pictures, tables and the report to a folder.
///
/// # Errors
/// When a picture cannot be drawn or a file not be written.
pub fn write(paper: &Paper, folder: &Path) -> Result<(), PaperError> {
    let mut drawn = Vec::new();
    for (_, data) in &paper.figures {
        let pictures = draw(data)?;
        for (panel, Drawn { name, picture, .. }) in data.panels.iter().zip(&pictures) {
            write_file(folder, &format!("{name}.svg"), picture.svg.as_bytes())?;
            write_file(folder, &format!("{name}.png"), &picture.png)?;
            write_file(folder, &format!("{name}.csv"), &panel.drawing.csv()?)?;
        }
        for table in &data.tables {
            let rows = [&table.header].into_iter().chain(&table.rows);
            write_file(folder, &format!("{}.csv", table.name), &csv(rows)?)?;
        }
        drawn.push(pictures);
    }
    write_file(folder, "claims.csv", &claims_csv(paper)?)?;
    write_file(folder, "numbers.csv", &numbers_csv(paper)?)?;
    write_file(folder, "report.html", html::page(paper, &drawn).as_bytes())
}

/// The first file of others that [`write_docs`] would replace in a folder.
pub fn foreign_docs(folder: &Path) -> Option<PathBuf> {
    let page = folder.join(PAGE);
    if begins_with(&page, markdown::TITLE.as_bytes()) {
        return None;
    }
    let pictures = markdown::SHOWN.iter().map(|name| folder.join(docs_picture(name)));
    [page]
        .into_iter()
        .chain(pictures)
        .find(|path| path.symlink_metadata().is_ok())
}

/// The page of the claims.
const PAGE: &str = "paper.md";

/// The path of a picture of that page.
fn docs_picture(name: &str) -> String {
    format!("images/paper-{name}.png")
}

/// Writes the claims table as `paper.md` with some of its pictures: what stands in `docs/validation`.
///
/// # Errors
/// When a picture cannot be drawn or a file not be written.
pub fn write_docs(paper: &Paper, folder: &Path) -> Result<(), PaperError> {
    // First, since it tells that the pictures are of an earlier call.
    write_file(folder, PAGE, docs_page(paper).as_bytes())?;
    for (_, data) in &paper.figures {
        for Drawn { name, picture, .. } in draw(data)? {
            if markdown::SHOWN.contains(&name.as_str()) {
                write_file(folder, &docs_picture(&name), &picture.png)?;
            }
        }
    }
    Ok(())
}

/// The text of `paper.md`.
pub fn docs_page(paper: &Paper) -> String {
    markdown::page(paper)
}

fn draw(data: &FigureData) -> Result<Vec<Drawn>, PaperError> {
    let panels = data.panels.par_iter().map(|panel| {
        let picture = panel.drawing.draw().map_err(|source| PaperError::Picture {
            name: panel.name.clone(),
            source,
        })?;
        Ok(Drawn {
            name: panel.name.clone(),
            caption: panel.caption.clone(),
            picture,
        })
    });
    panels.collect()
}

fn write_file(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), PaperError> {
    let path = folder.join(name);
    let parent = path.parent().unwrap_or(folder).to_owned();
    let written = std::fs::create_dir_all(parent).and_then(|()| write_atomic(&path, bytes));
    written.map_err(|source| FolderError::Write { path, source }.into())
}

fn csv<'a>(rows: impl Iterator<Item = &'a Vec<String>>) -> Result<Vec<u8>, PaperError> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for row in rows {
        table.write_record(row)?;
    }
    table
        .into_inner()
        .map_err(|error| csv::Error::from(error.into_error()).into())
}

fn claims_csv(paper: &Paper) -> Result<Vec<u8>, PaperError> {
    let header = [
        "number",
        "place",
        "claim",
        "measured",
        "value",
        "low",
        "high",
        "unit",
        "criterion",
        "verdict",
        "expected",
        "value_by_paper_step",
        "verdict_by_paper_step",
        "deviation",
        "remark",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for (index, result) in paper.results.iter().enumerate() {
        let ClaimResult { claim, number, .. } = result;
        let other = paper.results_by_paper_step.get(index);
        let [low, high] = number
            .interval
            .map_or_else(Default::default, |ends| ends.map(|end| format!("{end:?}")));
        rows.push(vec![
            claim.number.to_string(),
            claim.place.clone(),
            claim.claim.clone(),
            claim.measured.clone(),
            format!("{:?}", number.value),
            low,
            high,
            claim.unit.clone(),
            claim.criterion(),
            result.verdict.words().to_owned(),
            claim.expected.words().to_owned(),
            other.map_or(String::new(), |other| format!("{:?}", other.number.value)),
            other.map_or(String::new(), |other| other.verdict.words().to_owned()),
            claim.deviation.clone().unwrap_or_default(),
            claim.remark.clone(),
        ]);
    }
    csv(rows.iter())
}

/// Every number that was measured, those of claims among them.
fn numbers_csv(paper: &Paper) -> Result<Vec<u8>, PaperError> {
    let mut rows = vec![["quantity", "value", "low", "high"].map(str::to_owned).to_vec()];
    for (name, number) in paper.figures.iter().flat_map(|(_, data)| &data.numbers) {
        let [_, low, high] = number.ends();
        let interval = [low, high].map(|end| {
            if end.is_nan() {
                String::new()
            } else {
                format!("{end:?}")
            }
        });
        rows.push(
            [
                vec![name.clone(), format!("{:?}", number.value)],
                interval.to_vec(),
            ]
            .concat(),
        );
    }
    csv(rows.iter())
}

/// Number of claims with each verdict: holds, holds with a condition, does not hold.
fn counts(results: &[ClaimResult]) -> [usize; 3] {
    [Verdict::Holds, Verdict::HoldsWithCondition, Verdict::DoesNotHold]
        .map(|verdict| results.iter().filter(|result| result.verdict == verdict).count())
}

/// What is printed at the end: every claim in a line, and the count.
pub fn summary(paper: &Paper) -> String {
    let mut text = String::new();
    for result in &paper.results {
        let ClaimResult { claim, verdict, .. } = result;
        let deviation = claim
            .deviation
            .as_ref()
            .map_or(String::new(), |deviation| format!(" ({deviation})"));
        let odd = if result.as_expected() {
            ""
        } else {
            "  <- not as expected"
        };
        text += &format!(
            "{:>3}  {:<22}  {:<18}  {}{deviation}{odd}\n",
            claim.number,
            verdict.words(),
            result.measured(),
            claim.claim
        );
    }
    let [holds, conditioned, fails] = counts(&paper.results);
    text += &format!(
        "{} claims: {holds} hold, {conditioned} hold with a condition, {fails} do not hold\n",
        paper.results.len()
    );
    for (rule, result) in paper.unexpected_verdicts() {
        text += &format!(
            "claim {} with {}: {}, expected: {}\n",
            result.claim.number,
            step_name(rule),
            result.verdict.words(),
            result.claim.expected.words()
        );
    }
    text
}

/// A step rule in words.
fn step_name(rule: StepRule) -> &'static str {
    match rule {
        StepRule::Auto => "dt* = 0.1",
        StepRule::Paper => "dt* = (2/3) V*",
    }
}

/// What is written in words in the sources, and how a reader sees it.
const SYMBOLS: [(&str, &str); 11] = [
    ("sqrt(", "\u{221a}("),
    ("square root of ", "\u{221a}"),
    ("sigma_", "\u{3c3}_"),
    ("mu_", "\u{3bc}_"),
    ("mu*", "\u{3bc}*"),
    ("Omega*", "\u{3a9}*"),
    ("lambda", "\u{3bb}"),
    ("epsilon", "\u{3b5}"),
    ("rho", "\u{3c1}"),
    ("dt*", "\u{394}t*"),
    ("^2", "\u{b2}"),
];

/// A text with its Greek letters; subscripts still stand behind an underscore.
fn greek(text: &str) -> String {
    SYMBOLS
        .iter()
        .fold(text.to_owned(), |text, (word, symbol)| text.replace(word, symbol))
}

/// The claims about a figure, with those of the other step rule beside.
fn claims_of<'p>(paper: &'p Paper, figure: &Figure) -> Vec<(&'p ClaimResult, Option<&'p ClaimResult>)> {
    let pairs = paper
        .results
        .iter()
        .enumerate()
        .map(|(k, result)| (result, paper.results_by_paper_step.get(k)));
    pairs
        .filter(|(result, _)| result.claim.figure() == figure.name)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_letters() {
        let seen = greek("dt* = (2/3) V*, sqrt(E/rho), mu_s* and sigma_s*");
        assert_eq!(
            seen,
            "\u{394}t* = (2/3) V*, \u{221a}(E/\u{3c1}), \u{3bc}_s* and \u{3c3}_s*"
        );
        assert_eq!(greek("the throughput"), "the throughput");
    }
}
