//! Appendix: sensitivity of the main numbers to choices that the paper leaves open.

use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::MeasuredNumber;
use crate::runner::FigureRunner;
use crate::statistics::{distances, largest};
use slipfront_study::REDUCTION;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let baseline = runner.study("sensitivity")?;
    let texture = runner.study("sensitivity_texture")?;
    let (names, textured) = (baseline.names(0), texture.names(0));
    let mut rows = Vec::new();
    let mut variants = names.clone();
    variants.extend(textured.iter().filter(|name| !names.contains(name)).cloned());
    for variant in variants {
        let cell = |number: Option<MeasuredNumber>, digits| {
            number.map_or(String::new(), |number| number.shown(digits))
        };
        let of_baseline = |quantity: &str| {
            let place = names.iter().position(|name| *name == variant)?;
            let number = baseline.number(&[place], quantity);
            (!number.value.is_nan()).then_some(number)
        };
        let place = textured.iter().position(|name| *name == variant);
        let reduction = place.map(|place| texture.number(&[place], REDUCTION));
        let reduction = reduction.filter(|reduction| !reduction.value.is_nan());
        rows.push([
            variant.clone(),
            cell(of_baseline("static_friction_star"), 3),
            cell(of_baseline("kinetic_friction_star"), 3),
            cell(reduction, 1),
        ]);
    }
    data.table(
        "sensitivity",
        "Static and kinetic friction of the baseline (25 x 25 blocks, sigma_s* = 0.05), and the reduction by a circular \
         cavity (50 x 50 blocks, sigma_s* = 0, A* = 10 %), when one thing is changed. Runs without a transition have no static friction and no \
         reduction.",
        ["change", "mu_s*", "mu_k*", "reduction (%)"],
        rows,
    );

    let place =
        |names: &[String], start: &str| names.iter().position(|name| name.starts_with(start)).unwrap_or(0);
    let reversal = place(&names, "friction: reversal");
    let statics = |k: usize| baseline.values(&[k], "static_friction_star");
    let moved_by = |k: usize| largest(distances(&statics(0), &statics(k)));
    data.value("reversal_moves_static_friction", moved_by(reversal));
    data.value(
        "edges_move_static_friction",
        moved_by(place(&names, "edges: periodic")),
    );
    let reductions = texture.means(&[], REDUCTION);
    let shifted = (0..textured.len()).filter(|&k| textured[k].starts_with("centre"));
    data.value(
        "shift_moves_reduction",
        largest(shifted.map(|k| (reductions[k] - reductions[0]).abs())),
    );
    let kept = place(&textured, "load: not");
    data.value("kept_load_reduction_percent", reductions[kept]);
    Ok(())
}
