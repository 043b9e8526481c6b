//! How friction depends on the direction of the drive, for a study that varies it.

use slipfront_case::number_format::{four_digits, with_half_width};
use slipfront_run::study::{Anisotropy, Plan, Sample, StudyResults, anisotropies};

use super::table::table;

/// Most rows that are printed.
const MAX_ROWS: usize = 40;

/// A row for static and for kinetic friction at all levels of the other axes; empty if no axis is one of directions.
pub(crate) fn anisotropy(plan: &Plan, results: &StudyResults) -> String {
    let found = anisotropies(plan, results);
    let Some(first) = found.first() else {
        return String::new();
    };
    let levels = first.levels.iter().map(|(column, _)| column.as_str());
    let header: Vec<&str> = levels
        .chain([
            "friction",
            "mean",
            "anisotropy %",
            "from",
            "to",
            "principal",
            "lateral",
            "at",
        ])
        .collect();
    let rows: Vec<Vec<String>> = found.iter().take(MAX_ROWS).map(row).collect();
    let more = match found.len() - rows.len() {
        0 => String::new(),
        more => format!("  and {more} more in anisotropy.csv\n"),
    };
    format!(
        "friction over {} directions, in degrees from x towards y: anisotropy is\n\
         (largest - smallest)/mean, from the largest to the smallest; principal is the axis\n\
         of larger friction, lateral the largest friction across the drive\n\n{}{more}\n",
        first.directions,
        table(&header, &rows)
    )
}

fn row(found: &Anisotropy) -> Vec<String> {
    let value = |sample: &Sample, factor: f64| {
        with_half_width(factor * sample.mean, sample.half_width.map(|half| factor * half))
    };
    let symbol = match found.quantity {
        "static_friction_star" => "mu_s*",
        _ => "mu_k*",
    };
    let principal = found
        .principal
        .map_or("none".to_owned(), |principal| match principal.half_width {
            Some(half) => with_half_width(principal.direction, Some(half)),
            None => four_digits(principal.direction),
        });
    let (lateral, at) = found
        .lateral
        .as_ref()
        .map_or_else(Default::default, |(at, lateral)| {
            (value(lateral, 1.0), four_digits(*at))
        });
    let levels = found.levels.iter().map(|(_, level)| level.clone());
    let cells = [
        symbol.to_owned(),
        value(&found.mean, 1.0),
        value(&found.anisotropy, 100.0),
        four_digits(found.largest_direction),
        four_digits(found.smallest_direction),
        principal,
        lateral,
        at,
    ];
    levels.chain(cells).collect()
}
