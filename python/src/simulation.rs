//! Runs in progress.

use std::ffi::CString;
use std::sync::Arc;
use std::time::Instant;

use numpy::{PyArray2, PyArray3};
use pyo3::exceptions::{PyRuntimeError, PyRuntimeWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use slipfront::device::DeviceError;
use slipfront::observe::frames::Selection;
use slipfront::{Execution, State, StopReason, VectorField};
use slipfront_case::case::Case as SlipfrontCase;
use slipfront_case::field_info::field_named;
use slipfront_run::checkpoint::hash_of;
use slipfront_run::checksum::{verified, with_checksum};
use slipfront_run::columns::Columns;
use slipfront_run::device::refusal_of_run;
use slipfront_run::fields::FieldFrame;
use slipfront_run::running::{RunState, Running};
use slipfront_run::series::{SeriesRow, counts};
use slipfront_run::{clock, program};

use crate::arrays::{rows, stacked};
use crate::case::Case;
use crate::device::device_error;
use crate::errors::{CaseError, RunError};
use crate::process::{LOOK_EVERY, check_process, detached};
use crate::run_data::{RunData, series};

/// A run in progress, which only one thread can use at a time.
#[pyclass(module = "slipfront._slipfront")]
pub(crate) struct Simulation {
    /// The run; none after it was taken as a record.
    running: Option<Running>,
    started: jiff::Timestamp,
}

impl Simulation {
    /// A simulation of a run that has recorded its current instant: a checkpoint needs a recorded instant.
    pub(crate) fn start(mut running: Running) -> PyResult<Self> {
        running.advance(0).map_err(run_error)?;
        Ok(Self {
            running: Some(running),
            started: clock::now(),
        })
    }

    fn running(&self) -> PyResult<&Running> {
        check_process()?;
        self.running.as_ref().ok_or_else(ended)
    }
}

/// Vectors of the blocks of a run: x and y, row by row.
fn vectors<'py>(
    py: Python<'py>,
    VectorField { x, y }: VectorField,
    running: &Running,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let lattice = running.case().model.lattice;
    stacked(py, &[&x, &y], [lattice.ny, lattice.nx])
}

/// Context of a checkpoint: the build of the program, on which the numbers depend, and the case.
fn context(case: &SlipfrontCase) -> Vec<u8> {
    [program::this_build(), &hash_of(case)].concat().into_bytes()
}

fn run_error(error: slipfront::RunError) -> PyErr {
    RunError::new_err(error.to_string())
}

fn ended() -> PyErr {
    PyRuntimeError::new_err("this simulation has given its results away: begin another one")
}

#[pymethods]
impl Simulation {
    /// Begins a run of a case at rest.
    #[new]
    fn new(py: Python<'_>, case: &Case, threads: usize, device: &str) -> PyResult<Self> {
        let device = detached(py, || crate::device::device(device))??;
        if let Some(reason) = device
            .as_deref()
            .and_then(|device| refusal_of_run(&case.0, device))
        {
            return Err(device_error(DeviceError(reason)));
        }
        let execution = Execution {
            device,
            ..Execution::on_threads(threads)
        };
        Self::start(detached(py, || Running::start(&case.0, None, execution))?)
    }

    /// The run continued under another case; the position of the drive over each block, x and y in m; the
    /// steps of this run, and its other counts by the names of the columns of its series. This run then ends.
    #[allow(clippy::type_complexity, reason = "a tuple of Python, which has no name")]
    fn change<'py>(
        &mut self,
        py: Python<'py>,
        case: &Case,
        threads: usize,
    ) -> PyResult<(Self, Bound<'py, PyArray3<f64>>, u64, Vec<(&'static str, f64)>)> {
        let running = self.running.as_mut().ok_or_else(ended)?;
        let leg = detached(py, || running.change(&case.0, threads))?;
        let leg = leg.map_err(|error| CaseError::new_err(error.to_string()))?;
        let row = detached(py, || running.end_of_leg())?.map_err(run_error)?;
        let counted = counts(&row, &running.case().scales, &running.case().model);
        let drive = vectors(py, leg.drive_m, running)?;
        Ok((Self::start(leg.running)?, drive, leg.steps, counted))
    }

    /// Takes at most `steps` steps, for 50 ms or a little longer; returns their number, and whether the run
    /// has ended: `end`, `onset` or none.
    fn advance(&mut self, py: Python<'_>, steps: u64) -> PyResult<(u64, Option<&'static str>)> {
        let running = self.running.as_mut().ok_or_else(ended)?;
        let first = running.snapshot().step;
        let (piece, threads) = (running.case().steps_per_poll(), running.threads());
        let mut left = steps;
        let mut advance = || {
            let began = Instant::now();
            loop {
                let now = left.min(piece);
                let reason = running.advance(now)?;
                left -= now;
                if reason.is_some() || left == 0 || began.elapsed() >= LOOK_EVERY {
                    return Ok(reason);
                }
            }
        };
        // With several threads, this runs on one of them, so that it need not wake the others at every step.
        let reason = detached(py, || match threads {
            1 => advance(),
            _ => rayon::scope(|_| advance()),
        })?;
        let reason = reason.map_err(run_error)?.map(|reason| match reason {
            StopReason::End => "end",
            StopReason::Onset => "onset",
        });
        Ok((running.snapshot().step - first, reason))
    }

    /// Number of the step.
    #[getter]
    fn step(&self) -> PyResult<u64> {
        Ok(self.running()?.snapshot().step)
    }

    /// Time t*, mu* along and across the drive, N* in %.
    #[getter]
    fn point(&self) -> PyResult<[f64; 4]> {
        let now = self.running()?.snapshot();
        let point = now.point;
        Ok([
            now.time_star,
            point.mu_star,
            point.mu_lateral_star,
            point.sliding_percent,
        ])
    }

    /// Dimensionless displacements now, x and y, and velocities half a step later.
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray3<f64>>; 2]> {
        let running = self.running()?;
        let State {
            displacement,
            velocity,
        } = running.motion();
        Ok([
            vectors(py, displacement, running)?,
            vectors(py, velocity, running)?,
        ])
    }

    /// A field at the current instant, in the unit of `fields.nc`.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let running = self.running()?;
        let field =
            field_named(name).ok_or_else(|| PyValueError::new_err(format!("there is no field `{name}`")))?;
        let selection = Selection {
            fields: vec![field],
            stride: 1,
        };
        let frame = selection.capture(&running.snapshot());
        let scale = running.contact_stress_max();
        let case = running.case();
        let mut frame = FieldFrame::in_si_units(frame, String::new(), &[field], &case.scales, scale);
        rows(py, frame.values.swap_remove(0), case.model.lattice.nx)
    }

    /// The curve up to now: its columns.
    fn series<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let running = self.running()?;
        let case = running.case();
        let rows = running.rows().iter();
        let rows: Vec<SeriesRow> = rows
            .map(|row| SeriesRow::new(row, &case.scales, &case.model))
            .collect();
        series(py, &rows)
    }

    /// State from which the run continues bit-identically.
    fn checkpoint<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let running = self.running()?;
        let mut columns = Vec::new();
        running.write_columns(|place, part| {
            let (from, until) = (place as usize, place as usize + part.len());
            columns.resize(columns.len().max(until), 0);
            columns[from..until].copy_from_slice(part);
            Ok::<(), PyErr>(())
        })?;
        let contents = postcard::to_stdvec(&(running.state(), columns));
        let contents = contents.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(PyBytes::new(
            py,
            &with_checksum(&context(running.case()), &contents),
        ))
    }

    /// The run of this case, continued from a checkpoint.
    #[staticmethod]
    fn resume(py: Python<'_>, case: &Case, checkpoint: &[u8], threads: usize) -> PyResult<Self> {
        let refused = || {
            PyValueError::new_err(format!(
                "these bytes are no checkpoint of a run of this case by {}, or they are damaged: start the run again, or continue with \
                 the case and the program that made them",
                program::this_build()
            ))
        };
        let contents = verified(&context(&case.0), checkpoint).ok_or_else(refused)?;
        let parts = postcard::from_bytes::<(RunState, &[u8])>(contents);
        let (state, columns) = parts.map_err(|_| refused())?;
        let needed = state
            .columns(&case.0)
            .iter()
            .map(Columns::bytes)
            .sum::<Option<u64>>();
        if needed != Some(columns.len() as u64) {
            return Err(refused());
        }
        let read = |place: u64, part: &mut [u8]| {
            let from = place as usize;
            let found = columns.get(from..from + part.len()).ok_or(())?;
            part.copy_from_slice(found);
            Ok::<(), ()>(())
        };
        let running = detached(py, || {
            Running::resume(&case.0, state, Execution::on_threads(threads), read)
        })?;
        let running = running.ok().flatten().ok_or_else(refused)?;
        Self::start(running)
    }

    /// Results of the run, once it has ended; the simulation cannot be used afterwards.
    fn record(&mut self, py: Python<'_>, reason: &str) -> PyResult<RunData> {
        if let Some(failure) = self.running()?.device_failure() {
            let sentence = CString::new(format!("{failure}; the CPU computed the other steps"))?;
            PyErr::warn(py, &py.get_type::<PyRuntimeWarning>(), &sentence, 1)?;
        }
        let running = self.running.take().ok_or_else(ended)?;
        let reason = match reason {
            "onset" => StopReason::Onset,
            _ => StopReason::End,
        };
        let (case, processors) = (Arc::clone(running.case()), running.processors());
        let record = detached(py, || running.record(reason))?;
        Ok(RunData {
            case,
            record,
            started: self.started,
            processors,
        })
    }
}
