//! Cases to choose from: those of the folder `cases/`, and those behind the figures of the paper.

use std::collections::BTreeMap;

use include_dir::{Dir, include_dir};
use slipfront_session::{Document, Preset, Presets};
use toml::{Table, Value};

static CASES: Dir = include_dir!("$CARGO_MANIFEST_DIR/cases");

/// The case with which the page opens unless another one is named.
///
/// # Errors
/// A sentence, if the case cannot be made.
pub(crate) fn opening(presets: &Presets) -> Result<Document, String> {
    presets.document("circle")
}

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

/// All cases to choose from.
pub(crate) fn all() -> Presets {
    let mut all: Vec<_> = cases().map(|(name, text)| case(name, text)).collect();
    all.sort_by(|one, other| one.name.cmp(&other.name));
    all.extend(figures().map(|(name, text)| figure(name, text)));
    Presets(all)
}

/// A case of the folder, with the files beside it that it names. It is not parsed before it is chosen: a text
/// in quotes is taken for the name of a file if there is such a file.
fn case(name: &str, text: &str) -> Preset {
    let files = CASES.files().filter_map(|file| {
        let name = file.path().to_str()?;
        text.contains(&format!("\"{name}\""))
            .then(|| (name.to_owned(), file.contents().to_vec()))
    });
    let files = files.collect();
    Preset {
        name: name.to_owned(),
        group: "cases".to_owned(),
        title: title(text),
        toml: text.to_owned(),
        files,
    }
}

/// A case of the paper.
fn figure(name: &str, text: &str) -> Preset {
    Preset {
        name: format!("paper/{name}"),
        group: "paper".to_owned(),
        title: title(text),
        toml: case_of_study(text),
        files: BTreeMap::new(),
    }
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

/// The case of a file of the paper: as a whole, or the base of its study. The run goes on to its end, to be
/// seen.
fn case_of_study(text: &str) -> String {
    // What is wrong with a case is told when it is chosen.
    let Ok(mut table) = text.parse::<Table>() else {
        return text.to_owned();
    };
    let mut case = match table.remove("base") {
        Some(Value::Table(base)) => base,
        _ => table,
    };
    if let Some(Value::Table(time)) = case.get_mut("time") {
        time.remove("stop");
    }
    case.to_string()
}
