//! The results folder of a calibration: its file, copies of the records, the journal of runs, and
//! the findings.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf, absolute};
use std::sync::atomic::AtomicBool;

use serde::Deserialize;
use slipfront::device::Device;
use slipfront_base::disk::is_same;
use slipfront_plot::PictureLook;
use slipfront_run::manifest::ManifestFile;

use crate::file::{CALIBRATION, CalibrationFile, RECORD, SampledRecord};
use crate::fit::Fit;
use crate::progress::CalibrationProgress;
use crate::record_check::RecordCheck;
use crate::report::{FOUND, Report};
use crate::runs::{KeptRuns, RunMaker};
use slipfront_study::StudyError;
use slipfront_study::project_folder::{
    Checksums, Given, Others, Project, ResultFiles, notes_of_use, read_numbers,
};

/// A results folder, with the runs that were kept in it.
#[derive(Debug)]
pub struct CalibrationFolder {
    path: PathBuf,
    files: ResultFiles,
    kept: KeptRuns,
    fit: Fit,
}

/// Folders of calibrations.
pub const CALIBRATIONS: Project = Project {
    kind: &CALIBRATION,
    no_pictures: &[],
    beside: &[],
    verify_beside: None,
    find_again: Some(find_again),
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
    again.find(None, stop, &mut |_| {})?;
    Ok([kept, again.n_kept()])
}

/// Whether two paths, which need not exist yet, lead to the same folder.
fn is_same_place(one: &Path, other: &Path) -> bool {
    let are_equal = || matches!((absolute(one), absolute(other)), (Ok(one), Ok(other)) if one == other);
    is_same(one, other) || are_equal()
}

impl CalibrationFolder {
    /// Opens a results folder: a new one, an empty one, or one of an earlier call for these records that no
    /// other process uses. Training runs are kept in it, or in the folder `training`.
    ///
    /// # Errors
    /// When the ranges leave the bounds of the case; then nothing is written. When the folder contains other
    /// files, or results that were edited afterwards, unless `force` is set; when another process uses it, or
    /// it cannot be written to.
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
        let file = CalibrationFile::parse(&given.text, &name, &file.project.name, path)?;
        Ok(Self {
            path: path.to_owned(),
            files,
            kept,
            fit: Fit::new(file, records)?,
        })
    }

    /// The calibration of one folder, to be repeated in another.
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
        self.kept.known.len()
    }

    /// Trains, fits the records, runs blocks of half the size and further experiments, writes the findings,
    /// and returns them as a text. A device, if there is one, makes the runs, with the same findings.
    ///
    /// # Errors
    /// When runs cannot be made or kept, after a stop, and when the system refuses to write.
    pub fn find(
        &mut self,
        device: Option<&dyn Device>,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&CalibrationProgress),
    ) -> Result<String, StudyError> {
        let mut maker = RunMaker::new(stop, 0, watch);
        (maker.kept, maker.device) = (Some(&mut self.kept), device);
        let found = self.fit.find(&mut maker)?;
        let mut batch = self.files.begin();
        let text = Report::new(&self.fit.set_up, &found.findings).write(&found, &mut batch)?;
        batch.place(Others::Go, self.kept.listed()?)?;
        Ok(text)
    }

    /// Trains, and tests as [`Self::find`] does whether the model can have made the records. Keeps the
    /// training runs, and writes no findings.
    ///
    /// # Errors
    /// When runs cannot be made or kept, and after a stop.
    pub fn check(
        &mut self,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&CalibrationProgress),
    ) -> Result<RecordCheck, StudyError> {
        let mut maker = RunMaker::new(stop, 0, watch);
        maker.kept = Some(&mut self.kept);
        self.fit.check(&mut maker)
    }
}

/// The part of the findings that decides whether they are valid.
#[derive(Deserialize)]
struct Judgement {
    is_refused: bool,
}

impl CalibrationFolder {
    /// Refuses findings about records that the model cannot have made.
    ///
    /// # Errors
    /// A sentence with the name of the findings; when the folder has none.
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
