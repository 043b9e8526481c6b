//! The kernels on an NVIDIA GPU.

#![allow(unsafe_code)] // Libraries are looked for, and kernels are launched.

use std::sync::Arc;

use cudarc::driver::sys::CUdevice_attribute_enum::CU_DEVICE_ATTRIBUTE_MAX_SHARED_MEMORY_PER_BLOCK_OPTIN;
use cudarc::driver::sys::CUfunction_attribute_enum::CU_FUNC_ATTRIBUTE_MAX_DYNAMIC_SHARED_SIZE_BYTES;
use cudarc::driver::{CudaContext, CudaFunction, CudaStream, DriverError, LaunchConfig, PushKernelArg, sys};
use cudarc::nvrtc::{self, CompileOptions, Ptx};
use slipfront::PositionBins;
use slipfront::device::{Device, DeviceError, DeviceLattice};

use crate::arrays::Arrays;
use crate::batch::{Batch, Lattice, RECORD, more_bytes};
use crate::large_lattices::LargeKernels;

/// The kernels as PTX, written by `ptx.py`; empty if that script was not run before this crate was compiled.
const PTX: &str = include_str!(concat!(env!("OUT_DIR"), "/kernels.ptx"));

/// The source of the kernels, for NVRTC. Each file includes only files before it in this list.
const SOURCES: [&str; 9] = [
    include_str!("../kernels/target.h"),
    include_str!("../kernels/fixed_point.h"),
    include_str!("../kernels/step.h"),
    include_str!("../kernels/block.h"),
    include_str!("../kernels/warp.h"),
    include_str!("../kernels/group.h"),
    include_str!("../kernels/small_lattices.h"),
    include_str!("../kernels/large_lattices.h"),
    include_str!("../kernels/kernels.cu"),
];

/// Bytes of shared memory that a kernel needs per block of the lattice.
const BYTES_PER_BLOCK: usize = 6 * size_of::<f64>() + size_of::<u32>();

/// Library of the driver.
const DRIVER: &str = if cfg!(windows) {
    "nvcuda.dll"
} else {
    "libcuda.so.1"
};

/// Library of NVRTC, its folder in the package for Python, and the variable that names folders of libraries.
const NVRTC: [&str; 3] = if cfg!(windows) {
    ["nvrtc64_120_0.dll", "nvidia/cuda_nvrtc/bin", "PATH"]
} else {
    ["libnvrtc.so", "nvidia/cuda_nvrtc/lib", "LD_LIBRARY_PATH"]
};

/// Thread-group sizes for which there are kernels for small lattices, and the largest number of blocks for
/// each if memory allows.
const GROUPS: [(u32, usize); 3] = [(128, 1024), (256, 2304), (512, usize::MAX)];

/// Largest number of blocks of a lattice: kernels count them in 32 bits with a sign.
const MOST_BLOCKS: usize = i32::MAX as usize;

/// Largest number of lattices at once, the size of a grid along y.
const MOST_LATTICES: usize = 65_535;

/// Bytes of the GPU's memory that a block needs: its state before and after a step, its limits, its flags and
/// first slip, and its part of the sums of a group.
const BYTES_ON_GPU: usize = 10 * size_of::<f64>() + size_of::<u16>() + size_of::<u32>() + 1;

/// Most bytes that a block may need in addition: impulse, fall and memory of strength that falls with slip,
/// and its bin.
const MORE_BYTES_ON_GPU: usize = 5 * size_of::<f64>() + size_of::<u16>();

/// Number of steps at once for which the largest lattice leaves memory.
const STEPS_AT_ONCE: usize = 1024;

/// Bytes of the GPU's memory that a step of a lattice needs.
const BYTES_PER_STEP: usize = 8 * RECORD + 2 * size_of::<f64>();

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
    name: String,
    /// Largest number of blocks of a lattice for which memory was free when the GPU was opened.
    most_blocks: usize,
    context: Arc<CudaContext>,
    stream: Arc<CudaStream>,
    /// Kernels for [`GROUPS`], in their order.
    small: Vec<Kernel>,
    large: LargeKernels,
}

impl Gpu {
    /// Opens the first GPU of this machine.
    ///
    /// # Errors
    /// A sentence with the remedy, if there is no driver, no GPU or no compiler for the kernels.
    pub fn open() -> Result<Self, DeviceError> {
        // SAFETY: the function only tries to load a library, and initialising that library is the driver's
        // own code.
        if !unsafe { sys::is_culib_present() } {
            return Err(DeviceError(format!("no NVIDIA driver was found ({DRIVER})")));
        }
        let context = CudaContext::new(0).map_err(failed("no GPU can be opened"))?;
        let (major, minor) = context
            .compute_capability()
            .map_err(failed("the GPU does not say what it computes"))?;
        let module = context.load_module(ptx(major, minor)?).map_err(failed(
            "the driver does not take the kernels, which need its version 535 or later",
        ))?;
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
        let kernels = || {
            let small: Result<_, DriverError> = GROUPS.into_iter().map(load).collect();
            Ok((small?, LargeKernels::load(&module)?))
        };
        let (small, large) = kernels().map_err(failed("the GPU does not take the kernels"))?;
        let stream = context.default_stream();
        let counts = PositionBins::MAX * size_of::<u32>();
        let beside = size_of::<Lattice>() + STEPS_AT_ONCE * (BYTES_PER_STEP + counts);
        let of_blocks = room(&context, &stream)?.saturating_sub(beside);
        let fit = of_blocks / (BYTES_ON_GPU + MORE_BYTES_ON_GPU);
        Ok(Self {
            name: context.name().map_err(failed("the GPU has no name"))?,
            most_blocks: fit.min(MOST_BLOCKS),
            stream,
            small,
            large,
            context,
        })
    }

    /// Runs the steps of a batch of lattices with at most `most_blocks` blocks each.
    fn launch(&self, batch: &mut Batch, most_blocks: usize) -> Result<(), DriverError> {
        let stream = &self.stream;
        let mut arrays = Arrays::copy_to_gpu(batch, stream)?;
        match self.small.iter().find(|kernel| most_blocks <= kernel.most_blocks) {
            Some(kernel) => kernel.launch(stream, &mut arrays, most_blocks)?,
            None => self.large.launch(stream, &mut arrays, &batch.lattices)?,
        }
        arrays.return_to(batch, stream)
    }

    /// Number of lattices with `blocks` blocks that fit into the memory, with the numbers of `steps` steps
    /// and some more bytes.
    fn lattices_at_once(&self, blocks: usize, more: usize, steps: u32) -> Result<usize, DeviceError> {
        let bytes = size_of::<Lattice>() + blocks * BYTES_ON_GPU + more + steps as usize * BYTES_PER_STEP;
        let room = room(&self.context, &self.stream)?;
        match room / bytes {
            0 => Err(DeviceError(format!(
                "a lattice of {blocks} blocks needs {:.2} GB of the GPU's memory for {steps} steps, and half of \
                 what is free there is {:.2} GB",
                bytes as f64 * 1e-9,
                room as f64 * 1e-9
            ))),
            count => Ok(count.min(MOST_LATTICES)),
        }
    }
}

impl Kernel {
    fn launch(
        &self,
        stream: &Arc<CudaStream>,
        arrays: &mut Arrays,
        most_blocks: usize,
    ) -> Result<(), DriverError> {
        let config = LaunchConfig {
            grid_dim: (arrays.lattices.len() as u32, 1, 1),
            block_dim: (self.threads, 1, 1),
            shared_mem_bytes: (most_blocks * BYTES_PER_BLOCK) as u32,
        };
        // SAFETY: the argument has the type of the kernel's parameter, and the batch has checked the lengths
        // of the arrays.
        arrays.launch(stream, |arrays| unsafe {
            stream
                .launch_builder(&self.function)
                .arg(&arrays)
                .launch(config)
                .map(|_| ())
        })
    }
}

impl Device for Gpu {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn most_blocks(&self) -> usize {
        self.most_blocks
    }

    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        let blocks = |lattice: &&mut DeviceLattice| lattice.blocks[0] * lattice.blocks[1];
        let Some(most) = lattices.iter().map(blocks).max().filter(|_| steps > 0) else {
            return Ok(());
        };
        let more = lattices.iter().map(|lattice| more_bytes(lattice, steps)).max();
        let count = self.lattices_at_once(most, more.unwrap_or(0), steps)?;
        for some in lattices.chunks_mut(count) {
            let mut batch = Batch::new(some, steps)?;
            self.launch(&mut batch, most).map_err(failed("the GPU failed"))?;
            batch.return_to(some);
        }
        Ok(())
    }
}

/// Half of the bytes that are free in the memory of the GPU.
fn room(context: &CudaContext, stream: &CudaStream) -> Result<usize, DeviceError> {
    // Memory is free again only when the copies that used it last have ended.
    let ended = stream.synchronize();
    let memory = ended.and_then(|()| context.mem_get_info());
    let (free, _) = memory.map_err(failed("the GPU does not say how much memory is free"))?;
    Ok(free / 2)
}

/// The kernels as PTX: compiled beforehand, or now by NVRTC.
fn ptx(major: i32, minor: i32) -> Result<Ptx, DeviceError> {
    if !PTX.is_empty() {
        return Ok(Ptx::from_src(PTX));
    }
    // SAFETY: the function only tries to load a library that runs no code on initialisation.
    if !unsafe { nvrtc::sys::is_culib_present() } {
        let [library, folder, variable] = NVRTC;
        return Err(DeviceError(format!(
            "this program has no kernels for a GPU, and NVRTC, which could compile them, was not found \
             ({library}): run crates/slipfront-gpu/ptx.py before you build it, or install the CUDA toolkit, or \
             `pip install nvidia-cuda-nvrtc-cu12` and name its folder `{folder}` in {variable}"
        )));
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
