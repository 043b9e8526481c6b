//! A session of the laboratory as WebAssembly, for a Worker of its page: `lab_worker.js` of slipfront-lab.
//!
//! The Worker writes bytes into the room that the module gives it, calls a function, and is told what comes of it by `say`.

pub mod bits;
#[cfg(target_family = "wasm")]
mod calls;
#[cfg(target_family = "wasm")]
mod exports;
#[cfg(target_family = "wasm")]
mod host;
#[cfg(target_family = "wasm")]
mod imports;
