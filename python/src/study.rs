//! Studies.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use jiff::SignedDuration;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipfront_case::case::Case as SlipfrontCase;
use slipfront_run::manifest::Processors;
use slipfront_run::{clock, running};
use slipfront_study::converge::{self, MeshStudy};
use slipfront_study::{
    self as study, CostLimits, Plan, Progress, Role, RunKey, Sample, Spacing, StudyError, StudyFile,
    StudyFolder, StudyResults,
};

use crate::case::{Case, make};
use crate::process::{detached_study, locked, on_pool};
use crate::run_data::RunData;

/// A study with a valid case at every point.
#[pyclass(frozen, module = "slipfront._slipfront")]
pub(crate) struct Study {
    file: StudyFile,
    plan: Plan,
    /// Whether the points are meshes of one slider, which results compare.
    is_of_meshes: bool,
}

/// Values of the user's own quantities, in the order of their names, by run: the number of its point in the
/// whole study, its replicate, and whether it is the reference.
type OwnValues = BTreeMap<(usize, usize, bool), Vec<f64>>;

/// Values of own quantities, places and reasons of failed runs, and why no run has a value of the main
/// quantity, if none has.
type Executed = (OwnValues, Vec<(String, String)>, Option<String>);

impl Study {
    fn from_file(
        py: Python<'_>,
        read: impl FnOnce() -> Result<StudyFile, StudyError> + Send,
    ) -> PyResult<Self> {
        detached_study(py, || {
            let file = read()?;
            let plan = Plan::new(&file, None)?;
            Ok(Self {
                file,
                plan,
                is_of_meshes: false,
            })
        })
    }

    /// Writes tables and pictures, and the comparison of meshes.
    fn write(
        &self,
        plan: &Plan,
        results: &StudyResults,
        folder: &StudyFolder,
        stop: &AtomicBool,
    ) -> Result<(), StudyError> {
        if self.is_of_meshes {
            converge::write(plan, results, folder, stop).map(drop)
        } else {
            study::write(plan, results, folder, stop)
        }
    }

    fn key(&self, run: RunKey) -> (usize, usize, bool) {
        let index = self.plan.points[run.point].index;
        (index, run.replicate, run.role == Role::Reference)
    }
}

#[pymethods]
impl Study {
    /// The study of a file, with overrides of its base of the form KEY=VALUE.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        Self::from_file(py, || {
            let mut file = StudyFile::load(&path)?;
            file.set(&overrides)?;
            Ok(file)
        })
    }

    /// The study of a text called `name`; the files it names are relative to a folder.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, name: &str, folder: PathBuf) -> PyResult<Self> {
        Self::from_file(py, || StudyFile::parse(text, name, name, &folder))
    }

    /// The study in a folder of results.
    #[staticmethod]
    fn of_folder(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        Self::from_file(py, || study::study_of(&folder))
    }

    /// The study of a case on several meshes.
    #[staticmethod]
    fn on_meshes(py: Python<'_>, case: &Case, levels: i64, replicates: Option<i64>) -> PyResult<Self> {
        let MeshStudy { file, plan } = detached_study(py, || MeshStudy::new(&case.0, levels, replicates))?;
        Ok(Self {
            file,
            plan,
            is_of_meshes: true,
        })
    }

    /// Refuses a study that takes more memory, in GB, or more time, as "30min", than the user allows.
    fn check_cost(
        &self,
        py: Python<'_>,
        threads: usize,
        max_memory: Option<f64>,
        max_time: Option<&str>,
    ) -> PyResult<()> {
        let limits = CostLimits {
            memory_gb: max_memory,
            time: max_time.map(parse_time).transpose()?,
        };
        detached_study(py, || limits.check(&self.plan, threads))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.plan.name
    }

    /// Number of points.
    #[getter]
    fn n_points(&self) -> usize {
        self.plan.points.len()
    }

    /// Least and largest number of replicates of a point.
    #[getter]
    fn replicates(&self) -> (usize, usize) {
        let settings = &self.plan.settings;
        (settings.min_replicates(), settings.max_replicates())
    }

    /// The axes: for each, the columns of the tables that name its levels, the labels of pictures, and for
    /// each level its cells, its number and its label next to those of other axes.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let axes = self.plan.axes.iter().zip(study::axis_labels(&self.plan));
        axes.map(|(axis, labels)| {
            let row = PyDict::new(py);
            let levels = axis.levels.iter().zip(labels.levels);
            let levels =
                levels.map(|(level, label)| (level.labels.clone(), level.number, level.shown(), label));
            row.set_item("columns", &axis.columns)?;
            row.set_item("title", labels.title)?;
            row.set_item("drawn_title", labels.drawn_title)?;
            row.set_item("drawn_symbol", labels.drawn_symbol)?;
            row.set_item("is_meshed", labels.is_meshed)?;
            row.set_item("is_log", axis.spacing == Spacing::Logarithmic)?;
            row.set_item("levels", levels.collect::<Vec<_>>())?;
            Ok(row)
        })
        .collect()
    }

    /// Warnings about the cases of the points, each with the number of points and the first of them.
    #[getter]
    fn warnings(&self) -> Vec<(String, usize, String)> {
        let plan = &self.plan;
        let warnings = plan.warnings().iter().map(|warning| {
            let first = plan.describe(&plan.points[warning.first]);
            (warning.sentence.clone(), warning.points, first)
        });
        warnings.collect()
    }

    /// Whether the tables have a column of this name.
    fn has_column(&self, name: &str) -> bool {
        let mut axes = self.plan.axes.iter().flat_map(|axis| &axis.columns);
        study::is_column(name) || axes.any(|column| column == name)
    }

    /// The case of a run.
    fn case(&self, py: Python<'_>, point: usize, replicate: usize, reference: bool) -> PyResult<Case> {
        let role = if reference { Role::Reference } else { Role::Point };
        let run = RunKey {
            point,
            replicate,
            role,
        };
        make(py, |watch| self.plan.case(run, watch))
    }

    /// Statistics of a quantity at a point, under the names of `points.csv`.
    fn statistics(&self, values: Vec<f64>) -> Vec<(&'static str, f64)> {
        let sample = Sample::from_values(&values, self.plan.settings.confidence());
        let found = sample.map(|sample| {
            let [low, high] = sample.interval().unwrap_or([f64::NAN; 2]);
            vec![
                ("mean", sample.mean),
                ("deviation", sample.deviation.unwrap_or(f64::NAN)),
                ("low", low),
                ("high", high),
                ("min", sample.min),
                ("max", sample.max),
            ]
        });
        [vec![("n", values.len() as f64)], found.unwrap_or_default()].concat()
    }

    /// Makes the runs that the folder lacks, and writes tables, pictures and the comparison of meshes there.
    /// `folder` also says whether edited files there are replaced. `look` is called with the case, the record
    /// and the place of every run that ends, and returns the values of the user's own quantities. `watch` is
    /// called with the numbers of finished runs, of all, and of failed ones. Returns the values by run, the
    /// reasons of the runs that failed, and why no run has a value of the main quantity, if none has.
    fn execute(
        &self,
        py: Python<'_>,
        folder: (PathBuf, bool),
        threads: usize,
        look: Option<Py<PyAny>>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<Executed> {
        let (folder, force) = folder;
        let opened = detached_study(py, || {
            self.plan.check_memory(threads)?;
            let opened = StudyFolder::open(&folder, &self.file, None, force)?;
            opened.check_disk(&self.plan)?;
            Ok(opened)
        })?;
        let plan = self.plan.clone().reading_copies(&opened.study);
        let (own, raised) = (Mutex::new(OwnValues::new()), Mutex::new(None));
        let numbers = |now: &Progress| (now.done, now.total, now.failed);
        // One more thread of the pool waits for the others.
        let results = on_pool(py, "study", threads + 1, watch.as_ref(), numbers, |stop, show| {
            let look_at_run = |run: RunKey, case: &Arc<SlipfrontCase>, record: &running::RunData| {
                let Some(look) = &look else { return true };
                match own_values(look, self.key(run), case, record) {
                    Ok(values) => {
                        locked(&own).insert(self.key(run), values);
                        true
                    }
                    Err(error) => {
                        locked(&raised).get_or_insert(error);
                        stop.store(true, Ordering::Relaxed);
                        false
                    }
                }
            };
            study::execute_and_look(&plan, &opened.records, opened.path(), stop, &look_at_run, show)
        });
        if let Some(error) = locked(&raised).take() {
            return Err(error);
        }
        let results = results?;
        let never = AtomicBool::new(false);
        detached_study(py, || self.write(&plan, &results, &opened, &never))?;
        let describe = |(run, reason): (RunKey, &str)| {
            let place = plan.describe(&plan.points[run.point]);
            (format!("{place}, replicate {}", run.replicate), reason.to_owned())
        };
        let failures: Vec<_> = results.failures().map(describe).collect();
        let why = results.expect_values(&plan).err().filter(|_| failures.is_empty());
        let why = why.map(|error| error.to_string());
        Ok((std::mem::take(&mut *locked(&own)), failures, why))
    }
}

/// A time as the command takes it, such as "30min".
fn parse_time(text: &str) -> PyResult<SignedDuration> {
    text.parse().map_err(|error| {
        PyValueError::new_err(format!(
            "`max_time` = {text:?} is not a time: give one such as \"30min\" or \"2h\" ({error})"
        ))
    })
}

/// Values of the user's own quantities of a run.
fn own_values(
    look: &Py<PyAny>,
    key: (usize, usize, bool),
    case: &Arc<SlipfrontCase>,
    record: &running::RunData,
) -> PyResult<Vec<f64>> {
    let record = RunData {
        case: Arc::clone(case),
        record: record.clone(),
        started: clock::now(),
        processors: Processors::threads(1),
    };
    Python::attach(|py| {
        let values = look.call1(py, (Case(Arc::clone(case)), record, key))?;
        values.extract::<Vec<f64>>(py)
    })
}
