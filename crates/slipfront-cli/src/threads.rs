//! The thread pool of this process.

use std::hint::black_box;
use std::io::ErrorKind;
use std::sync::mpsc::channel;
use std::sync::{Arc, Mutex};
use std::thread::{Builder, available_parallelism};

use rayon::{ThreadBuilder, ThreadPoolBuilder};
use slipfront_base::machine::threads_that_fit;

use crate::failure::Failure;
use crate::print_stderr::print_stderr;

/// Parses a number of threads or tasks on the command line.
pub(crate) fn count_from_one(text: &str) -> Result<u16, String> {
    let count = text.parse().ok().filter(|&count| count > 0);
    count.ok_or_else(|| "it must be a whole number from 1 to 65535".to_owned())
}

/// Starts the thread pool of this process and returns the number of its threads: one per core by default, and
/// never more. If the system refuses some threads, there are fewer, but at least the present one. If there
/// are several, the present thread belongs to the pool, so that it need not wake the others at every step of
/// a run, nor wait for them.
pub(crate) fn set_threads(threads: Option<u16>) -> Result<usize, Failure> {
    let working = start_pool(threads, 0, true)?;
    Ok(working.max(1))
}

/// Starts the pool, as [`set_threads`] does, for a command that runs cases on the pool while the present
/// thread waits for them. Every thread of the pool starts `others` further threads.
pub(crate) fn set_worker_threads(threads: Option<u16>, others: usize) -> Result<usize, Failure> {
    match start_pool(threads, others, false)? {
        0 => Err(Failure::running(
            "the system refuses to start threads for the runs: raise the limit on processes (`ulimit -u`) or on addresses \
             (`ulimit -v`)",
        )),
        started => Ok(started),
    }
}

/// Starts the pool and returns the number of its threads, each with room for `others`; 0 if the present
/// thread does all the work. With `joins`, the present thread is one of several.
fn start_pool(threads: Option<u16>, others: usize, joins: bool) -> Result<usize, Failure> {
    let cores = available_parallelism().map_or(1, usize::from);
    let asked = threads.map_or(cores, usize::from);
    let wanted = threads_that_fit(asked.min(cores), others);
    let mut why = if wanted < asked.min(cores) {
        "the limit on addresses (`ulimit -v`) has no room for more".to_owned()
    } else {
        "this machine offers no more".to_owned()
    };
    // The threads start before the pool, because the pool could not be built if one of its threads were
    // refused.
    let (hand_over, works) = channel::<ThreadBuilder>();
    let works = Arc::new(Mutex::new(works));
    let (settled, has_settled) = channel();
    let joins = joins && wanted > 1;
    let (mut started, to_start) = (0, wanted - usize::from(joins));
    while started < to_start {
        let (works, settled) = (Arc::clone(&works), settled.clone());
        let wait_and_work = move || {
            // The first allocation gives a thread its arena, which counts for limits on address space.
            drop(black_box(Box::new(0_u8)));
            let _ = settled.send(());
            let work = works.lock().ok().and_then(|works| works.recv().ok());
            if let Some(work) = work {
                work.run();
            }
        };
        if let Err(error) = Builder::new().spawn(wait_and_work) {
            why = format!("the system refuses more: {error}");
            break;
        }
        let _ = has_settled.recv();
        started += 1;
    }
    let joins = joins && started > 0;
    let working = started + usize::from(joins);
    if working < asked {
        print_stderr(&format!(
            "note: {} of {asked} threads are used, because {why}",
            working.max(1)
        ));
    }
    let mut pool = ThreadPoolBuilder::new().num_threads(working.max(1));
    if joins || started == 0 {
        pool = pool.use_current_thread();
    }
    pool.spawn_handler(|thread| hand_over.send(thread).map_err(|_| ErrorKind::BrokenPipe.into()))
        .build_global()
        .map_err(Failure::running)?;
    Ok(working)
}
