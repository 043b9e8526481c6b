//! The numbers of a summary by name, for tables and statistics, and the other columns of the tables.

use std::collections::HashMap;
use std::sync::LazyLock;

use serde_json::Value;

use slipfront_run::observers;
use slipfront_run::summary::{OF_KINETIC_WINDOW, OF_PEAK, Summary};

/// Reduction of mu_s* against the reference of the same seed, % (Eq. 16).
pub const REDUCTION: &str = "static_reduction_percent";

/// Entries of a summary that are not quantities: the first is a pair of numbers, and the mean of the second
/// has no meaning.
const NOT_QUANTITIES: [&str; 2] = ["kinetic_window_star", "seed"];

/// Whether a quantity exists only for runs with a transition.
pub(crate) fn needs_transition(name: &str) -> bool {
    name == REDUCTION || OF_PEAK.contains(&name)
}

/// Whether tables have the quantity of this name only if one of their runs has it.
pub(crate) fn is_optional(name: &str) -> bool {
    let optional = observers::quantities(&Summary::default());
    optional.iter().any(|(optional, _)| *optional == name)
}

/// Names of all numbers in the order of the summary, followed by those of observers that only some runs have,
/// and by the reduction.
pub fn known() -> &'static [String] {
    static KNOWN: LazyLock<Vec<String>> = LazyLock::new(|| {
        let names = named(&Summary::default()).into_iter().map(|(name, _)| name);
        names.chain([REDUCTION.to_owned()]).collect()
    });
    &KNOWN
}

/// Columns of `runs.csv` before those of the axes, and columns between the axes and the quantities.
pub(crate) const BEFORE_AXES: [&str; 3] = ["point", "replicate", "role"];
pub(crate) const AFTER_AXES: [&str; 4] = ["seed", "run", "status", "reason"];

/// Columns of `points.csv` after those of the axes.
pub(crate) const STATISTICS: [&str; 10] = [
    "quantity",
    "n",
    "mean",
    "deviation",
    "low",
    "high",
    "min",
    "max",
    "narrow_enough",
    "runs_without_transition",
];

/// Whether the tables already have a column of this name, so that an axis cannot use it.
pub fn is_column(name: &str) -> bool {
    let fixed = [&BEFORE_AXES[..], &AFTER_AXES, &STATISTICS].concat();
    fixed.contains(&name) || known().iter().any(|known| known == name)
}

/// A quantity of a run, or of a pair of a run and its reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunQuantity {
    /// A number of the summary, by its position.
    Number(usize),
    /// The reduction of static friction (Eq. 16).
    Reduction,
}

impl RunQuantity {
    /// The quantity of this name, if there is one.
    pub fn named(name: &str) -> Option<Self> {
        if name == REDUCTION {
            return Some(Self::Reduction);
        }
        known().iter().position(|known| known == name).map(Self::Number)
    }
}

/// The numbers of a summary in the order of [`known`]: the part of it that tables and statistics need.
/// Numbers that only some summaries have are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct SummaryValues {
    values: Box<[Option<f64>]>,
    /// Static friction mu_s*; none without a transition.
    static_friction_star: Option<f64>,
    /// Whether the run had a transition from static to kinetic friction.
    pub(crate) transition: bool,
}

impl SummaryValues {
    pub(crate) fn from_summary(summary: &Summary) -> Self {
        let found: HashMap<_, _> = named(summary).into_iter().collect();
        let slides = summary
            .kinetic_window_star
            .is_some_and(|[from, _]| from > summary.onset_time_star);
        let counts = |name: &str| {
            summary.transition || !(OF_PEAK.contains(&name) || (OF_KINETIC_WINDOW.contains(&name) && !slides))
        };
        let known = known().iter().map(String::as_str);
        let values = known.map(|name| found.get(name).copied().flatten().filter(|_| counts(name)));
        Self {
            values: values.collect(),
            static_friction_star: summary.transition.then_some(summary.static_friction_star),
            transition: summary.transition,
        }
    }

    /// Number at a position; none if the summary has none.
    pub(crate) fn get(&self, position: usize) -> Option<f64> {
        self.values.get(position).copied().flatten()
    }
}

/// The numbers of a summary and their names; true and false are 1 and 0.
fn named(summary: &Summary) -> Vec<(String, Option<f64>)> {
    let Ok(Value::Object(fields)) = serde_json::to_value(summary) else {
        return Vec::new();
    };
    let number = |value: Value| match value {
        Value::Null => Some(None),
        Value::Bool(yes) => Some(Some(f64::from(u8::from(yes)))),
        Value::Number(number) => Some(number.as_f64()),
        Value::String(_) | Value::Array(_) | Value::Object(_) => None,
    };
    let fields = fields.into_iter();
    let kept = fields.filter(|(name, _)| !NOT_QUANTITIES.contains(&name.as_str()));
    let numbers = kept.filter_map(|(name, value)| Some((name, number(value)?)));
    let of_observers = observers::quantities(summary).into_iter();
    numbers
        .chain(of_observers.map(|(name, value)| (name.to_owned(), value)))
        .collect()
}

/// Reduction of mu_s* in % (Eq. 16), both runs on the same random surface; none unless both have a
/// transition:
///
/// ```text
/// 100 (mu_s*(reference) - mu_s*)/mu_s*(reference)
/// ```
pub(crate) fn reduction_percent(point: &SummaryValues, reference: &SummaryValues) -> Option<f64> {
    let (point, reference) = (point.static_friction_star?, reference.static_friction_star?);
    Some(100.0 * (reference - point) / reference)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_few_summaries_have_shifts_no_other() {
        let plain = Summary {
            work_j: 2.0,
            energy_error: 0.5,
            steps: 7,
            ..Summary::default()
        };
        let viscous = Summary {
            viscous_loss_j: Some(3.0),
            ..plain.clone()
        };
        assert_eq!(
            SummaryValues::from_summary(&viscous),
            SummaryValues::from_summary(&plain)
        );
        let Some(RunQuantity::Number(position)) = RunQuantity::named("steps") else {
            panic!("a summary has a number of steps")
        };
        assert_eq!(SummaryValues::from_summary(&viscous).get(position), Some(7.0));
    }

    /// Numbers that have a value in a run of this kind.
    fn values_of(transition: bool, window_from: f64) -> SummaryValues {
        SummaryValues::from_summary(&Summary {
            transition,
            static_friction_star: 0.6,
            static_friction: 0.3,
            mu_star_max: 0.6,
            onset_time_star: 120.0,
            first_slip_time_star: Some(80.0),
            kinetic_friction_star: Some(0.5),
            kinetic_window_star: Some([window_from, 500.0]),
            ..Summary::default()
        })
    }

    fn number(values: &SummaryValues, name: &str) -> Option<f64> {
        match RunQuantity::named(name) {
            Some(RunQuantity::Number(position)) => values.get(position),
            other => panic!("{name}: {other:?}"),
        }
    }

    #[test]
    fn what_the_peak_defines_is_empty_without_a_transition() {
        let (with, without) = (values_of(true, 200.0), values_of(false, 200.0));
        for name in OF_PEAK {
            assert!(number(&with, name).is_some(), "{name}");
            assert_eq!(number(&without, name), None, "{name}");
        }
        for name in [
            "mu_star_max",
            "first_slip_time_star",
            "kinetic_friction_star",
            "transition",
        ] {
            assert!(number(&without, name).is_some(), "{name}");
        }
        assert_eq!(reduction_percent(&with, &with), Some(0.0));
        assert_eq!(reduction_percent(&with, &without), None);
        assert_eq!(reduction_percent(&without, &with), None);
    }

    /// A kinetic window before the largest mu* gives no kinetic friction without a transition: while mu*
    /// still rises to the onset, its mean is not kinetic friction.
    #[test]
    fn a_kinetic_window_before_the_largest_mu_star_is_none_without_a_transition() {
        assert_eq!(number(&values_of(false, 100.0), "kinetic_friction_star"), None);
        assert_eq!(
            number(&values_of(true, 100.0), "kinetic_friction_star"),
            Some(0.5)
        );
    }
}
