//! Errors of studies.

use std::path::PathBuf;

use jiff::SignedDuration;
use slipfront::RunError;
use slipfront::device::DeviceError;
use thiserror::Error;

use slipfront_base::number_format::{are, count};
use slipfront_base::text::{display_path, single_line};
use slipfront_case::case_file::CaseError;
use slipfront_case::texture_file::TextureFileError;
use slipfront_plot::PictureError;
use slipfront_run::folder_error::FolderError;
use slipfront_run::instrument::InstrumentError;
use slipfront_run::pictures::error::RunPictureError;
use slipfront_run::program;

/// A study that cannot be used, or had to stop.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum StudyError {
    #[error(transparent)]
    File(#[from] CaseError),
    #[error(transparent)]
    Device(#[from] DeviceError),
    #[error("the point {point} is not a valid case: {source}")]
    Point { point: String, source: CaseError },
    #[error("the reference of the point {point} is not a valid case: {source}")]
    ReferencePoint { point: String, source: CaseError },
    #[error("the study has {runs} runs, more than {limit}: give --yes if that is meant")]
    Large { runs: u64, limit: u64 },
    #[error("the axes of the study multiply to more than {limit} points: take fewer levels")]
    TooLarge { limit: usize },
    #[error(
        "{} at once take about {needed} of memory where {available} are available to this process: give \
        --threads {fit}",
        count(*threads, "run")
    )]
    Memory {
        threads: usize,
        needed: String,
        available: String,
        fit: usize,
    },
    #[error(
        "a run of the point {point} takes about {needed} of memory where {available} are available to this process: \
        lower `slider.blocks`, or keep no run folders (`study.keep`)"
    )]
    PointMemory {
        point: String,
        needed: String,
        available: String,
    },
    #[error(
        "the design takes about {needed} of memory where {available} are available to this process, one run at a time: \
        lower `slider.blocks` or `design.runs`"
    )]
    DesignMemory { needed: String, available: String },
    #[error(
        "the calibration takes about {needed} of memory where {available} are available to this process, one run at a time: \
        lower `slider.blocks` of the case, or `calibrate.runs`"
    )]
    CalibrationMemory { needed: String, available: String },
    #[error(
        "the tables and pictures of the study take about {needed} of memory where {available} are available to this \
        process: give it more, in a queue for example with `--mem`"
    )]
    ResultsMemory { needed: String, available: String },
    #[error(
        "the runs still to be done take about {needed} where {free} are free in {path}: keep fewer run folders \
        (`study.keep`), or choose another folder with --out"
    )]
    Disk {
        needed: String,
        free: String,
        path: PathBuf,
    },
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error("the folder {path} holds other things than a {what}: choose another with --out")]
    OtherThings { what: &'static str, path: PathBuf },
    #[error(
        "the folder {path} holds another {what}, or this one before it was changed: choose another with --out"
    )]
    Changed { what: &'static str, path: PathBuf },
    #[error(
        "the folder {path} of a {of} holds files that were edited since they were written, or that are not slipfront's: {}; move them away, \
        choose another folder with --out, or replace them with --force",
        single_line(&names.join(", "))
    )]
    Edited {
        of: &'static str,
        path: PathBuf,
        names: Vec<String>,
    },
    #[error(
        "{} is damaged: {why}; it says which files are slipfront's, so that none is replaced: put it back as it was, choose another folder \
        with --out, or give --force",
        display_path(path)
    )]
    Checksums { path: PathBuf, why: String },
    #[error(transparent)]
    Training(#[from] TrainingError),
    #[error(
        "--training {} is the folder of the results, which keeps training runs without it: leave out --training, or name another folder",
        display_path(path)
    )]
    TrainingInResults { path: PathBuf },
    #[error("cannot write the texture: {0}")]
    Texture(#[from] TextureFileError),
    #[error("another slipfront is running in {path}: wait for it, or choose another folder with --out")]
    Busy { path: PathBuf },
    #[error(
        "cannot {action} {path}: {source}; finished runs are safe, and the same command goes on from there"
    )]
    Journal {
        action: &'static str,
        path: PathBuf,
        source: std::io::Error,
    },
    #[error(
        "cannot write {}: {source}; finished runs are safe, and the same command goes on from there",
        display_path(path)
    )]
    Write { path: PathBuf, source: std::io::Error },
    #[error("{path} is not a journal of runs")]
    NotJournal { path: PathBuf },
    #[error(
        "{path} holds runs of another kind of work: put back the file that was there, or choose another folder"
    )]
    OtherJournal { path: PathBuf },
    #[error(
        "cannot keep the folder of a run: {0}; finished runs are safe, and the same command goes on from there"
    )]
    Keep(#[from] RunPictureError),
    #[error(
        "{} in none of the shards{}: finish them, or run the rest with `slipfront study` on the study.toml of the united \
        folder, with --out the folder itself",
        are(*runs, "run"),
        of_others(*others)
    )]
    Missing { runs: usize, others: usize },
    #[error("{other} belongs to another study than {first}: merge shards of one study only")]
    Foreign { first: PathBuf, other: PathBuf },
    #[error("the shard `{given}` cannot be: {why}; write i/n with i from 1 to n, such as 2/8, or `slurm`")]
    Shard { given: String, why: String },
    #[error("cannot draw {name}: {source}")]
    Picture { name: String, source: PictureError },
    #[error(
        "{levels} meshes cannot be: give from {fewest} to {most} levels, the second of which is the mesh of the case"
    )]
    Levels { levels: i64, fewest: u8, most: u8 },
    #[error(
        "on blocks of {block_size} no block is textured: begin with finer blocks, by `slider.blocks` and `slider.block_size`"
    )]
    Bare { block_size: String },
    #[error(
        "the runs need {needed} of memory, {threads} at once: more than --max-memory {most} allows; take fewer --levels or \
        --threads"
    )]
    MemoryLimit {
        needed: String,
        threads: usize,
        most: f64,
    },
    #[error(
        "the runs are estimated to take {estimated:#} at least, longer than --max-time {most:#} allows: take fewer --levels or \
        --replicates"
    )]
    TimeLimit {
        estimated: SignedDuration,
        most: SignedDuration,
    },
    #[error(
        "{failed} of {} failed, the others stand in the tables; the first, replicate {replicate} of the point {point}: {reason}",
        count(*runs, "run")
    )]
    Failed {
        failed: usize,
        runs: usize,
        replicate: usize,
        point: String,
        reason: String,
    },
    #[error(
        "no run has a value of {quantity}{}: the tables hold the other numbers",
        if *needs_transition {
            ", since none has a transition from static to kinetic friction. Lengthen `time.duration_star` of the base if the runs end before it"
        } else {
            ""
        }
    )]
    NoValue {
        quantity: String,
        needs_transition: bool,
    },
    #[error(
        "no quantity has a value on every mesh: {} says what the runs found. Lengthen `time.duration_star` if they end before a transition",
        display_path(path)
    )]
    NotOnMeshes { path: PathBuf },
    #[error(
        "the model does not make such records, and the intervals promise nothing: {} says why, and what to look at",
        display_path(path)
    )]
    Refused { path: PathBuf },
    #[error(
        "there is no verdict, since every texture that was judged is lost on fresh surfaces: {} says why",
        display_path(path)
    )]
    NoVerdict { path: PathBuf },
    #[error(
        "no texture keeps these limits: widen `design.coverage`, lower `design.feature` or `design.gap`, or allow more features"
    )]
    NoDesign,
    #[error("nothing can be compared with the slider without texture: {why}")]
    Reference { why: String },
    #[error("stopped by a signal: finished runs are safe, and the same command goes on from there")]
    Interrupted,
}

impl StudyError {
    /// The error of a picture of this name that cannot be drawn.
    pub fn picture(name: &str) -> impl Fn(PictureError) -> Self {
        move |source| Self::Picture {
            name: name.to_owned(),
            source,
        }
    }
}

/// Reason for which the model has no curves at some values of the unknowns.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum TrainingError {
    #[error("the unknowns {point}: {source}")]
    Case { point: String, source: Box<CaseError> },
    #[error("the unknowns {point}: {source}")]
    Instrument { point: String, source: InstrumentError },
    #[error("the unknowns {point}: {source}; narrow the ranges")]
    Run { point: String, source: RunError },
    #[error(
        "the unknowns {point}: the run ends before record {record} does, or its friction is no force along the drive: \
         set `time.duration` to the length of the record"
    )]
    Short { point: String, record: usize },
}

/// The explanation of recorded runs that do not belong to a study, to be inserted into a sentence.
pub(crate) fn of_others(runs: usize) -> String {
    match runs {
        0 => String::new(),
        _ => format!(
            ", and {} of another program than {}, or of a study that was changed since",
            are(runs, "recorded run"),
            program::this_program()
        ),
    }
}
