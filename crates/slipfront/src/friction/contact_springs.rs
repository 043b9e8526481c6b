//! Springs between the blocks and the substrate.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::surface::Surface;

/// Every block in contact is held by a spring that breaks at its static threshold and forms again without stress:
/// `F_f = -k_t (u - a)`, where the anchor `a` becomes `u` when `k_t |u - a|` exceeds the threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSprings {
    /// Stiffness `k_t` per block, in units of `E l`.
    pub stiffness: f64,
    /// Seed by which a spring that forms again takes another coefficient; none if it keeps its own.
    pub redraw: Option<u64>,
}

impl ContactSprings {
    /// Static threshold of the spring of a block that has broken `breaks` times; `number` is that of the block in the whole lattice. One that is drawn anew has the coefficient of a
    /// block in contact that seed, block and number of breaks choose at random, so that thresholds keep their distribution,
    /// drawn or given.
    pub(crate) fn threshold(&self, surface: &Surface, block: usize, number: usize, breaks: u64) -> f64 {
        match self.redraw {
            Some(seed) if breaks > 0 && !surface.textured[block] => {
                let mut key = [0; 32];
                for (word, bytes) in [seed, number as u64, breaks].iter().zip(key.chunks_exact_mut(8)) {
                    bytes.copy_from_slice(&word.to_le_bytes());
                }
                let mut random = ChaCha8Rng::from_seed(key);
                let n = surface.n_blocks() as u128;
                // A block in contact there is at least: this one.
                let mut choose = || ((u128::from(random.next_u64()) * n) >> 64) as usize;
                let mut other = choose();
                while surface.textured[other] {
                    other = choose();
                }
                surface.static_limit_with(surface.mu_static[other], block)
            }
            _ => surface.static_limit(block),
        }
    }
}
