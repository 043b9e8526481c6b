//! Command `slipfront converge`: the mesh error of a result.

use std::path::{Path, PathBuf};

use clap::Args;
use jiff::SignedDuration;
use slipfront_study::converge::{MAX_LEVELS, MIN_LEVELS, MeshStudy, text, write};
use slipfront_study::{CostLimits, StudyFolder};

use super::study::{dry_run, run_all};
use crate::case_args::CaseArgs;
use crate::failure::Failure;
use crate::print::{print, print_message};
use crate::ranks::CommandRanks;
use crate::report::text_of;
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

The slider, its load, mount, damping, speed and duration stay what they are in metres, seconds and pascals; blocks have twice their
size, their own, half of it, and so on. The folder is that of a study: stopped in any way, the same command goes on where it was.")]
pub(crate) struct ConvergeCommand {
    #[command(flatten)]
    case: CaseArgs,
    /// Folder for the results [default: results/ and the name of the case with -meshes]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of meshes, each of half the blocks' size of the one before; the second is that of the case
    #[arg(long, value_name = "N", default_value_t = MIN_LEVELS, value_parser = clap::value_parser!(u8).range(i64::from(MIN_LEVELS)..=i64::from(MAX_LEVELS)))]
    levels: u8,
    /// Surfaces of each mesh [default: 5 if coefficients scatter, else 1]
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    replicates: Option<u16>,
    /// Replace files of the results that were edited since they were written, and files of others in their
    /// places
    #[arg(long)]
    force: bool,
    /// Most runs at once [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
    /// Runs nothing if all runs together need more memory, in GB
    #[arg(long, value_name = "GB")]
    max_memory: Option<f64>,
    /// Runs nothing if the runs are estimated to take longer, such as 30min or 2h
    #[arg(long, value_name = "TIME")]
    max_time: Option<SignedDuration>,
    /// Print the meshes with the time of their runs, and run nothing
    #[arg(long)]
    dry_run: bool,
    /// Show neither progress nor tables
    #[arg(short, long)]
    quiet: bool,
    /// Print the comparison as JSON on stdout, and nothing else there
    #[arg(long, conflicts_with = "dry_run")]
    json: bool,
}

impl ConvergeCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let threads = if self.dry_run {
            set_threads(self.threads)?
        } else {
            set_worker_threads(self.threads, 0)?
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
        let out = self.out.unwrap_or_else(|| Path::new("results").join(&file.name));
        let folder = StudyFolder::open(&out, &file, self.force).map_err(Failure::of_folder)?;
        folder.check_disk(&plan).map_err(Failure::input)?;
        let plan = plan.reading_copies(&folder.study);
        let results = run_all(&plan, &folder, None, &signals, self.quiet)?;
        let found = write(&plan, &results, &folder, &signals.stop);
        let found = found.map_err(|error| Failure::of_results(&signals, error))?;
        if self.json {
            let found = serde_json::to_value(&found).map_err(Failure::running)?;
            print(&text_of(&found))?;
        } else if !self.quiet {
            print_message(&text(&plan, &found, stdout_columns()));
        }
        found.expect_values(folder.path()).map_err(Failure::running)
    }
}
