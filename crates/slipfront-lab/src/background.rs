//! Work beside the session, in a thread of its own.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::thread;

/// Work in a thread of its own, which is asked to stop when this is dropped.
pub(crate) struct BackgroundTask(Arc<AtomicBool>);

impl BackgroundTask {
    /// Begins work in a thread, which holds `working` and looks now and then whether it shall stop.
    pub(crate) fn spawn(
        working: &Sender<()>,
        work: impl FnOnce(&AtomicBool) + Send + 'static,
    ) -> std::io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let (stops, working) = (Arc::clone(&stop), working.clone());
        thread::Builder::new().spawn(move || {
            work(&stops);
            drop(working);
        })?;
        Ok(Self(stop))
    }
}

impl Drop for BackgroundTask {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}
