//! `slipfront study STUDY.toml`: computes missing runs, then writes tables and pictures.

use std::path::{Path, PathBuf};

use clap::Args;
use slipfront::device::Device;
use slipfront_base::disk::is_same;
use slipfront_study as study;
use slipfront_study::{Plan, Progress, Shard, StudyError, StudyFile, StudyFolder, StudyResults};

use crate::failure::Failure;
use crate::print::{print, print_json, print_message};
use crate::print_stderr::print_notes;
use crate::progress::display::ProgressDisplay;
use crate::progress::study::show_study;
use crate::report::study::{study_plan, study_results};
use crate::runs_args::RunsArgs;
use crate::signals::Signals;
use crate::threads::{set_threads, set_worker_threads};

#[derive(Args)]
pub(crate) struct StudyRun {
    /// Study file
    #[arg(value_name = "STUDY.toml", required = true)]
    study: Option<PathBuf>,
    /// Set a key of the base case, such as drive.v_star=0.05 or texture.0.coverage=5; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Folder for the results [default: results/NAME with the name of the study]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    runs: RunsArgs,
    /// Do not print progress and tables
    #[arg(short, long)]
    quiet: bool,
    /// Print only the results to stdout, as JSON
    #[arg(long, conflicts_with = "dry_run")]
    json: bool,
    /// Print the plan and its cost, without running it
    #[arg(long)]
    dry_run: bool,
    /// Run only part i of n of the points; `slurm` reads i and n from the array task
    #[arg(long, value_name = "i/n")]
    shard: Option<Shard>,
    /// Allow more than 10 000 runs
    #[arg(long)]
    yes: bool,
}

/// Reason why runs of some studies are computed on the CPU.
const FOLDERS_ON_CPU: &str = "folders of all runs (`study.keep = \"all\"`) are only written on the CPU: keep those of failed runs, or none";

/// Largest number of runs of a study without `--yes`.
const MAX_UNCONFIRMED_RUNS: u64 = 10_000;

/// Refuses a very large study unless the user has confirmed it.
pub(super) fn refuse_large(file: &StudyFile, confirmed: bool) -> Result<(), Failure> {
    let runs = file.count_runs().map_err(Failure::input)?;
    if runs > MAX_UNCONFIRMED_RUNS && !confirmed {
        return Err(Failure::input(StudyError::Large {
            runs,
            limit: MAX_UNCONFIRMED_RUNS,
        }));
    }
    Ok(())
}

impl StudyRun {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let threads = if self.dry_run {
            set_threads(self.runs.threads)?
        } else {
            set_worker_threads(self.runs.threads, 0)?
        };
        let Some(path) = self.study else {
            return Err(Failure::input("name a study file"));
        };
        let mut file = StudyFile::load(&path).map_err(Failure::input)?;
        file.set(&self.overrides).map_err(Failure::input)?;
        refuse_large(&file, self.yes || self.dry_run)?;
        let plan = Plan::new(&file, self.shard).map_err(Failure::input)?;
        if self.dry_run {
            return print(&dry_run(&plan, threads)?);
        }
        plan.check_memory(threads).map_err(Failure::input)?;
        let kept = plan.settings.keeps_all_runs().then_some(FOLDERS_ON_CPU);
        let device = self.runs.device.open(kept, self.quiet)?;
        let is_changed_unsaid = self.out.is_none() && !self.overrides.is_empty();
        let out = self.out.unwrap_or_else(|| default_out(&file.name, self.shard));
        refuse_to_replace(&path, file.has_base_file() || is_changed_unsaid, &out)?;
        // A signal removes all files that were copied to the folder.
        let signals = Signals::catch().map_err(Failure::running)?;
        let folder = StudyFolder::open(&out, &file, self.shard, self.runs.force.given)
            .map_err(Failure::from_folder)?;
        folder.check_disk(&plan).map_err(Failure::input)?;
        let plan = plan.reading_copies(&folder.study);
        let results = run_all(&plan, &folder, device.as_deref(), &signals, self.quiet)?;
        study::write(&plan, &results, &folder, &signals.stop)
            .map_err(|error| Failure::from_results(&signals, error))?;
        if self.json {
            print_json(&study::answer(&plan, &results))?;
        } else if !self.quiet {
            print_message(&study_results(&plan, &results, folder.path()));
        }
        results.expect_no_failures(&plan).map_err(Failure::running)?;
        // Values that one shard lacks may be in the other shards.
        if self.shard.is_some() {
            return Ok(());
        }
        results.expect_values(&plan).map_err(Failure::running)
    }
}

/// Refuses the folder of the study file itself as the output folder if the study as run `differs` from the
/// file: the results folder contains the study with its base written out and the keys of `--set`, which would
/// replace the file.
fn refuse_to_replace(path: &Path, differs: bool, out: &Path) -> Result<(), Failure> {
    if !differs || !is_same(path, &out.join("study.toml")) {
        return Ok(());
    }
    let sentence = format!(
        "the results would replace {}, an input of the study: move it out of the folder, or choose another folder with --out",
        path.display()
    );
    Err(Failure::input(sentence))
}

/// Default folder for the results; each shard has its own.
fn default_out(name: &str, shard: Option<Shard>) -> PathBuf {
    let name = match shard {
        Some(shard) => format!("{name}-{}", shard.to_string().replace('/', "-of-")),
        None => name.to_owned(),
    };
    PathBuf::from("results").join(name)
}

/// Computes the runs that are missing in the folder.
pub(in crate::commands) fn run_all(
    plan: &Plan,
    folder: &StudyFolder,
    device: Option<&dyn Device>,
    signals: &Signals,
    quiet: bool,
) -> Result<StudyResults, Failure> {
    let mut progress = ProgressDisplay::new(quiet);
    if !quiet {
        print_notes(study::idle_axes(plan));
        print_notes(folder.notes());
    }
    let (records, path, stop) = (&folder.records, folder.path(), &signals.stop);
    let watch = &mut |now: &Progress| show_study(&mut progress, now);
    let done = match device {
        Some(device) => study::execute_on_device(plan, records, path, device, stop, watch),
        None => study::execute(plan, records, path, stop, watch),
    };
    progress.finish();
    done.map_err(|error| Failure::from_results(signals, error))
}

/// The plan of a study, with its cost as measured on this machine.
pub(in crate::commands) fn dry_run(plan: &Plan, threads: usize) -> Result<String, Failure> {
    // Only one run must fit into this machine: the study may be meant for another machine.
    plan.check_memory(1).map_err(Failure::input)?;
    let time = study::estimated_time(plan, threads).map_err(Failure::input)?;
    Ok(study_plan(plan, time, threads))
}
