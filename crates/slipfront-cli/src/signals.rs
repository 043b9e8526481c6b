//! Signals, as flags that are looked at now and then.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};

/// Whether a signal came that stops the program, or SIGUSR1.
#[derive(Clone, Debug)]
pub(crate) struct Signals {
    /// Set when one came that stops.
    pub(crate) stop: Arc<AtomicBool>,
    which: Arc<AtomicUsize>,
    usr1: Arc<AtomicBool>,
}

impl Signals {
    /// Keeps what queues, users and terminals send from ending the process: SIGINT, SIGTERM, SIGHUP, SIGUSR2 and SIGXCPU stop
    /// it when it looks, and a second one at once; SIGUSR1 does not. Systems without some of them never see those.
    pub(crate) fn catch() -> std::io::Result<Self> {
        let (stop, which) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
        let signals = Self {
            stop,
            which,
            usr1: Arc::default(),
        };
        for signal in [SIGINT, SIGTERM].into_iter().chain(hangup()) {
            signal_hook::flag::register_conditional_shutdown(
                signal,
                128 + signal,
                Arc::clone(&signals.stop),
            )?;
            signals.stop_on(signal)?;
        }
        #[cfg(unix)]
        {
            use signal_hook::consts::{SIGUSR1, SIGUSR2, SIGXCPU};
            signal_hook::flag::register(SIGUSR1, Arc::clone(&signals.usr1))?;
            // Warnings of queues. SIGXCPU comes again every second, while what has been computed is still being saved.
            signals.stop_on(SIGUSR2)?;
            signals.stop_on(SIGXCPU)?;
        }
        Ok(signals)
    }

    fn stop_on(&self, signal: i32) -> std::io::Result<()> {
        signal_hook::flag::register_usize(signal, Arc::clone(&self.which), signal as usize)?;
        signal_hook::flag::register(signal, Arc::clone(&self.stop))?;
        Ok(())
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

/// Makes a write that a limit of the size of files forbids fail with a reason, where the signal of it would end the process
/// without a word.
pub(crate) fn let_writes_fail() -> std::io::Result<()> {
    #[cfg(unix)]
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    Ok(())
}

/// SIGHUP, unless it is ignored, as under `nohup`; of systems that do not tell it is left alone.
fn hangup() -> Option<i32> {
    const SIGHUP: i32 = 1;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
    let ignored = u64::from_str_radix(ignored.trim(), 16).ok()?;
    (ignored & (1 << (SIGHUP - 1)) == 0).then_some(SIGHUP)
}
