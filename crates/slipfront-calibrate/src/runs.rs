//! Runs of a calibration: made on rayon's threads, counted, and kept in a journal if there is one.

use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use slipfront::device::{Device, DeviceError};
use slipfront_run::manifest::ManifestFile;
use slipfront_study::project_folder::{Journal, JournalEntry};
use slipfront_study::{StudyError, TrainingError};

use crate::file::CALIBRATION;
#[cfg(not(target_family = "wasm"))]
use crate::on_device::curves_on_device;
use crate::progress::{CalibrationProgress, CalibrationStage};
use crate::set_up::{Curves, SetUp};

/// Number of runs after which the journal and the progress are updated.
const AT_ONCE: usize = 32;

/// Largest number of runs that a device makes before they are kept and shown.
const AT_ONCE_ON_DEVICE: usize = 1024;

/// Memory in bytes for the curves of the runs that a device makes at once.
const CURVES_OF_DEVICE: f64 = 1e9;

/// A line of the journal.
#[derive(Serialize, Deserialize)]
struct CalibrationRun {
    /// Identity of the run.
    id: String,
    /// Friction of every record.
    curves: Curves,
}

impl JournalEntry for CalibrationRun {
    const KEYS: &'static [&'static str] = &["curves"];
}

/// Runs to make: points of the ranges, each with its own surface.
pub(crate) struct Runs<'a> {
    set_up: &'a SetUp,
    points: &'a [Vec<f64>],
    first_surface: u64,
}

impl<'a> Runs<'a> {
    /// Runs at points of the ranges, which are shares of them; the run of number `k` has the surface
    /// `first_surface + k`.
    pub(crate) const fn new(set_up: &'a SetUp, points: &'a [Vec<f64>], first_surface: u64) -> Self {
        Self {
            set_up,
            points,
            first_surface,
        }
    }

    /// Identities of all runs: hashes of everything that determines their curves.
    fn identities(&self) -> Result<Vec<String>, StudyError> {
        let of_set_up = self.set_up.identity()?;
        let of_run = |(surface, point): (u64, &Vec<f64>)| {
            let mut hasher = blake3::Hasher::new();
            hasher.update(of_set_up.as_bytes());
            hasher.update(&surface.to_le_bytes());
            for share in point {
                hasher.update(&share.to_le_bytes());
            }
            hasher.finalize().to_hex()[..16].to_owned()
        };
        Ok((self.first_surface..).zip(self.points).map(of_run).collect())
    }

    /// The run with this number and identity, to be made elsewhere.
    fn wanted(&self, number: usize, id: &str) -> WantedRun {
        WantedRun {
            id: id.to_owned(),
            is_finer: self.set_up.is_finer,
            halvings: self.set_up.halvings,
            point: self.points[number].clone(),
            surface: self.first_surface + number as u64,
        }
    }

    /// Number of runs that a device makes at once, so that their curves fit in memory.
    fn at_once_on_device(&self) -> Result<usize, StudyError> {
        let bytes = self.set_up.bytes_of_run(0)? * self.set_up.conditions.len() as f64;
        Ok(((CURVES_OF_DEVICE / bytes) as usize).clamp(AT_ONCE, AT_ONCE_ON_DEVICE))
    }

    /// Point of the ranges and surface of the run of this number.
    fn point(&self, run: usize) -> (&[f64], u64) {
        (&self.points[run], self.first_surface + run as u64)
    }

    /// The curves of the runs of these numbers; none of a run that was stopped.
    #[cfg_attr(
        target_family = "wasm",
        expect(unused_variables, reason = "a page has no device")
    )]
    fn curves(
        &self,
        runs: &[usize],
        device: Option<&dyn Device>,
        stop: &AtomicBool,
    ) -> Result<Vec<Result<Option<Curves>, TrainingError>>, DeviceError> {
        #[cfg(not(target_family = "wasm"))]
        if let Some(device) = device {
            let points: Vec<_> = runs.iter().map(|run| self.point(*run)).collect();
            return curves_on_device(self.set_up, &points, device, stop);
        }
        let made = runs.par_iter().with_max_len(1).map(|run| {
            let (point, surface) = self.point(*run);
            self.set_up.curves(point, surface, stop)
        });
        Ok(made.collect())
    }
}

/// A run that a calibration needs and that is made elsewhere, such as in another worker of a web page.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WantedRun {
    /// Identity of the run.
    pub(crate) id: String,
    is_finer: bool,
    halvings: u32,
    /// Point of the ranges.
    point: Vec<f64>,
    surface: u64,
}

impl WantedRun {
    /// Makes the run in a calibration with this set-up; none after a stop.
    ///
    /// # Errors
    /// When the case is not valid there, the run diverges, or it ends before a record.
    pub(crate) fn make(&self, set_up: &SetUp, stop: &AtomicBool) -> Result<Option<Curves>, TrainingError> {
        let set_up = SetUp {
            is_finer: self.is_finer,
            halvings: self.halvings,
            ..set_up.clone()
        };
        set_up.curves(&self.point, self.surface, stop)
    }
}

/// Runs that were made before, and the journals to which new runs are appended.
#[derive(Debug, Default)]
pub(crate) struct KeptRuns {
    /// Journal of the results folder, locked against other processes; none for runs that are only in memory.
    journal: Option<Journal>,
    /// Journal of training runs that several calibrations share.
    shared: Option<Journal>,
    /// Curves of the runs by their identities.
    pub(crate) known: HashMap<String, Curves>,
    /// Lines of the journal that failed their checksum.
    pub(crate) damaged: usize,
}

impl KeptRuns {
    /// Opens the journals of a results folder and of a folder of training runs. No other process may use
    /// them.
    pub(crate) fn open(folder: &Path, training: Option<&Path>) -> Result<Self, StudyError> {
        // Fail if another process uses a folder, before a new folder is created.
        let is_used = CALIBRATION.is_used(folder)?;
        let own = is_used.then(|| CALIBRATION.open_journal(folder)).transpose()?;
        let shared = training.map(|folder| CALIBRATION.open_journal::<CalibrationRun>(folder));
        let shared = shared.transpose()?;
        let (journal, mut kept, mut damaged) = match own {
            Some(own) => own,
            None => CALIBRATION.open_journal::<CalibrationRun>(folder)?,
        };
        let shared = shared.map(|(journal, more, more_damaged)| {
            damaged += more_damaged;
            kept.extend(more);
            journal
        });
        Ok(Self {
            journal: Some(journal),
            shared,
            known: kept.into_iter().map(|kept| (kept.id, kept.curves)).collect(),
            damaged,
        })
    }

    /// Copies the journal of a results folder into another.
    pub(crate) fn copy(folder: &Path, other: &Path) -> Result<(), StudyError> {
        Journal::copy::<CalibrationRun>(folder, other, CALIBRATION.journal)
    }

    /// The journal of the results folder with its checksum; nothing of runs that are only in memory.
    pub(crate) fn listed(&self) -> Result<Vec<ManifestFile>, StudyError> {
        self.journal.iter().map(Journal::listed).collect()
    }

    fn keep(&mut self, stage: CalibrationStage, made: Vec<CalibrationRun>) -> Result<(), StudyError> {
        let shared = self.shared.as_mut().filter(|_| stage.is_for_any_records());
        if let Some(journal) = shared.or(self.journal.as_mut()) {
            journal.append(&made)?;
        }
        self.known
            .extend(made.into_iter().map(|made| (made.id, made.curves)));
        Ok(())
    }
}

/// Makes the runs of a calibration.
pub struct RunMaker<'a> {
    stop: &'a AtomicBool,
    watch: &'a mut dyn FnMut(&CalibrationProgress),
    /// Runs that are not repeated, to which new ones are added; none if runs are not kept.
    pub(crate) kept: Option<&'a mut KeptRuns>,
    /// Device that makes the runs, with the same curves.
    pub(crate) device: Option<&'a dyn Device>,
    /// Whether runs are left to others, except those of a search for the closest curve, where each run
    /// depends on earlier ones.
    pub(crate) is_elsewhere: bool,
    /// The runs to be made elsewhere, for which the calibration was interrupted.
    pub(crate) wanted: Option<Vec<WantedRun>>,
    ended: usize,
    /// Expected number of runs, without those of a search for the closest curve.
    pub(crate) total: usize,
}

impl<'a> RunMaker<'a> {
    /// Makes runs without keeping them; `total` is their number, without those of a search for the closest
    /// curve.
    pub fn new(stop: &'a AtomicBool, total: usize, watch: &'a mut dyn FnMut(&CalibrationProgress)) -> Self {
        Self {
            stop,
            watch,
            kept: None,
            device: None,
            is_elsewhere: false,
            wanted: None,
            ended: 0,
            total,
        }
    }

    /// The curves of all runs, in their order.
    ///
    /// # Errors
    /// The error of the first run that has one; an error of the journal; after a stop; and if runs must be
    /// made elsewhere first.
    pub(crate) fn curves(&mut self, stage: CalibrationStage, runs: &Runs) -> Result<Vec<Curves>, StudyError> {
        let ids = match self.kept {
            Some(_) => runs.identities()?,
            None => vec![String::new(); runs.points.len()],
        };
        let known = |id: &String| self.kept.as_ref()?.known.get(id).cloned();
        let mut found: Vec<Option<Curves>> = ids.iter().map(known).collect();
        let missing: Vec<usize> = (0..found.len()).filter(|run| found[*run].is_none()).collect();
        self.total = match stage {
            // The number of runs of a search is not known in advance.
            CalibrationStage::Closest => self.total + missing.len(),
            _ => self.total.saturating_sub(found.len() - missing.len()),
        };
        self.show(stage, 0);
        if self.is_elsewhere && stage != CalibrationStage::Closest && !missing.is_empty() {
            let wanted = missing.iter().map(|run| runs.wanted(*run, &ids[*run]));
            self.wanted = Some(wanted.collect());
            return Err(StudyError::Interrupted);
        }
        let stop = self.stop;
        // The runs of a search are too few for a device.
        let device = self.device.filter(|_| stage != CalibrationStage::Closest);
        let at_once = match device {
            Some(_) => runs.at_once_on_device()?,
            None => AT_ONCE,
        };
        for some in missing.chunks(at_once) {
            let made = runs.curves(some, device, stop)?;
            let made: Option<Vec<Curves>> = made.into_iter().collect::<Result<_, _>>()?;
            let made = made.ok_or(StudyError::Interrupted)?;
            if let Some(kept) = &mut self.kept {
                let to_keep = some.iter().zip(&made).map(|(run, curves)| CalibrationRun {
                    id: ids[*run].clone(),
                    curves: curves.clone(),
                });
                kept.keep(stage, to_keep.collect())?;
            }
            for (run, curves) in some.iter().zip(made) {
                found[*run] = Some(curves);
            }
            self.show(stage, some.len());
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// Reports that `runs` more runs have ended.
    fn show(&mut self, stage: CalibrationStage, runs: usize) {
        self.ended += runs;
        (self.watch)(&CalibrationProgress {
            stage,
            runs: self.ended,
            total: self.total,
        });
    }
}
