//! Signals, as flags that are looked at now and then.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};

/// Whether SIGINT, SIGTERM or SIGUSR1 came.
#[derive(Clone, Debug)]
pub(crate) struct Signals {
    /// Set when one came.
    pub(crate) stop: Arc<AtomicBool>,
    which: Arc<AtomicUsize>,
    usr1: Arc<AtomicBool>,
}

impl Signals {
    /// Keeps SIGINT and SIGTERM from ending the process. A second one ends it at once.
    pub(crate) fn catch() -> std::io::Result<Self> {
        let (stop, which) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
        for signal in [SIGINT, SIGTERM] {
            signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&stop))?;
            signal_hook::flag::register_usize(signal, Arc::clone(&which), signal as usize)?;
            signal_hook::flag::register(signal, Arc::clone(&stop))?;
        }
        let usr1 = Arc::new(AtomicBool::new(false));
        Ok(Self { stop, which, usr1 })
    }

    /// The same, and SIGUSR1; systems without that signal never see it.
    pub(crate) fn catch_all() -> std::io::Result<Self> {
        let signals = Self::catch()?;
        #[cfg(unix)]
        signal_hook::flag::register(signal_hook::consts::SIGUSR1, Arc::clone(&signals.usr1))?;
        Ok(signals)
    }

    /// Whether SIGUSR1 came since this was asked last.
    pub(crate) fn take_usr1(&self) -> bool {
        self.usr1.swap(false, Ordering::SeqCst)
    }

    /// The signal that came, if one did.
    pub(crate) fn stopped(&self) -> Option<usize> {
        self.stop
            .load(Ordering::SeqCst)
            .then(|| self.which.load(Ordering::SeqCst))
    }
}
