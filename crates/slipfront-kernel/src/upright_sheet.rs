//! Tiles of an upright sheet, with friction along its interface.

use fearless_simd::Simd;

use super::band::Band;
use super::blocks::Sums;
use super::interface::friction_along_x;
use super::quanta::Quanta;
use super::scratch::Scratch;
use super::step::Step;
use super::vector::LANES;

impl Band {
    /// Eqs. 2 and 4-7 along the interface under a tile with known lattice forces. A separate function,
    /// compiled once for all spring formulas.
    #[inline(never)]
    pub(crate) fn interface_of_tile<S: Simd>(
        &mut self,
        simd: S,
        step: &Step,
        quanta: &Quanta,
        t: usize,
        scratch: &mut Scratch,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let elements = self.elements(t);
                let mut sums = Sums::zero(simd);
                // Moved out while the other arrays of the band are changed.
                let interface = self.interface.take();
                let mut moves = false;
                if let Some(interface) = &interface {
                    let under = interface.of_elements(elements.clone());
                    let next = [elements.end; 2];
                    let still = Some(interface.still(elements.len()));
                    let arrays =
                        self.friction_loop::<S, true>(simd, *step, (elements, next), scratch, 0, still);
                    moves = friction_along_x(simd, *step, quanta, (arrays, under), &mut sums);
                }
                self.interface = interface;
                self.set_swept(t, sums.totals::<true>(quanta, self.vectors(t).len()), moves);
            },
        );
    }

    /// Mask of the elements of vector `v` that slide: those that move, or at an interface those that move
    /// along x.
    pub fn sliding(&self, v: usize) -> u8 {
        if self.interface.is_none() {
            return self.moving[v];
        }
        let along_x = &self.velocity.x[v * LANES..(v + 1) * LANES];
        (0..LANES).fold(0, |mask, k| mask | u8::from(along_x[k] != 0.0) << k)
    }
}
