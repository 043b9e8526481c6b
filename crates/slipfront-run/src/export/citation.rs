//! Citations of results, of slipfront and of the article with the model that it implements, as BibTeX and as
//! a citation file (CFF 1.2.0).

use jiff::Timestamp;
use serde_json::json;

use super::attribution::Attribution;
use super::error::ExportError;
use super::exported::Exported;

/// Description of slipfront.
pub(super) const MODEL: &str = "a two-dimensional lattice spring-block model of the transition from static to kinetic friction of \
                                micro-textured surfaces";
/// Authors of slipfront.
pub(super) const DEVELOPERS: &str = "The slipfront developers";
pub(super) const ARTICLE_TITLE: &str = "2D Spring-block model to study the transition from static to kinetic friction of \
                                        complex-micro-textured contact surfaces";
const ARTICLE_DOI: &str = "10.1016/j.triboint.2023.108866";
pub(super) const ARTICLE_URL: &str = "https://doi.org/10.1016/j.triboint.2023.108866";
const ARTICLE_JOURNAL: &str = "Tribology International";
/// Family and given names of the authors, and the volume, as the repository of the University of Trento lists
/// them (<https://iris.unitn.it/handle/11572/437097>).
const ARTICLE_AUTHORS: [[&str; 2]; 2] = [["Jalali", "S. K."], ["Pugno", "N. M."]];
const ARTICLE_VOLUME: u16 = 188;
pub(super) const ARTICLE_YEAR: u16 = 2023;
/// Relation of the article to the results.
const ARTICLE_NOTE: &str = "The model";

/// Entries of BibTeX: one for each folder of results, one for slipfront and one for the article. Without an
/// author the entries of results have none.
pub fn bibtex(folders: &[Exported], by: &Attribution) -> String {
    let mut text = String::new();
    for results in folders {
        let title = format!("{{Friction computed with slipfront: {}}}", tex(&results.title()));
        let note = format!(
            "Made with {}. BLAKE3 hash of {}: {}; seal of {}: {}",
            results.program.in_words(),
            results.file,
            results.hash(),
            results.list,
            results.seal
        );
        let author = by
            .author
            .as_ref()
            .map(|author| format!("{{{}}}", tex(&author.name)));
        let finished = results.finished.parse::<Timestamp>().ok();
        let given = [
            ("title", Some(title)),
            ("note", Some(tex(&note))),
            ("author", author),
            ("year", finished.map(|time| time.strftime("%Y").to_string())),
            ("copyright", by.licence.as_ref().map(|licence| tex(&licence.name))),
        ];
        let fields = given.into_iter().filter_map(|(name, value)| Some((name, value?)));
        let seal = results.seal.get(..16).unwrap_or_default();
        text += &entry("misc", &format!("slipfront-{}-{seal}", results.kind), fields);
    }
    text += &entry(
        "software",
        "slipfront",
        [
            ("title", "{slipfront}".to_owned()),
            ("author", format!("{{{DEVELOPERS}}}")),
            ("version", tex(&versions(folders))),
            ("note", MODEL.to_owned()),
        ],
    );
    text + &entry(
        "article",
        "slipfront-model",
        [
            ("title", format!("{{{ARTICLE_TITLE}}}")),
            (
                "author",
                ARTICLE_AUTHORS
                    .map(|[family, given]| format!("{family}, {given}"))
                    .join(" and "),
            ),
            ("journal", ARTICLE_JOURNAL.to_owned()),
            ("volume", ARTICLE_VOLUME.to_string()),
            ("year", ARTICLE_YEAR.to_string()),
            ("doi", ARTICLE_DOI.to_owned()),
            ("note", ARTICLE_NOTE.to_owned()),
        ],
    )
}

fn entry<'f>(kind: &str, key: &str, fields: impl IntoIterator<Item = (&'f str, String)>) -> String {
    let lines = fields
        .into_iter()
        .map(|(name, value)| format!("  {name} = {{{value}}},\n"));
    format!("@{kind}{{{key},\n{}}}\n", lines.collect::<String>())
}

/// Versions of slipfront that made the results.
fn versions(folders: &[Exported]) -> String {
    let actions = folders.iter().flat_map(|results| &results.actions);
    let mut versions: Vec<&str> = actions.map(|action| action.program.version.as_str()).collect();
    versions.sort_unstable();
    versions.dedup();
    versions.join(", ")
}

/// A text with characters escaped, so that TeX prints every one. BibTeX counts braces, even after a
/// backslash, so commands replace single braces.
fn tex(text: &str) -> String {
    let sign = |c: char| match c {
        '&' | '%' | '$' | '#' | '_' => format!("\\{c}"),
        '{' => "\\textbraceleft{}".to_owned(),
        '}' => "\\textbraceright{}".to_owned(),
        '\\' => "\\textbackslash{}".to_owned(),
        '~' => "\\textasciitilde{}".to_owned(),
        '^' => "\\textasciicircum{}".to_owned(),
        c if c.is_control() => " ".to_owned(),
        _ => c.to_string(),
    };
    text.chars().map(sign).collect()
}

/// A string of YAML: a string of JSON, with numeric escapes for characters that some readers of YAML refuse
/// or treat as line breaks.
fn quoted(text: &str) -> String {
    let is_refused = |c: char| {
        c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}')
    };
    let sign = |c: char| {
        if is_refused(c) {
            format!("\\u{:04x}", u32::from(c))
        } else {
            c.to_string()
        }
    };
    json!(text).to_string().chars().map(sign).collect()
}

/// A citation file (CFF 1.2.0) of results, for a `CITATION.cff` next to them.
///
/// # Errors
/// [`ExportError::NeedsAuthor`]: the format requires an author.
pub fn cff(folders: &[Exported], by: &Attribution) -> Result<String, ExportError> {
    let author = by.author.as_ref().ok_or(ExportError::NeedsAuthor)?;
    let titles: Vec<String> = folders.iter().map(Exported::title).collect();
    let mut text = format!(
        "cff-version: 1.2.0\nmessage: \"If you use these results, please cite them, slipfront and the article of its model.\"\n\
         type: dataset\ntitle: {}\nauthors:\n  - name: {}\n",
        quoted(&format!(
            "Friction computed with slipfront: {}",
            titles.join(", ")
        )),
        quoted(&author.name)
    );
    if let Some(orcid) = &author.orcid {
        text += &format!("    orcid: {}\n", quoted(orcid));
    }
    if let Some(licence) = &by.licence {
        let key = if licence.url == licence.name {
            "license-url"
        } else {
            "license"
        };
        text += &format!("{key}: {}\n", quoted(&licence.name));
    }
    text += "identifiers:\n";
    for results in folders {
        let Exported { list, kind, name, .. } = results;
        text += &format!(
            "  - type: other\n    value: {}\n    description: {}\n",
            quoted(&format!("blake3:{}", results.seal)),
            quoted(&format!("Seal of {list} of the {kind} {name}"))
        );
    }
    text += &format!(
        "references:\n  - type: software\n    title: slipfront\n    version: {}\n    authors:\n      - name: {}\n",
        quoted(&versions(folders)),
        quoted(DEVELOPERS)
    );
    text += &format!(
        "  - type: article\n    title: {}\n    authors:\n{}    journal: {}\n    volume: {ARTICLE_VOLUME}\n    \
         year: {ARTICLE_YEAR}\n    doi: {ARTICLE_DOI}\n    notes: {}\n",
        quoted(ARTICLE_TITLE),
        ARTICLE_AUTHORS
            .map(|[family, given]| format!("      - family-names: {family}\n        given-names: {given}\n"))
            .concat(),
        quoted(ARTICLE_JOURNAL),
        quoted(ARTICLE_NOTE)
    );
    Ok(text)
}
