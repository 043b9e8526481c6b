//! The time, which is monotonic even if the clock of the machine is changed.

use std::sync::LazyLock;
use std::time::Instant;

use jiff::Timestamp;

/// Times of the first call in this process, by the clock and by a monotonic clock.
static FIRST: LazyLock<(Timestamp, Instant)> = LazyLock::new(|| (Timestamp::now(), Instant::now()));

/// The present time, which is monotonic within this process.
pub fn now() -> Timestamp {
    let (time, instant) = *FIRST;
    time + instant.elapsed()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_goes_on_and_is_that_of_the_clock() {
        let (before, clock) = (now(), Timestamp::now());
        let after = now();
        assert!(before <= after);
        // A test takes less than a minute, and no clock is set meanwhile.
        assert!(clock.duration_since(before).as_secs().abs() < 60);
    }
}
