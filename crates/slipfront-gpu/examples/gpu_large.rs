//! Measures what a step of one large lattice costs on a GPU, and checks that GPU and CPU give the same bits.
//! Prints the GPU with its bandwidth, and a table with tabs between its columns.
//!
//! ```console
//! $ cargo run --release -p slipfront-gpu --features cuda --example gpu_large
//! ```
//!
//! The sliders are those of the paper's Fig. 3 with more blocks, thrown so that every block slides, the most
//! work that a step can have. The time of a step is the difference of two runs of different length, so that
//! it excludes the copies to and from the GPU. The bandwidth is that of 82 bytes a block and step:
//! displacement and velocity before and after, limit, impulse and flags. It is compared with a copy within
//! the GPU's memory.

mod support;

use std::time::Instant;

use cudarc::driver::{CudaContext, DriverError};
use slipfront::device::{Device, DeviceLattice};
use slipfront::testing::FusedDevice;
use slipfront::{State, VectorField};
use slipfront_gpu::Gpu;

use self::support::{DT_STAR, ENERGIES, Failure, model};

/// Bytes that a step reads and writes for a block.
const BYTES: f64 = 82.0;

fn lattice(size: usize) -> Result<DeviceLattice, Failure> {
    let (model, n) = (model(size, 0.1, 1)?, size * size);
    let thrown = |scale: f64| VectorField {
        x: (0..n)
            .map(|b| scale * (1.0 + 0.1 * (0.01 * b as f64).sin()))
            .collect(),
        y: vec![0.0; n],
    };
    let state = State {
        displacement: thrown(1.0),
        velocity: thrown(100.0),
    };
    Ok(DeviceLattice::new(model, DT_STAR, Some(&state), ENERGIES)?)
}

/// Seconds of some steps.
fn seconds(gpu: &Gpu, lattice: &DeviceLattice, steps: u32) -> Result<f64, Failure> {
    let mut lattice = lattice.clone();
    let began = Instant::now();
    gpu.run(&mut [&mut lattice], steps)?;
    Ok(began.elapsed().as_secs_f64())
}

/// Bytes a second that a copy within the memory of the GPU reads and writes.
fn copy_bandwidth() -> Result<f64, DriverError> {
    const SIZE: usize = 1 << 30;
    let stream = CudaContext::new(0)?.default_stream();
    let from = stream.alloc_zeros::<u8>(SIZE)?;
    let mut to = stream.alloc_zeros::<u8>(SIZE)?;
    stream.memcpy_dtod(&from, &mut to)?;
    stream.synchronize()?;
    let began = Instant::now();
    for _ in 0..20 {
        stream.memcpy_dtod(&from, &mut to)?;
    }
    stream.synchronize()?;
    Ok(20.0 * 2.0 * SIZE as f64 / began.elapsed().as_secs_f64())
}

fn main() -> Result<(), Failure> {
    let gpu = Gpu::open()?;
    let bandwidth = copy_bandwidth()?;
    println!("{} copies {:.0} GB/s", gpu.name(), bandwidth * 1e-9);
    println!("blocks\tGPU, ns\tone core, ns\tshare of the bandwidth of a copy\tsame bits");
    for size in [512, 1024, 2048, 4096, 8192] {
        let lattice = lattice(size)?;
        let blocks = (size * size) as f64;
        let (few, many) = (20, 20 + (4e8 / blocks).clamp(20.0, 1000.0) as u32);
        seconds(&gpu, &lattice, few)?;
        let time = (seconds(&gpu, &lattice, many)? - seconds(&gpu, &lattice, few)?) / f64::from(many - few);
        let per_block = time / blocks * 1e9;
        let share = BYTES * blocks / time / bandwidth;
        // The CPU takes a second for a step of the largest lattice.
        let (on_cpu, is_same) = if size <= 2048 {
            let (mut by_gpu, mut by_cpu) = (lattice.clone(), lattice.clone());
            gpu.run(&mut [&mut by_gpu], few)?;
            let began = Instant::now();
            FusedDevice.run(&mut [&mut by_cpu], few)?;
            let per_step = began.elapsed().as_secs_f64() / f64::from(few);
            let is_same = by_gpu.records == by_cpu.records && by_gpu.state == by_cpu.state;
            (
                format!("{:.1}", per_step / blocks * 1e9),
                if is_same { "yes" } else { "NO" },
            )
        } else {
            ("-".to_owned(), "-")
        };
        println!("{size} x {size}\t{per_block:.4}\t{on_cpu}\t{share:.2}\t{is_same}");
    }
    Ok(())
}
