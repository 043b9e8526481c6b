//! Bytes that the Worker gives a module.

use std::cell::RefCell;

use crate::imports::{Saying, tell};

thread_local! {
    /// Bytes that the Worker has given.
    static GIVEN: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Takes the bytes that the Worker has given.
pub(crate) fn take() -> Vec<u8> {
    GIVEN.take()
}

/// Makes room for so many bytes, which the Worker then fills; gives their place.
pub(crate) fn room(length: usize) -> *mut u8 {
    GIVEN.with_borrow_mut(|given| {
        given.clear();
        given.resize(length, 0);
        given.as_mut_ptr()
    })
}

/// Lets defects be told. To be called first.
pub(crate) fn begin() {
    std::panic::set_hook(Box::new(|defect| {
        tell(Saying::Defect, 0, defect.to_string().as_bytes());
    }));
}
