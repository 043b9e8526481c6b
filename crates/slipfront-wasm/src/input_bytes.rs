//! Bytes that the Worker passes to a module.

use std::cell::RefCell;
use std::time::Duration;

use serde::Deserialize;

use crate::imports::{MessageKind, send_message};

thread_local! {
    /// Bytes that the Worker has passed.
    static GIVEN: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Takes the bytes that the Worker has passed.
pub(crate) fn take() -> Vec<u8> {
    GIVEN.take()
}

/// Allocates `length` bytes for the Worker to fill, and returns their address.
pub(crate) fn room(length: usize) -> *mut u8 {
    GIVEN.with_borrow_mut(|given| {
        given.clear();
        given.resize(length, 0);
        given.as_mut_ptr()
    })
}

/// Makes panics report to the Worker. The Worker calls this first.
pub(crate) fn begin() {
    std::panic::set_hook(Box::new(|defect| {
        send_message(MessageKind::Defect, 0, defect.to_string().as_bytes());
    }));
}

/// Parses the bytes that the Worker has passed as JSON.
pub(crate) fn read<T: for<'de> Deserialize<'de>>() -> Result<T, String> {
    serde_json::from_slice(&take()).map_err(|error| error.to_string())
}

/// Reports to the Worker why something cannot be done.
pub(crate) fn refuse(done: Result<(), String>) {
    if let Err(sentence) = done {
        send_message(MessageKind::Refusal, 0, sentence.as_bytes());
    }
}

/// Converts a time of the Worker, ms.
pub(crate) fn duration(milliseconds: f64) -> Duration {
    Duration::try_from_secs_f64(milliseconds / 1000.0).unwrap_or_default()
}
