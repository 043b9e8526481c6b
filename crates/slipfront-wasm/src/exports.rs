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
        calls::open(workers: u32);
        calls::handle();
        calls::advance(now: f64, unread: u32) -> f64;
        calls::hear(task: u32);
        calls::hear_lost(task: u32);
        calls::run();
        calls::save();
        calls::bits(most_steps: u32);
    }
}

#[cfg(feature = "pictures")]
#[expect(
    unsafe_code,
    reason = "names of functions stay as they are, and Rust cannot tell whether others have them"
)]
mod of_pictures {
    exported! {
        pictures::draw();
    }
}
