//! Comparison of several meshes, as text.

use slipfront_base::number_format::{four_digits, with_half_width};
use slipfront_base::text::note;

use super::on_meshes::{Convergence, MeshVerdict, OnMeshes};
use crate::plan::Plan;
use crate::text_table::table;
use crate::warning_texts::warning_texts;

/// The table of the results on every mesh, and a sentence on each quantity. Notes, in lines of at most
/// `columns` characters, name lengths of the material that equal the length of a block, and the warnings
/// about the cases.
pub fn text(plan: &Plan, found: &OnMeshes, columns: usize) -> String {
    let (quantities, lengths) = (&found.quantities, &found.lengths_of_a_block);
    let mut text = on_meshes(found) + "\n";
    if quantities.is_empty() {
        text += &note(
            "no quantity has a value on every mesh: runs.csv contains the results of the runs",
            columns,
        );
    }
    for one in quantities {
        if lengths.is_empty() {
            text += &format!("  {}\n", sentence(one));
        } else {
            text += &format!("  {}\n", of_another_material(one));
        }
    }
    if !lengths.is_empty() {
        let sentence = format!(
            "no limit is given, because every mesh is a different material: the block size sets {}. Give them as lengths of the material",
            lengths.join(", ")
        );
        text += &note(&sentence, columns);
    }
    let warnings = warning_texts(plan);
    warnings
        .iter()
        .fold(text, |text, warning| text + &note(warning, columns))
}

/// A row for every mesh: the edge of a block, the textured area, and every quantity.
fn on_meshes(found: &OnMeshes) -> String {
    let quantities = &found.quantities;
    let names = quantities.iter().map(|one| one.quantity.as_str());
    let header: Vec<&str> = ["block", "textured"].into_iter().chain(names).collect();
    let rows = found.meshes.iter().enumerate().map(|(k, mesh)| {
        let values = quantities.iter();
        let values = values.map(|one| with_half_width(one.means[k], one.half_widths[k]));
        let textured = format!("{} %", four_digits(mesh.coverage_percent));
        let cells = [mesh.block_size.clone(), textured].into_iter();
        cells.chain(values).collect()
    });
    let rows: Vec<Vec<String>> = rows.collect();
    table(&header, &rows)
}

/// The value on the finest mesh, if every mesh is a different material.
fn of_another_material(one: &Convergence) -> String {
    format!(
        "{}: {} on the finest mesh; this value depends on the mesh",
        one.quantity,
        four_digits(one.means[one.means.len() - 1])
    )
}

/// The value on the finest mesh, with the error due to mesh and surfaces.
fn sentence(one: &Convergence) -> String {
    let last = one.means.len() - 1;
    let (name, value, scatter) = (&one.quantity, one.means[last], one.half_widths[last]);
    let half = scatter.unwrap_or(0.0);
    let of_surfaces = scatter.map_or(String::new(), |half| {
        format!(", scatter between surfaces {}", two_digits(half))
    });
    match one.verdict {
        MeshVerdict::Converges { order, mesh_error } => format!(
            "{name}: {} (discretisation {}{of_surfaces}; order {order:.1})",
            with_error(value, mesh_error + half),
            two_digits(mesh_error)
        ),
        MeshVerdict::Equal => format!("{name}: {} on every mesh{of_surfaces}", four_digits(value)),
        // The scatter over seeds hides the effect of the mesh.
        MeshVerdict::Open { spread } if spread <= half => format!(
            "{name}: {}; the last three meshes differ by {}, within the scatter between surfaces: use more --replicates",
            with_error(value, spread + half),
            two_digits(spread)
        ),
        MeshVerdict::Open { spread } => format!(
            "{name}: {} on the finest mesh; no limit is given, because differences do not decrease: the last three meshes differ by {}",
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

/// Number of decimal places up to the second significant digit of a number.
fn places_of(number: f64) -> usize {
    if number == 0.0 {
        return 0;
    }
    (1.0 - libm::log10(number.abs()).floor()).clamp(0.0, 12.0) as usize
}
