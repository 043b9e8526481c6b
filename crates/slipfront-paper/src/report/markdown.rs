//! `docs/validation/paper.md`: the claims table and all figures.

use std::fmt::Write as _;

use super::symbols::greek;
use crate::claims::{ClaimResult, NUMBERING, REVISED};
use crate::figure_data::Panel;
use crate::paper::Paper;
use crate::step_rule::StepRule;

/// The first line of the page, which identifies a page of an earlier call.
pub(super) const TITLE: &str = "# The paper, claim by claim\n";

/// The text of `paper.md`.
pub fn page(paper: &Paper) -> String {
    let mut text = format!(
        "{TITLE}\n\
         This page lists every claim of the paper's text, with the result of a new run of its figures:\n\n\
         ```console\n$ slipfront paper --docs docs/validation\n```\n\n\
         Criteria and expected verdicts are in [crates/slipfront-paper/cases/claims.toml](../../crates/slipfront-paper/cases/claims.toml). Numbers D1 to D12 are\n\
         the [deviations from the paper's print](../model.md#deviations-from-the-papers-print). Intervals are 95 % confidence\n\
         intervals of the mean over random surfaces, five unless stated otherwise. The time step is {}. The last column has the\n\
         result with the paper's time step, {}; {}.\n\n{NUMBERING}\n{REVISED}\n\n\
         {}.\n\n\
         | | claim | place | measured | holds if | verdict | paper's step |\n\
         |---:|---|---|---|---|---|---|\n",
        greek(StepRule::Auto.formula()),
        greek(StepRule::Paper.formula()),
        other_verdicts(paper),
        paper.tally()
    );
    for (k, result) in paper.results.iter().enumerate() {
        let claim = &result.claim;
        let other = paper.results_by_paper_step.get(k);
        let mut remark = match claim.remark.as_str() {
            "" => String::new(),
            remark => format!(" {}", emphasised(remark)),
        };
        if !claim.revised.is_empty() {
            remark += &format!(" {}", emphasised(&format!("Revised: {}", claim.revised)));
        }
        let cells = [
            claim.number.to_string(),
            format!("{}.{remark}", claim.claim),
            claim.place.clone(),
            format!("{}: {}", claim.measured, result.measured()),
            claim.criterion(),
            result.verdict_in_full(),
            other.map_or(String::new(), ClaimResult::measured),
        ];
        let cells = cells.map(|cell| greek(&cell).replace('|', "\\|"));
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    write_figures(paper, &mut text);
    text
}

/// A text in italics, with symbols. The stars of dimensionless quantities are escaped, since they would end
/// the italics.
fn emphasised(text: &str) -> String {
    format!("*{}*", greek(text).replace('*', "\\*"))
}

/// Number of verdicts that differ with the paper's step, in words.
fn other_verdicts(paper: &Paper) -> String {
    let pairs = paper.results.iter().zip(&paper.results_by_paper_step);
    match pairs.filter(|(one, other)| one.verdict != other.verdict).count() {
        0 => "no verdict differs".to_owned(),
        1 => "one verdict differs".to_owned(),
        count => format!("{count} verdicts differ"),
    }
}

/// All pictures and tables, figure by figure.
fn write_figures(paper: &Paper, text: &mut String) {
    for (figure, data) in &paper.figures {
        let _ = write!(text, "\n## {}\n", figure.title);
        for Panel { name, caption, .. } in &data.panels {
            let caption = greek(caption);
            let _ = write!(text, "\n{caption}\n\n![{name}](images/paper-{name}.png)\n");
        }
        for table in &data.tables {
            let _ = write!(text, "\n{}\n\n", greek(&table.caption));
            let _ = writeln!(text, "| {} |", greek(&table.header.join(" | ")));
            let _ = writeln!(text, "|{}", "---|".repeat(table.header.len()));
            for row in &table.rows {
                let _ = writeln!(text, "| {} |", greek(&row.join(" | ")));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::emphasised;

    #[test]
    fn a_star_does_not_end_italics() {
        assert_eq!(
            emphasised("the rise of mu_s* was"),
            "*the rise of \u{3bc}_s\\* was*"
        );
    }
}
