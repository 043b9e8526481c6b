//! Names of the files in a run folder and in the folder of a study.

/// The resolved case.
pub const CASE: &str = "case.toml";
/// What was written, by which program, when and where; the last file to be written.
pub const MANIFEST: &str = "manifest.json";
/// The numbers of a run.
pub const SUMMARY: &str = "summary.json";
/// The curve of a run, row by row.
pub const SERIES: &str = "series.csv";
/// The events of slip of a run that is driven at an edge.
pub const PRECURSORS: &str = "precursors.csv";
/// What slides against place and time.
pub const KYMOGRAPH: &str = "kymograph.nc";
/// The fields of a run, block by block.
pub const FIELDS: &str = "fields.nc";
/// The hidden subfolder of everything that belongs to a run which is not complete.
pub const UNFINISHED: &str = ".slipfront";
/// In the hidden subfolder: the files that the run has finished, which also says that the subfolder is slipfront's.
pub const JOURNAL: &str = "journal.jsonl";
/// In the hidden subfolder: a folder of the temporary files that are being written.
pub const TEMPORARY: &str = "tmp";
/// In the hidden subfolder: the latest checkpoint.
pub const CHECKPOINT: &str = "checkpoint.bin";
/// In the hidden subfolder: the checkpoint before the latest.
pub const PREVIOUS: &str = "checkpoint-previous.bin";
/// Results that the figures of the paper are made of, kept between calls of `slipfront paper`.
pub const FIGURE_CACHE: &str = "found";
/// The journal of a study: a line for every run that has ended.
pub const RECORDS: &str = "records.jsonl";
/// Tables of a study: a row for every run, a row for every quantity at every point, and, where the direction of the drive is varied, a row
/// for friction over all directions.
pub const TABLES: [&str; 3] = ["runs.csv", "points.csv", "anisotropy.csv"];
/// Subfolder of the run folders that a study keeps.
pub const RUNS: &str = "runs";
