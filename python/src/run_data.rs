//! Results of a run.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipfront_case::case::Case as SlipfrontCase;
use slipfront_case::field_info::field_info;
use slipfront_run::fields::{FieldsData, KymographData};
use slipfront_run::manifest::Processors;
use slipfront_run::observers;
use slipfront_run::pictures;
use slipfront_run::results;
use slipfront_run::run_files::RunFiles;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::running;
use slipfront_run::series::{self, SeriesRow};
use slipfront_run::summary::summary_json;

use crate::arrays::{rows, stacked};
use crate::errors::folder_error;
use crate::process::detached;

/// Results of a run of this process.
#[pyclass(frozen, module = "slipfront._slipfront")]
pub(crate) struct RunData {
    pub(crate) case: Arc<SlipfrontCase>,
    pub(crate) record: running::RunData,
    pub(crate) started: jiff::Timestamp,
    pub(crate) processors: Processors,
}

#[pymethods]
impl RunData {
    /// Content of `summary.json`.
    fn summary(&self) -> String {
        summary_json(&self.record.summary)
    }

    /// The columns of `series.csv`.
    fn series<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (case, recorded) = (&self.case, self.record.rows.iter());
        let rows: Vec<SeriesRow> = recorded
            .map(|row| SeriesRow::new(row, &case.scales, &case.model))
            .collect();
        series(py, &rows)
    }

    /// The arrays of `fields.nc`.
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let frames = self.record.frames.clone();
        fields(py, results::fields_of(&self.case, &self.record, frames))
    }

    /// The arrays of `kymograph.nc`.
    fn kymograph<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        kymograph(py, KymographData::new(&self.record.kymograph, &self.case))
    }

    /// The tables of observers that only some runs have.
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let written = self.record.observers.tables(&self.case.scales);
        let files = written.map_err(folder_error)?.into_iter();
        let files: Vec<(String, Vec<u8>)> = files
            .map(|(table, contents)| (table.file.to_owned(), contents))
            .collect();
        tables(py, RunFiles::InMemory(&files))
    }

    /// Writes the folder of the run, with the bytes that the command writes.
    fn save(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<()> {
        let (case, started, processors) = (&*self.case, self.started, self.processors.clone());
        detached(py, || {
            let mut run = RunFolder::prepare(&folder, force, &case.inputs).map_err(folder_error)?;
            results::write_case(case, &mut run).map_err(folder_error)?;
            // Writing removes the fields from its argument.
            let mut record = self.record.clone();
            pictures::write_run(case, &mut record, run, started, processors).map_err(folder_error)?;
            Ok(())
        })?
    }
}

/// The columns of a series.
pub(crate) fn series<'py>(py: Python<'py>, rows: &[SeriesRow]) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    let steps: Vec<u64> = rows.iter().map(|row| row.step).collect();
    columns.set_item("step", steps.into_pyarray(py))?;
    for (name, values) in series::columns(rows) {
        columns.set_item(name, values.into_pyarray(py))?;
    }
    Ok(columns)
}

/// The tables that a run may have besides its series, by name: columns, with NaN for missing numbers; None
/// for a table that this run does not have.
pub(crate) fn tables<'py>(py: Python<'py>, run: RunFiles<'_>) -> PyResult<Bound<'py, PyDict>> {
    let tables = PyDict::new(py);
    for table in observers::tables() {
        tables.set_item(table.name(), None::<()>)?;
        let Some(file) = run.found(table.file).map_err(folder_error)? else {
            continue;
        };
        let columns = PyDict::new(py);
        for (name, values) in (table.columns)(&file).map_err(folder_error)? {
            columns.set_item(name, values.into_pyarray(py))?;
        }
        tables.set_item(table.name(), columns)?;
    }
    Ok(tables)
}

/// The arrays of a file of fields.
pub(crate) fn fields(py: Python<'_>, data: FieldsData) -> PyResult<Bound<'_, PyDict>> {
    let arrays = PyDict::new(py);
    let shape = [data.rows(), data.columns()];
    let columns = data.columns();
    let centres = |count: usize| -> Vec<f64> {
        let at = |k: usize| ((k * data.stride) as f64 + 0.5) * data.block_size;
        (0..count).map(at).collect()
    };
    arrays.set_item("x", centres(shape[1]).into_pyarray(py))?;
    arrays.set_item("y", centres(shape[0]).into_pyarray(py))?;
    arrays.set_item("stride", data.stride)?;
    arrays.set_item("block_size_m", data.block_size)?;
    arrays.set_item("time_unit_s", data.time_unit_s)?;
    let instants = PyDict::new(py);
    let frames = &data.frames;
    let labels: Vec<&str> = frames.iter().map(|frame| frame.label.as_str()).collect();
    instants.set_item("instant", labels)?;
    let times: Vec<f64> = frames.iter().map(|frame| frame.time_star).collect();
    instants.set_item("time_star", times.into_pyarray(py))?;
    let steps: Vec<u64> = frames.iter().map(|frame| frame.step).collect();
    instants.set_item("step", steps.into_pyarray(py))?;
    arrays.set_item("instants", instants)?;
    let of_time = PyDict::new(py);
    for (place, &field) in data.names.iter().enumerate() {
        let info = field_info(field);
        let values: Vec<&[f32]> = frames
            .iter()
            .map(|frame| frame.values[place].as_slice())
            .collect();
        of_time.set_item(
            info.name,
            (stacked(py, &values, shape)?, info.unit, info.long_name),
        )?;
    }
    arrays.set_item("fields", of_time)?;
    arrays.set_item("textured", rows(py, data.textured, columns)?)?;
    arrays.set_item("mu_static", rows(py, data.mu_static, columns)?)?;
    arrays.set_item("mu_kinetic", rows(py, data.mu_kinetic, columns)?)?;
    arrays.set_item(
        "first_slip_time_star",
        rows(py, data.first_slip_time_star, columns)?,
    )?;
    Ok(arrays)
}

/// The arrays of a kymograph.
pub(crate) fn kymograph(py: Python<'_>, data: KymographData) -> PyResult<Bound<'_, PyDict>> {
    let arrays = PyDict::new(py);
    let columns = data.columns();
    let width = (data.places[1] - data.places[0]) / columns.max(1) as f64;
    let middles: Vec<f64> = (0..columns)
        .map(|bin| data.places[0] + (bin as f64 + 0.5) * width)
        .collect();
    arrays.set_item("time_star", data.time_star.into_pyarray(py))?;
    arrays.set_item("place", middles.into_pyarray(py))?;
    arrays.set_item("sliding_share", rows(py, data.sliding_share, columns)?)?;
    Ok(arrays)
}
