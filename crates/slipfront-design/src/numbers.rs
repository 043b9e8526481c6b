//! Results of a design for the numbers of shapes.

use serde::Serialize;
use slipfront_base::number_format::exact;
use slipfront_study::Unknown;
use slipfront_study::text_table::table;
use slipfront_study::unknown::with_unit;

use crate::design::Design;
use crate::shapes::number;

/// Distance from an end of the range, as a share of the range, below which a number is near that end.
const NEAR_AN_END: f64 = 0.01;

/// A number that was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct FoundNumber {
    /// Key of the case.
    key: String,
    value: f64,
    /// Unit of the value and of the range, if they have one.
    unit: Option<String>,
    /// Range that was searched.
    range: [f64; 2],
}

impl FoundNumber {
    /// A number with its unit.
    fn with_unit(&self, number: f64) -> String {
        with_unit(exact(number), self.unit.as_deref())
    }

    /// The key with its value, for a sentence.
    pub(crate) fn key_and_value(&self) -> String {
        format!("{} = {}", self.key, self.with_unit(self.value))
    }

    /// A sentence on a number at an end of its range.
    pub(crate) fn end_of_range_note(&self) -> Option<String> {
        let [from, to] = self.range;
        let near = NEAR_AN_END * (to - from);
        let is_near = self.value - from <= near || to - self.value <= near;
        is_near.then(|| {
            format!(
                "`{}` is at an end of its range, {} to {}: a wider range may contain a better value",
                self.key,
                self.with_unit(from),
                self.with_unit(to)
            )
        })
    }
}

/// The numbers at shares of their ranges; none for a mask.
pub(crate) fn numbers_found(design: &Design, shares: Option<&[f64]>) -> Vec<FoundNumber> {
    let Some((shapes, shares)) = design.shapes.as_ref().zip(shares) else {
        return Vec::new();
    };
    let found = shapes
        .unknowns
        .iter()
        .zip(shares)
        .map(|(unknown, &share)| FoundNumber {
            key: unknown.key().to_owned(),
            value: number(unknown, share),
            unit: unknown.unit().map(str::to_owned),
            range: [0.0, 1.0].map(|end| unknown.at(end)),
        });
    found.collect()
}

/// Names of the columns of unknowns in tables, as `texture.0.lambda (um)`.
pub(crate) fn columns_of_unknowns(design: &Design) -> Vec<String> {
    let unknowns = design.shapes.iter().flat_map(|shapes| &shapes.unknowns);
    unknowns.map(Unknown::column).collect()
}

/// Cells of the columns of unknowns.
pub(crate) fn numbers_at(design: &Design, shares: Option<&[f64]>) -> Vec<f64> {
    numbers_found(design, shares)
        .into_iter()
        .map(|found| found.value)
        .collect()
}

/// The table of the numbers that were found; empty for a mask.
pub(crate) fn table_of_numbers(numbers: &[FoundNumber]) -> String {
    if numbers.is_empty() {
        return String::new();
    }
    let row = |found: &FoundNumber| {
        let [from, to] = found.range.map(|end| found.with_unit(end));
        vec![
            found.key.clone(),
            found.with_unit(found.value),
            format!("{from} to {to}"),
        ]
    };
    let rows: Vec<Vec<String>> = numbers.iter().map(row).collect();
    format!("{}\n", table(&["unknown", "found", "range"], &rows))
}
