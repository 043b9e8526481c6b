//! Calibrations: keys of a case from measured records.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use slipfront_calibrate::{CalibrationFile, CalibrationFolder, CalibrationProgress, SampledRecord};
use slipfront_study::StudyError;

use crate::errors::folder_error;
use crate::process::{detached_study, on_pool};

/// A calibration file.
#[pyclass(frozen, module = "slipfront._slipfront")]
pub(crate) struct Calibration {
    file: CalibrationFile,
}

#[pymethods]
impl Calibration {
    /// The calibration of a text called `name`; the files it names are relative to a folder.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, name: &str, folder: PathBuf) -> PyResult<Self> {
        Self::from_file(py, || CalibrationFile::parse(text, name, name, &folder))
    }

    /// The calibration of a file, with overrides of its base of the form KEY=VALUE.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        Self::from_file(py, || {
            let mut file = CalibrationFile::load(&path)?;
            file.project.set(&overrides)?;
            Ok(file)
        })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.file.project.name
    }

    /// The columns of records.
    #[getter]
    fn columns(&self) -> [&str; 2] {
        self.file.keys.columns()
    }

    /// Calibrates in a folder, or continues there, and returns sentences about lines of the records that were
    /// skipped. `folder` also says whether edited files there are replaced.
    fn execute(
        &self,
        py: Python<'_>,
        folder: (PathBuf, bool),
        training: Option<PathBuf>,
        records: Vec<PathBuf>,
        threads: usize,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<Vec<String>> {
        let (folder, force) = folder;
        let (mut opened, notes) = self.open(py, &folder, force, training.as_deref(), &records, threads)?;
        on_pool(py, "work", threads, watch.as_ref(), numbers, |stop, show| {
            opened.find(None, stop, show)
        })?;
        Ok(notes)
    }

    /// Tests whether the model can reproduce the records, and returns the reasons why it cannot, the numbers
    /// of the tests as JSON, and sentences about lines of the records that were skipped.
    fn check(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        training: Option<PathBuf>,
        records: Vec<PathBuf>,
        threads: usize,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<String>, String, Vec<String>)> {
        let (mut opened, notes) = self.open(py, &folder, false, training.as_deref(), &records, threads)?;
        let found = on_pool(py, "work", threads, watch.as_ref(), numbers, |stop, show| {
            opened.check(stop, show)
        })?;
        let tests = serde_json::to_string(&found).map_err(folder_error)?;
        Ok((found.reasons(), tests, notes))
    }

    /// Simulates planned records, up to a place in its unit with a number of values or at the times of
    /// records, and returns the expected widths of the intervals as JSON.
    fn plan(
        &self,
        py: Python<'_>,
        until: Option<(String, usize)>,
        records: Vec<PathBuf>,
        threads: usize,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let grids = detached_study(py, || match &until {
            Some((until, values)) => self.file.planned(until, *values),
            None => Ok(self
                .file
                .read(&records)?
                .iter()
                .map(SampledRecord::places)
                .collect()),
        })?;
        let plan = on_pool(py, "work", threads, watch.as_ref(), numbers, |stop, show| {
            self.file.plan(grids, stop, show)
        })?;
        serde_json::to_string(&plan).map_err(folder_error)
    }
}

impl Calibration {
    fn from_file(
        py: Python<'_>,
        read: impl FnOnce() -> Result<CalibrationFile, StudyError> + Send,
    ) -> PyResult<Self> {
        let file = detached_study(py, read)?;
        Ok(Self { file })
    }

    /// The results folder for these records, and sentences about their lines that were skipped.
    fn open(
        &self,
        py: Python<'_>,
        folder: &Path,
        force: bool,
        training: Option<&Path>,
        records: &[PathBuf],
        threads: usize,
    ) -> PyResult<(CalibrationFolder, Vec<String>)> {
        detached_study(py, || {
            let records = self.file.read(records)?;
            self.file.check_memory(&records, threads)?;
            let notes = records.iter().flat_map(SampledRecord::notes).collect();
            let folder = CalibrationFolder::open(folder, training, &self.file, records, force)?;
            Ok((folder, notes))
        })
    }
}

/// The numbers of a calibration's progress: finished runs, and all.
fn numbers(now: &CalibrationProgress) -> (usize, usize) {
    (now.runs, now.total)
}
