//! The names by which the Worker calls.

/// Gives functions of `calls.rs` to the Worker, by their names.
macro_rules! exported {
    ($(fn $name:ident($($argument:ident: $kind:ty),*) $(-> $given:ty)?;)*) => {$(
        // SAFETY: a name that is not changed could be that of another function of the module, of which none is called like this.
        #[unsafe(no_mangle)]
        extern "C" fn $name($($argument: $kind),*) $(-> $given)? {
            crate::calls::$name($($argument),*)
        }
    )*};
}

#[expect(
    unsafe_code,
    reason = "names of functions stay as they are, and Rust cannot tell whether others have them"
)]
mod named {
    exported! {
        fn room(length: usize) -> *mut u8;
        fn begin();
        fn open();
        fn handle();
        fn work(now: f64, unread: u32) -> f64;
        fn hear(task: u32);
        fn hear_lost(task: u32);
        fn run();
        fn save();
        fn bits(most_steps: u32);
    }
}
