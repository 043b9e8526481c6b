//! The laboratory as WebAssembly, for Workers of its page: `lab_worker.js` of slipfront-lab. One module has
//! the session, made with the feature `session` alone. A second one, made with `work` alone and loaded on
//! first use, does the work beside it.
//!
//! The Worker writes bytes into the room that a module gives it, calls a function, and gets the results by
//! `say`.

#[cfg(feature = "work")]
pub mod bits;
#[cfg(target_family = "wasm")]
mod exports;
#[cfg(target_family = "wasm")]
mod given;
#[cfg(all(feature = "session", target_family = "wasm"))]
mod host;
#[cfg(target_family = "wasm")]
mod imports;
#[cfg(all(feature = "session", target_family = "wasm"))]
mod session;
#[cfg(all(feature = "work", target_family = "wasm"))]
mod work;
