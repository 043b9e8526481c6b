//! A session of the laboratory as WebAssembly, for a Worker of its page: `lab_worker.js` of slipfront-lab. A
//! second module, made with the feature `pictures` alone, draws the pictures of runs that are saved.
//!
//! The Worker writes bytes into the room that a module gives it, calls a function, and is told what comes of
//! it by `say`.

#[cfg(feature = "session")]
pub mod bits;
#[cfg(all(feature = "session", target_family = "wasm"))]
mod calls;
#[cfg(target_family = "wasm")]
mod exports;
#[cfg(target_family = "wasm")]
mod given;
#[cfg(all(feature = "session", target_family = "wasm"))]
mod host;
#[cfg(target_family = "wasm")]
mod imports;
#[cfg(all(feature = "pictures", target_family = "wasm"))]
mod pictures;
#[cfg(all(feature = "session", target_family = "wasm"))]
mod questions;
