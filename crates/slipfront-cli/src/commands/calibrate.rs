//! `slipfront calibrate`: estimates keys of a case from measured records.

use std::path::{Path, PathBuf};

use clap::Args;
use slipfront_calibrate::{CalibrationFile, CalibrationFolder, CalibrationProgress, SampledRecord};
use slipfront_study::StudyError;

use crate::failure::Failure;
use crate::print::{print, print_file, print_json, print_message};
use crate::print_stderr::print_notes;
use crate::progress::calibrate::show_calibration;
use crate::progress::display::ProgressDisplay;
use crate::runs_args::RunsArgs;
use crate::signals::Signals;
use crate::threads::set_threads;

/// Estimate parameters from measured friction curves
///
/// Every parameter has a credible interval; a record that the model cannot reproduce is rejected
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront calibrate cases/calibrations/sliding.toml cases/calibrations/sliding.csv
  slipfront calibrate cases/calibrations/sliding.toml cases/calibrations/sliding.csv --training results/training -o results/first
  slipfront calibrate cases/calibrations/paper.toml --dry-run --until \"2 s\"

If the command is stopped in any way, the same command resumes it. The folder contains the intervals, a picture of each record with
the calibrated model, and a case with the medians.")]
pub(crate) struct CalibrateCommand {
    /// Calibration file
    #[arg(value_name = "CALIBRATION.toml")]
    calibration: PathBuf,
    /// Measured records as text tables (.csv), in the order of `calibrate.records`
    #[arg(required_unless_present = "until", value_name = "RECORD")]
    records: Vec<PathBuf>,
    /// Plan a measurement: simulate records and print the expected intervals, also for longer, slower and
    /// faster experiments, and write nothing; given records only supply their times
    #[arg(long, conflicts_with = "device")]
    dry_run: bool,
    /// End of the planned record with its unit, such as "20 s", instead of records
    #[arg(long, value_name = "PLACE", requires = "dry_run", conflicts_with = "records")]
    until: Option<String>,
    /// Number of values of the planned record
    #[arg(long, value_name = "N", requires = "until", default_value_t = 400, value_parser = clap::value_parser!(u32).range(40..=1_000_000))]
    values: u32,
    /// Folder for the results [default: results/NAME with the name of the calibration]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder for training runs, which calibrations of other records can share [default: the results folder]
    #[arg(long, value_name = "DIR")]
    training: Option<PathBuf>,
    #[command(flatten)]
    runs: RunsArgs,
    /// Do not print progress and estimates
    #[arg(short, long)]
    quiet: bool,
    /// Print only the estimates to stdout, as JSON; with --dry-run the plan
    #[arg(long)]
    json: bool,
}

impl CalibrateCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let threads = set_threads(self.runs.threads)?;
        let file = CalibrationFile::load(&self.calibration).map_err(Failure::input)?;
        if self.dry_run {
            return self.plan(&file);
        }
        let records = file.read(&self.records).map_err(Failure::input)?;
        // A calibration that is invalid or needs too much memory leaves no folder.
        file.check_memory(&records, threads).map_err(Failure::input)?;
        let device = self.runs.device.open(None, self.quiet || self.json)?;
        let out = self
            .out
            .unwrap_or_else(|| Path::new("results").join(&file.project.name));
        let training = self.training.as_deref();
        let notes: Vec<String> = records.iter().flat_map(SampledRecord::notes).collect();
        // A signal removes all files that were copied to the folder.
        let signals = Signals::catch().map_err(Failure::running)?;
        let folder = CalibrationFolder::open(&out, training, &file, records, self.runs.force.given);
        let mut folder = folder.map_err(Failure::from_folder)?;
        if !self.quiet && !self.json {
            print_notes(notes);
            print_notes(folder.notes());
        }
        let mut progress = ProgressDisplay::new(self.quiet);
        let show = &mut |now: &CalibrationProgress| show_calibration(&mut progress, now);
        let found = folder.find(device.as_deref(), &signals.stop, show);
        progress.finish();
        let text = found.map_err(|error| match error {
            StudyError::Interrupted => Failure::stopped(
                &signals,
                "stopped by a signal: the same command resumes from there",
            ),
            StudyError::Training(error) => Failure::input(error),
            error => Failure::from_results(&signals, error),
        })?;
        if self.json {
            print_file(&folder.numbers())?;
        } else if !self.quiet {
            print_message(&format!("{text}\n{}\n", folder.path().display()));
        }
        folder.expect_own_records().map_err(Failure::running)
    }

    /// Prints what planned records would determine.
    fn plan(&self, file: &CalibrationFile) -> Result<(), Failure> {
        let grids = match &self.until {
            Some(until) => file.planned(until, self.values as usize),
            None => {
                let records = file.read(&self.records);
                records.map(|records| records.iter().map(SampledRecord::places).collect())
            }
        };
        let grids = grids.map_err(Failure::input)?;
        let signals = Signals::catch().map_err(Failure::running)?;
        let mut progress = ProgressDisplay::new(self.quiet);
        let show = &mut |now: &CalibrationProgress| show_calibration(&mut progress, now);
        let plan = file.plan(grids, &signals.stop, show);
        progress.finish();
        let plan = plan.map_err(|error| match error {
            StudyError::Interrupted => Failure::stopped(&signals, "stopped by a signal"),
            error => Failure::input(error),
        })?;
        if self.json {
            return print_json(&plan);
        }
        print(&plan.in_words())
    }
}
