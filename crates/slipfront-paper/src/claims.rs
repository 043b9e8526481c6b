//! The claims of the paper, read from `cases/claims.toml` of this crate and judged by the numbers of the figures.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::embedded_cases::CLAIMS;
use crate::error::PaperError;
use crate::number::Number;

/// A claim of the paper and how it is judged.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Its number.
    pub number: u32,
    /// Where the paper makes it: section, then figure, table or equation.
    pub place: String,
    /// What it says, in other words than the paper's.
    pub claim: String,
    /// Description of the number that was measured.
    pub measured: String,
    /// Name of the number that was measured: `figure.number`.
    pub quantity: String,
    /// Unit of the number; may be empty.
    #[serde(default)]
    pub unit: String,
    /// Digits after the point with which the number is shown.
    #[serde(default = "three")]
    pub digits: usize,
    /// Bounds of the number within which the claim holds, ends included.
    pub within: [f64; 2],
    /// A second number: where it is out of its bounds, the claim holds only with a condition.
    pub condition: Option<Condition>,
    /// The expected verdict. Another one points to a fault of the program or to a change of the model.
    pub expected: Verdict,
    /// Number of the deviation from the paper's print (D1 to D12) that explains the verdict.
    pub deviation: Option<String>,
    /// A remark for the reader; may be empty.
    #[serde(default)]
    pub remark: String,
    /// Whether two surfaces and one time step are enough to judge it.
    #[serde(default = "yes")]
    pub reduced: bool,
}

/// The condition of a claim.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// Name of the number that decides.
    pub quantity: String,
    /// Bounds of the number within which the claim holds without a condition, ends included.
    pub within: [f64; 2],
    /// The condition in words.
    pub only: String,
}

fn three() -> usize {
    3
}

fn yes() -> bool {
    true
}

/// Whether a claim holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It holds.
    Holds,
    /// It holds under a condition that the paper does not state.
    HoldsWithCondition,
    /// It does not hold.
    DoesNotHold,
}

impl Verdict {
    /// The verdict in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsWithCondition => "holds with a condition",
            Self::DoesNotHold => "does not hold",
        }
    }
}

/// A claim, what was measured, and the verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimResult {
    /// The claim.
    pub claim: Claim,
    /// The measured number.
    pub number: Number,
    /// The measured number of its condition.
    pub condition: Option<Number>,
    /// Whether it holds.
    pub verdict: Verdict,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    claim: Vec<Claim>,
}

/// All claims, in order.
///
/// # Errors
/// When the file is no list of claims.
pub fn claims() -> Result<Vec<Claim>, PaperError> {
    let list: List = toml::from_str(CLAIMS)?;
    Ok(list.claim)
}

impl Claim {
    /// The figure that measures it.
    pub fn figure(&self) -> &str {
        self.quantity.split('.').next().unwrap_or(&self.quantity)
    }

    /// The criterion, in words.
    pub fn criterion(&self) -> String {
        let [low, high] = self.within;
        let unit = match self.unit.as_str() {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        match (low.is_finite(), high.is_finite()) {
            (true, true) if low == high => format!("{low}{unit}"),
            (true, true) => format!("{low} to {high}{unit}"),
            (true, false) => format!("at least {low}{unit}"),
            (false, true) => format!("at most {high}{unit}"),
            (false, false) => "any".to_owned(),
        }
    }

    /// The deviation that explains the verdict, such as ` (D3)`; empty without one.
    pub(super) fn deviation_in_brackets(&self) -> String {
        let deviation = self.deviation.as_ref();
        deviation.map_or(String::new(), |deviation| format!(" ({deviation})"))
    }

    /// Judges it by the measured numbers.
    ///
    /// # Errors
    /// [`PaperError::Unmeasured`] when its number is not among them.
    pub fn judge(self, numbers: &BTreeMap<String, Number>) -> Result<ClaimResult, PaperError> {
        let measured = |quantity: &String| {
            let number = numbers.get(quantity).copied();
            number.ok_or_else(|| PaperError::Unmeasured {
                number: self.number,
                quantity: quantity.clone(),
            })
        };
        let number = measured(&self.quantity)?;
        let condition = self.condition.as_ref();
        let condition = condition
            .map(|condition| measured(&condition.quantity))
            .transpose()?;
        let inside = |number: &Number, [low, high]: [f64; 2]| (low..=high).contains(&number.value);
        let general = match (&self.condition, &condition) {
            (Some(bound), Some(number)) => inside(number, bound.within),
            _ => true,
        };
        let verdict = match (inside(&number, self.within), general) {
            (false, _) => Verdict::DoesNotHold,
            (true, true) => Verdict::Holds,
            (true, false) => Verdict::HoldsWithCondition,
        };
        Ok(ClaimResult {
            claim: self,
            number,
            condition,
            verdict,
        })
    }
}

impl ClaimResult {
    /// Whether the verdict is the expected one.
    pub fn as_expected(&self) -> bool {
        self.verdict == self.claim.expected
    }

    /// The verdict in words, with the condition and the deviation that explain it.
    pub(super) fn verdict_in_full(&self) -> String {
        let words = self.verdict.words();
        let deviation = self.claim.deviation_in_brackets();
        match (self.verdict, &self.claim.condition) {
            (Verdict::HoldsWithCondition, Some(condition)) => {
                format!("{words}: {}{deviation}", condition.only)
            }
            _ => format!("{words}{deviation}"),
        }
    }

    /// The measured number with its interval and unit.
    pub fn measured(&self) -> String {
        let number = self.number.shown(self.claim.digits);
        match self.claim.unit.as_str() {
            "" => number,
            unit => format!("{number} {unit}"),
        }
    }
}

/// Number of claims with each verdict: holds, holds with a condition, does not hold.
pub(super) fn count_verdicts(results: &[ClaimResult]) -> [usize; 3] {
    [Verdict::Holds, Verdict::HoldsWithCondition, Verdict::DoesNotHold]
        .map(|verdict| results.iter().filter(|result| result.verdict == verdict).count())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(within: [f64; 2], condition: Option<[f64; 2]>) -> Claim {
        Claim {
            number: 1,
            place: "3.1".to_owned(),
            claim: "it is so".to_owned(),
            measured: "how much".to_owned(),
            quantity: "fig99.main".to_owned(),
            unit: String::new(),
            digits: 2,
            within,
            condition: condition.map(|within| Condition {
                quantity: "fig99.other".to_owned(),
                within,
                only: "on Sundays".to_owned(),
            }),
            expected: Verdict::Holds,
            deviation: None,
            remark: String::new(),
            reduced: true,
        }
    }

    fn verdict(claim: Claim, main: f64, other: f64) -> Verdict {
        let numbers = [("fig99.main", main), ("fig99.other", other)];
        let numbers = numbers.map(|(name, value)| (name.to_owned(), Number::exact(value)));
        claim.judge(&BTreeMap::from(numbers)).unwrap().verdict
    }

    #[test]
    fn a_claim_holds_if_its_number_is_within_bounds() {
        assert_eq!(verdict(claim([0.0, 1.0], None), 1.0, 9.0), Verdict::Holds);
        assert_eq!(verdict(claim([0.0, 1.0], None), 1.001, 9.0), Verdict::DoesNotHold);
        // A claim whose number could not be measured does not hold.
        assert_eq!(
            verdict(claim([0.0, f64::INFINITY], None), f64::NAN, 9.0),
            Verdict::DoesNotHold
        );
    }

    #[test]
    fn a_condition_restricts_a_claim_that_holds_and_saves_none_that_does_not() {
        let conditioned = || claim([0.0, 1.0], Some([0.0, 1.0]));
        assert_eq!(verdict(conditioned(), 0.5, 0.5), Verdict::Holds);
        assert_eq!(verdict(conditioned(), 0.5, 2.0), Verdict::HoldsWithCondition);
        assert_eq!(verdict(conditioned(), 2.0, 0.5), Verdict::DoesNotHold);
    }

    #[test]
    fn another_verdict_than_the_expected_one_is_noticed() {
        let result = |value| {
            let numbers = BTreeMap::from([("fig99.main".to_owned(), Number::exact(value))]);
            claim([0.0, 1.0], None).judge(&numbers).unwrap()
        };
        assert!(result(0.5).as_expected() && !result(2.0).as_expected());
    }

    #[test]
    fn a_claim_about_nothing_measured_is_refused() {
        let error = claim([0.0, 1.0], None)
            .judge(&BTreeMap::new())
            .unwrap_err()
            .to_string();
        assert_eq!(error, "claim 1 is about `fig99.main`, which is not measured");
    }

    #[test]
    fn the_list_of_claims_is_complete() {
        let claims = claims().unwrap();
        assert!(claims.len() >= 30);
        for (index, claim) in claims.iter().enumerate() {
            assert_eq!(claim.number as usize, index + 1);
            assert!(
                crate::figures::FIGURES
                    .iter()
                    .any(|figure| figure.name == claim.figure()),
                "{}",
                claim.quantity
            );
            assert!(claim.within[0] <= claim.within[1], "claim {}", claim.number);
            // A claim that fails, or holds with a condition only, needs a reason.
            let reasoned = claim.deviation.is_some() || claim.condition.is_some() || !claim.remark.is_empty();
            assert!(
                claim.expected == Verdict::Holds || reasoned,
                "claim {}",
                claim.number
            );
            assert_eq!(
                claim.expected == Verdict::HoldsWithCondition,
                claim.condition.is_some(),
                "claim {}",
                claim.number
            );
        }
    }
}
