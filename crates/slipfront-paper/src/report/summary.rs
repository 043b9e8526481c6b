//! The summary that the command prints at the end.

use crate::claims::ClaimResult;
use crate::paper::Paper;

/// A table with a line for every claim, the number of claims with each verdict, and the verdicts that are not
/// the expected ones.
pub fn summary(paper: &Paper) -> String {
    let mut text = format!("{:>3}  {:<27}  {:<18}  claim\n", "no.", "verdict", "measured");
    for result in &paper.results {
        let ClaimResult { claim, verdict, .. } = result;
        let deviation = claim.deviation_in_brackets();
        let note = if result.as_expected() {
            ""
        } else {
            "  <- not as expected"
        };
        text += &format!(
            "{:>3}  {:<27}  {:<18}  {}{deviation}{note}\n",
            claim.number,
            verdict.words(),
            result.measured(),
            claim.claim
        );
    }
    text += &format!("{}\n", paper.tally());
    for (rule, result) in paper.unexpected_verdicts() {
        text += &format!(
            "claim {} with {}: {}, expected: {}\n",
            result.claim.number,
            rule.formula(),
            result.verdict.words(),
            result.claim.expected.words()
        );
    }
    text
}
