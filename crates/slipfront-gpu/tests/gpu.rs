//! Tests with a GPU where there is one, and of the error message where there is none.

use slipfront::device::{Device, DeviceLattice, EnergySteps};
use slipfront::testing::FusedDevice;
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Surface};
use slipfront_gpu::Gpu;

/// Without a usable GPU the error names the reason; with one, a run has the bits of the fused kernel.
#[test]
fn a_gpu_has_the_same_bits_or_is_refused_with_a_reason() {
    let gpu = match Gpu::open() {
        Ok(gpu) => gpu,
        Err(error) => {
            let reasons = [
                "no NVIDIA driver was found",
                "no GPU can be opened",
                "the driver does not",
                "NVRTC",
            ];
            let sentence = error.to_string();
            assert!(
                reasons.iter().any(|reason| sentence.contains(reason)),
                "{sentence}"
            );
            return;
        }
    };
    (&gpu as &dyn Device)
        .test_bits()
        .expect("the GPU has the bits of the CPU");
    // In the memory that threads share, and in that of the GPU.
    for sizes in [[[25, 25], [7, 30]], [[100, 100], [67, 66]]] {
        compare(&gpu, sizes);
    }
}

/// Compares two lattices, the second of which is periodic along x.
fn compare(gpu: &Gpu, sizes: [[usize; 2]; 2]) {
    let edges = [Edges::Free, Edges::Periodic];
    let models = sizes.into_iter().zip(edges).map(|([nx, ny], edge)| {
        let lattice = Lattice::with_edges(nx, ny, [edge, Edges::Free]);
        let mut surface = Surface::uniform(&lattice, 1.0, 0.5);
        surface.textured[nx * ny / 2] = true;
        let drive = Drive::along_x(0.1);
        Model::new(lattice, surface, drive, 0.1, 1e-6, FrictionLaw::Projection)
    });
    let energies = EnergySteps { every: 7, last: 0 };
    let begun =
        models.map(|model| DeviceLattice::new(model, 0.2, None, energies).expect("the model is plain"));
    let mut on_gpu: Vec<_> = begun.collect();
    let mut on_cpu = on_gpu.clone();
    // 16 steps are the interval between two measurements.
    for steps in [96, 81] {
        gpu.run(&mut on_gpu.iter_mut().collect::<Vec<_>>(), steps)
            .expect("the GPU computes");
        FusedDevice
            .run(&mut on_cpu.iter_mut().collect::<Vec<_>>(), steps)
            .expect("the CPU computes");
        assert_eq!(format!("{on_gpu:?}"), format!("{on_cpu:?}"));
    }
}
