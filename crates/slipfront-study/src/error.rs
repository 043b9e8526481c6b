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
use slipfront_run::export::ExportError;
use slipfront_run::folder_error::FolderError;
use slipfront_run::instrument::InstrumentError;
use slipfront_run::pictures::error::RunPictureError;
use slipfront_run::program;
use slipfront_run::verify::VerifyError;

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
    #[error("the study has {runs} runs, more than {limit}: confirm with --yes")]
    Large { runs: u64, limit: u64 },
    #[error("the axes of the study give more than {limit} points: use fewer levels")]
    TooLarge { limit: usize },
    #[error(
        "{} at a time need about {needed} of memory, but {available} are available to this process: use --threads {fit}",
        count(*threads, "run")
    )]
    Memory {
        threads: usize,
        needed: String,
        available: String,
        fit: usize,
    },
    #[error(
        "a run of the point {point} needs about {needed} of memory, but {available} are available to this process: reduce \
        `slider.blocks`, or keep no run folders (`study.keep`)"
    )]
    PointMemory {
        point: String,
        needed: String,
        available: String,
    },
    #[error(
        "the design needs about {needed} of memory with one run at a time, but {available} are available to this process: \
        reduce `slider.blocks` or `design.runs`"
    )]
    DesignMemory { needed: String, available: String },
    #[error(
        "the calibration needs about {needed} of memory with one run at a time, but {available} are available to this process: \
        reduce `slider.blocks` of the case, or `calibrate.runs`"
    )]
    CalibrationMemory { needed: String, available: String },
    #[error(
        "the tables and pictures of the study need about {needed} of memory, but {available} are available to this process: \
        allow more, in a queue for example with `--mem`"
    )]
    ResultsMemory { needed: String, available: String },
    #[error(
        "the remaining runs need about {needed}, but {free} are free in {path}: keep fewer run folders (`study.keep`), or \
        choose another folder with --out"
    )]
    Disk {
        needed: String,
        free: String,
        path: PathBuf,
    },
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error(transparent)]
    Verify(#[from] VerifyError),
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error(
        "the study in {path} lacks {}{}: finish it first, or merge it with its other shards",
        count(*runs, "run"),
        of_others(*others)
    )]
    LacksRuns {
        path: PathBuf,
        runs: usize,
        others: usize,
    },
    #[error("the {what} in {path} is not finished: run it again to resume it first")]
    Unfinished { what: &'static str, path: PathBuf },
    #[error("the {what} in {path} is not finished: run it again to resume it, and then export it")]
    UnfinishedExport { what: &'static str, path: PathBuf },
    #[error(
        "{path} contains figures of `slipfront paper`, which can be computed again: give folders of runs or studies"
    )]
    ExportOfFigures { path: PathBuf },
    #[error("the folder {path} is not the folder of a {what}: choose another with --out")]
    OtherThings { what: &'static str, path: PathBuf },
    #[error(
        "the folder {path} contains another {what}, or an earlier version of this one: choose another with --out"
    )]
    Changed { what: &'static str, path: PathBuf },
    #[error(
        "the folder {path} of a {of} contains files that were edited, or were not written by slipfront: {}; move them away, \
        choose another folder with --out, or replace those that were edited with --force",
        single_line(&names.join(", "))
    )]
    Edited {
        of: &'static str,
        path: PathBuf,
        names: Vec<String>,
    },
    #[error(
        "{} is damaged: {why}; it lists the files written by slipfront, so no file was replaced: restore it, choose another \
        folder with --out, or give --force",
        display_path(path)
    )]
    Checksums { path: PathBuf, why: String },
    #[error(transparent)]
    Training(#[from] TrainingError),
    #[error(
        "--training {} is the results folder, which contains training runs by default: leave out --training, or give another folder",
        display_path(path)
    )]
    TrainingInResults { path: PathBuf },
    #[error("cannot write the texture: {0}")]
    Texture(#[from] TextureFileError),
    #[error("another slipfront is running in {path}: wait for it, or choose another folder with --out")]
    Busy { path: PathBuf },
    #[error(
        "cannot {action} {path}: {source}; finished runs are safe, and the same command resumes from there"
    )]
    Journal {
        action: &'static str,
        path: PathBuf,
        source: std::io::Error,
    },
    #[error(
        "cannot write {}: {source}; finished runs are safe, and the same command resumes from there",
        display_path(path)
    )]
    Write { path: PathBuf, source: std::io::Error },
    #[error("{path} is not a journal of runs")]
    NotJournal { path: PathBuf },
    #[error(
        "{path} contains runs of another kind of task: restore the original file, or choose another folder"
    )]
    OtherJournal { path: PathBuf },
    #[error(
        "cannot keep the folder of a run: {0}; finished runs are safe, and the same command resumes from there"
    )]
    Keep(#[from] RunPictureError),
    #[error(
        "{} in none of the shards{}: finish the shards, or run the rest with `slipfront study` on the study.toml of the merged \
        folder, with this folder as --out",
        are(*runs, "run"),
        of_others(*others)
    )]
    Missing { runs: usize, others: usize },
    #[error(
        "{path} is not the folder of the run that the journal names there: it was exchanged or replaced; put the \
        original back"
    )]
    NotItsRun { path: PathBuf },
    #[error("{other} and {first} belong to different studies: merge only shards of the same study")]
    Foreign { first: PathBuf, other: PathBuf },
    #[error(
        "{path} holds part {there} of this study, not part {part}: choose another folder with --out; with `--shard slurm`, submit \
        the whole array again, or write the part in figures, such as --shard {there}"
    )]
    OtherPart {
        path: PathBuf,
        there: String,
        part: String,
    },
    #[error("invalid shard `{given}`: {why}; write i/n with i from 1 to n, such as 2/8, or `slurm`")]
    Shard { given: String, why: String },
    #[error("cannot draw {name}: {source}")]
    Picture { name: String, source: PictureError },
    #[error(
        "{levels} meshes are not possible: give {fewest} to {most} levels; the second level is the mesh of the case"
    )]
    Levels { levels: i64, fewest: u8, most: u8 },
    #[error(
        "with blocks of {block_size} no block is textured: start with finer blocks, with `slider.blocks` and `slider.block_size`"
    )]
    Bare { block_size: String },
    #[error(
        "the runs need {needed} of memory, {threads} at a time: more than --max-memory {most}; use fewer --levels or --threads"
    )]
    MemoryLimit {
        needed: String,
        threads: usize,
        most: f64,
    },
    #[error(
        "the runs are estimated to take at least {estimated:#}, longer than --max-time {most:#}: use fewer --levels or \
        --replicates"
    )]
    TimeLimit {
        estimated: SignedDuration,
        most: SignedDuration,
    },
    #[error(
        "{failed} of {} failed; the tables contain the others. First failure, replicate {replicate} of the point {point}: {reason}",
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
        "no run has a value of {quantity}{}: the tables contain the other quantities",
        if *needs_transition {
            ", because none has a transition from static to kinetic friction. Increase `time.duration_star` of the base if the runs end before the transition"
        } else {
            ""
        }
    )]
    NoValue {
        quantity: String,
        needs_transition: bool,
    },
    #[error(
        "no quantity has a value on every mesh: {} contains the results of the runs. Increase `time.duration_star` if they end before a transition",
        display_path(path)
    )]
    NotOnMeshes { path: PathBuf },
    #[error(
        "the model cannot reproduce these records, so its numbers do not describe them: {} gives the reasons, and what to check",
        display_path(path)
    )]
    Refused { path: PathBuf },
    #[error(
        "there is no verdict, because every tested texture failed on new random surfaces: {} gives the reasons",
        display_path(path)
    )]
    NoVerdict { path: PathBuf },
    #[error(
        "no texture satisfies these limits{why}: widen `design.coverage`, reduce `design.feature` or `design.gap`, or allow more features"
    )]
    NoDesign { why: String },
    #[error("a comparison with the untextured slider is not possible: {why}")]
    Reference { why: String },
    #[error("stopped by a signal: finished runs are safe, and the same command resumes from there")]
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

/// The model has no curves at some values of the unknowns.
#[derive(Debug, Error)]
#[error("the unknowns {point}: {reason}")]
pub struct TrainingError {
    /// The values of the unknowns.
    pub point: String,
    /// Reason why there are no curves.
    pub reason: Box<NoCurve>,
}

/// Reason why the model has no curve.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum NoCurve {
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Instrument(#[from] InstrumentError),
    #[error("{0}; narrow the ranges")]
    Run(#[from] RunError),
    #[error(
        "the run ends before record {record}, or its friction is not a force along the drive: set `time.duration` to the \
         duration of the record"
    )]
    Short { record: usize },
}

/// The explanation of recorded runs that do not belong to a study, to be inserted into a sentence.
fn of_others(runs: usize) -> String {
    match runs {
        0 => String::new(),
        _ => format!(
            ", and {} from another program than {}, or from a study that was changed since",
            are(runs, "recorded run"),
            program::this_program()
        ),
    }
}
