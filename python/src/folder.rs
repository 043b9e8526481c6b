//! Folders of results.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipfront::Execution;
use slipfront::communicator::Alone;
use slipfront_base::unfinished::TemporaryFolder;
use slipfront_calibrate::CALIBRATIONS;
use slipfront_case::case::{Case as SlipfrontCase, Ranks};
use slipfront_case::case_file::CaseFile;
use slipfront_design::DESIGNS;
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::names::{FIELDS, FIGURE_CACHE, KYMOGRAPH, SERIES};
use slipfront_run::run_files::RunFiles;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::run_folder::inspection::Contents;
use slipfront_run::running::Running;
use slipfront_run::verify::inspect;
use slipfront_run::{fields, series, summary};
use slipfront_study::converge::is_written;
use slipfront_study::project_folder::Extent;
use slipfront_study::study_of;
use slipfront_study::verify::{has_records, verify as verify_folder};

use crate::case::{Case, make};
use crate::errors::{FolderError, folder_error};
use crate::process::detached;
use crate::run_data;
use crate::simulation::Simulation;

/// The folder of the temporary folders of this process; it is removed with the last reference to it.
#[pyclass(frozen, module = "slipfront._slipfront")]
pub(crate) struct TemporaryParent(Arc<TemporaryFolder>);

#[pymethods]
impl TemporaryParent {
    #[new]
    fn new() -> PyResult<Self> {
        Ok(Self(TemporaryFolder::shared()?))
    }

    #[getter]
    fn path(&self) -> PathBuf {
        self.0.path().to_owned()
    }
}

/// Kind of a folder: `run`, `interrupted`, `study`, `meshes` for a study that compares meshes, `design`,
/// `calibration`, `paper`, or none of these.
#[pyfunction]
pub(crate) fn kind_of(folder: PathBuf) -> PyResult<Option<&'static str>> {
    if has_records(&folder) {
        let is_of_meshes = study_of(&folder).is_ok_and(|study| is_written(&folder, &study.axes));
        return Ok(Some(if is_of_meshes { "meshes" } else { "study" }));
    }
    if DESIGNS.kind.is_in(&folder) && folder.join("design.json").exists() {
        return Ok(Some("design"));
    }
    if CALIBRATIONS.kind.is_in(&folder) && folder.join("calibration.json").exists() {
        return Ok(Some("calibration"));
    }
    if folder.join(FIGURE_CACHE).is_dir() {
        return Ok(Some("paper"));
    }
    let run = inspect(&folder).map_err(folder_error)?;
    Ok(match run.contents {
        Contents::Complete(_) => Some("run"),
        Contents::Interrupted => Some("interrupted"),
        Contents::Empty | Contents::Foreign => None,
    })
}

/// Compares a folder with its manifest, or with its records.
#[pyfunction]
pub(crate) fn verify(py: Python<'_>, folder: PathBuf) -> PyResult<()> {
    let check = detached(py, || {
        verify_folder(
            &folder,
            &[DESIGNS, CALIBRATIONS],
            Extent::Derived,
            &AtomicBool::new(false),
        )
    })?
    .map_err(folder_error)?;
    match check.differences.as_slice() {
        [] => Ok(()),
        differences => Err(FolderError::new_err(differences.join("\n"))),
    }
}

/// Makes a folder ready for the files of a run: a new or empty one, or with `force` one from which the files
/// of an earlier run are removed, and nothing else.
#[pyfunction]
pub(crate) fn make_ready(folder: PathBuf, force: bool) -> PyResult<()> {
    let run = RunFolder::prepare(&folder, force, &[]).map_err(folder_error)?;
    run.discard();
    Ok(())
}

/// The case with which the run of a folder began, under the name of the folder.
fn case_of(py: Python<'_>, folder: &Path, file: CaseFile) -> PyResult<Case> {
    let canonical = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let name = canonical
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    make(py, |watch| {
        SlipfrontCase::to_run(file, &name, folder, watch, Ranks::ALONE)
    })
}

/// A complete run in its folder: its case, and the content of a `RunData`.
#[pyfunction]
pub(crate) fn read_run<'py>(py: Python<'py>, folder: PathBuf) -> PyResult<(Case, Bound<'py, PyDict>)> {
    let run = inspect(&folder).map_err(folder_error)?;
    let file = run.case_to_resume().map_err(folder_error)?.clone();
    let case = case_of(py, &folder, file)?;
    let read = PyDict::new(py);
    let numbers = summary::read_summary(&folder).map_err(folder_error)?;
    read.set_item("summary", summary::summary_json(&numbers))?;
    let rows = series::read_csv(folder.join(SERIES)).map_err(folder_error)?;
    read.set_item("series", run_data::series(py, &rows)?)?;
    let data = fields::read_fields(folder.join(FIELDS)).map_err(folder_error)?;
    read.set_item("fields", run_data::fields(py, data)?)?;
    let kymograph = folder.join(KYMOGRAPH);
    if kymograph.exists() {
        let data = fields::read_kymograph(&kymograph).map_err(folder_error)?;
        read.set_item("kymograph", run_data::kymograph(py, data)?)?;
    }
    read.set_item("tables", run_data::tables(py, RunFiles::Folder(&folder))?)?;
    Ok((case, read))
}

/// The case of an interrupted run, and the run continued from its latest checkpoint, or from its start if it
/// has none.
#[pyfunction]
pub(crate) fn interrupted(py: Python<'_>, folder: PathBuf, threads: usize) -> PyResult<(Case, Simulation)> {
    let run = inspect(&folder).map_err(folder_error)?;
    let file = run.case_to_resume().map_err(folder_error)?.clone();
    let case = case_of(py, &folder, file)?;
    let execution = Execution::on_threads(threads);
    let running = detached(py, || {
        let loaded = Checkpoints::load(&folder, &case.0, false, &Alone).map_err(folder_error)?;
        let Some(loaded) = loaded else {
            return Ok(Running::start(&case.0, None, execution));
        };
        let resumed = loaded.resume(&case.0, execution).map_err(folder_error)?;
        let foreign = || folder_error("its checkpoint does not belong to its case");
        resumed.ok_or_else(foreign)
    })??;
    Ok((case, Simulation::start(running)?))
}
