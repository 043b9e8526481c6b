//! The meaning of the files of a run in words, and media types of files of results.

use crate::names::{CASE, FIELDS, KYMOGRAPH, MANIFEST, MOVIE, RunPicture, SERIES, STATE, SUMMARY};
use crate::observers::tables;

/// Media types of files of results by their endings.
const FORMATS: [(&str, &str); 13] = [
    ("csv", "text/csv"),
    ("dxf", "image/vnd.dxf"),
    ("gif", "image/gif"),
    ("json", "application/json"),
    ("jsonl", "application/jsonl"),
    ("nc", "application/x-netcdf"),
    ("npy", "application/x-npy"),
    ("png", "image/png"),
    ("svg", "image/svg+xml"),
    ("tif", "image/tiff"),
    ("tiff", "image/tiff"),
    ("toml", "application/toml"),
    ("txt", "text/plain"),
];

/// Media type of a file; if its ending is unknown, the type of arbitrary bytes.
pub(super) fn format_of(name: &str) -> &'static str {
    let ending = name.rsplit('.').next().unwrap_or_default();
    let known = FORMATS.iter().find(|(known, _)| *known == ending);
    known.map_or("application/octet-stream", |(_, format)| format)
}

/// Content of a file of a run.
pub(super) fn meaning_in_run(name: &str) -> String {
    let known = [
        (CASE, "The case with every default filled in"),
        (SUMMARY, "The numbers of the run"),
        (SERIES, "The curves over time"),
        (
            KYMOGRAPH,
            "Fraction of sliding blocks against position along the drive and time",
        ),
        (
            FIELDS,
            "Displacement, velocity, stress and sliding of every block at selected instants",
        ),
        (
            STATE,
            "Displacement and velocity of every block after the last step, in m and m/s",
        ),
        (MOVIE, "The snapshots one after the other"),
        (
            MANIFEST,
            "Provenance of the run; length and BLAKE3 checksum of every other file",
        ),
    ];
    let tables = tables().map(|table| (table.file, table.description));
    if let Some((_, meaning)) = known.into_iter().chain(tables).find(|(known, _)| *known == name) {
        return meaning.to_owned();
    }
    let is_shown = |picture: &RunPicture| picture.files().iter().any(|file| file == name);
    match RunPicture::ALL.into_iter().find(is_shown) {
        Some(picture) => format!("Picture: {}", picture.shows()),
        None => "A file that the case reads".to_owned(),
    }
}
