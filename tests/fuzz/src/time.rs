//! Measures processor time.

use std::time::Duration;

/// Processor time of all threads of this process up to now, to a hundredth of a second; none where the system
/// does not tell it.
fn of_process() -> Option<Duration> {
    /// Length of a tick of every Linux.
    const TICK: Duration = Duration::from_millis(10);
    /// Places of the time of the process and of the system for it, behind the name of the program, which may
    /// contain blanks.
    const TIMES: std::ops::Range<usize> = 11..13;
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let (_, fields) = stat.rsplit_once(')')?;
    let times = fields.split_ascii_whitespace().take(TIMES.end).skip(TIMES.start);
    let ticks: u32 = times.map(str::parse::<u32>).sum::<Result<_, _>>().ok()?;
    Some(ticks * TICK)
}

/// Runs `work`, and gives the processor time that it has taken, nothing where the system does not tell it.
/// Time and not a clock: a machine that does other things beside takes no more of it.
pub(crate) fn time_of(work: impl FnOnce()) -> Duration {
    let before = of_process();
    work();
    let taken = of_process().zip(before).map(|(after, before)| after - before);
    taken.unwrap_or_default()
}
