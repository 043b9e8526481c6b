//! Signals, as flags that are checked regularly.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};

/// Signals that have arrived.
#[derive(Clone, Debug)]
pub(crate) struct Signals {
    /// Flag set when a signal that stops the program has arrived.
    pub(crate) stop: Arc<AtomicBool>,
    /// Signals that stop the program, and whether each has arrived; the first one in this list gives the
    /// status.
    stops: Vec<(i32, Arc<AtomicBool>)>,
    usr1: Arc<AtomicBool>,
}

impl Signals {
    /// Catches the signals of queues, users and terminals. SIGINT, SIGTERM, SIGHUP, SIGUSR2 and SIGXCPU stop
    /// the process at its next check; a second one of the first three stops it at once. SIGUSR1 does not stop
    /// it. Systems without some of these signals never receive them.
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
            // Queues send these as warnings, with time to save; SIGXCPU is repeated every second in that
            // time.
            signals.stop_on(SIGUSR2)?;
            signals.stop_on(SIGXCPU)?;
        }
        Ok(signals)
    }

    fn stop_on(&mut self, signal: i32) -> std::io::Result<()> {
        let came = Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(signal, Arc::clone(&came))?;
        // Registered second, so that whoever sees the flag `stop` also sees its cause.
        signal_hook::flag::register(signal, Arc::clone(&self.stop))?;
        self.stops.push((signal, came));
        Ok(())
    }

    /// Whether SIGUSR1 has arrived since the last call.
    pub(crate) fn take_usr1(&self) -> bool {
        self.usr1.swap(false, Ordering::SeqCst)
    }

    /// The signal that stops the program, if one has arrived.
    pub(crate) fn stopped(&self) -> Option<i32> {
        let mut stops = self.stops.iter();
        stops
            .find(|(_, came)| came.load(Ordering::SeqCst))
            .map(|(signal, _)| *signal)
    }
}

/// Makes a write beyond the file-size limit fail with an error; otherwise the signal would end the process
/// without a message.
pub(crate) fn ignore_sigxfsz() -> std::io::Result<()> {
    #[cfg(unix)]
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    Ok(())
}

/// Number of SIGHUP; none if the signal is ignored, as under `nohup`, or the system does not say.
#[cfg(unix)]
fn hangup() -> Option<i32> {
    const SIGHUP: i32 = 1;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
    let ignored = u64::from_str_radix(ignored.trim(), 16).ok()?;
    (ignored & (1 << (SIGHUP - 1)) == 0).then_some(SIGHUP)
}

/// None, because the system has no SIGHUP.
#[cfg(not(unix))]
fn hangup() -> Option<i32> {
    None
}
