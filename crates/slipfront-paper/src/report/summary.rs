//! What the command prints at the end.

use super::words::step_name;
use crate::claims::{ClaimResult, count_verdicts};
use crate::paper::Paper;

/// A line for every claim, the number of claims with each verdict, and the verdicts that are not the expected ones.
pub fn summary(paper: &Paper) -> String {
    let mut text = String::new();
    for result in &paper.results {
        let ClaimResult { claim, verdict, .. } = result;
        let deviation = claim
            .deviation
            .as_ref()
            .map_or(String::new(), |deviation| format!(" ({deviation})"));
        let note = if result.as_expected() {
            ""
        } else {
            "  <- not as expected"
        };
        text += &format!(
            "{:>3}  {:<22}  {:<18}  {}{deviation}{note}\n",
            claim.number,
            verdict.words(),
            result.measured(),
            claim.claim
        );
    }
    let [holds, conditioned, fails] = count_verdicts(&paper.results);
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
