//! Functions that the Worker gives the session: its clock, the date, and the module that draws pictures.

use std::time::Duration;

use crate::given;

#[expect(unsafe_code, reason = "Rust cannot look at functions of the Worker")]
// SAFETY: the Worker gives them with these types (`lab_worker.js`), and reads no more than the bytes that it
// is shown.
unsafe extern "C" {
    safe fn now() -> f64;
    safe fn date();
    safe fn draw(at: *const u8, length: usize);
}

/// The time of day, UTC as in RFC 3339.
pub(crate) fn time_of_day() -> String {
    date();
    String::from_utf8(given::take()).unwrap_or_default()
}

/// Answer of the module that draws pictures to these bytes; empty where there is no such module, or it has
/// failed.
pub(crate) fn drawn_of(asked: &[u8]) -> Vec<u8> {
    draw(asked.as_ptr(), asked.len());
    given::take()
}

/// The time by the clock of the Worker.
pub(crate) fn clock() -> Duration {
    duration(now())
}

/// A time of the Worker, ms.
pub(crate) fn duration(milliseconds: f64) -> Duration {
    Duration::try_from_secs_f64(milliseconds / 1000.0).unwrap_or_default()
}
