//! Springs between blocks and substrate, which break at the static threshold and form again, or slide.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use slipfront::{AfterBreak, ContactSprings, Surface};

use super::step::{Motion, Update};
use super::vector::{Vector, difference, length, sum, times};

/// Coefficient of the spring of block `b` that has broken `breaks` times: its own, or with `redraw` that of a
/// block in contact, chosen by the random stream of seed, block and number of breaks.
pub(crate) fn coefficient(law: &ContactSprings, surface: &Surface, b: usize, breaks: u64) -> f64 {
    let AfterBreak::FormsAgain { redraw: Some(seed) } = law.after_break else {
        return surface.mu_static[b];
    };
    if breaks == 0 {
        return surface.mu_static[b];
    }
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

/// A spring that yields in an update.
pub(crate) struct Yielding {
    /// Displacement at which the spring has no force from now on.
    pub(crate) anchor: Vector,
    /// Energy that is lost with a spring that breaks.
    pub(crate) lost: f64,
    /// Work against kinetic friction of a block that has slid before.
    pub(crate) slip_work: f64,
}

/// The update of a block at `place`, with the anchor of its spring, and how the spring yields: at `holds`, or
/// at `slows` while the block slides. `F_f = -k_t (u - a)`; for a spring that breaks the mean of its forces
/// before and after.
pub(crate) fn update(
    law: &ContactSprings,
    motion: &Motion,
    force: Vector,
    [place, anchor]: [Vector; 2],
    [holds, slows]: [f64; 2],
    slid: bool,
) -> (Update, Option<Yielding>) {
    let stretch = difference(place, anchor);
    let pull = law.stiffness * length(stretch);
    let left = if law.slides() { slows } else { 0.0 };
    let yields = pull > if slid { slows } else { holds.max(left) };
    let friction = match (yields, slid) {
        (false, _) => pull,
        (true, false) => 0.5 * (pull + left),
        (true, true) => left,
    };
    let yielding = yields.then(|| Yielding {
        anchor: difference(place, times(left / pull, stretch)),
        lost: if slid {
            0.0
        } else {
            0.5 * (pull * pull - left * left) / law.stiffness
        },
        slip_work: if slid {
            left * (pull - left) / law.stiffness
        } else {
            0.0
        },
    });
    let share = if pull > 0.0 { friction / pull } else { 1.0 };
    let friction = times(-share * law.stiffness, stretch);
    let velocity = motion.accelerated(sum(force, friction));
    (Update { velocity, friction }, yielding)
}
