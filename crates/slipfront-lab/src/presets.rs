//! Cases to choose from: those of the folder `cases/`, and those behind the figures of the paper.

use include_dir::{Dir, include_dir};
use slipfront_case::case_file::CaseError;
use slipfront_case::text::truncated;
use toml::{Table, Value};

use crate::document::Document;
use crate::protocol::PresetEntry;

static CASES: Dir = include_dir!("$CARGO_MANIFEST_DIR/cases");

/// The case with which the page opens unless another one is named: the circle, with more blocks.
///
/// # Errors
/// A sentence, if the case cannot be made.
pub(crate) fn opening() -> Result<Document, String> {
    let blocks = Value::Array(vec![Value::Integer(100); 2]);
    document("circle")?.with([("slider.blocks".to_owned(), Some(blocks))])
}

const PAPER: &str = "paper/";

/// Names and texts of the cases of the folder.
fn cases() -> impl Iterator<Item = (&'static str, &'static str)> {
    CASES.files().filter_map(|file| {
        let name = file.path().to_str()?.strip_suffix(".toml")?;
        Some((name, file.contents_utf8()?))
    })
}

/// Names and texts of the cases of the paper.
fn figures() -> impl Iterator<Item = (&'static str, &'static str)> {
    slipfront_paper::cases().filter(|(name, _)| name.starts_with("fig") || name.starts_with("table"))
}

/// The list of all cases to choose from.
pub(crate) fn entries() -> Vec<PresetEntry> {
    let entry = |group, prefix: &'static str| {
        move |(name, text): (&str, &str)| PresetEntry {
            name: format!("{prefix}{name}"),
            group,
            title: title(text),
        }
    };
    let mut all: Vec<_> = cases().map(entry("cases", "")).collect();
    all.sort_by(|one, other| one.name.cmp(&other.name));
    all.extend(figures().map(entry("paper", PAPER)));
    all
}

/// The first sentence of the comment with which a case begins.
fn title(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix('#'));
    let comment = lines.map(str::trim).collect::<Vec<_>>().join(" ");
    // "Fig. 3" and "Eq. 1" go on.
    let ends = comment.match_indices(". ").map(|(end, _)| &comment[..end]);
    let is_abbreviated =
        |part: &&str| part.ends_with("Fig") || part.ends_with("Figs") || part.ends_with("Eq");
    let sentence = ends.into_iter().find(|part| !is_abbreviated(part));
    sentence.unwrap_or(&comment).trim_end_matches('.').to_owned()
}

/// A case by its name.
///
/// # Errors
/// A sentence, if there is none of that name or it cannot be made.
pub(crate) fn document(name: &str) -> Result<Document, String> {
    let sentence = |error: CaseError| error.to_string();
    if let Some(figure) = name.strip_prefix(PAPER) {
        let (_, text) = figures()
            .find(|(known, _)| *known == figure)
            .ok_or_else(|| unknown(name))?;
        let none = |_: &str| Err("there is no such file".to_owned());
        return Document::new(figure, &case_of_study(text)?, none).map_err(sentence);
    }
    let (_, text) = cases()
        .find(|(known, _)| *known == name)
        .ok_or_else(|| unknown(name))?;
    let read = |file: &str| {
        let found = CASES.get_file(file).ok_or("there is no such file")?;
        Ok(found.contents().to_vec())
    };
    Document::new(name, text, read).map_err(sentence)
}

fn unknown(name: &str) -> String {
    format!("there is no case `{}`", truncated(name))
}

/// The case of a file of the paper: as a whole, or the base of its study. The run goes on to its end, to be seen.
fn case_of_study(text: &str) -> Result<String, String> {
    let mut table: Table = text.parse().map_err(|error| format!("{error}"))?;
    let mut case = match table.remove("base") {
        Some(Value::Table(base)) => base,
        _ => table,
    };
    if let Some(Value::Table(time)) = case.get_mut("time") {
        time.remove("stop");
    }
    Ok(case.to_string())
}
