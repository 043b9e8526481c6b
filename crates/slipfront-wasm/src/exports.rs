//! The names by which the Worker calls.

/// Gives functions of a module of this crate to the Worker, by their names.
macro_rules! exported {
    ($($module:ident::$name:ident($($argument:ident: $kind:ty),*) $(-> $given:ty)?;)*) => {$(
        // SAFETY: a name that is not changed could be that of another function of the module, of which none
        // is called like this.
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
        given::room(length: usize) -> *mut u8;
        given::begin();
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
