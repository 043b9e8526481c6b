//! The kernels on an NVIDIA GPU.

#![allow(unsafe_code)] // Kernels are launched, and structs are copied to the GPU.

use std::sync::Arc;

use cudarc::driver::sys::CUdevice_attribute_enum::CU_DEVICE_ATTRIBUTE_MAX_SHARED_MEMORY_PER_BLOCK_OPTIN;
use cudarc::driver::sys::CUfunction_attribute_enum::CU_FUNC_ATTRIBUTE_MAX_DYNAMIC_SHARED_SIZE_BYTES;
use cudarc::driver::{
    CudaContext, CudaFunction, CudaStream, DeviceRepr, DriverError, LaunchConfig, PushKernelArg, sys,
};
use cudarc::nvrtc::{self, CompileOptions, Ptx};
use slipfront::device::{Device, DeviceError, DeviceLattice};

use crate::batch::{Batch, Lattice, RECORD};

/// The kernels as PTX, written by `ptx.py`; empty if that script was not run before this crate was compiled.
const PTX: &str = include_str!(concat!(env!("OUT_DIR"), "/kernels.ptx"));

/// The source of the kernels, for NVRTC. Each file includes only files before it in this list.
const SOURCES: [&str; 7] = [
    include_str!("../kernels/target.h"),
    include_str!("../kernels/fixed_point.h"),
    include_str!("../kernels/step.h"),
    include_str!("../kernels/block.h"),
    include_str!("../kernels/warp.h"),
    include_str!("../kernels/small_lattices.h"),
    include_str!("../kernels/kernels.cu"),
];

/// Bytes of shared memory that a kernel needs per block of the lattice.
const BYTES_PER_BLOCK: usize = 6 * size_of::<f64>() + size_of::<u32>();

/// Thread-group sizes for which there are kernels, and the largest number of blocks for each if memory
/// allows.
const GROUPS: [(u32, usize); 3] = [(128, 1024), (256, 2304), (512, usize::MAX)];

/// Kernel for lattices up to a given size.
#[derive(Debug)]
struct Kernel {
    function: CudaFunction,
    threads: u32,
    most_blocks: usize,
}

/// An NVIDIA GPU.
#[derive(Debug)]
pub struct Gpu {
    context: Arc<CudaContext>,
    stream: Arc<CudaStream>,
    /// Kernels for [`GROUPS`], in their order.
    kernels: Vec<Kernel>,
}

// SAFETY: the struct has no padding and no pointers, and has the layout of the struct of the kernels.
unsafe impl DeviceRepr for Lattice {}

impl Gpu {
    /// Opens the first GPU of this machine.
    ///
    /// # Errors
    /// A sentence with the remedy, if there is no driver, no GPU or no compiler for the kernels.
    pub fn open() -> Result<Self, DeviceError> {
        // SAFETY: the function only tries to load a library, and initialising that library is the driver's
        // own code.
        if !unsafe { sys::is_culib_present() } {
            let message = "no NVIDIA driver was found (libcuda.so.1): the CPU gives the same results";
            return Err(DeviceError(message.to_owned()));
        }
        let context = CudaContext::new(0).map_err(failed("no GPU can be opened"))?;
        let (major, minor) = context
            .compute_capability()
            .map_err(failed("the GPU does not say what it computes"))?;
        let module = context
            .load_module(ptx(major, minor)?)
            .map_err(failed("the driver does not take the kernels"))?;
        let shared = context
            .attribute(CU_DEVICE_ATTRIBUTE_MAX_SHARED_MEMORY_PER_BLOCK_OPTIN)
            .map_err(failed("the GPU does not say how much memory threads share"))?;
        let load = |(threads, most): (u32, usize)| {
            let function = module.load_function(&format!("small_lattices_{threads}"))?;
            let room = (shared - function.shared_size_bytes()?) as usize;
            let most_blocks = most.min(room / BYTES_PER_BLOCK);
            let bytes = (most_blocks * BYTES_PER_BLOCK) as i32;
            function.set_attribute(CU_FUNC_ATTRIBUTE_MAX_DYNAMIC_SHARED_SIZE_BYTES, bytes)?;
            Ok(Kernel {
                function,
                threads,
                most_blocks,
            })
        };
        let kernels: Result<Vec<_>, DriverError> = GROUPS.into_iter().map(load).collect();
        Ok(Self {
            stream: context.default_stream(),
            kernels: kernels.map_err(failed("the GPU does not take the kernels"))?,
            context,
        })
    }

    /// Name of the GPU.
    ///
    /// # Errors
    /// When the driver fails.
    pub fn name(&self) -> Result<String, DeviceError> {
        self.context.name().map_err(failed("the GPU has no name"))
    }

    /// Runs the steps of a batch of lattices with at most `most_blocks` blocks each.
    fn launch(&self, batch: &mut Batch, kernel: &Kernel, most_blocks: usize) -> Result<(), DriverError> {
        let stream = &self.stream;
        let mut lattices = stream.clone_htod(&batch.lattices)?;
        let mut state = stream.clone_htod(&batch.state)?;
        let given = stream.clone_htod(&batch.given)?;
        let flags = stream.clone_htod(&batch.flags)?;
        let mut first_slips = stream.clone_htod(&batch.first_slips)?;
        let mut records = stream.alloc_zeros::<u64>(batch.records.len())?;
        let config = LaunchConfig {
            grid_dim: (batch.lattices.len() as u32, 1, 1),
            block_dim: (kernel.threads, 1, 1),
            shared_mem_bytes: (most_blocks * BYTES_PER_BLOCK) as u32,
        };
        let mut launch = stream.launch_builder(&kernel.function);
        launch
            .arg(&mut lattices)
            .arg(&mut state)
            .arg(&given)
            .arg(&flags)
            .arg(&mut first_slips)
            .arg(&mut records);
        // SAFETY: the arguments have the types of the kernel's parameters, and the batch has checked the
        // lengths of the arrays.
        unsafe { launch.launch(config) }?;
        stream.memcpy_dtoh(&lattices, &mut batch.lattices)?;
        stream.memcpy_dtoh(&state, &mut batch.state)?;
        stream.memcpy_dtoh(&first_slips, &mut batch.first_slips)?;
        stream.memcpy_dtoh(&records, &mut batch.records)?;
        stream.synchronize()
    }

    /// Number of lattices with `blocks` blocks that fit into half of the free memory, with the numbers of
    /// `steps` steps.
    fn lattices_at_once(&self, blocks: usize, steps: u32) -> Result<usize, DeviceError> {
        let (free, _) = self
            .context
            .mem_get_info()
            .map_err(failed("the GPU does not say how much memory is free"))?;
        let per_block = 6 * size_of::<f64>() + size_of::<u16>() + size_of::<u32>();
        let per_step = 8 * RECORD + 2 * size_of::<f64>();
        let bytes = size_of::<Lattice>() + blocks * per_block + steps as usize * per_step;
        match free / 2 / bytes {
            0 => Err(DeviceError(format!(
                "a lattice of {blocks} blocks needs {bytes} bytes for {steps} steps, twice which the GPU does not have free: \
                 the CPU gives the same results"
            ))),
            count => Ok(count),
        }
    }
}

impl Device for Gpu {
    fn most_blocks(&self) -> usize {
        let of_kernels = self.kernels.iter().map(|kernel| kernel.most_blocks);
        of_kernels.max().unwrap_or(0)
    }

    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        let blocks = |lattice: &&mut DeviceLattice| lattice.blocks[0] * lattice.blocks[1];
        let Some(most) = lattices.iter().map(blocks).max() else {
            return Ok(());
        };
        let Some(kernel) = self.kernels.iter().find(|kernel| most <= kernel.most_blocks) else {
            return Err(DeviceError(format!(
                "a lattice of {most} blocks is larger than the {} that the GPU takes: the CPU gives the same results",
                self.most_blocks()
            )));
        };
        let count = self.lattices_at_once(most, steps)?;
        for some in lattices.chunks_mut(count) {
            let mut batch = Batch::new(some, steps)?;
            self.launch(&mut batch, kernel, most)
                .map_err(failed("the GPU failed"))?;
            batch.return_to(some);
        }
        Ok(())
    }
}

/// The kernels as PTX: compiled beforehand, or now by NVRTC.
fn ptx(major: i32, minor: i32) -> Result<Ptx, DeviceError> {
    if !PTX.is_empty() {
        return Ok(Ptx::from_src(PTX));
    }
    // SAFETY: the function only tries to load a library that runs no code on initialisation.
    if !unsafe { nvrtc::sys::is_culib_present() } {
        let message = "this program has no kernels for a GPU, and NVRTC, which could compile them, was not found \
                       (libnvrtc.so): run crates/slipfront-gpu/ptx.py before you build it, or install NVRTC, for \
                       example with `pip install nvidia-cuda-nvrtc-cu12`";
        return Err(DeviceError(message.to_owned()));
    }
    let options = CompileOptions {
        // No fused multiply-add: a product and a sum are two operations with two roundings, as on the CPU.
        fmad: Some(false),
        options: vec![
            format!("--gpu-architecture=compute_{major}{minor}"),
            "--std=c++17".to_owned(),
        ],
        ..CompileOptions::default()
    };
    nvrtc::compile_ptx_with_opts(source(), options)
        .map_err(|error| DeviceError(format!("NVRTC does not compile the kernels: {error}")))
}

/// The source of all kernels as one text.
fn source() -> String {
    let lines = SOURCES.into_iter().flat_map(str::lines);
    let kept = lines.filter(|line| !line.starts_with("#include \"") && !line.starts_with("#pragma once"));
    kept.flat_map(|line| [line, "\n"]).collect()
}

/// Turns an error of the driver into a sentence.
fn failed(what: &str) -> impl FnOnce(DriverError) -> DeviceError {
    move |error| DeviceError(format!("{what}: {error}"))
}
