//! Contact stress and traction, which a sweep does not keep, computed again from displacements and velocities
//! with the exact spring law, whichever formula the sweep used.

use fearless_simd::{Level, Simd, SimdBase, SimdFloat, dispatch};

use super::aligned::{Aligned, chunks};
use super::band::Band;
use super::layout::TILE;
use super::pull::{pull, pull_of_differing};
use super::scratch::Scratch;
use super::springs::{Differing, Geometry, SquareRoot};
use super::step::Step;
use super::vector::{LANES, add, bits, is_zero, load, load_vec2, scale, select, splat, square};

/// Stress of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stress {
    /// `|F_f + F_c|` (Eq. 10).
    Contact,
    /// `|F_f|`.
    Traction,
}

/// Number for each element of a tile.
pub type OfTile = [[f64; LANES]; TILE / LANES];

/// Reads stresses of the tiles of a band, the lowest first.
pub struct StressReader<'a> {
    level: Level,
    band: &'a Band,
    stress: Stress,
    step: Step,
    springs: SquareRoot,
    /// The element up to which the springs to the next row are known.
    springs_end: usize,
    scratch: std::sync::MutexGuard<'a, Scratch>,
}

impl<'a> StressReader<'a> {
    /// Reads a stress at a step, with springs under a load of strain `epsilon`.
    pub fn new(level: Level, band: &'a Band, stress: Stress, step: Step, epsilon: f64) -> Self {
        Self {
            level,
            band,
            stress,
            step,
            springs: SquareRoot { epsilon },
            springs_end: 0,
            scratch: band.lock_scratch(),
        }
    }

    /// Replaces the kinetic friction of the elements of tile `t`, which matters where they move, by their
    /// stress, with friction as for one block. The tile is after those read before.
    pub fn read(&mut self, t: usize, forces: &mut OfTile) {
        let (level, springs) = (self.level, self.springs);
        if self.band.variations.is_some() {
            dispatch!(level, simd => self.read_with(simd, Differing(springs), t, forces));
        } else {
            dispatch!(level, simd => self.read_with(simd, springs, t, forces));
        }
    }

    #[inline(always)]
    fn read_with<S: Simd, G: Geometry>(&mut self, simd: S, geometry: G, t: usize, forces: &mut OfTile) {
        let (band, scratch) = (self.band, &mut *self.scratch);
        let elements = band.elements(t);
        let displaced = band.halo + elements.start..band.halo + elements.end;
        // For consecutive tiles, the springs in between are in the ring buffer already.
        let from = band.below(displaced.start).max(self.springs_end);
        self.springs_end = displaced.end;
        band.upward(simd, geometry, scratch, from, displaced.end);
        band.lattice_forces(simd, geometry, t, scratch);
        let n = elements.len();
        let displacements = chunks(&band.displacement, displaced.start, n);
        let velocities = chunks(&band.velocity, elements.start, n);
        let lattice_forces = chunks(&scratch.lattice, 0, n);
        let interface = band
            .interface
            .as_ref()
            .map(|interface| interface.of_elements(elements.clone()));
        for (c, of_vector) in forces[..n / LANES].iter_mut().enumerate() {
            let mut velocity = load_vec2(simd, velocities, c);
            let mut kinetic_force = load(simd, of_vector);
            let lattice = load_vec2(simd, lattice_forces, c);
            let u = load_vec2(simd, displacements, c);
            let variations = band.variations.as_ref().filter(|_| G::BLOCKS_DIFFER);
            let mut drive = match variations {
                Some(variations) => {
                    let first = elements.start + c * LANES;
                    let eight = |values: &Aligned| load(simd, &values[first..].as_chunks().0[0]);
                    let loads = variations.loads.as_ref().map(eight);
                    pull_of_differing(simd, self.step, eight(&variations.drive_springs), loads, u)
                }
                None => pull(simd, self.step, u),
            };
            if let Some(interface) = &interface {
                let [reaction, share] = interface.reaction(simd, c, u[1]);
                drive[1] += reaction;
                (kinetic_force, velocity[1]) = (share * kinetic_force, splat(simd, 0.0));
            }
            let [x, y] = add(drive, lattice);
            let mut force = [-x, -y];
            let stuck = is_zero(simd, velocity);
            if bits(simd, stuck) != u8::MAX {
                let per_velocity = kinetic_force / square(velocity).sqrt();
                force = select(stuck, force, scale(-per_velocity, velocity));
            }
            if interface.is_some() {
                force[1] = splat(simd, 0.0);
            }
            if self.stress == Stress::Contact {
                force = add(force, lattice);
            }
            square(force).sqrt().store_array(of_vector);
        }
    }
}
