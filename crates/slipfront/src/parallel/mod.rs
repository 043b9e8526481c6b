//! Loops that threads share out, with the names of rayon. Where a target has no threads, as WebAssembly in a
//! Worker of a page, the same loops go from the first element to the last; results never depend on that.

#[cfg(target_family = "wasm")]
mod alone;
#[cfg(not(target_family = "wasm"))]
mod threads;

#[cfg(target_family = "wasm")]
pub use alone::*;
#[cfg(not(target_family = "wasm"))]
pub use threads::*;
