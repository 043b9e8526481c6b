//! Tables of claims and numbers as CSV.

use crate::claims::ClaimResult;
use crate::drawing::finish;
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

/// `claims.csv`: a row for each claim.
pub(super) fn claims_csv(paper: &Paper) -> Result<Vec<u8>, PaperError> {
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
        "revised",
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
            claim.revised.clone(),
        ]);
    }
    csv(rows.iter())
}

/// All measured numbers, including those of claims.
pub(super) fn numbers_csv(paper: &Paper) -> Result<Vec<u8>, PaperError> {
    let mut rows = vec![["quantity", "value", "low", "high"].map(str::to_owned).to_vec()];
    for (name, number) in paper
        .figures
        .iter()
        .flat_map(|(figure, data)| data.named_numbers(figure.name))
    {
        let cell = |value: f64| {
            if value.is_nan() {
                String::new()
            } else {
                format!("{value:?}")
            }
        };
        let [_, low, high] = number.ends().map(cell);
        rows.push(vec![name, format!("{:?}", number.value), low, high]);
    }
    csv(rows.iter())
}
