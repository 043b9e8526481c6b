//! Tests of whether the model can have made the records, and their results in words.

use serde::Serialize;
use slipfront_base::number_format::four_digits;

use crate::clipping::Clipped;
use crate::closest::Closest;
use crate::misfit::Misfit;
use crate::predicted::Comparison;

/// Tests of whether the model can have made the records.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordCheck {
    /// Values at the end of the range of a sensor, if the file has no range.
    pub clipped: Option<Clipped>,
    /// Comparison of the records with the training runs.
    pub misfit: Misfit,
    /// Comparison of the records with runs of the calibrated model.
    pub comparison: Comparison,
    /// The closest curve, if the unknowns determine it.
    pub closest: Option<Closest>,
}

impl RecordCheck {
    /// Whether the model cannot have made the records.
    pub fn is_refused(&self) -> bool {
        self.clipped.is_some()
            || self.misfit.is_refused()
            || self.comparison.is_refused()
            || self.closest.is_some_and(|closest| closest.is_refused())
    }

    /// Reasons why the model cannot have made the records; empty if it can.
    pub fn reasons(&self) -> Vec<String> {
        let mut reasons = Vec::new();
        if let Some(clipped) = &self.clipped {
            reasons.push(format!(
                "{} values of record {}, {} % of them, are exactly equal to its maximum, as for a saturated sensor: set `range` \
                 in [instrument]",
                clipped.values,
                clipped.record + 1,
                four_digits(100.0 * clipped.share)
            ));
        }
        let [low, high] = self.misfit.drift;
        if self.misfit.has_drift {
            let [low, high] = [low, high].map(|drift| four_digits(100.0 * drift));
            reasons.push(format!("friction drifts by {low} to {high} % over the records"));
        }
        if self.misfit.distance > 1.0 {
            reasons.push(format!(
                "their distance from the training runs is {} times the distance that contains 99.5 % of these runs",
                four_digits(self.misfit.distance)
            ));
        }
        reasons.extend(
            self.closest
                .filter(Closest::is_refused)
                .map(|closest| differences(&closest)),
        );
        if self.comparison.is_refused() {
            let names = self.comparison.differs_in.iter().take(2).map(|(name, _)| *name);
            reasons.push(format!(
                "they differ from runs of the calibrated model, most in {}",
                names.collect::<Vec<_>>().join(" and ")
            ));
        }
        if self.misfit.is_outside() {
            let [level, low, high] = self.misfit.level;
            let (which, of) = if level > high {
                ("largest", high)
            } else {
                ("least", low)
            };
            reasons.push(format!(
                "mean friction in the second half of a record is {} times the {which} of the training runs",
                four_digits(level / of)
            ));
        }
        reasons
    }
}

/// The residuals from the closest curve, in words.
fn differences(closest: &Closest) -> String {
    let part = match closest.share {
        1.0 => String::new(),
        share => format!(" over the first {} of the records", one_over(share)),
    };
    let size = format!(
        "the closest curve{} differs{part} by {:.1} times the noise",
        at_step(closest),
        closest.noise_ratio
    );
    if closest.is_correlated() {
        format!(
            "{size}, and neighbouring values differ in the same way (correlation {:.2}, of white noise less than {:.2})",
            closest.correlation, closest.most_correlated
        )
    } else {
        size
    }
}

/// The time step of the closest curve, in words, if it is finer than that of the case.
pub(crate) fn at_step(closest: &Closest) -> String {
    match closest.halvings {
        0 => String::new(),
        halvings => format!(", at 1/{} of the time step,", 1_u32 << halvings),
    }
}

/// A share such as 1/8.
fn one_over(share: f64) -> String {
    format!("1/{}", (1.0 / share).round())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Results for records that the model has made.
    fn passed() -> RecordCheck {
        RecordCheck {
            clipped: None,
            misfit: Misfit {
                drift: [-0.01, 0.02],
                has_drift: false,
                distance: 0.5,
                level: [2.0, 1.0, 3.0],
            },
            comparison: Comparison {
                rank: 0.6,
                distance: 0.9,
                differs_in: vec![("spectrum", 1.2), ("slips", 1.0), ("levels", 0.7)],
            },
            closest: closest(1.01, 0.05, 1.0),
        }
    }

    fn closest(noise_ratio: f64, correlation: f64, share: f64) -> Option<Closest> {
        Some(Closest {
            noise_ratio,
            correlation,
            most_correlated: 0.2,
            share,
            halvings: 0,
        })
    }

    /// A refused record has a reason; an accepted one has none.
    #[test]
    fn every_refusal_has_its_reason() {
        assert!(!passed().is_refused() && passed().reasons().is_empty());
        let refuse = |change: fn(&mut RecordCheck), words: &str| {
            let mut check = passed();
            change(&mut check);
            let reasons = check.reasons();
            assert!(check.is_refused() && reasons.len() == 1, "{words}: {reasons:?}");
            assert!(reasons[0].contains(words), "{words}: {reasons:?}");
        };
        refuse(
            |check| {
                check.clipped = Some(Clipped {
                    record: 0,
                    values: 20,
                    share: 0.05,
                });
            },
            "20 values of record 1, 5 % of them, are exactly equal to its maximum",
        );
        refuse(
            |check| check.misfit.has_drift = true,
            "friction drifts by -1 to 2 %",
        );
        refuse(
            |check| check.misfit.distance = 3.0,
            "their distance from the training runs is 3 times",
        );
        refuse(
            |check| check.misfit.level = [9.0, 1.0, 3.0],
            "3 times the largest",
        );
        refuse(|check| check.comparison.rank = 0.0, "most in spectrum and slips");
        refuse(
            |check| check.closest = closest(2.0, 0.05, 0.25),
            "over the first 1/4 of the records by 2.0 times the noise",
        );
        refuse(
            |check| check.closest = closest(1.01, 0.5, 1.0),
            "(correlation 0.50, of white noise less than 0.20)",
        );
    }
}
