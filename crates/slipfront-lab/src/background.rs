//! Jobs outside a session, each in its own thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;
use std::time::{Duration, Instant};

use slipfront_session::{Event, Job, Task, Worker};

/// A job in its own thread. Dropping the task asks the job to stop.
pub(crate) struct BackgroundTask {
    stop: Arc<AtomicBool>,
    /// Events that the job sends; the channel closes when the job has ended.
    events: Receiver<Event>,
    is_lost: bool,
}

impl BackgroundTask {
    /// Begins a job in a thread that holds `working`, if there is one, with a pool of `threads` threads.
    ///
    /// # Errors
    /// A sentence, if the system refuses threads.
    pub(crate) fn begin(job: Job, threads: usize, working: Option<Sender<()>>) -> Result<Self, String> {
        // The job has its own thread pool: in the global pool, steps of the run on the page would wait until
        // whole runs of the job have ended.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| format!("the system refuses threads for the work: {error}"))?;
        let stop = Arc::new(AtomicBool::new(false));
        let (tells, events) = channel();
        let worker = ThreadWorker {
            tells,
            stop: Arc::clone(&stop),
            began: Instant::now(),
        };
        let begun = thread::Builder::new().spawn(move || {
            pool.install(|| job.run(&worker));
            drop((pool, working));
        });
        begun.map_err(|error| format!("the system refuses a thread for the work: {error}"))?;
        Ok(Self {
            stop,
            events,
            is_lost: false,
        })
    }
}

impl Task for BackgroundTask {
    fn next_event(&mut self) -> Option<Event> {
        match self.events.try_recv() {
            Ok(event) => Some(event),
            Err(TryRecvError::Empty) => None,
            // After the last event of a completed job, the session does not ask again.
            Err(TryRecvError::Disconnected) if self.is_lost => None,
            Err(TryRecvError::Disconnected) => {
                self.is_lost = true;
                Some(Event::lost())
            }
        }
    }
}

impl Drop for BackgroundTask {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// The thread of a job.
struct ThreadWorker {
    tells: Sender<Event>,
    stop: Arc<AtomicBool>,
    began: Instant,
}

impl Worker for ThreadWorker {
    fn send(&self, event: Event) {
        // After the end of the session nobody receives events.
        let _ = self.tells.send(event);
    }

    fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    fn now(&self) -> Duration {
        self.began.elapsed()
    }
}
