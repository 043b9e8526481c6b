//! The numbers of a batch in the memory of a GPU.

#![allow(unsafe_code)] // Structs are copied and passed to the GPU.

use std::sync::Arc;

use cudarc::driver::sys::CUdeviceptr;
use cudarc::driver::{CudaSlice, CudaStream, DevicePtr, DevicePtrMut, DeviceRepr, DriverError};

use crate::batch::{Batch, Lattice};

/// Numbers of lattices in the memory of a GPU, as in [`Batch`].
#[derive(Debug)]
pub(crate) struct Arrays {
    pub(crate) lattices: CudaSlice<Lattice>,
    pub(crate) state: CudaSlice<f64>,
    given: CudaSlice<f64>,
    memory: CudaSlice<f64>,
    flags: CudaSlice<u16>,
    bins: CudaSlice<u16>,
    counts: CudaSlice<u32>,
    first_slips: CudaSlice<u32>,
    records: CudaSlice<u64>,
}

/// The struct `Arrays` of `kernels/step.h`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Pointers {
    pub(crate) lattices: CUdeviceptr,
    pub(crate) state: CUdeviceptr,
    given: CUdeviceptr,
    memory: CUdeviceptr,
    flags: CUdeviceptr,
    bins: CUdeviceptr,
    counts: CUdeviceptr,
    first_slips: CUdeviceptr,
    records: CUdeviceptr,
}

// SAFETY: the struct has no padding and no pointers, and has the layout of the struct of the kernels.
unsafe impl DeviceRepr for Lattice {}

// SAFETY: the struct has no padding, and has the layout of the struct of the kernels, in which pointers have
// 8 bytes.
unsafe impl DeviceRepr for Pointers {}

impl Arrays {
    /// Copies the numbers of a batch to the GPU.
    pub(crate) fn copy_to_gpu(batch: &Batch, stream: &Arc<CudaStream>) -> Result<Self, DriverError> {
        Ok(Self {
            lattices: stream.clone_htod(&batch.lattices)?,
            state: stream.clone_htod(&batch.state)?,
            given: stream.clone_htod(&batch.given)?,
            memory: stream.clone_htod(&batch.memory)?,
            flags: stream.clone_htod(&batch.flags)?,
            bins: stream.clone_htod(&batch.bins)?,
            counts: stream.clone_htod(&batch.counts)?,
            first_slips: stream.clone_htod(&batch.first_slips)?,
            records: stream.alloc_zeros(batch.records.len())?,
        })
    }

    /// Launches kernels with the addresses of the numbers.
    pub(crate) fn launch(
        &mut self,
        stream: &Arc<CudaStream>,
        launch: impl FnOnce(Pointers) -> Result<(), DriverError>,
    ) -> Result<(), DriverError> {
        let lattices = self.lattices.device_ptr_mut(stream);
        let state = self.state.device_ptr_mut(stream);
        let given = self.given.device_ptr_mut(stream);
        let memory = self.memory.device_ptr_mut(stream);
        let flags = self.flags.device_ptr(stream);
        let bins = self.bins.device_ptr(stream);
        let counts = self.counts.device_ptr_mut(stream);
        let first_slips = self.first_slips.device_ptr_mut(stream);
        let records = self.records.device_ptr_mut(stream);
        launch(Pointers {
            lattices: lattices.0,
            state: state.0,
            given: given.0,
            memory: memory.0,
            flags: flags.0,
            bins: bins.0,
            counts: counts.0,
            first_slips: first_slips.0,
            records: records.0,
        })
    }

    /// Copies what kernels have changed back to the batch.
    pub(crate) fn return_to(&self, batch: &mut Batch, stream: &Arc<CudaStream>) -> Result<(), DriverError> {
        stream.memcpy_dtoh(&self.lattices, &mut batch.lattices)?;
        stream.memcpy_dtoh(&self.state, &mut batch.state)?;
        stream.memcpy_dtoh(&self.memory, &mut batch.memory)?;
        stream.memcpy_dtoh(&self.counts, &mut batch.counts)?;
        stream.memcpy_dtoh(&self.first_slips, &mut batch.first_slips)?;
        stream.memcpy_dtoh(&self.records, &mut batch.records)?;
        stream.synchronize()
    }
}
