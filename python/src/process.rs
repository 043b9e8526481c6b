//! The process whose threads the engine uses.
//!
//! A forked child lacks the pool of threads, and locks that other threads held stay locked: a child that used
//! them would wait forever. All uses of them go through this file, which refuses them in such a child.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

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

/// Does `work` on another thread, and checks for signals on this one, which receives them; none if the work
/// panicked.
pub(crate) fn watched<T: Send>(work: impl FnOnce() -> T + Send, mut look: impl FnMut()) -> Option<T> {
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

/// Does `work` on a pool of threads; this thread checks for signals and shows progress. An exception of
/// either ends the work.
pub(crate) fn on_pool<T: Send>(
    py: Python<'_>,
    threads: usize,
    work: impl FnOnce(&AtomicBool) -> Result<T, StudyError> + Send,
    show: &mut (dyn FnMut(Python<'_>) -> PyResult<()> + Send),
) -> PyResult<T> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(folder_error)?;
    let stop = AtomicBool::new(false);
    let mut raised = None;
    let mut look = || {
        let shown = Python::attach(|py| py.check_signals().and_then(|()| show(py)));
        if let Err(error) = shown {
            raised.get_or_insert(error);
            stop.store(true, Ordering::Relaxed);
        }
    };
    let ended = detached(py, || {
        let ended = watched(|| pool.install(|| work(&stop)), &mut look);
        look();
        ended
    })?;
    if let Some(error) = raised {
        return Err(error);
    }
    let ended = ended.ok_or_else(|| PyRuntimeError::new_err("a fault of the program ended the work"))?;
    ended.map_err(|error| study_error(py, &error))
}
