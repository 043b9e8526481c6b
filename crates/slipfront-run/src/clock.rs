//! The time, which goes on whatever is done to the clock of the machine meanwhile.

use std::sync::LazyLock;
use std::time::Instant;

use jiff::Timestamp;

/// When this was asked first in this process: by the clock, and by what only goes on.
static FIRST: LazyLock<(Timestamp, Instant)> = LazyLock::new(|| (Timestamp::now(), Instant::now()));

/// The time, which only goes on in this process.
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
