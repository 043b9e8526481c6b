//! The time, and how long something took, whatever is done to the clock of the machine meanwhile.

use std::sync::LazyLock;
use std::time::{Duration, Instant};

use jiff::Timestamp;

/// When this was asked first in this process: by the clock, and by what only goes on.
static FIRST: LazyLock<(Timestamp, Instant)> = LazyLock::new(|| (Timestamp::now(), Instant::now()));

/// The time, which only goes on in this process.
pub fn now() -> Timestamp {
    let (time, instant) = *FIRST;
    time + instant.elapsed()
}

/// What has passed since `started`; nothing if the clock was set back since another process said so.
pub fn since(started: Timestamp) -> Duration {
    now().duration_since(started).try_into().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_takes_less_than_no_time() {
        let started = now();
        assert!(since(started) >= since(now()));
        // A run that was begun an hour ahead of this clock.
        let hour = Duration::from_secs(3600);
        assert_eq!(since(started + hour), Duration::ZERO);
        assert!(since(started - hour) >= hour);
    }
}
