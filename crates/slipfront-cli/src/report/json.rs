//! Reports for programs, as JSON.

use serde_json::{Value, json};
use slipfront_base::machine::available_memory;
use slipfront_case::case::Case;
use slipfront_run::estimate_cost::StepTime;
use slipfront_run::running::useful_threads;

use super::cost::warnings;
use super::speeds::Speeds;

/// The physics and the cost of a case, with the key names of `summary.json` for the same numbers; `per_step`
/// is the time of a step. A number that is not finite, such as the critical size if slip of any size is
/// stable, is null.
pub(crate) fn check(case: &Case, per_step: &StepTime) -> Value {
    let (groups, lattice, plan) = (&case.groups, &case.model.lattice, &case.time_plan);
    let budget = &case.budget;
    let bytes = |estimate: f64| estimate.ceil() as u64;
    let lengths: Vec<Value> = case
        .lengths()
        .iter()
        .map(|length| {
            json!({
                "name": length.name,
                "blocks": length.blocks,
                "length_m": length.metres,
                "enough_blocks": length.enough,
            })
        })
        .collect();
    json!({
        "case": case.name,
        "blocks": [lattice.nx, lattice.ny],
        "n_blocks": case.model.n_blocks(),
        "block_size_m": case.scales.block_size,
        "v_star": groups.v_star,
        "r_star": groups.r_star,
        "omega_star": groups.omega_star,
        "sigma_static_star": groups.sigma_static_star,
        "sigma_kinetic_star": groups.sigma_kinetic_star,
        "epsilon": groups.epsilon,
        "seed": case.file.friction.seed,
        "texture_percent": case.texture.meshed_percent,
        "texture_percent_asked": case.texture.asked_percent,
        "lengths": lengths,
        "dt_star": plan.dt_star,
        "dt_star_limit": plan.step_limit,
        "steps": plan.last_step,
        "duration_star": plan.end_star(),
        "expected_onset_star": case.initial.is_none().then_some(case.expected.onset_star),
        "shear_star": case.model.mean_dead_load()[0],
        "shear_share": case.share_of_shear(),
        "blocks_slipping_at_once": case.expected.at_once.count,
        "expected_steady_level_star": case.expected.steady_level,
        "time_unit_s": case.scales.time(),
        "displacement_unit_m": case.scales.displacement(),
        "stress_unit_pa": case.scales.stress(),
        "block_steps": case.block_steps(),
        "seconds": per_step.of_steps(&case.expected_steps()),
        "threads": useful_threads(case, rayon::current_num_threads()),
        "seconds_per_step_at_rest": per_step.at_rest,
        "seconds_per_step_sliding": per_step.sliding,
        "speeds": Speeds::new(case).map(|speeds| speeds.json(case, per_step)),
        "memory_bytes": bytes(budget.memory()),
        "memory_available_bytes": available_memory().map(bytes),
        "disk_bytes": bytes(budget.disk()),
        "disk_of_checkpoints_bytes": bytes(budget.disk_of_checkpoints()),
        "warnings": warnings(case),
    })
}
