//! `slipfront converge`: how much of a result belongs to the mesh.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::Args;
use jiff::SignedDuration;
use slipfront_case::case::Case;
use slipfront_case::number_format::byte_size;
use slipfront_study::converge::{MAX_LEVELS, MIN_LEVELS, OnMeshes, mesh_study, meshes, without_texture};
use slipfront_study::{Plan, StudyFolder};

use super::study::{estimated_seconds, finish, run_all};
use crate::case_args::CaseArgs;
use crate::failure::Failure;
use crate::print::print_message;
use crate::ranks::CommandRanks;
use crate::report;
use crate::signals::Signals;
use crate::threads::{count_from_one, set_worker_threads};

/// Run a case on several meshes: what it finds, with an error that says how much of it belongs to the mesh
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront converge cases/sheet.toml -o results/sheet
  slipfront converge cases/sheet.toml --levels 4 --set drive.v_star=0.005
  slipfront converge cases/circle.toml --replicates 8 --max-time 30min

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
    /// Most runs at once [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
    /// Runs nothing if all runs together need more memory, in GB
    #[arg(long, value_name = "GB")]
    max_memory: Option<f64>,
    /// Runs nothing if the runs are estimated to take longer, such as 30min or 2h
    #[arg(long, value_name = "TIME")]
    max_time: Option<SignedDuration>,
    /// Show neither progress nor tables
    #[arg(short, long)]
    quiet: bool,
}

/// Surfaces of a mesh if coefficients scatter.
const REPLICATES: u16 = 5;

impl ConvergeCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let threads = set_worker_threads(self.threads, 0)?;
        let folder = self.case.folder();
        let signals = Signals::catch().map_err(Failure::running)?;
        let case = self.case.load(&CommandRanks::alone(), &signals, self.quiet)?;
        let replicates = self.replicates.unwrap_or_else(|| default_replicates(&case));
        let name = format!("{}-meshes", case.name);
        let file = mesh_study(&case, &name, &folder, self.levels, u32::from(replicates));
        let file = file.map_err(Failure::input)?;
        let plan = Plan::new(&file, None).map_err(Failure::input)?;
        refuse_vanished(&plan)?;
        plan.check_memory(threads).map_err(Failure::input)?;
        refuse_costly(&plan, threads, self.max_memory, self.max_time)?;
        let out = self.out.unwrap_or_else(|| Path::new("results").join(&name));
        let folder = StudyFolder::open(&out, &file).map_err(Failure::input)?;
        folder.check_disk(&plan).map_err(Failure::input)?;
        let plan = plan.reading_copies(&folder.study);
        let results = run_all(&plan, &folder, &signals, self.quiet)?;
        finish(&plan, &results, &folder, true)?;
        let found = OnMeshes::of(&plan, &results, &case);
        let text = report::convergence(&plan, &found);
        found.write(&folder, &text).map_err(Failure::running)?;
        if !self.quiet {
            print_message(&text);
        }
        Ok(())
    }
}

/// Several where surfaces differ by their seeds.
fn default_replicates(case: &Case) -> u16 {
    let groups = &case.groups;
    if groups.sigma_static_star > 0.0 || groups.sigma_kinetic_star > 0.0 {
        REPLICATES
    } else {
        1
    }
}

/// Refuses textures that the blocks of a mesh are too large for.
fn refuse_vanished(plan: &Plan) -> Result<(), Failure> {
    let Some(position) = without_texture(plan) else {
        return Ok(());
    };
    let size = &meshes(plan)[position].block_size;
    Err(Failure::input(anyhow!(
        "on blocks of {size} no block is textured: begin with finer blocks, by `slider.blocks` and `slider.block_size`"
    )))
}

/// Refuses what takes more memory or time than the user allows.
fn refuse_costly(
    plan: &Plan,
    threads: usize,
    max_memory: Option<f64>,
    max_time: Option<SignedDuration>,
) -> Result<(), Failure> {
    const GB: f64 = 1e9;
    let memory = plan.memory(threads);
    // NaN is a limit that nothing fits.
    let fits = |most: f64| memory <= most * GB;
    if let Some(most) = max_memory.filter(|most| !fits(*most)) {
        return Err(Failure::input(anyhow!(
            "the runs need {} of memory, {threads} at once: more than --max-memory {} allows; take fewer --levels or --threads",
            byte_size(memory),
            most
        )));
    }
    let Some(most) = max_time else { return Ok(()) };
    let seconds = estimated_seconds(plan, threads)?;
    if seconds > most.as_secs_f64() {
        return Err(Failure::input(anyhow!(
            "the runs are estimated to take {}: longer than --max-time {most:#} allows; take fewer --levels or --replicates",
            report::duration(seconds)
        )));
    }
    Ok(())
}
