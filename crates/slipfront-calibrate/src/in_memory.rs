//! A calibration without a results folder, for a web page: the page passes texts and bytes, and can
//! distribute the runs over several workers.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_case::case::FilesInMemory;
use slipfront_study::{StudyError, TrainingError};

use crate::file::CalibrationFile;
use crate::fit::Fit;
use crate::progress::CalibrationProgress;
use crate::report::Report;
use crate::runs::{KeptRuns, RunMaker, WantedRun};
use crate::set_up::Curves;

/// A calibration with its file, record and runs in memory.
#[derive(Debug)]
pub struct CalibrationInMemory {
    fit: Fit,
    kept: KeptRuns,
}

/// Results of a calibration, with the bytes that a results folder has.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationResults {
    /// The findings as JSON, as in `calibration.json`.
    pub numbers: String,
    /// The findings as a text, as in `calibration.txt`.
    pub report: String,
    /// Keys of the case, each with the median of an unknown.
    pub set: Vec<(String, toml::Value)>,
}

/// End of a call that calibrates.
#[derive(Debug)]
pub enum Outcome {
    /// The calibration is done.
    Found(CalibrationResults),
    /// The calibration needs these runs first; pass them to [`add`](CalibrationInMemory::add).
    Wants(Vec<WantedRun>),
}

impl CalibrationInMemory {
    /// A calibration from the text of a calibration file and a record with this name and content. Files that
    /// the base case names are in memory.
    ///
    /// # Errors
    /// When the file is not valid, the record cannot be read, the ranges leave the bounds of the case, or
    /// there is no memory for `threads` runs at once.
    pub fn new(
        text: &str,
        files: FilesInMemory,
        (name, bytes): (&str, Vec<u8>),
        threads: usize,
    ) -> Result<Self, StudyError> {
        let file = CalibrationFile::parse(text, "calibration.toml", "calibration", Path::new(""))?;
        let file = file.with_files(files);
        let records = vec![file.read_bytes(0, Path::new(name), bytes)?];
        file.check_memory(&records, threads)?;
        Ok(Self {
            fit: Fit::new(file, records)?,
            kept: KeptRuns::default(),
        })
    }

    /// Calibrates, or returns the runs that are needed first if they are made elsewhere.
    ///
    /// # Errors
    /// When a run cannot be made, and after a stop.
    pub fn find(
        &mut self,
        is_elsewhere: bool,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&CalibrationProgress),
    ) -> Result<Outcome, StudyError> {
        let mut maker = RunMaker::new(stop, 0, watch);
        (maker.kept, maker.is_elsewhere) = (Some(&mut self.kept), is_elsewhere);
        let found = match self.fit.find(&mut maker) {
            Err(StudyError::Interrupted) => {
                let wanted = maker.wanted.ok_or(StudyError::Interrupted);
                return wanted.map(Outcome::Wants);
            }
            found => found?,
        };
        let report = Report::new(&self.fit.set_up, &found.findings);
        let set = report.set();
        Ok(Outcome::Found(CalibrationResults {
            // Structs of texts and numbers: serialisation cannot fail.
            numbers: serde_json::to_string_pretty(&found.findings).expect("findings are JSON"),
            report: report.text()?,
            set: set
                .iter()
                .map(|set| (set.key().to_owned(), set.value()))
                .collect(),
        }))
    }

    /// Makes a run that another calibration with the same file and record needs; none after a stop.
    ///
    /// # Errors
    /// The error of the run.
    pub fn make(&self, wanted: &WantedRun, stop: &AtomicBool) -> Result<Option<Curves>, TrainingError> {
        wanted.make(&self.fit.set_up, stop)
    }

    /// Adds a needed run that was made elsewhere.
    pub fn add(&mut self, wanted: WantedRun, made: Curves) {
        self.kept.known.insert(wanted.id, made);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file and a record of a small slider without random coefficients.
    fn small() -> (String, Vec<u8>) {
        let text = "[base]\nslider.blocks = [4, 4]\nfriction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n\
                    drive.v_star = 0.1\n\
                    [calibrate]\nx = 't'\ny = 'mu'\nnoise = 0.02\nruns = 200\nfiner_runs = 0\n\
                    unknowns = { 'friction.mu_static' = [0.3, 0.9], 'friction.r_star' = [0.4, 0.9] }";
        let case = slipfront_case::case::Case::parse("slider.blocks = [4, 4]", "case", "", &[]).unwrap();
        let unit = case.scales.time();
        let row = |k: u32| {
            let t = f64::from(k);
            format!("{},{}\n", t * unit, 0.6 * (0.05 * t).min(0.7 + 0.02 * (t % 7.0)))
        };
        let rows: String = (0..60).map(row).collect();
        (text.to_owned(), format!("t (s),mu (1)\n{rows}").into_bytes())
    }

    fn calibration() -> CalibrationInMemory {
        let (text, record) = small();
        CalibrationInMemory::new(&text, FilesInMemory::new(), ("record.csv", record), 1).unwrap()
    }

    #[test]
    fn runs_made_elsewhere_give_the_same_bits() {
        let go_on = AtomicBool::new(false);
        let find = |one: &mut CalibrationInMemory, is_elsewhere| {
            one.find(is_elsewhere, &go_on, &mut |_| {}).unwrap()
        };
        let Outcome::Found(here) = find(&mut calibration(), false) else {
            panic!("runs are wanted")
        };
        let mut one = calibration();
        let mut stages = Vec::new();
        let elsewhere = loop {
            let mut stage = None;
            let found = one
                .find(true, &go_on, &mut |now| stage = Some(now.stage))
                .unwrap();
            match found {
                Outcome::Found(results) => break results,
                Outcome::Wants(wanted) => {
                    stages.push((stage.unwrap(), wanted.len()));
                    let other = calibration();
                    for run in wanted {
                        // A message to another worker keeps every bit of a number.
                        let sent: WantedRun =
                            serde_json::from_str(&serde_json::to_string(&run).unwrap()).unwrap();
                        let made = other.make(&sent, &go_on).unwrap().unwrap();
                        one.add(run, made);
                    }
                }
            }
        };
        assert_eq!(elsewhere, here);
        use crate::CalibrationStage::{OtherStep, Prediction, Training};
        assert_eq!(stages, [(Training, 200), (Prediction, 120), (OtherStep, 40)]);
    }

    #[test]
    fn a_stop_ends_a_calibration() {
        let stop = AtomicBool::new(true);
        let ended = calibration().find(false, &stop, &mut |_| {});
        assert!(matches!(ended, Err(StudyError::Interrupted)));
    }
}
