//! The results folder of a calibration: its file, copies of the records, the journal of training runs, and what was found.

use std::collections::{BTreeMap, HashMap};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};
use slipfront_case::disk::{TEXT_MAX_BYTES, is_empty, make_folders, read_limited};
use slipfront_run::folder_error::FolderError;

use super::calibration::{Calibration, Estimate};
use super::file::{CalibrationFile, GivenRecord};
use super::findings::{Findings, Further, OnFinerBlocks, Told, ToldTogether};
use super::grid::Grid;
use super::predicted::{PREDICTED, bands};
use super::report::{FOUND, Report};
use super::set_up::{Conditions, Curves, SetUp};
use super::training::{Training, TrainingRun};
use crate::axis::overrides;
use crate::error::StudyError;
use crate::files_in_folder::{copy_in, write_in};
use crate::journal::Journal;
use crate::record::to_line;

/// The calibration file in the folder, with the base case as a table in it.
const CALIBRATION: &str = "calibration.toml";

/// The journal: a line for every training run.
pub(crate) const TRAINING: &str = "training.jsonl";

/// What names of copies of records begin with.
const RECORD: &str = "record-";

/// Points that are drawn from what the records tell.
const SAMPLE: usize = 400;

/// A line of the journal.
#[derive(Serialize, Deserialize)]
struct KeptRun {
    /// Identity of the set-up.
    id: String,
    #[serde(flatten)]
    run: TrainingRun,
}

/// What a calibration is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationStage {
    /// Runs of the case over the ranges.
    Training,
    /// Runs on blocks of half the size.
    FinerBlocks,
    /// Runs of experiments that may be made next.
    Further,
}

/// How far a calibration has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CalibrationProgress {
    /// What it is doing.
    pub stage: CalibrationStage,
    /// Runs of this call that have ended.
    pub runs: usize,
    /// All runs of this call.
    pub of: usize,
}

/// A results folder, with the runs that were kept in it.
#[derive(Debug)]
pub struct CalibrationFolder {
    path: PathBuf,
    /// Keeps other processes out of the folder, and training runs unless another folder has them.
    journal: Journal,
    /// Training runs that several calibrations share.
    shared: Option<Journal>,
    known: HashMap<(String, usize), Curves>,
    /// Lines of the journals that failed their checksum.
    pub damaged: usize,
    file: CalibrationFile,
    records: Vec<GivenRecord>,
    set_up: SetUp,
}

/// Whether the folder is the results folder of a calibration.
pub fn is_calibration(folder: &Path) -> bool {
    folder.join(CALIBRATION).exists() && folder.join(TRAINING).exists()
}

/// Whether a calibration in the folder has come to its end.
pub(crate) fn is_finished(folder: &Path) -> bool {
    folder.join(FOUND[0]).exists()
}

/// A journal of training runs, the runs in it, and how many of its lines are damaged.
fn open_journal(folder: &Path) -> Result<(Journal, Vec<KeptRun>, usize), StudyError> {
    Journal::open(folder, TRAINING).map_err(|error| match error {
        StudyError::NotRecords { path } => FolderError::Foreign { path }.into(),
        error => error,
    })
}

impl CalibrationFolder {
    /// Opens a results folder: a new one, an empty one, or one of an earlier call for these records that no other process works in. Training
    /// runs are kept in it, or in the folder `training`.
    ///
    /// # Errors
    /// When the records cannot be read, or the ranges leave the bounds of the case: then nothing is written. When the folder holds other
    /// things, another process works in it, or it cannot be written to.
    pub fn open(
        path: &Path,
        training: Option<&Path>,
        file: &CalibrationFile,
        records: &[PathBuf],
    ) -> Result<Self, StudyError> {
        let given = file.read(records)?;
        file.set_up(&given)?;
        make_folders(path).map_err(FolderError::unwritable(path))?;
        let used = path.join(TRAINING).exists();
        if !used && !is_empty(path).map_err(FolderError::unwritable(path))? {
            return Err(StudyError::OtherThings {
                what: "calibration",
                path: path.to_owned(),
            });
        }
        let (journal, mut kept, mut damaged) = open_journal(path)?;
        let (text, copies) = file.portable()?;
        let contents = contents(records)?;
        for (name, bytes) in contents
            .iter()
            .chain([&(CALIBRATION.to_owned(), text.clone().into_bytes())])
        {
            let before = read_limited(&path.join(name), u64::MAX).ok();
            if before.is_some_and(|before| before != *bytes) {
                return Err(StudyError::Changed {
                    what: "calibration",
                    path: path.to_owned(),
                });
            }
        }
        copy_in(path, &copies)?;
        for (name, bytes) in &contents {
            write_in(path, name, |to| to.write_all(bytes))?;
        }
        write_in(path, CALIBRATION, |to| to.write_all(text.as_bytes()))?;
        let mut shared = None;
        if let Some(training) = training {
            make_folders(training).map_err(FolderError::unwritable(training))?;
            let (journal, more, more_damaged) = open_journal(training)?;
            shared = Some(journal);
            damaged += more_damaged;
            kept.extend(more);
        }
        let name = path.join(CALIBRATION).display().to_string();
        let file = CalibrationFile::parse(&text, &name, &file.name, path)?;
        let names: Vec<PathBuf> = contents.iter().map(|(name, _)| path.join(name)).collect();
        let records = file.read(&names)?;
        Ok(Self {
            path: path.to_owned(),
            journal,
            shared,
            known: kept
                .into_iter()
                .map(|kept| ((kept.id, kept.run.run), kept.run.curves))
                .collect(),
            damaged,
            set_up: file.set_up(&records)?,
            file,
            records,
        })
    }

    /// The calibration in one folder, to be found again in another.
    pub(crate) fn again(folder: &Path, other: &Path) -> Result<Self, StudyError> {
        let file = CalibrationFile::load(&folder.join(CALIBRATION))?;
        let names = std::fs::read_dir(folder).map_err(FolderError::read(folder))?;
        let mut records = BTreeMap::new();
        for entry in names {
            let path = entry.map_err(FolderError::read(folder))?.path();
            let stem = path.file_stem().and_then(|stem| stem.to_str());
            let number = stem.and_then(|stem| stem.strip_prefix(RECORD)?.parse::<usize>().ok());
            if let Some(number) = number {
                records.insert(number, path);
            }
        }
        let records: Vec<PathBuf> = records.into_values().collect();
        Self::open(other, None, &file, &records)
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of training runs that are known.
    pub fn n_kept(&self) -> usize {
        self.known.len()
    }

    /// Trains, fits the records, looks at blocks of half the size and at further experiments, writes what was found, and gives it as a text.
    ///
    /// # Errors
    /// When runs cannot be made or kept, after a stop, and when the system refuses to write.
    pub fn find(
        &mut self,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&CalibrationProgress),
    ) -> Result<String, StudyError> {
        let keys = self.file.keys.clone();
        let set_up = self.set_up.clone();
        let (runs, finer_runs) = (keys.runs as usize, keys.finer_runs as usize);
        let finer = self.finer();
        let further = self.further(&keys.next)?;
        let mut all = self.n_missing(&set_up, runs)?;
        if let Ok(Some(finer)) = &finer {
            all += self.n_missing(finer, finer_runs)?;
        }
        for (_, further) in &further {
            all += self.n_missing(further, runs)?;
        }
        let mut ended = 0;
        let mut train = |folder: &mut Self, stage, set_up: &SetUp, runs| {
            folder.train(set_up, runs, stop, &mut |new| {
                ended += new;
                watch(&CalibrationProgress {
                    stage,
                    runs: ended,
                    of: all,
                });
            })
        };
        let training = train(self, CalibrationStage::Training, &set_up, runs)?;
        let grids: Vec<Grid> = set_up.conditions.iter().map(|one| one.grid.clone()).collect();
        let calibration = Calibration::new(&training, &grids, keys.noise);
        let curves: Vec<Vec<f64>> = self
            .records
            .iter()
            .map(|record| record.grid.record(&record.measured))
            .collect();
        let estimate = calibration.estimate(&curves);
        let mut unknowns: Vec<Told> = set_up
            .unknowns
            .iter()
            .enumerate()
            .map(|(number, unknown)| Told::of(unknown, &estimate, number))
            .collect();
        let finer = match finer {
            Ok(Some(finer)) => {
                let training = train(self, CalibrationStage::FinerBlocks, &finer, finer_runs)?;
                let there = Calibration::new(&training, &grids, keys.noise).estimate(&curves);
                for ((told, unknown), found) in
                    unknowns.iter_mut().zip(&finer.unknowns).zip(&there.distributions)
                {
                    told.hold_against(unknown, found);
                }
                OnFinerBlocks::Runs(finer_runs)
            }
            Ok(None) => OnFinerBlocks::NotAskedFor,
            Err(reason) => OnFinerBlocks::Impossible(reason),
        };
        let widths = calibration.widths(&estimate);
        let mut next = Vec::new();
        for (name, further) in further {
            let more = train(self, CalibrationStage::Further, &further, runs)?;
            let mut grids = grids.clone();
            grids.push(further.conditions[0].grid.clone());
            let with = Calibration::new(&training.clone().with(more), &grids, keys.noise).widths(&estimate);
            next.push(Further {
                set: name,
                narrowed_to: with
                    .iter()
                    .zip(&widths)
                    .map(|(with, without)| with / without)
                    .collect(),
            });
        }
        let bands = bands(
            &set_up,
            &calibration.sample(&estimate, PREDICTED),
            keys.noise,
            stop,
        )?;
        let findings = Findings {
            runs,
            noise: keys.noise,
            pairs: pairs(&set_up, &estimate),
            is_refused: estimate.misfit.is_refused(),
            within_band_percent: bands
                .iter()
                .zip(&curves)
                .map(|(band, curve)| band.holds_percent(curve))
                .collect(),
            misfit: estimate.misfit.clone(),
            unknowns,
            finer,
            next,
            version: env!("CARGO_PKG_VERSION"),
        };
        let report = Report {
            path: &self.path,
            set_up: &set_up,
            findings: &findings,
        };
        report.write(&curves, &bands, &calibration.sample(&estimate, SAMPLE))
    }

    /// The set-up on blocks of half the size; none if the file does not ask for it, or a reason why there is none.
    fn finer(&self) -> Result<Option<SetUp>, String> {
        if self.file.keys.finer_runs == 0 {
            return Ok(None);
        }
        let finer = SetUp {
            is_finer: true,
            ..self.set_up.clone()
        };
        let middle = finer.middle();
        for conditions in &finer.conditions {
            finer
                .case(&middle, 0, conditions)
                .map_err(|error| error.to_string())?;
        }
        Ok(Some(finer))
    }

    /// The set-ups of further experiments, over the path of the first record, and what they are called.
    fn further(&self, next: &[toml::Table]) -> Result<Vec<(String, SetUp)>, StudyError> {
        let middle = self.set_up.middle();
        let first = &self.set_up.conditions[0];
        let found_in_next = |error| self.file.found_in("next", error);
        let speed = |conditions: &Conditions| {
            let case = self.set_up.case(&middle, 0, conditions).map_err(found_in_next)?;
            Ok::<f64, StudyError>(case.model.drive.v_star * case.scales.displacement() / case.scales.time())
        };
        let set_up = |set: &toml::Table| {
            let mut conditions = Conditions {
                overrides: overrides(set),
                grid: first.grid.clone(),
            };
            conditions.grid = first.grid.slower(speed(first)? / speed(&conditions)?);
            let names: Vec<String> = conditions.overrides.iter().map(ToString::to_string).collect();
            let further = SetUp {
                conditions: vec![conditions],
                ..self.set_up.clone()
            };
            Ok((names.join(", "), further))
        };
        next.iter().map(set_up).collect()
    }

    /// Trains, or goes on where an earlier call was; `watch` is given the number of runs that have just ended.
    fn train(
        &mut self,
        set_up: &SetUp,
        runs: usize,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(usize),
    ) -> Result<Training, StudyError> {
        let id = set_up.identity()?;
        let of_set_up: HashMap<usize, Curves> = (0..runs)
            .filter_map(|run| Some((run, self.known.get(&(id.clone(), run))?.clone())))
            .collect();
        watch(0);
        let Self {
            shared,
            journal,
            known,
            ..
        } = self;
        let journal = shared.as_mut().unwrap_or(journal);
        let mut keep = |made: &[TrainingRun]| {
            let lines: Vec<u8> = made
                .iter()
                .flat_map(|run| {
                    to_line(&KeptRun {
                        id: id.clone(),
                        run: run.clone(),
                    })
                })
                .collect();
            journal.append(&lines)?;
            known.extend(made.iter().map(|run| ((id.clone(), run.run), run.curves.clone())));
            watch(made.len());
            Ok(())
        };
        Training::run(set_up, runs, of_set_up, &mut keep, stop)
    }

    /// How many of so many training runs are not known yet.
    fn n_missing(&self, set_up: &SetUp, runs: usize) -> Result<usize, StudyError> {
        let id = set_up.identity()?;
        Ok((0..runs)
            .filter(|&run| !self.known.contains_key(&(id.clone(), run)))
            .count())
    }
}

/// Copies of records: their names in the folder, and what stands in them.
fn contents(records: &[PathBuf]) -> Result<Vec<(String, Vec<u8>)>, StudyError> {
    let copy = |(number, path): (usize, &PathBuf)| {
        let ending = path
            .extension()
            .and_then(|ending| ending.to_str())
            .unwrap_or("csv");
        let bytes = read_limited(path, TEXT_MAX_BYTES).map_err(FolderError::read(path))?;
        Ok((format!("{RECORD}{}.{ending}", number + 1), bytes))
    };
    records.iter().enumerate().map(copy).collect()
}

/// Pairs of unknowns that are told only together.
fn pairs(set_up: &SetUp, estimate: &Estimate) -> Vec<ToldTogether> {
    let of = |pair: &super::calibration::Pair| ToldTogether {
        keys: pair
            .unknowns
            .map(|number| set_up.unknowns[number].key().to_owned()),
        correlation: pair.correlation,
    };
    estimate.pairs.iter().map(of).collect()
}
