//! Names of the files in a run folder and in the folder of a study.

/// The resolved case.
pub const CASE: &str = "case.toml";

/// What was written, by which program, when and where; the last file to be written.
pub const MANIFEST: &str = "manifest.json";

/// The numbers of a run.
pub const SUMMARY: &str = "summary.json";

/// The curve of a run, row by row.
pub const SERIES: &str = "series.csv";

/// The fields of a run, block by block.
pub const FIELDS: &str = "fields.nc";

/// The latest checkpoint.
pub const CHECKPOINT: &str = "checkpoint.bin";

/// The checkpoint before the latest.
pub const PREVIOUS: &str = "checkpoint-previous.bin";

/// Results that the figures of the paper are made of, kept between calls of `slipfront paper`.
pub const FIGURE_CACHE: &str = "found";

/// How every checkpoint begins.
pub const CHECKPOINT_BEGINNING: &[u8] = b"{\"slipfront_checkpoint\":";

/// The journal of a study: a line for every run that has ended.
pub const RECORDS: &str = "records.jsonl";

/// Tables of a study: a row for every run, and a row for every point.
pub const TABLES: [&str; 2] = ["runs.csv", "points.csv"];

/// Subfolder of the run folders that a study keeps.
pub const RUNS: &str = "runs";
