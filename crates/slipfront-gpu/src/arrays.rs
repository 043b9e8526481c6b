//! The numbers of a batch in the memory of a GPU.

#![allow(unsafe_code)] // A struct is copied to the GPU.

use std::sync::Arc;

use cudarc::driver::{CudaSlice, CudaStream, DeviceRepr, DriverError};

use crate::batch::{Batch, Lattice};

/// Numbers of lattices in the memory of a GPU, as in [`Batch`].
#[derive(Debug)]
pub(crate) struct Arrays {
    pub(crate) lattices: CudaSlice<Lattice>,
    pub(crate) state: CudaSlice<f64>,
    pub(crate) given: CudaSlice<f64>,
    pub(crate) memory: CudaSlice<f64>,
    pub(crate) flags: CudaSlice<u16>,
    pub(crate) first_slips: CudaSlice<u32>,
    pub(crate) records: CudaSlice<u64>,
}

// SAFETY: the struct has no padding and no pointers, and has the layout of the struct of the kernels.
unsafe impl DeviceRepr for Lattice {}

impl Arrays {
    /// Copies the numbers of a batch to the GPU.
    pub(crate) fn of(batch: &Batch, stream: &Arc<CudaStream>) -> Result<Self, DriverError> {
        Ok(Self {
            lattices: stream.clone_htod(&batch.lattices)?,
            state: stream.clone_htod(&batch.state)?,
            given: stream.clone_htod(&batch.given)?,
            memory: stream.clone_htod(&batch.memory)?,
            flags: stream.clone_htod(&batch.flags)?,
            first_slips: stream.clone_htod(&batch.first_slips)?,
            records: stream.alloc_zeros(batch.records.len())?,
        })
    }

    /// Copies what kernels have changed back to the batch.
    pub(crate) fn return_to(&self, batch: &mut Batch, stream: &Arc<CudaStream>) -> Result<(), DriverError> {
        stream.memcpy_dtoh(&self.lattices, &mut batch.lattices)?;
        stream.memcpy_dtoh(&self.state, &mut batch.state)?;
        stream.memcpy_dtoh(&self.memory, &mut batch.memory)?;
        stream.memcpy_dtoh(&self.first_slips, &mut batch.first_slips)?;
        stream.memcpy_dtoh(&self.records, &mut batch.records)?;
        stream.synchronize()
    }
}
