//! The lengths of a case, in blocks and in metres.

use slipfront_base::number_format::{four_digits, with_si_prefix};
use slipfront_case::case::{Case, CaseLength};

use slipfront_study::text_table::table;

/// The table of the lengths of a case, with the number of blocks that is sufficient for each, and the length
/// that decides on the mesh.
pub(crate) fn lengths(case: &Case) -> String {
    let rows: Vec<Vec<String>> = case.lengths().iter().map(|length| row(case, length)).collect();
    let decides = case.deciding_length();
    table(&["length", "blocks", "metres", "enough"], &rows) + &format!("{:<18}{decides}\n", "mesh")
}

fn row(case: &Case, length: &CaseLength) -> Vec<String> {
    let finite = |text: String| {
        if length.blocks.is_finite() {
            text
        } else {
            "-".to_owned()
        }
    };
    let mut row = vec![
        length.name.clone(),
        finite(four_digits(length.blocks)),
        finite(with_si_prefix(length.metres, "m")),
        length.enough.map_or_else(|| "-".to_owned(), four_digits),
    ];
    row.extend(remark(case, length));
    row
}

/// Remark at the end of a row.
fn remark(case: &Case, length: &CaseLength) -> Option<String> {
    if length.blocks.is_infinite() {
        return Some("slip of any size is stable on this mount".to_owned());
    }
    let field = case
        .correlated_field()
        .filter(|_| length.name == "correlation length")?;
    let percent = |share: f64| four_digits(100.0 * share);
    Some(format!(
        "means over a block have {} % of the variance, means over the slider {} %",
        percent(field.variance_of_blocks()),
        percent(field.variance_of_slider())
    ))
}
