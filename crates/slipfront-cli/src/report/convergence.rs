//! The answer of a case on several meshes.

use slipfront_case::number_format::{four_digits, with_half_width};
use slipfront_study::Plan;
use slipfront_study::converge::{Convergence, OnMeshes, Verdict};

use super::study::case_warnings;
use super::table::table;
use crate::wrap::note;

/// The table of what every mesh found, and a sentence on each quantity. Notes name lengths of the material that are the block's, and tell the
/// warnings about the cases.
pub(crate) fn convergence(plan: &Plan, found: &OnMeshes) -> String {
    let quantities = &found.quantities;
    let mut header = vec!["block", "textured"];
    header.extend(quantities.iter().map(|one| one.quantity.as_str()));
    let rows = found.meshes.iter().enumerate().map(|(k, mesh)| {
        let mut row = vec![
            mesh.block_size.clone(),
            format!("{} %", four_digits(mesh.coverage_percent)),
        ];
        row.extend(
            quantities
                .iter()
                .map(|one| with_half_width(one.means[k], one.half_widths[k])),
        );
        row
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let mut text = table(&header, &rows) + "\n";
    if quantities.is_empty() {
        text += &note("no quantity has a value on every mesh: look at runs.csv for what the runs found");
    }
    if found.lengths_of_a_block.is_empty() {
        for one in quantities {
            text += &format!("  {}\n", sentence(one));
        }
        return text + &case_warnings(plan);
    }
    for one in quantities {
        text += &format!(
            "  {}: {} on the finest mesh, and a number of that mesh\n",
            one.quantity,
            four_digits(one.means[one.means.len() - 1])
        );
    }
    text += &note(&format!(
        "no limit is given, since every mesh is another material: a block gives it {}. Give them as lengths of the material",
        found.lengths_of_a_block.join(", ")
    ));
    text + &case_warnings(plan)
}

/// The value on the finest mesh, with the error that meshes and surfaces leave.
fn sentence(one: &Convergence) -> String {
    let last = one.means.len() - 1;
    let (name, value, scatter) = (&one.quantity, one.means[last], one.half_widths[last]);
    let half = scatter.unwrap_or(0.0);
    let of_surfaces = scatter.map_or(String::new(), |half| {
        format!(" and the scatter over surfaces {}", two_digits(half))
    });
    match one.verdict {
        Verdict::Converges { order, mesh_error } => format!(
            "{name}: {}, of which the mesh is {}{of_surfaces} (order {order:.1})",
            with_error(value, mesh_error + half),
            two_digits(mesh_error)
        ),
        Verdict::Equal => format!("{name}: {} on every mesh{of_surfaces}", four_digits(value)),
        // What seeds scatter by hides what the mesh does.
        Verdict::Open { spread } if spread <= half => format!(
            "{name}: {}; the last three meshes differ by {}, within the scatter over surfaces: more --replicates show more",
            with_error(value, spread + half),
            two_digits(spread)
        ),
        Verdict::Open { spread } => format!(
            "{name}: {} on the finest mesh; no limit is claimed, since differences do not decrease: the last three meshes differ by {}",
            four_digits(value),
            two_digits(spread)
        ),
    }
}

/// A value to the second digit of its error, and the error.
fn with_error(value: f64, error: f64) -> String {
    let places = places_of(error);
    format!("{value:.places$} \u{b1} {error:.places$}")
}

fn two_digits(error: f64) -> String {
    let places = places_of(error);
    format!("{error:.places$}")
}

/// Places behind the point down to the second digit of a number.
fn places_of(number: f64) -> usize {
    if number == 0.0 {
        return 0;
    }
    (1.0 - number.abs().log10().floor()).clamp(0.0, 12.0) as usize
}
