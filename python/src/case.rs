//! Cases.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use numpy::{Element, PyArray2};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBytes, PyDict};
use slipfront::Surface;
use slipfront_case::case::{Budget, Case as SlipfrontCase, Files, FilesInMemory, Ranks};
use slipfront_case::case_file::{CaseError as Error, CaseFile};

use crate::arrays::borrowed;
use crate::errors::{CaseError, case_error};
use crate::process::{LOOK_EVERY, detached};

/// A case that can be run, which never changes.
#[pyclass(frozen, module = "slipfront._slipfront")]
pub(crate) struct Case(pub(crate) Arc<SlipfrontCase>);

/// Makes a case while other Python threads continue. The case is refused if there is no memory for its run,
/// unless that memory is [small](Budget::SMALL). `make` gets the function that watches its texture. A signal
/// ends the work.
pub(crate) fn make(
    py: Python<'_>,
    make: impl FnOnce(&mut dyn FnMut(f64) -> bool) -> Result<SlipfrontCase, Error> + Send,
) -> PyResult<Case> {
    let mut signal = None;
    let mut looked = Instant::now();
    let made = detached(py, || {
        let case = make(&mut |_| {
            if looked.elapsed() >= LOOK_EVERY {
                looked = Instant::now();
                signal = Python::attach(|py| py.check_signals().err());
            }
            signal.is_none()
        })?;
        if case.budget.memory() >= Budget::SMALL {
            case.budget.check_memory(&case.file, false)?;
        }
        Ok(case)
    })?;
    match (made, signal) {
        (_, Some(signal)) => Err(signal),
        (Ok(case), None) => Ok(Case(Arc::new(case))),
        (Err(error), None) => Err(case_error(py, &error)),
    }
}

/// Files of arrays by the names that a case gives them.
type Arrays = BTreeMap<String, PyBackedBytes>;

fn in_memory(arrays: &Arrays) -> FilesInMemory {
    let contents = arrays.iter();
    contents
        .map(|(name, contents)| (name.clone(), Arc::from(&**contents)))
        .collect()
}

/// Numbers of the surface of a case, without a copy.
fn of_surface<'py, T: Element>(
    case: &Bound<'py, Case>,
    values: impl Fn(&Surface) -> &[T],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let model = &case.get().0.model;
    borrowed(case.clone().into_any(), values(&model.surface), model.lattice.nx)
}

#[pymethods]
impl Case {
    /// The case of a file, with overrides of the form KEY=VALUE, which may name arrays in memory.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, overrides: Vec<String>, arrays: Arrays) -> PyResult<Self> {
        let arrays = in_memory(&arrays);
        make(py, |watch| {
            SlipfrontCase::load_with(&path, &overrides, Some(&arrays), watch, Ranks::ALONE)
        })
    }

    /// The case of a text called `name`; the files it names are arrays in memory, or relative to a folder.
    #[staticmethod]
    fn parse(
        py: Python<'_>,
        text: &str,
        name: &str,
        folder: PathBuf,
        overrides: Vec<String>,
        arrays: Arrays,
    ) -> PyResult<Self> {
        let arrays = in_memory(&arrays);
        let files = Files {
            folder: &folder,
            in_memory: Some(&arrays),
        };
        make(py, |watch| {
            let file = CaseFile::parse(text, name, &overrides)?;
            SlipfrontCase::to_run(file, name, files, watch, Ranks::ALONE)
        })
    }

    /// The name of the case and of its results.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// The resolved case, with every default.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        self.0.file.to_toml().map_err(|error| case_error(py, &error))
    }

    /// The resolved case, with every default, as JSON.
    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.0.file).map_err(|error| CaseError::new_err(error.to_string()))
    }

    /// The files that the case reads: the name of each in the resolved case, its path or its name in memory,
    /// and the hash of its contents.
    #[getter]
    fn inputs(&self) -> Vec<(String, PathBuf, String)> {
        let inputs = self.0.inputs.iter();
        inputs
            .map(|input| {
                (
                    input.name.clone(),
                    input.original.clone(),
                    input.hash.to_hex().to_string(),
                )
            })
            .collect()
    }

    /// The files in memory, by their names there.
    #[getter]
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let files = PyDict::new(py);
        for input in &self.0.inputs {
            if let Some(contents) = &input.contents {
                files.set_item(input.original.to_string_lossy(), PyBytes::new(py, contents))?;
            }
        }
        Ok(files)
    }

    /// The contents of the files that the case reads, by their names in the resolved case; an error if one
    /// has changed since the case was made.
    fn read_inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let files = PyDict::new(py);
        for input in &self.0.inputs {
            let contents = input.read_again().map_err(|error| case_error(py, &error))?;
            files.set_item(&input.name, PyBytes::new(py, &contents))?;
        }
        Ok(files)
    }

    /// The resolved physics, as `slipfront check` prints it.
    #[getter]
    fn physics(&self) -> String {
        slipfront_cli::physics(&self.0)
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings()
    }

    /// Rows and columns of the lattice.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.0.model.lattice.ny, self.0.model.lattice.nx)
    }

    /// The last step of a run, unless it ends earlier.
    #[getter]
    fn last_step(&self) -> u64 {
        self.0.time_plan.last_step
    }

    /// Named numbers: dimensionless groups and units.
    #[getter]
    fn numbers(&self) -> Vec<(&'static str, f64)> {
        let (groups, scales, plan) = (&self.0.groups, &self.0.scales, &self.0.time_plan);
        vec![
            ("v_star", groups.v_star),
            ("r_star", groups.r_star),
            ("omega_star", groups.omega_star),
            ("sigma_static_star", groups.sigma_static_star),
            ("sigma_kinetic_star", groups.sigma_kinetic_star),
            ("epsilon", groups.epsilon),
            ("dt_star", plan.dt_star),
            ("duration_star", plan.end_star()),
            ("texture_percent", self.0.texture.meshed_percent),
            ("block_size_m", scales.block_size),
            ("time_unit_s", scales.time()),
            ("displacement_unit_m", scales.displacement()),
            ("speed_unit_m_s", scales.speed()),
            ("stress_unit_pa", scales.stress()),
        ]
    }

    /// Whether each block is textured.
    #[getter]
    fn textured<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<bool>>> {
        of_surface(this, |surface| &surface.textured)
    }

    /// Static friction coefficient of every block.
    #[getter]
    fn mu_static<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        of_surface(this, |surface| &surface.mu_static)
    }

    /// Kinetic friction coefficient of every block.
    #[getter]
    fn mu_kinetic<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        of_surface(this, |surface| &surface.mu_kinetic)
    }
}
