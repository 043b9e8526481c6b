//! Command `slipfront converge`: the mesh error of a result.

use std::path::{Path, PathBuf};

use clap::Args;
use jiff::SignedDuration;
use slipfront_study::converge::{MAX_LEVELS, MIN_LEVELS, MeshStudy, text, write};
use slipfront_study::{CostLimits, StudyFolder};

use super::study::{dry_run, run_all};
use crate::bounds::within;
use crate::case_args::CaseArgs;
use crate::failure::Failure;
use crate::print::{print, print_json, print_message};
use crate::ranks::CommandRanks;
use crate::runs_args::RunsArgs;
use crate::signals::Signals;
use crate::threads::{count_from_one, set_threads, set_worker_threads};
use crate::wrap::stdout_columns;

/// Run a case on several meshes and estimate the mesh error
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront converge cases/sheet.toml -o results/sheet
  slipfront converge cases/sheet.toml --levels 4 --set drive.v_star=0.005
  slipfront converge cases/circle.toml --replicates 8 --max-time 30min
  slipfront converge cases/sheet.toml --dry-run

Slider, load, mount, damping, speed and duration keep their values in metres, seconds and pascals. The block size is twice that of the
case, that of the case, half of it, and so on. If the command is stopped in any way, the same command resumes it.")]
pub(crate) struct ConvergeCommand {
    #[command(flatten)]
    case: CaseArgs,
    /// Folder for the results [default: results/NAME-meshes with the name of the case]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of meshes, each with half the block size of the previous one; the second is the mesh of the
    /// case
    #[arg(long, value_name = "N", default_value_t = MIN_LEVELS, value_parser = clap::value_parser!(u8).range(i64::from(MIN_LEVELS)..=i64::from(MAX_LEVELS)))]
    levels: u8,
    /// Random surfaces per mesh [default: 5 if coefficients are random, else 1]
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    replicates: Option<u16>,
    #[command(flatten)]
    runs: RunsArgs,
    /// Refuse to run if all runs together need more memory, in GB
    #[arg(long, value_name = "GB", value_parser = gigabytes)]
    max_memory: Option<f64>,
    /// Refuse to run if the estimated time is longer, such as 30min or 2h
    #[arg(long, value_name = "TIME")]
    max_time: Option<SignedDuration>,
    /// Print the meshes and the estimated time of their runs, without running them
    #[arg(long, conflicts_with = "device")]
    dry_run: bool,
    /// Do not print progress and tables
    #[arg(short, long)]
    quiet: bool,
    /// Print only the comparison to stdout, as JSON
    #[arg(long, conflicts_with = "dry_run")]
    json: bool,
}

/// Parses a size of memory in GB.
fn gigabytes(text: &str) -> Result<f64, String> {
    within(text, 0.001, 1e6, "GB")
}

impl ConvergeCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let threads = if self.dry_run {
            set_threads(self.runs.threads)?
        } else {
            set_worker_threads(self.runs.threads, 0)?
        };
        let signals = Signals::catch().map_err(Failure::running)?;
        let case = self.case.load(&CommandRanks::alone(), &signals, self.quiet)?;
        let (levels, replicates) = (i64::from(self.levels), self.replicates.map(i64::from));
        let study = MeshStudy::new(&case, levels, replicates);
        let MeshStudy { file, plan } = study.map_err(Failure::input)?;
        if self.dry_run {
            return print(&dry_run(&plan, threads)?);
        }
        let limits = CostLimits {
            memory_gb: self.max_memory,
            time: self.max_time,
        };
        limits.check(&plan, threads).map_err(Failure::input)?;
        let device = self.runs.device.open(None, self.quiet || self.json)?;
        let out = self.out.unwrap_or_else(|| Path::new("results").join(&file.name));
        let folder =
            StudyFolder::open(&out, &file, None, self.runs.force.given).map_err(Failure::from_folder)?;
        folder.check_disk(&plan).map_err(Failure::input)?;
        let plan = plan.reading_copies(&folder.study);
        let results = run_all(&plan, &folder, device.as_deref(), &signals, self.quiet)?;
        let found = write(&plan, &results, &folder, &signals.stop);
        let found = found.map_err(|error| Failure::from_results(&signals, error))?;
        if self.json {
            print_json(&found)?;
        } else if !self.quiet {
            print_message(&text(&plan, &found, stdout_columns()));
        }
        found.expect_values(folder.path()).map_err(Failure::running)
    }
}
