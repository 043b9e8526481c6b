//! The peaks of mu* in a program of speeds.

use serde::{Deserialize, Serialize};
use slipfront::observe::Cycles;
use slipfront_case::case::Case;

use super::observed::{Observed, Times};

/// A part of a program of speeds in which the drive moves forwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CycleSummary {
    /// t* at which the part begins.
    pub from_star: f64,
    /// Speed V* of the part.
    pub v_star: f64,
    /// Largest mu* in the part.
    pub mu_star_max: f64,
    /// t* of the largest mu*.
    pub time_star: f64,
}

/// Largest number of peaks that are printed.
const MAX_PEAKS: usize = 6;

impl Observed for Cycles {
    type Numbers = Vec<CycleSummary>;

    fn of_run(case: &Case) -> Option<Self> {
        // The increments that lead a bulk body to its onset are no program.
        let has_program = case.model.drive.program.is_some() && !case.model.rests_by_excess();
        has_program.then(Self::default)
    }

    fn fits(&self, _new: &Self, now: Times) -> bool {
        self.is_consistent_with(now.drive_time_star)
    }

    fn numbers(&self) -> Vec<CycleSummary> {
        let peaks = self.cycles().iter().map(|cycle| CycleSummary {
            from_star: cycle.from_star,
            v_star: cycle.v_star,
            mu_star_max: cycle.mu_star,
            time_star: cycle.time_star,
        });
        peaks.collect()
    }

    fn line(numbers: &Vec<CycleSummary>, _case: &Case) -> (&'static str, String) {
        let shown = numbers.iter().take(MAX_PEAKS);
        let shown: Vec<String> = shown.map(|cycle| format!("{:.4}", cycle.mu_star_max)).collect();
        let more = if numbers.len() > MAX_PEAKS {
            ", and so on"
        } else {
            ""
        };
        ("peaks", format!("mu* = {}{more}", shown.join(", ")))
    }
}
