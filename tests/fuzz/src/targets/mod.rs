//! The targets, a file for each kind of parser.

mod arrays;
mod calibration;
mod case;
mod checkpoint;
mod drawing;
mod fields;
mod figure_cache;
mod json;
mod kymograph;
mod measured;
mod plot;
mod quantity;
mod requests;
mod run_journal;
mod series;
mod study;
mod workbook;

use crate::target::Target;

/// All targets, in the order in which a run reads and writes their files.
pub const TARGETS: [Target; 26] = [
    case::CASE_FILE,
    case::CASE,
    study::STUDY_FILE,
    calibration::CALIBRATION_FILE,
    quantity::QUANTITY,
    arrays::NPY,
    arrays::CSV_TABLE,
    arrays::MASK_PNG,
    arrays::HEIGHT_MAP,
    drawing::SVG,
    drawing::DXF,
    measured::MEASURED,
    workbook::WORKBOOK,
    run_journal::RUN_JOURNAL,
    figure_cache::FIGURE_CACHE,
    checkpoint::CHECKPOINTS,
    fields::FIELDS,
    kymograph::KYMOGRAPH,
    json::SUMMARY,
    series::SERIES,
    series::PRECURSORS,
    series::EVENTS,
    json::MANIFEST,
    json::JOURNAL,
    plot::PLOT,
    requests::REQUESTS,
];

/// The target of a name.
pub fn named(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}
