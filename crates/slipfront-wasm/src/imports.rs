//! The function that the Worker gives every module, for messages to it.

/// Kinds of messages from a module to the Worker.
#[derive(Clone, Copy)]
#[repr(u32)]
#[allow(dead_code, reason = "each module says a part of these")]
pub(crate) enum Saying {
    /// A reply of the session.
    Reply,
    /// A picture of the field.
    Picture,
    /// A kymograph.
    Kymograph,
    /// Work that is to be begun, with its number.
    Job,
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

#[expect(unsafe_code, reason = "Rust cannot look at a function of the Worker")]
// SAFETY: the Worker gives it with these types (`lab_worker.js`), and reads no more than the bytes that it is
// shown.
unsafe extern "C" {
    safe fn say(what: u32, number: u32, at: *const u8, length: usize);
    /// The time by the clock of the Worker, ms.
    #[cfg(feature = "work")]
    pub(crate) safe fn now() -> f64;
    /// Gives the module the time of day, UTC as in RFC 3339.
    #[cfg(feature = "work")]
    pub(crate) safe fn date();
}

/// Says something to the Worker, with a number where it has one.
pub(crate) fn tell(what: Saying, number: u32, bytes: &[u8]) {
    say(what as u32, number, bytes.as_ptr(), bytes.len());
}
