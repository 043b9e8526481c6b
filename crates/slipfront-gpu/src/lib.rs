//! Plain lattices of slipfront on a GPU, with the bits of its fused kernel.
//!
//! The kernels (`kernels/`) are one source in CUDA C++. The feature `cuda` runs them on a GPU of NVIDIA; the
//! feature `emulated` compiles them for the CPU, thread by thread and warp by warp, for tests where there is
//! no GPU. Both implement `slipfront::device::Device`. Without these features the crate is empty.
//!
//! Sums have the bits of the fused kernel since they are sums of integers. Terms have them since each is
//! found by the operations of that kernel in their order, none of which is contracted with another.

#![cfg(any(feature = "cuda", feature = "emulated"))]

mod batch;
#[cfg(feature = "cuda")]
mod cuda;
#[cfg(feature = "emulated")]
mod emulated;

#[cfg(feature = "cuda")]
pub use cuda::Gpu;
#[cfg(feature = "emulated")]
pub use emulated::Emulated;
