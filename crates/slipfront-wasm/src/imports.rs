//! The function that the Worker provides to every module for messages to the Worker.

/// Kinds of messages from a module to the Worker.
#[derive(Clone, Copy)]
#[repr(u32)]
#[allow(dead_code, reason = "each module says a part of these")]
pub(crate) enum MessageKind {
    /// A reply of the session.
    Reply,
    /// A picture of the field.
    Picture,
    /// A kymograph.
    Kymograph,
    /// A job to begin, with its task number.
    Job,
    /// The number of a task to end.
    End,
    /// An event of a job outside the session, as JSON.
    Event,
    /// A run to save.
    Save,
    /// The name of a run to stop saving.
    StopSaving,
    /// The completed fraction of a run, in millionths.
    Share,
    /// The archive of a run.
    Archive,
    /// The bits of a run.
    Bits,
    /// A sentence that says why a call was refused.
    Refusal,
    /// A panic, with the text that a program would print in its terminal.
    Defect,
}

#[expect(unsafe_code, reason = "Rust cannot look at a function of the Worker")]
// SAFETY: the Worker provides these functions with these types (`lab_worker.js`), and reads no more than the
// bytes passed to it.
unsafe extern "C" {
    safe fn say(what: u32, number: u32, at: *const u8, length: usize);
    /// The time by the clock of the Worker, ms.
    #[cfg(feature = "work")]
    pub(crate) safe fn now() -> f64;
    /// Makes the Worker pass the time of day to the module: UTC, as in RFC 3339.
    #[cfg(feature = "work")]
    pub(crate) safe fn date();
}

/// Sends a message to the Worker, with a task number if it has one.
pub(crate) fn send_message(what: MessageKind, number: u32, bytes: &[u8]) {
    say(what as u32, number, bytes.as_ptr(), bytes.len());
}
