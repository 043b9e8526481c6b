//! Studies.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use slipfront_run::clock;
use slipfront_run::study::{self, Plan, Progress, Role, RunKey, StudyError, StudyFile, StudyFolder};

use crate::case::{Case, LOOK_EVERY, make};
use crate::errors::{folder_error, study_error};
use crate::record::Record;

/// A study whose every point is a valid case.
#[pyclass(frozen, module = "slipfront._slipfront")]
pub(crate) struct Study {
    file: StudyFile,
    plan: Plan,
}

/// Values of the user's own quantities: of a run, the number of its point in the whole study, its replicate, and whether it is the
/// reference, in the order of their names.
type OwnValues = BTreeMap<(usize, usize, bool), Vec<f64>>;

impl Study {
    fn of(py: Python<'_>, read: impl FnOnce() -> Result<StudyFile, StudyError> + Send) -> PyResult<Self> {
        let planned = py.detach(|| {
            let file = read()?;
            let plan = Plan::new(&file, None)?;
            Ok(Self { file, plan })
        });
        planned.map_err(|error| study_error(py, &error))
    }

    fn key(&self, run: RunKey) -> (usize, usize, bool) {
        let index = self.plan.points[run.point].index;
        (index, run.replicate, run.role == Role::Reference)
    }
}

#[pymethods]
impl Study {
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Self::of(py, || StudyFile::load(&path))
    }

    /// The study of a text that is called `name`; the files it names stand relative to a folder.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, name: &str, folder: PathBuf) -> PyResult<Self> {
        Self::of(py, || StudyFile::parse(text, name, name, &folder))
    }

    /// The study in a folder of results.
    #[staticmethod]
    fn of_folder(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        Self::of(py, || study::study_of(&folder))
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

    /// Replicates of a point, at least and at most.
    #[getter]
    fn replicates(&self) -> (usize, usize) {
        let settings = &self.plan.settings;
        (settings.min_replicates(), settings.max_replicates())
    }

    /// The keys of the axes, each with its number of levels.
    #[getter]
    fn axes(&self) -> Vec<(Vec<String>, usize)> {
        let axes = self.plan.axes.iter();
        axes.map(|axis| (axis.columns.clone(), axis.levels.len()))
            .collect()
    }

    /// The case of a run.
    fn case(&self, py: Python<'_>, point: usize, replicate: usize, reference: bool) -> PyResult<Case> {
        let role = match reference {
            true => Role::Reference,
            false => Role::Point,
        };
        let run = RunKey {
            point,
            replicate,
            role,
        };
        make(py, |watch| self.plan.case(run, watch))
    }

    /// Runs what the folder lacks, and writes tables and pictures there. `look` is called with the case, the record and the place of
    /// every run that ends, and gives the values of the user's own quantities; `watch` with the numbers of runs that are done, of all,
    /// and of failed ones. Gives the values by run, and the reasons of the runs that failed.
    fn execute(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        threads: usize,
        look: Option<Py<PyAny>>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<(OwnValues, Vec<(String, String)>)> {
        let failed = |error: StudyError| Python::attach(|py| study_error(py, &error));
        let opened = py.detach(|| {
            self.plan.check_memory(threads)?;
            let opened = StudyFolder::open(&folder, &self.file)?;
            opened.check_disk(&self.plan)?;
            Ok(opened)
        });
        let opened = opened.map_err(failed)?;
        let plan = self.plan.clone().reading_copies(&opened.study);
        let stop = AtomicBool::new(false);
        let (own, raised) = (Mutex::new(OwnValues::new()), Mutex::new(None::<PyErr>));
        let raise = |error: PyErr| {
            let mut first = raised.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert(error);
            stop.store(true, Ordering::Relaxed);
        };
        let look_at_run =
            |run: RunKey, case: &Arc<slipfront_case::case::Case>, record: &slipfront_run::running::Record| {
                let Some(look) = &look else { return true };
                let key = self.key(run);
                let record = Record {
                    case: Arc::clone(case),
                    record: record.clone(),
                    started: clock::now(),
                    threads: 1,
                };
                let values = Python::attach(|py| {
                    let values = look.call1(py, (Case(Arc::clone(case)), record, key))?;
                    values.extract::<Vec<f64>>(py)
                });
                match values {
                    Ok(values) => {
                        own.lock()
                            .unwrap_or_else(PoisonError::into_inner)
                            .insert(key, values);
                        true
                    }
                    Err(error) => {
                        raise(error);
                        false
                    }
                }
            };
        let progress = Mutex::new(None::<Progress>);
        let ended = AtomicBool::new(false);
        let results = py.detach(|| {
            std::thread::scope(|scope| {
                let worker = scope.spawn(|| {
                    // One more thread of the pool waits for the others.
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads + 1).build();
                    let done = pool.map(|pool| {
                        pool.install(|| {
                            let watch = &mut |now: &Progress| {
                                *progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(now.clone());
                            };
                            study::execute_and_look(
                                &plan,
                                &opened.records,
                                opened.path(),
                                &stop,
                                &look_at_run,
                                watch,
                            )
                        })
                    });
                    ended.store(true, Ordering::Relaxed);
                    done
                });
                // Signals come to the thread that called, and so does what is shown.
                while !ended.load(Ordering::Relaxed) && !worker.is_finished() {
                    std::thread::park_timeout(LOOK_EVERY);
                    let now = progress.lock().unwrap_or_else(PoisonError::into_inner).take();
                    let looked = Python::attach(|py| {
                        py.check_signals()?;
                        if let (Some(watch), Some(now)) = (&watch, now) {
                            watch.call1(py, (now.done, now.total, now.failed))?;
                        }
                        Ok(())
                    });
                    if let Err(error) = looked {
                        raise(error);
                    }
                }
                worker.join()
            })
        });
        if let Some(error) = raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(error);
        }
        let results = match results {
            Ok(Ok(results)) => results.map_err(failed)?,
            Ok(Err(error)) => return Err(folder_error(error)),
            Err(_) => return Err(PyRuntimeError::new_err("a fault of the program ended the study")),
        };
        py.detach(|| study::write(&plan, &results, &opened))
            .map_err(failed)?;
        let describe = |(run, reason): (RunKey, &str)| {
            let place = plan.describe(&plan.points[run.point]);
            (format!("{place}, replicate {}", run.replicate), reason.to_owned())
        };
        let failures = results.failures().map(describe).collect();
        Ok((own.into_inner().unwrap_or_else(PoisonError::into_inner), failures))
    }
}
