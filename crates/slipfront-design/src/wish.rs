//! The wish of a design, and the distance of a texture from it.

use serde::de::IntoDeserializer;
use serde::de::value::Error as ValueError;
use serde::{Deserialize, Serialize};
use slipfront_base::number_format::{four_digits, si_prefix, with_half_width};
use slipfront_case::case_file::names_of;
use slipfront_run::summary::Summary;
use slipfront_study::statistics::mean;

use crate::mean::Mean;

/// Largest distance from a value that is not reported as missed, %.
const MISSED_PERCENT: f64 = 0.5;

/// A number of a run that a wish is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// The largest mu* up to a stated time.
    StaticFriction,
    /// Kinetic friction mu_k*.
    KineticFriction,
    /// The largest mu* minus mu_k*.
    FrictionDrop,
}

/// A wish.
#[derive(Clone, Debug, PartialEq)]
pub enum Wish {
    /// The least value of a quantity.
    Least(Quantity),
    /// The largest value of a quantity.
    Largest(Quantity),
    /// A value of a quantity.
    Value(Target),
    /// A whole curve: mu* at times t* of the drive, both in the order of time.
    Curve(Vec<[f64; 2]>),
}

/// A target value of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Quantity that should have the value.
    pub quantity: Quantity,
    /// The value, in units of mu_s.
    pub star: f64,
    /// Largest distance from the value at which a part is good, in units of mu_s; none without a tolerance.
    pub tolerance_star: Option<f64>,
    /// Unit of the wish.
    pub unit: FrictionUnit,
}

/// Unit of friction in the wish and in the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrictionUnit {
    /// One mu_s in this unit.
    pub mu_s: f64,
    /// Suffix for the unit after a number, such as ` mN`; empty for a coefficient.
    pub name: String,
}

impl FrictionUnit {
    /// Coefficients of friction, where the mean static one is `mu_s`.
    pub fn coefficient(mu_s: f64) -> Self {
        Self {
            mu_s,
            name: String::new(),
        }
    }

    /// Shares of mu_s.
    pub fn share() -> Self {
        Self {
            mu_s: 1.0,
            name: " mu_s".to_owned(),
        }
    }

    /// Forces of the order of `force` in N, where mu_s corresponds to the force `of_mu_s`.
    pub fn force(force: f64, of_mu_s: f64) -> Self {
        let (factor, prefix) = si_prefix(force);
        Self {
            mu_s: of_mu_s / factor,
            name: format!(" {prefix}N"),
        }
    }

    /// A number in units of mu_s, converted to this unit, as text.
    pub(crate) fn text(&self, star: f64) -> String {
        four_digits(star * self.mu_s) + &self.name
    }

    /// A standard deviation in units of mu_s, converted to this unit, to two digits, as text.
    pub(crate) fn scatter_text(&self, star: f64) -> String {
        let scatter = star * self.mu_s;
        let digits = (1.0 - libm::floor(libm::log10(scatter))).clamp(0.0, 12.0);
        format!("{scatter:.0$}{1}", digits as usize, self.name)
    }

    /// A mean in units of mu_s with its interval, converted to this unit, as text.
    pub(crate) fn mean_text(&self, mean: &Mean) -> String {
        let half_width = mean.half_width.map(|half| half * self.mu_s);
        with_half_width(mean.mean * self.mu_s, half_width) + &self.name
    }
}

/// Numbers of a run that determine the loss of a design.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The largest mu* of the run.
    pub(crate) largest_star: f64,
    /// Static friction mu_s*: the first peak of the run.
    pub(crate) first_peak_star: f64,
    /// Kinetic friction mu_k*, if the run is long enough.
    pub(crate) kinetic_star: Option<f64>,
    /// Root mean square difference of mu* from the curve of the wish, if it has one.
    pub(crate) misfit: Option<f64>,
}

impl Measured {
    /// The numbers from a summary.
    pub(crate) fn from_summary(summary: &Summary) -> Self {
        Self {
            largest_star: summary.mu_star_max,
            first_peak_star: summary.static_friction_star,
            kinetic_star: summary.kinetic_friction_star,
            misfit: None,
        }
    }

    /// A quantity; NaN if the run does not have it.
    pub(crate) fn get(&self, quantity: Quantity) -> f64 {
        let kinetic = || self.kinetic_star.unwrap_or(f64::NAN);
        match quantity {
            Quantity::StaticFriction => self.largest_star,
            Quantity::KineticFriction => kinetic(),
            Quantity::FrictionDrop => self.largest_star - kinetic(),
        }
    }
}

impl Quantity {
    /// The quantity of this name in a design file, such as `static_friction`.
    ///
    /// # Errors
    /// A list of the valid names, as the end of a sentence.
    pub(crate) fn of_name(name: &str) -> Result<Self, String> {
        let found: Result<Self, ValueError> = Self::deserialize(name.into_deserializer());
        found.map_err(|_| match names_of::<Self>() {
            [others @ .., last] => format!("{} or {last}", others.join(", ")),
            [] => String::new(),
        })
    }

    /// Name of the quantity in a sentence.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::StaticFriction => "static friction",
            Self::KineticFriction => "kinetic friction",
            Self::FrictionDrop => "drop of friction",
        }
    }
}

impl Wish {
    /// The quantity of the wish; static friction for a curve.
    pub fn quantity(&self) -> Quantity {
        match self {
            Self::Least(quantity) | Self::Largest(quantity) => *quantity,
            Self::Value(target) => target.quantity,
            Self::Curve(_) => Quantity::StaticFriction,
        }
    }

    /// Whether runs must last until sliding is steady.
    pub fn needs_sliding(&self) -> bool {
        self.quantity() != Quantity::StaticFriction
    }

    /// The wish for a drive that takes `times` times as long for the same path as the drive of this wish.
    pub(crate) fn with_times(&self, times: f64) -> Self {
        match self {
            Self::Curve(points) => Self::Curve(points.iter().map(|[time, mu]| [time * times, *mu]).collect()),
            other => other.clone(),
        }
    }

    /// Whether textures are compared with the slider without texture.
    pub(crate) fn is_relative(&self) -> bool {
        matches!(self, Self::Least(_) | Self::Largest(_))
    }

    /// Deviation of a run with a texture from the wish. `without` is the run on the same surface without
    /// texture, for a wish that [is relative](Self::is_relative):
    ///
    /// ```text
    /// least  q/q_0;   largest  -q/q_0;   value  q/q_wanted - 1;   curve  root of the mean square of the differences of mu*
    /// ```
    ///
    /// # Errors
    /// A sentence, when a run does not have the quantity, or the run without texture has no value to compare
    /// with.
    pub(crate) fn deviation(&self, with: &Measured, without: Option<&Measured>) -> Result<f64, String> {
        let quantity = self.quantity();
        let reference = without.map_or(f64::NAN, |without| without.get(quantity));
        let deviation = match self {
            Self::Least(_) => with.get(quantity) / reference,
            Self::Largest(_) => -with.get(quantity) / reference,
            Self::Value(target) => with.get(quantity) / target.star - 1.0,
            Self::Curve(_) => with.misfit.unwrap_or(f64::NAN),
        };
        if deviation.is_finite() {
            return Ok(deviation);
        }
        let is_measured = |found: &Measured| found.get(quantity).is_finite();
        Err(if is_measured(with) && without.is_none_or(is_measured) {
            format!(
                "the {} of the untextured slider is 0, so a comparison is not possible: give a target value, or another quantity",
                quantity.name()
            )
        } else {
            "the run has no kinetic friction: no block slips, or the run ends before the kinetic window begins; increase \
             `time.duration_star` or reduce `time.kinetic_from_star`"
                .to_owned()
        })
    }

    /// The loss for deviations on several surfaces, the lower the better: their mean; for a wish for a value,
    /// the magnitude of their mean; with a tolerance, their root mean square.
    ///
    /// Parts are within a tolerance if bias and scatter are both small. The mean square contains both:
    /// `bias^2 + deviation^2`. It is smooth, so a search can rank two drafts even if no part of either is
    /// within the tolerance; the share of parts within the tolerance could not.
    pub(crate) fn loss(&self, deviations: &[f64]) -> f64 {
        match self {
            Self::Value(target) if target.tolerance_star.is_some() => {
                mean(&deviations.iter().map(|d| d * d).collect::<Vec<_>>()).sqrt()
            }
            Self::Value(_) => mean(deviations).abs(),
            _ => mean(deviations),
        }
    }

    /// Contributions of the deviations to the [loss](Self::loss): their mean is the loss, and their scatter
    /// gives its uncertainty. The root of the mean square is linearised in the squares around their mean.
    pub(crate) fn parts_of_loss(&self, deviations: &[f64]) -> Vec<f64> {
        let loss = self.loss(deviations);
        match self {
            Self::Value(target) if target.tolerance_star.is_some() => {
                let part = |d: &f64| {
                    if loss == 0.0 {
                        0.0
                    } else {
                        0.5 * (loss + d * d / loss)
                    }
                };
                deviations.iter().map(part).collect()
            }
            Self::Value(_) if mean(deviations) < 0.0 => deviations.iter().map(|d| -d).collect(),
            _ => deviations.to_vec(),
        }
    }

    /// Whether a deviation is within the tolerance of the wish; none without a tolerance.
    pub(crate) fn is_within(&self, deviation: f64) -> Option<bool> {
        match self {
            Self::Value(target) => {
                let tolerance = target.tolerance_star?;
                Some((deviation * target.star).abs() <= tolerance)
            }
            _ => None,
        }
    }

    /// The tolerance of the wish in its unit, as text.
    pub(crate) fn tolerance_text(&self) -> Option<String> {
        match self {
            Self::Value(target) => Some(target.unit.text(target.tolerance_star?)),
            _ => None,
        }
    }

    /// A loss as reported: a reduction or a rise in %, the distance from a value in %, or the distance from a
    /// curve.
    pub(crate) fn reported_loss(&self, loss: f64) -> f64 {
        match self {
            Self::Least(_) => self.reported_difference(1.0 - loss),
            Self::Largest(_) => self.reported_difference(-loss - 1.0),
            Self::Value(..) | Self::Curve(_) => self.reported_difference(loss),
        }
    }

    /// Name of the loss as reported.
    pub(crate) fn loss_name(&self) -> &'static str {
        match self {
            Self::Least(_) => "reduction",
            Self::Largest(_) => "rise",
            Self::Value(target) if target.tolerance_star.is_some() => "RMS distance from the value",
            Self::Value(_) => "distance from the value",
            Self::Curve(_) => "RMS distance from the curve",
        }
    }

    /// Unit of the loss as reported.
    pub(crate) fn loss_unit(&self) -> &'static str {
        match self {
            Self::Curve(_) => "",
            _ => " %",
        }
    }

    /// A sentence on the loss of a design as reported, with half the width of its interval. `found` is the
    /// quantity of the design if there is one case, and empty for several.
    pub(crate) fn headline(&self, loss: f64, half_width: Option<f64>, found: &str) -> String {
        let of = self.quantity().name();
        match self {
            Self::Least(_) | Self::Largest(_) => format!(
                "{} of {of}: {}{} relative to the untextured slider",
                self.loss_name(),
                with_half_width(loss, half_width),
                self.loss_unit()
            ),
            Self::Value(..) if found.is_empty() => {
                format!(
                    "target value of {of}: {} % difference over the cases",
                    four_digits(loss)
                )
            }
            Self::Value(target) => {
                let root = if target.tolerance_star.is_some() {
                    " in the root of the mean square"
                } else {
                    ""
                };
                format!(
                    "target {of} of {}: result {found}, {} % difference{root}",
                    target.unit.text(target.star),
                    four_digits(loss)
                )
            }
            Self::Curve(_) => format!("target curve: rms difference of {} in mu*", four_digits(loss)),
        }
    }

    /// The end of the headline for a design that misses its wish.
    pub(crate) fn missed(&self, loss: f64) -> &'static str {
        match self {
            Self::Value(target) if target.tolerance_star.is_none() && loss > MISSED_PERCENT => {
                ". The value cannot be reached within these limits, or by this search: give more runs, or wider limits"
            }
            _ => "",
        }
    }

    /// A difference of losses as reported: in percentage points; unchanged for a curve.
    pub(crate) fn reported_difference(&self, difference: f64) -> f64 {
        match self {
            Self::Curve(_) => difference,
            _ => 100.0 * difference,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(star: f64, tolerance_star: Option<f64>) -> Wish {
        Wish::Value(Target {
            quantity: Quantity::StaticFriction,
            star,
            tolerance_star,
            unit: FrictionUnit::share(),
        })
    }

    /// Three parts lie 0.1 below, 0.1 above and 0.2 above a value of 2; their deviations are half as large.
    #[test]
    fn a_tolerance_counts_parts_and_takes_squares() {
        let deviations = [-0.05, 0.05, 0.1];
        let tolerant = value(2.0, Some(0.15));
        let squares: f64 = (0.0025 + 0.0025 + 0.01) / 3.0;
        assert!((tolerant.loss(&deviations) - squares.sqrt()).abs() < 1e-15);
        assert_eq!(value(2.0, None).loss(&deviations), mean(&deviations));
        let parts = tolerant.parts_of_loss(&deviations);
        assert!((mean(&parts) - squares.sqrt()).abs() < 1e-15);
        // For a small change of the deviations, the root mean square changes as the mean of the contributions
        // does.
        let step = 1e-6;
        let moved = tolerant.loss(&[-0.05, 0.05, 0.1 + step]) - tolerant.loss(&deviations);
        let slope = 0.1 * 2.0 * step / 3.0 / (2.0 * squares.sqrt());
        assert!((moved / slope - 1.0).abs() < 1e-4);
        assert_eq!(
            deviations.map(|d| tolerant.is_within(d)),
            [Some(true), Some(true), Some(false)]
        );
        assert_eq!(value(2.0, None).is_within(0.0), None);
        assert_eq!(tolerant.parts_of_loss(&[0.0, 0.0]), [0.0, 0.0]);
    }

    #[test]
    fn friction_is_told_in_the_unit_of_the_wish() {
        let force = FrictionUnit::force(0.012, 0.04);
        assert_eq!(force.text(0.3), "12 mN");
        assert_eq!(force.scatter_text(0.000_123), "0.0049 mN");
        assert_eq!(FrictionUnit::share().text(0.3), "0.3 mu_s");
        assert_eq!(FrictionUnit::coefficient(0.5).text(0.6), "0.3");
    }

    #[test]
    fn losses_are_what_they_are_called() {
        let run = |largest_star: f64, kinetic_star: f64| Measured {
            largest_star,
            first_peak_star: 0.0,
            kinetic_star: Some(kinetic_star),
            misfit: Some(0.25),
        };
        let (with, without) = (run(0.75, 0.5), run(1.0, 0.25));
        let reported =
            |wish: Wish| wish.reported_loss(wish.loss(&[wish.deviation(&with, Some(&without)).unwrap()]));
        assert_eq!(reported(Wish::Least(Quantity::StaticFriction)), 25.0);
        assert_eq!(reported(Wish::Largest(Quantity::StaticFriction)), -25.0);
        assert_eq!(reported(Wish::Largest(Quantity::KineticFriction)), 100.0);
        assert_eq!(
            reported(Wish::Least(Quantity::FrictionDrop)),
            100.0 * (1.0 - 0.25 / 0.75)
        );
        assert_eq!(reported(value(1.5, None)), 50.0);
        assert_eq!(reported(value(0.5, None)), 50.0);
        assert_eq!(reported(value(0.5, Some(0.1))), 50.0);
        assert_eq!(reported(Wish::Curve(Vec::new())), 0.25);
        let short = Measured {
            kinetic_star: None,
            ..with.clone()
        };
        let least = Wish::Least(Quantity::KineticFriction);
        for (with, without) in [(&short, &with), (&with, &short)] {
            let said = least.deviation(with, Some(without)).unwrap_err();
            assert!(said.contains("increase `time.duration_star`"), "{said}");
        }
        let slipless = run(1.0, 0.0);
        let said = least.deviation(&with, Some(&slipless)).unwrap_err();
        assert!(
            said.contains("kinetic friction of the untextured slider is 0"),
            "{said}"
        );
        // A curve at half the speed takes twice the time.
        let slower = Wish::Curve(vec![[1.0, 0.5]]).with_times(2.0);
        assert_eq!(slower, Wish::Curve(vec![[2.0, 0.5]]));
    }
}
