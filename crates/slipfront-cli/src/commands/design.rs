//! `slipfront design`: the texture with the desired friction.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use jiff::SignedDuration;
use slipfront_design::{Bounds, DesignFile, DesignFolder};
use slipfront_study::StudyError;

use crate::failure::Failure;
use crate::print::{print, print_file, print_json, print_message};
use crate::print_stderr::print_notes;
use crate::progress::design::show_design;
use crate::progress::display::ProgressDisplay;
use crate::report::design::design;
use crate::runs_args::RunsArgs;
use crate::signals::Signals;
use crate::threads::set_threads;

/// Search for a texture with the desired friction
///
/// The best texture is tested on random surfaces that the search did not use
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront design cases/designs/least_friction.toml
  slipfront design cases/designs/least_friction.toml --runs 2000 -o results/quick
  slipfront design cases/designs/static_friction.toml --time 60s
  slipfront design cases/designs/dimples.toml --dry-run

If the command is stopped in any way, the same command resumes it. The folder contains the mask as .npy, .png, .svg, .dxf and .gsf, a
case that reads it, and a comparison with named patterns.")]
pub(crate) struct DesignCommand {
    /// Design file
    #[arg(value_name = "DESIGN.toml")]
    design: PathBuf,
    /// Folder for the results [default: results/NAME with the name of the design]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of runs of the search, instead of `design.runs`; the final test takes further runs
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    runs: Option<u32>,
    /// Stop the search after this time, such as 60s or 10min; the result then depends on the speed of this
    /// machine
    #[arg(long, value_name = "TIME")]
    time: Option<SignedDuration>,
    #[command(flatten)]
    many_runs: RunsArgs,
    /// Print the target, the maximum number of runs and their estimated time, without running them
    #[arg(long)]
    dry_run: bool,
    /// Do not print progress and verdict
    #[arg(short, long)]
    quiet: bool,
    /// Print only the verdict to stdout, as JSON; with --dry-run the plan
    #[arg(long)]
    json: bool,
}

impl DesignCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let threads = set_threads(self.many_runs.threads)?;
        let file = DesignFile::load(&self.design).map_err(Failure::input)?;
        let runs = self.runs.unwrap_or(file.keys.runs) as usize;
        // A design that is invalid or needs too much memory leaves no folder.
        file.check(runs, threads, self.time.is_some())
            .map_err(Failure::input)?;
        if self.dry_run {
            return self.plan(&file, runs, threads);
        }
        let refused = file
            .has_curve()
            .then_some("the runs of a target curve are computed on the CPU alone");
        let device = self.many_runs.device.open(refused, self.quiet || self.json)?;
        let out = self
            .out
            .unwrap_or_else(|| Path::new("results").join(&file.project.name));
        // A signal removes all files that were copied to the folder.
        let signals = Signals::catch().map_err(Failure::running)?;
        let folder =
            DesignFolder::open(&out, &file, self.many_runs.force.given).map_err(Failure::from_folder)?;
        let mut folder = folder.on_device(device);
        let began = Instant::now();
        let most = self.time.map(|time| time.as_secs_f64());
        let share_of_time = || Bounds::share_of(began.elapsed().as_secs_f64(), most);
        let bounds = Bounds {
            runs,
            share_of_time: &share_of_time,
            stop: &signals.stop,
            cut: None,
        };
        if !self.quiet && !self.json {
            print_notes(folder.notes());
        }
        let mut progress = ProgressDisplay::new(self.quiet);
        let found = folder.find(&bounds, &mut |now| show_design(&mut progress, now));
        progress.finish();
        let text = found.map_err(|error| match error {
            StudyError::Interrupted => {
                let (out, best) = (out.display(), out.join("mask.npy"));
                let so_far = if folder.has_verdict() {
                    format!("{out} still contains the results of an earlier search; ")
                } else if best.exists() {
                    format!(
                        "the best texture so far is in {}, without a verdict; ",
                        best.display()
                    )
                } else {
                    String::new()
                };
                let sentence = format!("stopped by a signal: {so_far}the same command resumes from there");
                Failure::stopped(&signals, sentence)
            }
            StudyError::NoDesign { .. } => Failure::input(error),
            error => Failure::from_results(&signals, error),
        })?;
        if self.json {
            print_file(&folder.numbers())?;
        } else if !self.quiet {
            print_message(&format!("{text}\n{}\n", folder.path().display()));
        }
        folder.expect_verdict().map_err(Failure::running)
    }

    /// Prints the target of the search, and its cost.
    fn plan(&self, file: &DesignFile, runs: usize, threads: usize) -> Result<(), Failure> {
        let plan = file.plan(runs, threads).map_err(Failure::input)?;
        if self.json {
            return print_json(&plan);
        }
        print(&design(&plan, threads))
    }
}
