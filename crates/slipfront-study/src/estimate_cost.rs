//! What the runs of a study will cost, from some steps of each size of slider.

use std::collections::HashMap;

use slipfront_case::case_file::CaseError;
use slipfront_run::estimate_cost::seconds_per_step;

use crate::plan::Plan;

/// Seconds that the runs will take on `threads` threads of this machine, with the fewest replicates.
///
/// # Errors
/// When a file that a case reads has changed since the plan was made.
pub fn estimated_seconds(plan: &Plan, threads: usize) -> Result<f64, CaseError> {
    let mut seconds = 0.0;
    // The time per block depends on the size of the lattice: a small one fits into the cache.
    let mut rates: HashMap<usize, f64> = HashMap::new();
    for run in plan.runs(1) {
        let (cost, n_blocks) = plan.cost(run);
        let rate = match rates.get(&n_blocks) {
            Some(&rate) => rate,
            None => {
                let case = plan.case(run, &mut |_| true)?;
                let rate = n_blocks as f64 / seconds_per_step(&case);
                rates.insert(n_blocks, rate);
                rate
            }
        };
        seconds += cost / rate;
    }
    let replicates = plan.settings.min_replicates() as f64;
    Ok(replicates * seconds / threads as f64)
}
