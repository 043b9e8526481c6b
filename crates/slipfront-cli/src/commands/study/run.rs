//! `slipfront study STUDY.toml`: run what is missing, then write tables and pictures.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use clap::Args;
use signal_hook::consts::{SIGINT, SIGTERM};
use slipfront::Simulation;
use slipfront_case::study::{self, Findings, Plan, Role, RunKey, Shard, StudyError, StudyFile, StudyFolder};

use crate::commands::{print, set_threads};
use crate::failure::Failure;
use crate::progress::StudyProgress;
use crate::report;

#[derive(Args)]
pub(crate) struct StudyRun {
    /// Study file
    #[arg(value_name = "STUDY.toml", required = true)]
    study: Option<PathBuf>,
    /// Folder for the results [default: results/ and the name of the study]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Most runs at once [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Show neither progress nor tables
    #[arg(short, long)]
    quiet: bool,
    /// Print the plan and what it will cost, and run nothing
    #[arg(long)]
    dry_run: bool,
    /// Run only part i of n of the points; `slurm` takes i and n from the array task
    #[arg(long, value_name = "i/n")]
    shard: Option<Shard>,
    /// Run more than 10 000 runs without asking
    #[arg(long)]
    yes: bool,
}

/// Runs that are done without asking.
const MANY: u64 = 10_000;

impl StudyRun {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let threads = set_threads(self.threads)?;
        let Some(path) = self.study else {
            return Err(Failure::input(anyhow::anyhow!("name a study file")));
        };
        let file = StudyFile::load(&path).map_err(Failure::input)?;
        let plan = Plan::new(&file, self.shard).map_err(Failure::input)?;
        if self.dry_run {
            return print(&dry_run(&plan, threads)?);
        }
        let runs = plan.runs(plan.settings.max_replicates());
        if runs > MANY && !self.yes {
            return Err(Failure::input(StudyError::Large { runs, limit: MANY }));
        }
        let out = self
            .out
            .unwrap_or_else(|| PathBuf::from("results").join(&file.name));
        let mut folder = StudyFolder::open(&out, &file).map_err(Failure::input)?;
        folder.copy_inputs(&plan, &file).map_err(Failure::running)?;
        run(&plan, &mut folder, threads, self.quiet)
    }
}

/// Runs what the folder lacks, and writes tables and pictures.
pub(super) fn run(plan: &Plan, folder: &mut StudyFolder, threads: usize, quiet: bool) -> Result<(), Failure> {
    let (stop, signal) = on_signals().map_err(Failure::running)?;
    if folder.records.damaged > 0 && !quiet {
        eprintln!(
            "{} damaged lines of the record file count as not run",
            folder.records.damaged
        );
    }
    let mut progress = StudyProgress::new(quiet);
    let path = folder.path().to_owned();
    let done = study::execute(plan, &mut folder.records, &path, threads, &stop, &mut |now| {
        progress.show(now)
    });
    progress.finish();
    let findings = match done {
        Err(StudyError::Interrupted) => return Err(Failure::Stopped(signal.load(Ordering::Relaxed))),
        done => done.map_err(Failure::running)?,
    };
    study::write(plan, &findings, folder).map_err(Failure::running)?;
    if !quiet {
        print(&report::study(plan, &findings, folder.path()))?;
    }
    failures(plan, &findings)
}

/// Flags that SIGINT and SIGTERM set: that one came, and which.
fn on_signals() -> std::io::Result<(Arc<AtomicBool>, Arc<AtomicUsize>)> {
    let (stop, which) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
    for signal in [SIGINT, SIGTERM] {
        // A second signal ends the process at once.
        signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&stop))?;
        signal_hook::flag::register_usize(signal, Arc::clone(&which), signal as usize)?;
        signal_hook::flag::register(signal, Arc::clone(&stop))?;
    }
    Ok((stop, which))
}

/// A study with failed runs is done, but not well.
fn failures(plan: &Plan, findings: &Findings) -> Result<(), Failure> {
    let failed: Vec<(RunKey, &str)> = findings.failures().collect();
    let Some((run, reason)) = failed.first() else {
        return Ok(());
    };
    let point = plan.points.iter().find(|point| point.index == run.point);
    let place = point.map_or(String::new(), |point| plan.describe(point));
    let sentence = format!(
        "{} runs failed, the others stand in the tables; the first, replicate {} of the point {place}: {reason}",
        failed.len(),
        run.replicate
    );
    Err(Failure::running(anyhow::anyhow!(sentence)))
}

/// Steps by which the cost of a run is measured.
const PROBE_STEPS: u32 = 200;

fn dry_run(plan: &Plan, threads: usize) -> Result<String, Failure> {
    let replicates = plan.settings.min_replicates();
    let mut block_steps = 0.0;
    let mut per_block_step = None;
    for point in &plan.points {
        for role in [Role::Point, Role::Reference]
            .into_iter()
            .take(1 + usize::from(plan.has_reference()))
        {
            let case = plan
                .case(RunKey {
                    point: point.index,
                    replicate: 0,
                    role,
                })
                .map_err(Failure::input)?;
            block_steps += replicates as f64 * case.block_steps();
            per_block_step.get_or_insert_with(|| {
                let began = Instant::now();
                let mut simulation = Simulation::at_rest(&case.model, case.schedule.dt_star);
                (0..PROBE_STEPS).for_each(|_| simulation.step());
                let steps = f64::from(PROBE_STEPS) * case.model.lattice.n_blocks() as f64;
                began.elapsed().as_secs_f64() / steps
            });
        }
    }
    // Observers cost about as much as the step itself.
    let seconds = 2.0 * block_steps * per_block_step.unwrap_or_default() / threads as f64;
    Ok(report::plan(plan, block_steps, seconds, threads))
}
