//! Functions that the Worker gives the module: messages to it, and its clock.

use std::time::Duration;

/// Kinds of messages from the module to the Worker.
#[derive(Clone, Copy)]
#[repr(u32)]
pub(crate) enum Saying {
    /// A reply of the session.
    Reply,
    /// A picture of the field.
    Picture,
    /// A kymograph.
    Kymograph,
    /// Work that is to be begun, with its number.
    Work,
    /// The number of work that is to be ended.
    End,
    /// An event of work beside a session, as JSON.
    Event,
    /// A run that is to be saved.
    Save,
    /// The name of a run that is no longer to be saved.
    StopSaving,
    /// The share of a run that is done, in millionths.
    Share,
    /// The archive of a run.
    Archive,
    /// Bits of a run.
    Bits,
    /// A sentence that says why a call was refused.
    Refusal,
    /// A defect, as the terminal of a program would show it.
    Defect,
}

#[expect(unsafe_code, reason = "Rust cannot look at functions of the Worker")]
// SAFETY: the Worker gives them with these types (`lab_worker.js`), and reads no more than the bytes that it is shown.
unsafe extern "C" {
    safe fn say(what: u32, number: u32, at: *const u8, length: usize);
    safe fn now() -> f64;
    safe fn date();
}

/// Says something to the Worker, with a number where it has one.
pub(crate) fn tell(what: Saying, number: u32, bytes: &[u8]) {
    say(what as u32, number, bytes.as_ptr(), bytes.len());
}

/// Lets the Worker give the time of day, UTC as in RFC 3339, as it gives a text.
pub(crate) fn ask_date() {
    date();
}

/// The time by the clock of the Worker.
pub(crate) fn clock() -> Duration {
    duration(now())
}

/// A time of the Worker, ms.
pub(crate) fn duration(milliseconds: f64) -> Duration {
    Duration::try_from_secs_f64(milliseconds / 1000.0).unwrap_or_default()
}
