//! Parallel loops, with the names of rayon. On a target without threads, such as WebAssembly in a Worker of a
//! page, the same loops run in sequence; results never depend on this.

#[cfg(target_family = "wasm")]
mod alone;
#[cfg(not(target_family = "wasm"))]
mod threads;

#[cfg(target_family = "wasm")]
pub use alone::*;
#[cfg(not(target_family = "wasm"))]
pub use threads::*;
