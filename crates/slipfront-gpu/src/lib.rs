//! Plain lattices of slipfront on a GPU, with the same bits as slipfront's fused kernel.
//!
//! The kernels (`kernels/`) are one source in CUDA C++. The feature `cuda` runs them on an NVIDIA GPU. The
//! feature `emulated` compiles them for the CPU, thread by thread and warp by warp, for tests without a GPU.
//! Both implement `slipfront::device::Device`. Without these features the crate is empty.
//!
//! Sums have the same bits because they are sums of integers. Their terms have the same bits because each is
//! computed by the same operations in the same order as in the fused kernel, without contraction.

#![cfg(any(feature = "cuda", feature = "emulated"))]

#[cfg(feature = "cuda")]
mod arrays;
mod batch;
#[cfg(feature = "cuda")]
mod cuda;
#[cfg(feature = "emulated")]
mod emulated;
#[cfg(feature = "cuda")]
mod large_lattices;

#[cfg(feature = "cuda")]
pub use cuda::Gpu;
#[cfg(feature = "emulated")]
pub use emulated::Emulated;
