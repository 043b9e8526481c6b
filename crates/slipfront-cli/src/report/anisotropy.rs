//! Dependence of friction on the direction of the drive, for a study that varies it.

use slipfront_base::number_format::{four_digits, with_half_width};
use slipfront_study::text_table::table;
use slipfront_study::{Anisotropy, OverDirections, Plan, Sample, StudyResults, anisotropies};

use crate::wrap::note;

/// Largest numbers of printed rows, and of notes on omissions.
const MAX_ROWS: usize = 40;
const MAX_NOTES: usize = 8;

/// Columns of the table after those of the other axes.
const COLUMNS: [&str; 9] = [
    "friction",
    "mean",
    "anisotropy %",
    "from",
    "to",
    "p",
    "principal",
    "lateral",
    "at",
];

/// Rows for static and kinetic friction at all levels of the other axes; empty if no axis varies the
/// direction.
pub(crate) fn anisotropy(plan: &Plan, results: &StudyResults) -> String {
    let all = anisotropies(plan, results);
    let Some(first) = all.first() else {
        return String::new();
    };
    let mut header: Vec<&str> = first.levels.iter().map(|(column, _)| column.as_str()).collect();
    header.extend(COLUMNS);
    let with_numbers = all.iter().filter_map(|row| Some((row, row.found.as_ref().ok()?)));
    let rows: Vec<Vec<String>> = with_numbers.map(|(row, found)| cells(row, found)).collect();
    let shown = rows.len().min(MAX_ROWS);
    let more = match rows.len() - shown {
        0 => String::new(),
        more => format!("  and {more} more in anisotropy.csv\n"),
    };
    let table = match shown {
        0 => String::new(),
        _ => format!(
            "friction over the directions, in degrees from x towards y: anisotropy is (largest -\n\
             smallest)/mean, from the largest to the smallest; p: probability of an anisotropy at least\n\
             this large if friction is isotropic; principal: axis of the larger friction; lateral:\n\
             largest friction across the drive\n\n{}{more}\n",
            table(&header, &rows[..shown])
        ),
    };
    table + &notes(&all)
}

/// Notes on omissions, and on missing numbers.
fn notes(all: &[Anisotropy]) -> String {
    let sentence = |row: &Anisotropy| {
        let parts = [row.left_out.as_ref(), row.found.as_ref().err()];
        let parts: Vec<&str> = parts.into_iter().flatten().map(String::as_str).collect();
        let levels = row
            .levels
            .iter()
            .map(|(name, level)| format!(", {name} = {level}"));
        let levels: String = levels.collect();
        (!parts.is_empty()).then(|| note(&format!("{}{levels}: {}", row.quantity, parts.join("; "))))
    };
    let mut notes: Vec<String> = all.iter().filter_map(sentence).collect();
    if notes.len() > MAX_NOTES {
        let more = notes.split_off(MAX_NOTES).len();
        let more = format!("and {more} similar notes; anisotropy.csv contains all results");
        notes.push(note(&more));
    }
    notes.concat()
}

fn cells(row: &Anisotropy, found: &OverDirections) -> Vec<String> {
    let value = |sample: &Sample, factor: f64| {
        with_half_width(factor * sample.mean, sample.half_width.map(|half| factor * half))
    };
    let symbol = match row.quantity {
        "static_friction_star" => "mu_s*",
        _ => "mu_k*",
    };
    let principal = match found.principal {
        Some(principal) => with_half_width(principal.direction, principal.half_width),
        None => "none".to_owned(),
    };
    let (lateral, at) = match &found.lateral {
        Some((at, lateral)) => (value(lateral, 1.0), four_digits(*at)),
        None => Default::default(),
    };
    let levels = row.levels.iter().map(|(_, level)| level.clone());
    let cells = [
        symbol.to_owned(),
        value(&found.mean, 1.0),
        value(&found.anisotropy, 100.0),
        four_digits(found.largest_direction),
        four_digits(found.smallest_direction),
        found.p_value.map_or("none".to_owned(), probability),
        principal,
        lateral,
        at,
    ];
    levels.chain(cells).collect()
}

/// A probability to three decimals, or only its power of ten if it is smaller.
fn probability(p: f64) -> String {
    match p {
        p if p >= 0.001 => format!("{p:.3}"),
        p if p >= 1e-9 => format!("{p:.0e}"),
        _ => "<1e-9".to_owned(),
    }
}
