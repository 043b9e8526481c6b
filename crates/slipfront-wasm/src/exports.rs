//! Functions that the Worker calls by name.

/// Exports functions of a module of this crate to the Worker under their own names.
macro_rules! exported {
    ($($module:ident::$name:ident($($argument:ident: $kind:ty),*) $(-> $given:ty)?;)*) => {$(
        // SAFETY: without mangling, a name could clash with another symbol of the module, but no other
        // function has one of these names.
        #[unsafe(no_mangle)]
        extern "C" fn $name($($argument: $kind),*) $(-> $given)? {
            crate::$module::$name($($argument),*)
        }
    )*};
}

#[expect(
    unsafe_code,
    reason = "names of functions stay as they are, and Rust cannot tell whether others have them"
)]
mod of_every_module {
    exported! {
        input_bytes::room(length: usize) -> *mut u8;
        input_bytes::begin();
    }
}

#[cfg(feature = "session")]
#[expect(
    unsafe_code,
    reason = "names of functions stay as they are, and Rust cannot tell whether others have them"
)]
mod of_session {
    exported! {
        session::open(workers: u32);
        session::handle();
        session::advance(now: f64, unread: u32) -> f64;
        session::hear(task: u32);
        session::hear_lost(task: u32);
    }
}

#[cfg(feature = "work")]
#[expect(
    unsafe_code,
    reason = "names of functions stay as they are, and Rust cannot tell whether others have them"
)]
mod of_work {
    exported! {
        work::run();
        work::save();
        work::bits(most_steps: u32);
    }
}
