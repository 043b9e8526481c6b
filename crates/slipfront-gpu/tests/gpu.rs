//! Tests with a GPU where there is one, and of the error message where there is none.

use slipfront::device::{Device, DeviceLattice, EnergySteps};
use slipfront::testing::FusedDevice;
use slipfront::{Drive, FrictionLaw, Lattice, Model, Surface};
use slipfront_gpu::Gpu;

/// Without a usable GPU the error names a remedy; with one, a run has the bits of the fused kernel.
#[test]
fn a_gpu_has_the_same_bits_or_is_refused_with_a_remedy() {
    let gpu = match Gpu::open() {
        Ok(gpu) => gpu,
        Err(error) => {
            let sentence = error.to_string();
            assert!(
                sentence.contains("the CPU gives the same results") || sentence.contains("pip install"),
                "{sentence}"
            );
            return;
        }
    };
    // In the memory that threads share, and in that of the GPU.
    for size in [25, 100] {
        compare(&gpu, size);
    }
}

fn compare(gpu: &Gpu, size: usize) {
    let lattice = Lattice::free(size, size);
    let mut surface = Surface::uniform(&lattice, 1.0, 0.5);
    surface.textured[312] = true;
    let model = Model::new(
        lattice,
        surface,
        Drive::along_x(0.1),
        0.1,
        1e-6,
        FrictionLaw::Projection,
    );
    let energies = EnergySteps { every: 7, last: 0 };
    let mut on_gpu = DeviceLattice::new(model, 0.2, None, energies).expect("the model is plain");
    let mut on_cpu = on_gpu.clone();
    for steps in [100, 77] {
        gpu.run(&mut [&mut on_gpu], steps).expect("the GPU computes");
        FusedDevice
            .run(&mut [&mut on_cpu], steps)
            .expect("the CPU computes");
        assert_eq!(format!("{on_gpu:?}"), format!("{on_cpu:?}"));
    }
}
