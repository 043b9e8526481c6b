//! The results folder of a calibration: its file, copies of the records, the journal of runs, and
//! the findings.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf, absolute};
use std::sync::atomic::AtomicBool;

use serde::Deserialize;
use slipfront_base::disk::is_same;
use slipfront_plot::PictureLook;
use slipfront_run::manifest::ManifestFile;
use slipfront_run::measured::Measure;

use crate::bandwidth::{fastest_swing, missing_noise, noise_share};
use crate::calibration::{Calibration, Estimate};
use crate::clipping::Clipped;
use crate::closest::closest;
use crate::file::{CALIBRATION, CalibrationFile, CalibrationKeys, RECORD, SampledRecord};
use crate::findings::{
    CoupledUnknowns, Findings, Further, InstrumentFindings, OnFinerBlocks, UnknownEstimate,
};
use crate::normals::{Stream, normals};
use crate::predicted::{PREDICTED, Predicted};
use crate::progress::{CalibrationProgress, CalibrationStage};
use crate::record_check::RecordCheck;
use crate::report::{FOUND, Report};
use crate::runs::{KeptRuns, RunMaker};
use crate::sample_points::SamplePoints;
use crate::set_up::SetUp;
use crate::training::Training;
use slipfront_study::project_folder::{
    Checksums, Derivation, Given, Others, ResultFiles, notes_of_use, read_numbers,
};
use slipfront_study::{StudyError, TrainingError};

/// Number of runs at another time step.
const AT_OTHER_STEP: usize = 40;

/// Number of points that are drawn from the estimate.
const SAMPLE: usize = 400;

/// Curves of measured records, and the estimate of a training from them.
struct FittedRecords {
    curves: Vec<Vec<f64>>,
    calibration: Calibration,
    estimate: Estimate,
}

impl FittedRecords {
    fn of(training: &Training, set_up: &SetUp, records: &[SampledRecord], noise: f64) -> Self {
        let curves = records.iter().map(|record| record.grid.record(&record.measured));
        let curves: Vec<Vec<f64>> = curves.collect();
        let calibration = Calibration::new(training, &set_up.grids(), noise);
        let estimate = calibration.estimate(&curves);
        Self {
            curves,
            calibration,
            estimate,
        }
    }

    /// Points that are drawn from the estimate.
    fn sample(&self, points: usize) -> Vec<Vec<f64>> {
        self.calibration.sample(&self.estimate, points)
    }

    /// Runs of the calibrated model, and what they and the training say of the records.
    ///
    /// A record with less noise than the file states has intervals that are too wide and hold: it is compared
    /// with the runs as a record with the noise that it lacks.
    fn check(
        &self,
        set_up: &SetUp,
        records: &[SampledRecord],
        noise: f64,
        maker: &mut RunMaker,
    ) -> Result<(Predicted, RecordCheck), StudyError> {
        let points = self.sample(PREDICTED);
        let (of_step, closest) = closest(maker, set_up, &points, &self.curves, noise)?.unzip();
        let stage = CalibrationStage::Prediction;
        let predicted = Predicted::run(maker, stage, of_step.as_ref().unwrap_or(set_up), points, noise)?;
        let as_noisy = records.iter().zip(&self.curves).enumerate();
        let as_noisy = as_noisy.map(|(number, (record, curve))| {
            let missing = missing_noise(&record.measured, noise);
            record
                .grid
                .noisy(curve, missing, normals(Stream::Missing, 0, number))
        });
        let clipped = || {
            let mut records = records.iter().enumerate();
            records.find_map(|(number, record)| Clipped::of(number, &record.measured))
        };
        let check = RecordCheck {
            clipped: if set_up.has_range() { None } else { clipped() },
            misfit: self.estimate.misfit.clone(),
            comparison: predicted.compare(&as_noisy.collect::<Vec<_>>()),
            closest,
        };
        Ok((predicted, check))
    }
}

/// A results folder, with the runs that were kept in it.
#[derive(Debug)]
pub struct CalibrationFolder {
    path: PathBuf,
    files: ResultFiles,
    kept: KeptRuns,
    file: CalibrationFile,
    records: Vec<SampledRecord>,
    set_up: SetUp,
}

/// Folders of calibrations.
pub const CALIBRATIONS: Derivation = Derivation {
    kind: &CALIBRATION,
    no_pictures: &[],
    find_again,
};

/// Calibrates again in another folder from the runs in the journal.
fn find_again(
    folder: &Path,
    other: &Path,
    look: &PictureLook,
    stop: &AtomicBool,
) -> Result<[usize; 2], StudyError> {
    KeptRuns::copy(folder, other)?;
    let mut again = CalibrationFolder::again(folder, other)?;
    again.files = again.files.with_look(look.clone());
    let kept = again.n_kept();
    again.find(stop, &mut |_| {})?;
    Ok([kept, again.n_kept()])
}

/// Whether two paths, which need not exist yet, are those of one folder.
fn is_same_place(one: &Path, other: &Path) -> bool {
    let are_equal = || matches!((absolute(one), absolute(other)), (Ok(one), Ok(other)) if one == other);
    is_same(one, other) || are_equal()
}

impl CalibrationFolder {
    /// Opens a results folder: a new one, an empty one, or one of an earlier call for these records that no
    /// other process works in. Training runs are kept in it, or in the folder `training`.
    ///
    /// # Errors
    /// When the ranges leave the bounds of the case: then nothing is written. When the folder holds other
    /// files, or some that were edited since they were written and may not be replaced by `force`; when
    /// another process works in it, or it cannot be written to.
    pub fn open(
        path: &Path,
        training: Option<&Path>,
        file: &CalibrationFile,
        records: Vec<SampledRecord>,
        force: bool,
    ) -> Result<Self, StudyError> {
        if let Some(training) = training
            && is_same_place(path, training)
        {
            let path = training.to_owned();
            return Err(StudyError::TrainingInResults { path });
        }
        file.set_up(&records)?;
        let kept = KeptRuns::open(path, training)?;
        let given = Given {
            others: contents(&records),
            ..file.project.given()?
        };
        let files = given.place(&CALIBRATION, path, force)?;
        let name = path.join(CALIBRATION.file).display().to_string();
        let file = CalibrationFile::parse(&given.text, &name, file.name(), path)?;
        Ok(Self {
            path: path.to_owned(),
            files,
            kept,
            set_up: file.set_up(&records)?,
            file,
            records,
        })
    }

    /// The calibration in one folder, to be found again in another.
    fn again(folder: &Path, other: &Path) -> Result<Self, StudyError> {
        let file = CalibrationFile::load(&folder.join(CALIBRATION.file))?;
        let listed = Checksums::read(folder)?.unwrap_or_default().files;
        let mut records = BTreeMap::new();
        for ManifestFile { name, .. } in listed {
            let number = name
                .strip_prefix(RECORD)
                .and_then(|rest| rest.split('.').next()?.parse::<usize>().ok());
            if let Some(number) = number {
                records.insert(number, folder.join(name));
            }
        }
        let records: Vec<PathBuf> = records.into_values().collect();
        let records = file.read(&records)?;
        file.check_memory(&records, rayon::current_num_threads())?;
        Self::open(other, None, &file, records, false)
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the findings as numbers.
    pub fn numbers(&self) -> PathBuf {
        self.path.join(FOUND[0])
    }

    /// Sentences about a folder that has been used before.
    pub fn notes(&self) -> Vec<String> {
        notes_of_use(self.kept.damaged, self.n_kept())
    }

    /// Number of lines of the journals that failed their checksum.
    pub fn damaged(&self) -> usize {
        self.kept.damaged
    }

    /// Number of runs that are known.
    pub fn n_kept(&self) -> usize {
        self.kept.count()
    }

    /// Trains, fits the records, runs blocks of half the size and further experiments, writes the findings,
    /// and returns them as a text.
    ///
    /// # Errors
    /// When runs cannot be made or kept, after a stop, and when the system refuses to write.
    pub fn find(
        &mut self,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&CalibrationProgress),
    ) -> Result<String, StudyError> {
        let instrument = self.instrument(&self.set_up)?;
        let Self {
            kept,
            file,
            records,
            set_up,
            ..
        } = self;
        let keys = &file.keys;
        let (runs, noise) = (keys.runs as usize, keys.noise);
        let (finer, further) = (finer(file, set_up), file.further(set_up)?);
        let finer_runs = if matches!(finer, Ok(Some(_))) {
            keys.finer_runs as usize
        } else {
            0
        };
        let of = runs * (1 + further.len()) + finer_runs + PREDICTED + AT_OTHER_STEP;
        let maker = &mut RunMaker::new(stop, of, watch).with(kept);
        let training = Training::run(maker, CalibrationStage::Training, set_up, runs)?;
        let told = FittedRecords::of(&training, set_up, records, noise);
        let estimate = &told.estimate;
        let unknowns = set_up.unknowns.iter().enumerate();
        let mut unknowns: Vec<UnknownEstimate> = unknowns
            .map(|(number, unknown)| UnknownEstimate::of(unknown, estimate, number))
            .collect();
        let finer = match finer {
            Ok(Some(finer)) => {
                let training = Training::run(maker, CalibrationStage::FinerBlocks, &finer, finer_runs)?;
                let there = FittedRecords::of(&training, &finer, records, noise).estimate;
                let found = finer.unknowns.iter().zip(&there.distributions);
                for (told, (unknown, found)) in unknowns.iter_mut().zip(found) {
                    told.hold_against(unknown, found);
                }
                OnFinerBlocks::Runs(finer_runs)
            }
            Ok(None) => OnFinerBlocks::NotAskedFor,
            Err(reason) => OnFinerBlocks::Impossible(reason),
        };
        let next = weigh(maker, &set_up.grids(), further, &training, &told, noise)?;
        let (predicted, check) = told.check(set_up, records, noise, maker)?;
        let bands = predicted.bands();
        // Where the calibrated model needs a finer step already, it is held against that of the training.
        let halvings = predicted.halvings();
        let points = predicted.points()[..AT_OTHER_STEP].to_vec();
        let other = if halvings > 0 {
            set_up.clone()
        } else {
            set_up.halved(1)
        };
        let other = Predicted::run(maker, CalibrationStage::OtherStep, &other, points, noise)?;
        let (mut coarse, mut fine) = (&predicted.curves()[..AT_OTHER_STEP], other.curves());
        if halvings > 0 {
            (coarse, fine) = (fine, coarse);
        }
        let moved = told.calibration.moved(coarse, fine);
        for (told, (unknown, moved)) in unknowns.iter_mut().zip(set_up.unknowns.iter().zip(moved)) {
            told.hold_against_finer_step(unknown, moved);
        }
        let within = bands.iter().zip(&told.curves);
        let findings = Findings {
            runs,
            noise,
            pairs: pairs(set_up, estimate),
            is_refused: check.is_refused(),
            within_band_percent: within.map(|(band, curve)| band.holds_percent(curve)).collect(),
            check,
            instrument,
            unknowns,
            finer_step: 1 << halvings.max(1),
            finer,
            next,
            version: env!("CARGO_PKG_VERSION"),
        };
        let mut batch = self.files.begin();
        let mut report = Report {
            batch: &mut batch,
            set_up,
            findings: &findings,
        };
        let text = report.write(&told.curves, &bands, &told.sample(SAMPLE))?;
        batch.place(Others::Go)?;
        Ok(text)
    }

    /// Trains, and makes the tests of [`Self::find`] of whether the model can have made the records. Training
    /// runs are kept, and no findings are written.
    ///
    /// # Errors
    /// When runs cannot be made or kept, and after a stop.
    pub fn check(
        &mut self,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&CalibrationProgress),
    ) -> Result<RecordCheck, StudyError> {
        let CalibrationKeys { runs, noise, .. } = self.file.keys;
        let (set_up, records) = (&self.set_up, &self.records);
        let maker = &mut RunMaker::new(stop, runs as usize + PREDICTED, watch).with(&mut self.kept);
        let training = Training::run(maker, CalibrationStage::Training, set_up, runs as usize)?;
        let told = FittedRecords::of(&training, set_up, records, noise);
        let (_, check) = told.check(set_up, records, noise, maker)?;
        Ok(check)
    }

    /// Frequencies that the instrument passes and that the records have, and their noise.
    fn instrument(&self, set_up: &SetUp) -> Result<InstrumentFindings, StudyError> {
        let middle = set_up.middle();
        let instrument = set_up.instrument(&middle, &set_up.conditions[0]);
        let instrument = instrument.map_err(|source| TrainingError::Instrument {
            point: set_up.point(&middle),
            source,
        })?;
        let records = self.records.iter();
        let of_times = records.filter(|record| record.measured.along == Measure::Time);
        Ok(InstrumentFindings {
            bandwidth_hz: instrument.and_then(|instrument| instrument.bandwidth()),
            fastest_swing_hz: of_times
                .filter_map(|record| fastest_swing(&record.measured))
                .max_by(f64::total_cmp),
            noise_percent: self
                .records
                .iter()
                .map(|record| 100.0 * noise_share(&record.measured))
                .collect(),
        })
    }
}

/// Trains with each of the further experiments beside the records, and returns how much narrower the
/// intervals are.
fn weigh(
    maker: &mut RunMaker,
    grids: &[SamplePoints],
    further: Vec<(String, SetUp)>,
    training: &Training,
    told: &FittedRecords,
    noise: f64,
) -> Result<Vec<Further>, StudyError> {
    let widths = told.calibration.widths(&told.estimate);
    let mut weighed = Vec::new();
    for (set, further) in further {
        let more = Training::run(maker, CalibrationStage::Further, &further, training.points.len())?;
        let grids = [grids, &further.grids()].concat();
        let with = Calibration::new(&training.clone().with(more), &grids, noise);
        let with = with.widths(&told.estimate);
        weighed.push(Further {
            set,
            narrowed_to: with
                .iter()
                .zip(&widths)
                .map(|(with, without)| with / without)
                .collect(),
        });
    }
    Ok(weighed)
}

/// The set-up on blocks of half the size; none if the file does not ask for it, or a reason why there is
/// none.
fn finer(file: &CalibrationFile, set_up: &SetUp) -> Result<Option<SetUp>, String> {
    if file.keys.finer_runs == 0 {
        return Ok(None);
    }
    set_up.finer().map(Some)
}

/// The part of the findings that decides whether they promise anything.
#[derive(Deserialize)]
struct Judgement {
    is_refused: bool,
}

impl CalibrationFolder {
    /// Refuses findings about records that the model cannot have made.
    ///
    /// # Errors
    /// A sentence that names the findings; when the folder has none.
    pub fn expect_own_records(&self) -> Result<(), StudyError> {
        let [numbers, words] = FOUND.map(|name| self.path().join(name));
        match read_numbers(&numbers)? {
            Judgement { is_refused: false } => Ok(()),
            Judgement { is_refused: true } => Err(StudyError::Refused { path: words }),
        }
    }
}

/// Copies of records: their names in the folder, and their contents.
fn contents(records: &[SampledRecord]) -> Vec<(String, Vec<u8>)> {
    let copy = |(number, record): (usize, &SampledRecord)| {
        let name = format!("{RECORD}{}.{}", number + 1, record.ending);
        (name, record.bytes.clone())
    };
    records.iter().enumerate().map(copy).collect()
}

/// Pairs of unknowns that are determined only together.
fn pairs(set_up: &SetUp, estimate: &Estimate) -> Vec<CoupledUnknowns> {
    let of = |pair: &crate::calibration::Pair| CoupledUnknowns {
        keys: pair
            .unknowns
            .map(|number| set_up.unknowns[number].key().to_owned()),
        correlation: pair.correlation,
    };
    estimate.pairs.iter().map(of).collect()
}
