//! Signals, as flags that are looked at now and then.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};

/// Whether SIGINT, SIGTERM, SIGHUP or SIGUSR1 came.
#[derive(Clone, Debug)]
pub(crate) struct Signals {
    /// Set when one came.
    pub(crate) stop: Arc<AtomicBool>,
    which: Arc<AtomicUsize>,
    usr1: Arc<AtomicBool>,
}

impl Signals {
    /// Keeps SIGINT, SIGTERM and, where a terminal that closes sends it, SIGHUP from ending the process. A second one ends it
    /// at once.
    pub(crate) fn catch() -> std::io::Result<Self> {
        let (stop, which) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
        for signal in [SIGINT, SIGTERM].into_iter().chain(hangup()) {
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

/// SIGHUP, unless it is ignored, as under `nohup`; of systems that do not tell it is left alone.
fn hangup() -> Option<i32> {
    const SIGHUP: i32 = 1;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
    let ignored = u64::from_str_radix(ignored.trim(), 16).ok()?;
    (ignored & (1 << (SIGHUP - 1)) == 0).then_some(SIGHUP)
}
