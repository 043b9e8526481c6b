//! Springs between blocks and substrate, which break at the static threshold and form again.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use slipfront::{ContactSprings, Surface};

use super::step::{Motion, Update};
use super::vector::{Vector, length, sum, times};

/// Coefficient of the spring of block `b` that has broken `breaks` times: its own, or with `redraw` that of a
/// block in contact which the random stream of seed, block and number of breaks chooses.
pub(crate) fn coefficient(law: &ContactSprings, surface: &Surface, b: usize, breaks: u64) -> f64 {
    let Some(seed) = law.redraw.filter(|_| breaks > 0) else {
        return surface.mu_static[b];
    };
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&(b as u64).to_le_bytes());
    key[16..24].copy_from_slice(&breaks.to_le_bytes());
    let mut random = ChaCha8Rng::from_seed(key);
    loop {
        let n = surface.mu_static.len() as u128;
        let other = ((u128::from(random.next_u64()) * n) >> 64) as usize;
        if !surface.textured[other] {
            return surface.mu_static[other];
        }
    }
}

/// The update of a block whose spring is stretched by `stretch = u - a`, and whether the spring breaks:
/// `F_f = -k_t (u - a)`, of one that breaks for half of the step.
pub(crate) fn update(
    law: &ContactSprings,
    motion: &Motion,
    force: Vector,
    stretch: Vector,
    holds: f64,
) -> (Update, bool) {
    let breaks = law.stiffness * length(stretch) > holds;
    let share = if breaks { 0.5 } else { 1.0 };
    let friction = times(-share * law.stiffness, stretch);
    let velocity = motion.accelerated(sum(force, friction));
    (Update { velocity, friction }, breaks)
}
