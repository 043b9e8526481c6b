//! The laboratory as WebAssembly, for Workers of its page: `lab_worker.js` of slipfront-lab. One module holds
//! the session and is built with the feature `session` alone. A second module runs the jobs outside the
//! session; it is built with the feature `work` alone, and loaded on first use.
//!
//! To call a function, the Worker allocates bytes in a module, fills them and calls the function. The
//! function returns its results through `say`.

#[cfg(feature = "work")]
pub mod bits;
#[cfg(target_family = "wasm")]
mod exports;
#[cfg(all(feature = "session", target_family = "wasm"))]
mod host;
#[cfg(target_family = "wasm")]
mod imports;
#[cfg(target_family = "wasm")]
mod input_bytes;
#[cfg(all(feature = "session", target_family = "wasm"))]
mod session;
#[cfg(all(feature = "work", target_family = "wasm"))]
mod work;
