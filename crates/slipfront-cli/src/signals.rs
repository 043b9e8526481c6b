//! Signals, as flags that are looked at now and then.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};

/// Which signals came.
#[derive(Clone, Debug)]
pub(crate) struct Signals {
    /// Set when one came that stops the program.
    pub(crate) stop: Arc<AtomicBool>,
    /// Those that do, and whether each came; the first of them that did gives the status.
    stops: Vec<(i32, Arc<AtomicBool>)>,
    usr1: Arc<AtomicBool>,
}

impl Signals {
    /// Keeps what queues, users and terminals send from ending the process: SIGINT, SIGTERM, SIGHUP, SIGUSR2 and SIGXCPU stop
    /// it when it looks, a second one of the first three at once; SIGUSR1 does not stop it. Systems without some of them
    /// never see those.
    pub(crate) fn catch() -> std::io::Result<Self> {
        let mut signals = Self {
            stop: Arc::default(),
            stops: Vec::new(),
            usr1: Arc::default(),
        };
        let asked = Arc::new(AtomicBool::new(false));
        for signal in [SIGTERM, SIGINT].into_iter().chain(hangup()) {
            signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&asked))?;
            signal_hook::flag::register(signal, Arc::clone(&asked))?;
            signals.stop_on(signal)?;
        }
        #[cfg(unix)]
        {
            use signal_hook::consts::{SIGUSR1, SIGUSR2, SIGXCPU};
            signal_hook::flag::register(SIGUSR1, Arc::clone(&signals.usr1))?;
            // Warnings of queues, which leave time to save: SIGXCPU comes again every second meanwhile.
            signals.stop_on(SIGUSR2)?;
            signals.stop_on(SIGXCPU)?;
        }
        Ok(signals)
    }

    fn stop_on(&mut self, signal: i32) -> std::io::Result<()> {
        let came = Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(signal, Arc::clone(&came))?;
        // Whoever sees that it is to stop can see why.
        signal_hook::flag::register(signal, Arc::clone(&self.stop))?;
        self.stops.push((signal, came));
        Ok(())
    }

    /// Whether SIGUSR1 came since this was asked last.
    pub(crate) fn take_usr1(&self) -> bool {
        self.usr1.swap(false, Ordering::SeqCst)
    }

    /// The signal that came, if one did.
    pub(crate) fn stopped(&self) -> Option<i32> {
        let mut stops = self.stops.iter();
        stops
            .find(|(_, came)| came.load(Ordering::SeqCst))
            .map(|(signal, _)| *signal)
    }
}

/// Makes a write that a limit of the size of files forbids fail with a reason, where the signal of it would end the process
/// without a word.
pub(crate) fn ignore_sigxfsz() -> std::io::Result<()> {
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
