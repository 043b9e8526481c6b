//! Threads of a transform.

use fearless_simd::Level;

/// Calls two functions, on two threads if there are any.
pub type Join = fn(&mut (dyn FnMut() + Send), &mut (dyn FnMut() + Send));

/// How the columns of a transform are computed; no bit of the result depends on it.
#[derive(Clone, Copy, Debug)]
pub struct Threads {
    /// Vector instructions.
    pub level: Level,
    /// Function that shares out the work of several threads.
    pub join: Join,
}
