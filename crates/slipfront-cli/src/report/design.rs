//! The plan of a design.

use slipfront_base::number_format::{count, four_digits};
use slipfront_design::DesignPlan;

use super::cost::held_drive_remark;
use super::times::duration;

/// The plan of a design and its cost.
pub(crate) fn design(plan: &DesignPlan, threads: usize) -> String {
    let unknowns = plan.unknowns.iter();
    let unknowns = unknowns.map(|(key, [from, to])| format!("  {key}: {from} to {to}\n"));
    let what = if plan.unknowns.is_empty() {
        "masks"
    } else {
        "shapes"
    };
    let [nx, ny] = plan.blocks;
    let [least, most] = plan.coverage_percent.map(four_digits);
    let designs = match plan.designs {
        1 => String::new(),
        n => format!("{}, each with ", count(n, "design")),
    };
    format!(
        "{}\n{}  {what} that cover {least} to {most} % of {nx} x {ny} blocks, in {}, compared with {}\n  \
         {designs}{} of the search, at most {} of the verdict\n  \
         at most {:.2e} block-steps{}, {} on {} of this machine\n",
        plan.name,
        unknowns.collect::<String>(),
        count(plan.cases, "case"),
        count(plan.patterns.len(), "named pattern"),
        count(plan.search_runs, "run"),
        count(plan.verdict_runs, "run"),
        plan.block_steps,
        held_drive_remark(plan.time[1].is_infinite()),
        duration(plan.time),
        count(threads, "thread")
    )
}
