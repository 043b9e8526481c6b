//! The process whose threads the engine uses.
//!
//! A forked child lacks the pool of threads, and locks that other threads held stay locked: a child that used
//! them would wait forever. All uses of them go through this file, which refuses them in such a child.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use pyo3::call::PyCallArgs;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use slipfront_study::StudyError;

use crate::errors::{ForkError, folder_error, study_error};

/// Time that the engine works between two checks for signals.
pub(crate) const LOOK_EVERY: Duration = Duration::from_millis(50);

/// The process that first used the engine; children that it forks afterwards inherit it. 0 before the first
/// use.
static FIRST: AtomicU32 = AtomicU32::new(0);

/// Refuses to continue in a process that was forked from one in which the engine had been used.
#[pyfunction]
pub(crate) fn check_process() -> PyResult<()> {
    let here = std::process::id();
    match FIRST.compare_exchange(0, here, Ordering::Relaxed, Ordering::Relaxed) {
        Err(first) if first != here => Err(ForkError::new_err(format!(
            "process {here} was forked from one, {first}, in which slipfront had made a case or a run: the threads of the engine did not \
             come along, and a run here would wait for them for ever. Start processes by \"spawn\", as in \
             `multiprocessing.get_context(\"spawn\").Pool()`, or use slipfront for the first time after the fork"
        ))),
        _ => Ok(()),
    }
}

/// Does the work of the engine while other Python threads continue.
#[allow(
    clippy::disallowed_methods,
    reason = "this is the place that the others go through"
)]
pub(crate) fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    check_process()?;
    Ok(py.detach(work))
}

/// Does some work on a study, a design or a calibration while other Python threads continue.
pub(crate) fn detached_study<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, StudyError> + Send,
) -> PyResult<T> {
    detached(py, work)?.map_err(|error| study_error(py, &error))
}

/// Does `work` on another thread, and checks for signals on this one, which receives them; none if the work
/// panicked.
fn watched<T: Send>(work: impl FnOnce() -> T + Send, mut look: impl FnMut()) -> Option<T> {
    std::thread::scope(|scope| {
        let (done, result) = mpsc::channel();
        let worker = scope.spawn(move || done.send(work()).is_ok());
        loop {
            match result.recv_timeout(LOOK_EVERY) {
                Ok(found) => return Some(found),
                Err(RecvTimeoutError::Timeout) => look(),
                Err(RecvTimeoutError::Disconnected) => return worker.join().err().and(None),
            }
        }
    })
}

/// Does `work`, which has a name in errors, on a pool of threads. This thread checks for signals, and calls
/// `watch` with the numbers of the latest progress that the work has reported. An exception ends the work.
pub(crate) fn on_pool<T, P, N>(
    py: Python<'_>,
    name: &str,
    threads: usize,
    watch: Option<&Py<PyAny>>,
    numbers: fn(&P) -> N,
    work: impl FnOnce(&AtomicBool, &mut dyn FnMut(&P)) -> Result<T, StudyError> + Send,
) -> PyResult<T>
where
    T: Send,
    P: Clone + Send,
    N: for<'py> PyCallArgs<'py>,
{
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(folder_error)?;
    let stop = AtomicBool::new(false);
    let progress: Mutex<Option<P>> = Mutex::new(None);
    let report = &mut |now: &P| *locked(&progress) = Some(now.clone());
    let mut raised = None;
    let mut look = || {
        let now = locked(&progress).take();
        let shown = Python::attach(|py| {
            py.check_signals()?;
            match (watch, now) {
                (Some(watch), Some(now)) => watch.call1(py, numbers(&now)).map(drop),
                _ => Ok(()),
            }
        });
        if let Err(error) = shown {
            raised.get_or_insert(error);
            stop.store(true, Ordering::Relaxed);
        }
    };
    let ended = detached(py, || {
        let ended = watched(|| pool.install(|| work(&stop, report)), &mut look);
        look();
        ended
    })?;
    if let Some(error) = raised {
        return Err(error);
    }
    let fault = || PyRuntimeError::new_err(format!("a fault of the program ended the {name}"));
    ended.ok_or_else(fault)?.map_err(|error| study_error(py, &error))
}

/// Locks a mutex, also after a panic of another thread.
pub(crate) fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
