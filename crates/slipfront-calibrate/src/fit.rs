//! A calibration from records: training, estimate, and checks of how far to trust it.

use slipfront_run::measured::Measure;

use crate::calibration::{Calibration, Estimate, Pair};
use crate::clipping::Clipped;
use crate::closest::closest;
use crate::file::{CalibrationFile, CalibrationKeys, SampledRecord};
use crate::findings::{
    CoupledUnknowns, Findings, Further, InstrumentFindings, OnFinerBlocks, UnknownEstimate,
};
use crate::predicted::{FrictionBand, PREDICTED, Predicted};
use crate::progress::CalibrationStage;
use crate::record_check::RecordCheck;
use crate::record_noise::{fastest_swing, missing_noise, noise_share};
use crate::runs::RunMaker;
use crate::sample_points::SamplePoints;
use crate::set_up::{Curves, SetUp};
use crate::synthetic_noise::{Stream, normals};
use crate::training::Training;
use slipfront_study::StudyError;

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
    fn new(training: &Training, set_up: &SetUp, records: &[SampledRecord], noise: f64) -> Self {
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

    /// Runs of the calibrated model, and the tests of the records against them and against the training.
    ///
    /// If a record has less noise than the file states, its intervals are wider than needed but valid. For
    /// the comparison with the runs, the missing noise is added to it.
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
            records.find_map(|(number, record)| Clipped::find(number, &record.measured))
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

/// A calibration: its file, its records, and the set-up of its runs.
#[derive(Debug)]
pub(crate) struct Fit {
    pub(crate) file: CalibrationFile,
    pub(crate) records: Vec<SampledRecord>,
    pub(crate) set_up: SetUp,
}

/// Results of a calibration.
pub(crate) struct Found {
    pub(crate) findings: Findings,
    /// Friction of every record at the points of the comparison.
    pub(crate) records: Curves,
    /// Band of the friction of the calibrated model for every record.
    pub(crate) bands: Vec<FrictionBand>,
    /// Points of the ranges that are drawn from the estimate.
    pub(crate) sample: Vec<Vec<f64>>,
}

impl Fit {
    /// A calibration as a file describes, from these records.
    ///
    /// # Errors
    /// When the ranges leave the bounds of the case.
    pub(crate) fn new(file: CalibrationFile, records: Vec<SampledRecord>) -> Result<Self, StudyError> {
        Ok(Self {
            set_up: file.set_up(&records)?,
            file,
            records,
        })
    }

    /// Trains, fits the records, and runs blocks of half the size and further experiments.
    ///
    /// # Errors
    /// When runs cannot be made or kept, and after a stop.
    pub(crate) fn find(&self, maker: &mut RunMaker) -> Result<Found, StudyError> {
        let Self {
            file,
            records,
            set_up,
        } = self;
        let instrument = self.instrument()?;
        let keys = &file.keys;
        let (runs, noise) = (keys.runs as usize, keys.noise);
        let (finer, further) = (finer(file, set_up), file.further(set_up)?);
        let finer_runs = if matches!(finer, Ok(Some(_))) {
            keys.finer_runs as usize
        } else {
            0
        };
        let total = runs * (1 + further.len()) + finer_runs + PREDICTED + AT_OTHER_STEP;
        maker.total = total;
        let training = Training::run(maker, CalibrationStage::Training, set_up, runs)?;
        let fitted = FittedRecords::new(&training, set_up, records, noise);
        let estimate = &fitted.estimate;
        let unknowns = set_up.unknowns.iter().enumerate();
        let mut unknowns: Vec<UnknownEstimate> = unknowns
            .map(|(number, unknown)| UnknownEstimate::new(unknown, estimate, number))
            .collect();
        let finer = match finer {
            Ok(Some(finer)) => {
                let training = Training::run(maker, CalibrationStage::FinerBlocks, &finer, finer_runs)?;
                let there = FittedRecords::new(&training, &finer, records, noise).estimate;
                let found = finer.unknowns.iter().zip(&there.distributions);
                for (estimate_of_unknown, (unknown, found)) in unknowns.iter_mut().zip(found) {
                    estimate_of_unknown.hold_against(unknown, found);
                }
                OnFinerBlocks::Runs(finer_runs)
            }
            Ok(None) => OnFinerBlocks::NotAskedFor,
            Err(reason) => OnFinerBlocks::Impossible(reason),
        };
        let next = weigh(maker, &set_up.grids(), further, &training, &fitted, noise)?;
        let (predicted, check) = fitted.check(set_up, records, noise, maker)?;
        let bands = predicted.bands();
        // If the calibrated model already runs at a finer step, the runs to compare with have the step of the
        // training.
        let halvings = predicted.halvings;
        let points = predicted.points[..AT_OTHER_STEP].to_vec();
        let other = if halvings > 0 {
            set_up.clone()
        } else {
            set_up.halved(1)
        };
        let other = Predicted::run(maker, CalibrationStage::OtherStep, &other, points, noise)?;
        let (mut coarse, mut fine) = (&predicted.curves[..AT_OTHER_STEP], other.curves.as_slice());
        if halvings > 0 {
            (coarse, fine) = (fine, coarse);
        }
        let moved = fitted.calibration.moved(coarse, fine);
        for (estimate_of_unknown, (unknown, moved)) in
            unknowns.iter_mut().zip(set_up.unknowns.iter().zip(moved))
        {
            estimate_of_unknown.hold_against_finer_step(unknown, moved);
        }
        let within = bands.iter().zip(&fitted.curves);
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
        Ok(Found {
            findings,
            bands,
            sample: fitted.sample(SAMPLE),
            records: fitted.curves,
        })
    }

    /// Trains, and tests whether the model can have made the records.
    ///
    /// # Errors
    /// When runs cannot be made or kept, and after a stop.
    pub(crate) fn check(&self, maker: &mut RunMaker) -> Result<RecordCheck, StudyError> {
        let CalibrationKeys { runs, noise, .. } = self.file.keys;
        let Self { set_up, records, .. } = self;
        maker.total = runs as usize + PREDICTED;
        let training = Training::run(maker, CalibrationStage::Training, set_up, runs as usize)?;
        let fitted = FittedRecords::new(&training, set_up, records, noise);
        let (_, check) = fitted.check(set_up, records, noise, maker)?;
        Ok(check)
    }

    /// Bandwidth of the instrument, and frequencies and noise of the records.
    fn instrument(&self) -> Result<InstrumentFindings, StudyError> {
        let set_up = &self.set_up;
        let middle = set_up.middle();
        let instrument = set_up.instrument(&middle, &set_up.conditions[0]);
        let instrument = instrument.map_err(|error| set_up.error_at(&middle, error))?;
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

/// Trains with each further experiment in addition to the records, and returns by how much the intervals
/// shrink.
fn weigh(
    maker: &mut RunMaker,
    grids: &[SamplePoints],
    further: Vec<(String, SetUp)>,
    training: &Training,
    fitted: &FittedRecords,
    noise: f64,
) -> Result<Vec<Further>, StudyError> {
    let widths = fitted.calibration.widths(&fitted.estimate);
    let mut weighed = Vec::new();
    for (set, further) in further {
        let more = Training::run(maker, CalibrationStage::Further, &further, training.points.len())?;
        let grids = [grids, &further.grids()].concat();
        let with = Calibration::new(&training.clone().with(more), &grids, noise);
        let with = with.widths(&fitted.estimate);
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

/// Pairs of unknowns that are determined only together.
fn pairs(set_up: &SetUp, estimate: &Estimate) -> Vec<CoupledUnknowns> {
    let of = |pair: &Pair| CoupledUnknowns {
        keys: pair
            .unknowns
            .map(|number| set_up.unknowns[number].key().to_owned()),
        correlation: pair.correlation,
    };
    estimate.pairs.iter().map(of).collect()
}
