//! Estimate of the cost of a study, from a few steps on each size of slider; and limits on the cost.

use std::collections::HashMap;

use jiff::SignedDuration;
use slipfront_base::number_format::byte_size;
use slipfront_case::case_file::CaseError;
use slipfront_run::estimate_cost::StepTime;

use crate::error::StudyError;
use crate::plan::Plan;

/// Limits on the runs of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CostLimits {
    /// Memory of all simultaneous runs, GB.
    pub memory_gb: Option<f64>,
    /// Time until all runs are done.
    pub time: Option<SignedDuration>,
}

/// Bounds of the time in s that the runs will take on `threads` threads of this machine, with the fewest
/// replicates.
///
/// # Errors
/// When a file that a case reads has changed since the plan was made.
pub fn estimated_time(plan: &Plan, threads: usize) -> Result<[f64; 2], CaseError> {
    let mut time = [0.0; 2];
    // The time per block depends on the size of the lattice: a small one fits into the cache.
    let mut per_step: HashMap<usize, StepTime> = HashMap::new();
    for run in plan.runs(1) {
        let (steps, n_blocks) = plan.cost(run);
        let of_step = match per_step.get(&n_blocks) {
            Some(&of_step) => of_step,
            None => {
                let of_step = StepTime::measure(&plan.case(run, &mut |_| true)?);
                per_step.insert(n_blocks, of_step);
                of_step
            }
        };
        let of_run = of_step.of_steps(&steps);
        time = [time[0] + of_run[0], time[1] + of_run[1]];
    }
    let replicates = plan.settings.min_replicates() as f64;
    Ok(time.map(|time| replicates / threads as f64 * time))
}

impl CostLimits {
    /// Refuses a plan if memory is too small for `threads` simultaneous runs, or if it exceeds the limits.
    ///
    /// # Errors
    /// A sentence with the cost, the limit, and the remedy.
    pub fn check(self, plan: &Plan, threads: usize) -> Result<(), StudyError> {
        const GB: f64 = 1e9;
        plan.check_memory(threads)?;
        let memory = plan.memory(threads);
        // Nothing fits a limit of NaN.
        let fits = |most: f64| memory <= most * GB;
        if let Some(most) = self.memory_gb.filter(|most| !fits(*most)) {
            let needed = byte_size(memory);
            return Err(StudyError::MemoryLimit {
                needed,
                threads,
                most,
            });
        }
        let Some(most) = self.time else { return Ok(()) };
        // Use the lower estimate: other work on the machine must not cause a refusal.
        let [least, _] = estimated_time(plan, threads)?;
        if least > most.as_secs_f64() {
            let estimated = SignedDuration::from_secs(least.ceil() as i64);
            return Err(StudyError::TimeLimit { estimated, most });
        }
        Ok(())
    }
}
