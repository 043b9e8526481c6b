//! The claims of the paper, read from `cases/claims.toml` of this crate and judged by the numbers of the
//! figures.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::embedded_cases::CLAIMS;
use crate::error::PaperError;
use crate::number::MeasuredNumber;

/// Text on gaps in the numbers of claims.
pub(super) const NUMBERING: &str = "Claims keep their numbers. 2 and 62 are not used, because the paper does not make these claims. \
                                    Claims from 82 on were found later and are listed in the order of the paper.";
/// Text on the meaning of [`Claim::revised`].
pub(super) const REVISED: &str = "\u{201c}Revised\u{201d} marks a claim with a wording or criterion that was fixed only after a measurement. Such a claim counts as \
                                  not reproduced as stated; the measured number supports the part of the claim that holds.";

/// A claim of the paper, and the rule that decides on it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Number of the claim.
    pub number: u32,
    /// Place in the paper: section, then figure, table or equation.
    pub place: String,
    /// Content of the claim, in other words than the paper's.
    pub claim: String,
    /// Description of the number that was measured.
    pub measured: String,
    /// Name of the number that was measured: `figure.number`.
    pub quantity: String,
    /// Unit of the number; may be empty.
    #[serde(default)]
    pub unit: String,
    /// Number of decimal places of the printed number.
    #[serde(default = "three")]
    pub digits: usize,
    /// Bounds of the number within which the claim holds, ends included.
    pub within: [f64; 2],
    /// A second number: if it is out of its bounds, the claim holds only under the condition in its words.
    pub condition: Option<Reading>,
    /// The number after the correction of a misprint. If it is within its bounds, a claim that does not hold
    /// as printed counts as a misprint; the words give the correction.
    pub correction: Option<Reading>,
    /// Expected verdict; another one points to a fault of the program or to a change of the model.
    pub expected: ClaimVerdict,
    /// Number of the deviation from the paper's print (D1 to D12) that explains the verdict.
    pub deviation: Option<String>,
    /// A remark for the reader; may be empty.
    #[serde(default)]
    pub remark: String,
    /// Part of the claim's wording or criterion that was fixed only after a measurement, and that
    /// measurement; empty if there is none. A claim with such a part counts as [`ClaimVerdict::NotAsStated`],
    /// not as one that holds.
    #[serde(default)]
    pub revised: String,
    /// Whether two surfaces and one time step are enough to judge the claim.
    #[serde(default = "yes")]
    pub reduced: bool,
}

/// An alternative reading of a claim.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reading {
    /// Name of the number that decides.
    pub quantity: String,
    /// Bounds of the number within which this reading holds, ends included.
    pub within: [f64; 2],
    /// The condition or the correction.
    pub words: String,
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
pub enum ClaimVerdict {
    /// The claim holds.
    Holds,
    /// The claim holds under a condition that the paper does not state.
    HoldsWithCondition,
    /// The claim was not reproduced by the criterion that was fixed before measuring; a part of it holds by a
    /// criterion that was fixed afterwards.
    NotAsStated,
    /// The claim does not hold as printed, but does after the correction of an error in print or algebra.
    Misprint,
    /// The claim does not hold.
    DoesNotHold,
}

impl ClaimVerdict {
    /// All verdicts, in the order in which they are counted.
    pub const ALL: [Self; 5] = [
        Self::Holds,
        Self::HoldsWithCondition,
        Self::NotAsStated,
        Self::Misprint,
        Self::DoesNotHold,
    ];

    /// The verdict in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsWithCondition => "holds with a condition",
            Self::NotAsStated => "not reproduced as stated",
            Self::Misprint => "misprint or slip of algebra",
            Self::DoesNotHold => "does not hold",
        }
    }

    /// Number of claims with the verdict, as a part of a sentence about claims.
    pub fn counted(self, count: usize) -> String {
        let (one, several) = match self {
            Self::Holds => ("holds", "hold"),
            Self::HoldsWithCondition => ("holds with a condition", "hold with a condition"),
            Self::NotAsStated => ("is not reproduced as stated", "are not reproduced as stated"),
            Self::Misprint => (
                "is a misprint or slip of algebra",
                "are misprints or slips of algebra",
            ),
            Self::DoesNotHold => ("does not hold", "do not hold"),
        };
        format!("{count} {}", if count == 1 { one } else { several })
    }
}

/// A claim, its measured number, and the verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimResult {
    /// The claim.
    pub claim: Claim,
    /// The measured number.
    pub number: MeasuredNumber,
    /// Verdict on the claim.
    pub verdict: ClaimVerdict,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    claim: Vec<Claim>,
}

/// All claims, in order.
///
/// # Errors
/// When the file is not a list of claims.
pub fn claims() -> Result<Vec<Claim>, PaperError> {
    let list: List = toml::from_str(CLAIMS)?;
    Ok(list.claim)
}

impl Claim {
    /// The figure that measures the claim.
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

    /// Judges the claim by the measured numbers.
    ///
    /// # Errors
    /// [`PaperError::Unmeasured`] when the claim's number is not among them.
    pub fn judge(self, numbers: &BTreeMap<String, MeasuredNumber>) -> Result<ClaimResult, PaperError> {
        let measured = |quantity: &String| {
            let number = numbers.get(quantity).copied();
            number.ok_or_else(|| PaperError::Unmeasured {
                number: self.number,
                quantity: quantity.clone(),
            })
        };
        let inside = |number: &MeasuredNumber, [low, high]: [f64; 2]| (low..=high).contains(&number.value);
        let holds_by = |reading: &Option<Reading>| -> Result<Option<bool>, PaperError> {
            let Some(reading) = reading else {
                return Ok(None);
            };
            Ok(Some(inside(&measured(&reading.quantity)?, reading.within)))
        };
        let number = measured(&self.quantity)?;
        let (general, corrected) = (holds_by(&self.condition)?, holds_by(&self.correction)?);
        let verdict = match (inside(&number, self.within), general, corrected) {
            (true, ..) if !self.revised.is_empty() => ClaimVerdict::NotAsStated,
            (true, Some(false), _) => ClaimVerdict::HoldsWithCondition,
            (true, ..) => ClaimVerdict::Holds,
            (false, _, Some(true)) => ClaimVerdict::Misprint,
            (false, ..) => ClaimVerdict::DoesNotHold,
        };
        Ok(ClaimResult {
            claim: self,
            number,
            verdict,
        })
    }
}

impl ClaimResult {
    /// Whether the verdict is the expected one.
    pub fn as_expected(&self) -> bool {
        self.verdict == self.claim.expected
    }

    /// The verdict in words, with the condition, the correction and the deviation that explain it.
    pub(super) fn verdict_in_full(&self) -> String {
        let words = self.verdict.words();
        let deviation = self.claim.deviation_in_brackets();
        let claim = &self.claim;
        let words_of = |reading: &Option<Reading>| reading.as_ref().map(|reading| reading.words.clone());
        let why = match self.verdict {
            ClaimVerdict::HoldsWithCondition => words_of(&claim.condition),
            ClaimVerdict::NotAsStated => {
                let condition =
                    words_of(&claim.condition).unwrap_or_else(|| "by the present criterion".to_owned());
                Some(format!("it holds {condition}"))
            }
            ClaimVerdict::Misprint => words_of(&claim.correction),
            ClaimVerdict::Holds | ClaimVerdict::DoesNotHold => None,
        };
        let why = why.map_or(String::new(), |why| format!(": {why}"));
        format!("{words}{why}{deviation}")
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

/// Number of claims with each verdict, as a sentence.
pub(super) fn tally(verdicts: &[ClaimVerdict]) -> String {
    let counted = ClaimVerdict::ALL
        .map(|verdict| verdict.counted(verdicts.iter().filter(|&&other| other == verdict).count()));
    format!("{} claims: {}", verdicts.len(), counted.join(", "))
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
            condition: condition.map(other),
            correction: None,
            expected: ClaimVerdict::Holds,
            deviation: None,
            remark: String::new(),
            revised: String::new(),
            reduced: true,
        }
    }

    fn other(within: [f64; 2]) -> Reading {
        Reading {
            quantity: "fig99.other".to_owned(),
            within,
            words: "on Sundays".to_owned(),
        }
    }

    fn verdict(claim: Claim, main: f64, other: f64) -> ClaimVerdict {
        let numbers = [("fig99.main", main), ("fig99.other", other)];
        let numbers = numbers.map(|(name, value)| (name.to_owned(), MeasuredNumber::exact(value)));
        claim.judge(&BTreeMap::from(numbers)).unwrap().verdict
    }

    #[test]
    fn a_claim_holds_if_its_number_is_within_bounds() {
        assert_eq!(verdict(claim([0.0, 1.0], None), 1.0, 9.0), ClaimVerdict::Holds);
        assert_eq!(
            verdict(claim([0.0, 1.0], None), 1.001, 9.0),
            ClaimVerdict::DoesNotHold
        );
        // A claim does not hold if its number could not be measured.
        assert_eq!(
            verdict(claim([0.0, f64::INFINITY], None), f64::NAN, 9.0),
            ClaimVerdict::DoesNotHold
        );
    }

    #[test]
    fn a_condition_restricts_a_claim_that_holds_and_saves_none_that_does_not() {
        let conditioned = || claim([0.0, 1.0], Some([0.0, 1.0]));
        assert_eq!(verdict(conditioned(), 0.5, 0.5), ClaimVerdict::Holds);
        assert_eq!(verdict(conditioned(), 0.5, 2.0), ClaimVerdict::HoldsWithCondition);
        assert_eq!(verdict(conditioned(), 2.0, 0.5), ClaimVerdict::DoesNotHold);
    }

    #[test]
    fn a_claim_that_fails_as_printed_is_a_misprint_if_it_holds_corrected() {
        let corrected = || Claim {
            correction: Some(other([0.0, 1.0])),
            ..claim([0.0, 1.0], None)
        };
        assert_eq!(verdict(corrected(), 2.0, 0.5), ClaimVerdict::Misprint);
        assert_eq!(verdict(corrected(), 2.0, 2.0), ClaimVerdict::DoesNotHold);
        assert_eq!(verdict(corrected(), 0.5, 2.0), ClaimVerdict::Holds);
        let numbers = [("fig99.main", 2.0), ("fig99.other", 0.5)];
        let numbers = numbers.map(|(name, value)| (name.to_owned(), MeasuredNumber::exact(value)));
        let result = corrected().judge(&BTreeMap::from(numbers)).unwrap();
        assert_eq!(
            result.verdict_in_full(),
            "misprint or slip of algebra: on Sundays"
        );
    }

    #[test]
    fn a_claim_whose_criterion_was_settled_after_measuring_is_not_reproduced_as_stated() {
        let revised = |condition| Claim {
            revised: "First at least 2.".to_owned(),
            ..claim([0.0, 1.0], condition)
        };
        for (condition, other) in [(None, 0.5), (Some([0.0, 1.0]), 0.5), (Some([0.0, 1.0]), 2.0)] {
            assert_eq!(verdict(revised(condition), 0.5, other), ClaimVerdict::NotAsStated);
            assert_eq!(verdict(revised(condition), 2.0, other), ClaimVerdict::DoesNotHold);
        }
        let verdict_with = |condition| {
            let numbers = [("fig99.main", 0.5), ("fig99.other", 2.0)];
            let numbers = numbers.map(|(name, value)| (name.to_owned(), MeasuredNumber::exact(value)));
            let result = revised(condition).judge(&BTreeMap::from(numbers)).unwrap();
            result.verdict_in_full()
        };
        assert_eq!(
            verdict_with(Some([0.0, 1.0])),
            "not reproduced as stated: it holds on Sundays"
        );
        assert_eq!(
            verdict_with(None),
            "not reproduced as stated: it holds by the present criterion"
        );
    }

    #[test]
    fn verdicts_are_counted_by_class() {
        let verdicts = [
            ClaimVerdict::DoesNotHold,
            ClaimVerdict::Misprint,
            ClaimVerdict::Misprint,
        ];
        assert_eq!(
            tally(&verdicts),
            "3 claims: 0 hold, 0 hold with a condition, 0 are not reproduced as stated, 2 are misprints or slips of algebra, 1 does not hold"
        );
    }

    #[test]
    fn another_verdict_than_the_expected_one_is_noticed() {
        let result = |value| {
            let numbers = BTreeMap::from([("fig99.main".to_owned(), MeasuredNumber::exact(value))]);
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
        assert_eq!(error, "claim 1 needs `fig99.main`, which no figure measures");
    }

    #[test]
    fn the_list_of_claims_is_complete() {
        let claims = claims().unwrap();
        let mut numbers: Vec<u32> = claims.iter().map(|claim| claim.number).collect();
        // The claims of the first list are in its order.
        assert!(numbers.iter().filter(|&&number| number <= 81).is_sorted());
        numbers.sort_unstable();
        let last = numbers[numbers.len() - 1];
        let unused: Vec<u32> = (1..=last).filter(|number| !numbers.contains(number)).collect();
        assert_eq!(unused, [2, 62]);
        assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]), "{numbers:?}");
        // The history of the list shows that these claims were worded or changed after measuring, so the list
        // must say so.
        let reworded = [16, 38, 40, 46, 51, 56, 58, 80, 81];
        for claim in claims.iter().filter(|claim| reworded.contains(&claim.number)) {
            assert!(!claim.revised.is_empty(), "claim {}", claim.number);
        }
        for claim in &claims {
            assert!(
                crate::figures::FIGURES
                    .iter()
                    .any(|figure| figure.name == claim.figure()),
                "{}",
                claim.quantity
            );
            assert!(claim.within[0] <= claim.within[1], "claim {}", claim.number);
            // A claim that fails, or holds only under a condition, needs a reason.
            let is_revised = !claim.revised.is_empty();
            let reasoned = claim.deviation.is_some()
                || claim.condition.is_some()
                || is_revised
                || !claim.remark.is_empty();
            assert!(
                claim.expected == ClaimVerdict::Holds || reasoned,
                "claim {}",
                claim.number
            );
            assert_eq!(
                claim.expected == ClaimVerdict::HoldsWithCondition,
                claim.condition.is_some() && !is_revised,
                "claim {}",
                claim.number
            );
            // A claim with a criterion that was changed after its measurement must not count as holding.
            let holds = [ClaimVerdict::Holds, ClaimVerdict::HoldsWithCondition].contains(&claim.expected);
            assert!(!(is_revised && holds), "claim {}", claim.number);
            assert_eq!(
                claim.expected == ClaimVerdict::Misprint,
                claim.correction.is_some(),
                "claim {}",
                claim.number
            );
        }
    }
}
