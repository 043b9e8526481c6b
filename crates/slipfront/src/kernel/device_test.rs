//! The test that a device must pass before it computes anything.

use crate::device::{Device, DeviceError, DeviceLattice, EnergySteps};
use crate::drive::Drive;
use crate::friction::{Friction, FrictionLaw};
use crate::lattice::{Edges, Lattice};
use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::state::State;
use crate::surface::{Coefficients, Distribution, Load, Surface};

/// Time step t* of the test.
const DT_STAR: f64 = 0.2;

/// Number of steps before each comparison: the onset lies in the first of them.
const STEPS: [u32; 2] = [90, 57];

impl dyn Device {
    /// Compares the device with the fused kernel, on small and large sliders through their onsets: every
    /// number of every step and of every block.
    ///
    /// # Errors
    /// If the device fails, or a number has other bits: it must not be used then.
    pub fn test_bits(&self) -> Result<(), DeviceError> {
        let constant = || Friction::from(FrictionLaw::Projection);
        let falling = || Friction::of_falling_strength(0.3, Some(1.0));
        // The sliders use each formula for springs. A GPU with 187 KiB of memory for the threads of a group
        // computes all but the second with another kernel each, one with 64 KiB the first two and the others.
        for (size, epsilon, friction) in [
            (25, 1e-6, falling()),
            (33, 1e-6, falling()),
            (40, 1e-3, constant()),
            (60, 0.1, constant()),
            (100, 1e-6, falling()),
        ] {
            let mut tested = begun(size, epsilon, friction);
            let mut expected = tested.clone();
            for steps in STEPS {
                self.run(&mut [&mut tested], steps)?;
                expected.run_on_cpu(steps);
                if numbers(&tested) != numbers(&expected) {
                    return Err(DeviceError(format!(
                        "{} must not be used, since a test with {size} x {size} blocks differs from the CPU",
                        self.name()
                    )));
                }
            }
        }
        Ok(())
    }
}

/// A textured slider at rest, which is periodic along x.
fn begun(size: usize, epsilon: f64, friction: Friction) -> DeviceLattice {
    let lattice = Lattice::with_edges(size, size, [Edges::Periodic, Edges::Free]);
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let n = lattice.n_blocks();
    let coefficients = Coefficients::draw_blocks(0..n, gauss(1.0), gauss(0.5), 1);
    let textured = (0..n).map(|b| b % 7 == 0 && b / size % 5 < 2).collect();
    let surface = Surface::new(coefficients, textured, Load::Redistributed, 1.0);
    let surface = surface.expect("most blocks are in contact");
    let drive = Drive::at_angle(0.5, 20.0);
    let bins = PositionBins::new(&lattice, &drive);
    let model = Model::new(lattice, surface, drive, 0.1, epsilon, friction);
    let energies = EnergySteps { every: 5, last: 0 };
    let begun = DeviceLattice::new(model, DT_STAR, None, energies);
    let mut begun = begun.expect("a device computes plain models");
    begun.add_counts(8, &bins);
    begun
}

/// Bits of all numbers of a lattice that a device changes.
fn numbers(lattice: &DeviceLattice) -> Vec<u64> {
    let State {
        displacement: u,
        velocity: v,
    } = &lattice.state;
    let motion = &lattice.motion;
    let of_law = lattice.strength.iter().flat_map(|strength| &strength.columns);
    let of_blocks = [&u.x, &u.y, &v.x, &v.y].into_iter().chain(of_law).flatten();
    let of_steps = lattice.records.iter().flat_map(|record| {
        let [kinetic, springs, drive] = record.stored;
        let [ux, uy] = record.displacement;
        let [vx, vy] = record.velocity_after;
        let sums = [
            record.velocity_square,
            record.friction_power,
            record.stress_square_max,
            record.weakening_energy,
        ];
        [ux, uy, vx, vy, kinetic, springs, drive].into_iter().chain(sums)
    });
    let of_motion = motion.bounds.iter().chain(&motion.velocity_after);
    let sliding = lattice.records.iter().flat_map(|record| record.n_sliding);
    let in_bins = lattice.counts.iter().flat_map(|counts| &counts.recorded);
    let in_bins = in_bins.flat_map(|(_, counts)| counts.iter().copied());
    let slips = sliding
        .chain(in_bins)
        .chain(lattice.first_slips.iter().copied())
        .map(u64::from);
    let bits = of_blocks
        .chain(of_motion)
        .copied()
        .chain(of_steps)
        .map(f64::to_bits);
    let steps = [lattice.steps_done, motion.drive_steps, motion.drive_moves];
    bits.chain(slips).chain(steps).collect()
}
