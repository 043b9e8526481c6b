//! Tables of claims and numbers as CSV.

use crate::claims::ClaimResult;
use crate::drawing::{finish, known};
use crate::error::PaperError;
use crate::paper::Paper;

/// Rows as CSV.
pub(super) fn csv<'a>(rows: impl Iterator<Item = &'a Vec<String>>) -> Result<Vec<u8>, PaperError> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for row in rows {
        table.write_record(row)?;
    }
    finish(table)
}

/// Text of a cell, from a result and the one of the same claim with the paper's time step.
type Cell = fn(&ClaimResult, Option<&ClaimResult>) -> String;

/// Columns of `claims.csv`.
const CLAIM_COLUMNS: [(&str, Cell); 16] = [
    ("number", |result, _| result.claim.number.to_string()),
    ("place", |result, _| result.claim.place.clone()),
    ("claim", |result, _| result.claim.claim.clone()),
    ("measured", |result, _| result.claim.measured.clone()),
    ("value", |result, _| format!("{:?}", result.number.value)),
    ("low", |result, _| end(result, 0)),
    ("high", |result, _| end(result, 1)),
    ("unit", |result, _| result.claim.unit.clone()),
    ("criterion", |result, _| result.claim.criterion()),
    ("verdict", |result, _| result.verdict.words().to_owned()),
    ("expected", |result, _| result.claim.expected.words().to_owned()),
    ("value_by_paper_step", |_, other| {
        other.map_or(String::new(), |other| format!("{:?}", other.number.value))
    }),
    ("verdict_by_paper_step", |_, other| {
        other.map_or(String::new(), |other| other.verdict.words().to_owned())
    }),
    ("deviation", |result, _| {
        result.claim.deviation.clone().unwrap_or_default()
    }),
    ("remark", |result, _| result.claim.remark.clone()),
    ("revised", |result, _| result.claim.revised.clone()),
];

/// An end of the interval of a measured number; empty without one.
fn end(result: &ClaimResult, end: usize) -> String {
    let interval = result.number.interval;
    interval.map_or(String::new(), |ends| format!("{:?}", ends[end]))
}

/// `claims.csv`: a row for each claim.
pub(super) fn claims_csv(paper: &Paper) -> Result<Vec<u8>, PaperError> {
    let mut rows = vec![CLAIM_COLUMNS.map(|(name, _)| name.to_owned()).to_vec()];
    for (index, result) in paper.results.iter().enumerate() {
        let other = paper.results_by_paper_step.get(index);
        rows.push(CLAIM_COLUMNS.map(|(_, cell)| cell(result, other)).to_vec());
    }
    csv(rows.iter())
}

/// All measured numbers, including those of claims.
pub(super) fn numbers_csv(paper: &Paper) -> Result<Vec<u8>, PaperError> {
    let mut rows = vec![["quantity", "value", "low", "high"].map(str::to_owned).to_vec()];
    let figures = paper.figures.iter();
    for (name, number) in figures.flat_map(|(figure, data)| data.named_numbers(figure.name)) {
        let cell = |value: f64| known(value).map_or(String::new(), |value| format!("{value:?}"));
        let [_, low, high] = number.ends().map(cell);
        rows.push(vec![name, format!("{:?}", number.value), low, high]);
    }
    csv(rows.iter())
}
