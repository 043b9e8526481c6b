//! The largest friction of an elastic body on a rigid plane, from a quasi-static solution. The surface of the
//! body is a periodic square of blocks under a prescribed pressure. Its interior is a stiffness for every
//! wave number.
//!
//! A displacement of the surface `u exp(i q.x)` has the stiffness `L(q)` along the wave and `T(q)` across it.
//! Blocks stick up to their strength, and slide against friction that falls linearly with slip to the kinetic
//! value. The body is pulled by a slowly growing traction. When no state of rest is near any longer, slip
//! runs away, and friction has passed its maximum.
//!
//! Lengths are in blocks, stiffnesses per area in `G/(1 - nu)` per block.

use std::f64::consts::TAU;

use crate::fourier::{Complex, Fourier};

/// Uncertainty of the largest traction, and largest force on a block that counts as zero, over the mean
/// strength: a hundredth of a percentage point in the reduction of friction.
const TOLERANCE: f64 = 1e-4;
/// Largest increment of the traction.
const INCREMENT: f64 = 0.1;

/// A body as a stiffness for every wave of a periodic square of blocks.
pub(crate) struct Body {
    side: usize,
    fourier: Fourier,
    /// `(L + T)/2` of every wave; the values of a row belong to one wave number along y.
    mean: Vec<f64>,
    /// `(L - T)/2 exp(2 i phi)` of a wave in the direction phi.
    difference: Vec<Complex>,
    stiffest: f64,
}

/// Blocks on the plane.
pub(crate) struct Blocks {
    /// Static strength over the mean of all blocks; 0 for a textured block.
    pub(crate) strength: Vec<f64>,
    /// Ratio of kinetic to static strength.
    pub(crate) ratio: f64,
    /// Slip over which friction falls to kinetic.
    pub(crate) slip_length: f64,
}

/// Displacement and slip of all blocks.
#[derive(Clone)]
struct State {
    displacement: Vec<Complex>,
    slip: Vec<f64>,
}

impl Body {
    /// A body of side x side blocks with these stiffnesses along and across a wave of wave number q. A
    /// uniform displacement of all blocks has no stiffness.
    pub(crate) fn new(side: usize, stiffness: impl Fn(f64) -> [f64; 2]) -> Self {
        let wave_number = |k: usize| {
            let k = if 2 * k > side {
                k as f64 - side as f64
            } else {
                k as f64
            };
            TAU * k / side as f64
        };
        let (mut mean, mut difference) = (vec![0.0], vec![Complex::default()]);
        let mut stiffest = 0.0_f64;
        for k in 1..side * side {
            let wave = Complex::new(wave_number(k / side), wave_number(k % side));
            let q = wave.length();
            let [along, across] = stiffness(q);
            mean.push(0.5 * (along + across));
            let turned = (wave * wave).times(0.5 * (along - across) / (q * q));
            // At the shortest wave length, waves in opposite directions are the same wave, and parts of
            // opposite sign cancel.
            let cancels = 2 * (k / side) == side || 2 * (k % side) == side;
            difference.push(Complex::new(turned.x, if cancels { 0.0 } else { turned.y }));
            stiffest = stiffest.max(along).max(across);
        }
        Self {
            side,
            fourier: Fourier::new(side),
            mean,
            difference,
            stiffest,
        }
    }

    /// A deep body: `G q/(1 - nu)` along and `G q` across.
    pub(crate) fn half_space(side: usize, poisson: f64) -> Self {
        Self::new(side, |q| [q, (1.0 - poisson) * q])
    }

    /// Traction of the body on its blocks.
    fn traction(&self, displacement: &[Complex], traction: &mut Vec<Complex>) {
        traction.clear();
        traction.extend_from_slice(displacement);
        self.fourier.forward(traction);
        let side = self.side;
        let opposite = |k: usize| (side - k / side) % side * side + (side - k % side) % side;
        // The transform holds both components, x + i y: F = -(mean z(q) + difference conj(z(-q))).
        for k in 0..side * side {
            let other = opposite(k);
            if k > other {
                continue;
            }
            let [one, two] = [traction[k], traction[other]];
            let answer = |k: usize, z: Complex, opposite: Complex| {
                (z.times(self.mean[k]) + self.difference[k] * opposite.conjugate()).times(-1.0)
            };
            traction[k] = answer(k, one, two);
            traction[other] = answer(other, two, one);
        }
        self.fourier.back(traction);
    }

    /// Largest mean friction over the mean strength, where the drive pulls along x.
    pub(crate) fn largest_friction(&self, blocks: &Blocks) -> f64 {
        let n = self.side * self.side;
        assert_eq!(blocks.strength.len(), n);
        let mut state = State {
            displacement: vec![Complex::default(); n],
            slip: vec![0.0; n],
        };
        // Sliding blocks carry at least the kinetic strength.
        let (mut held, mut slides) = (0.0, f64::INFINITY);
        let mut pull = blocks.ratio;
        while slides - held > TOLERANCE {
            let mut next = state.clone();
            if self.comes_to_rest(blocks, pull, &mut next) {
                state = next;
                held = pull;
            } else {
                slides = pull;
            }
            pull = (held + INCREMENT).min(0.5 * (held + slides));
        }
        held
    }

    /// Whether the blocks come to rest under a traction along x, before all of them have slid the distance
    /// over which friction falls.
    ///
    /// Blocks move in proportion to the force that friction does not balance. The stiffest wave moves 1.5
    /// times the distance to equilibrium, which is stable, and too little to cause slip.
    fn comes_to_rest(&self, blocks: &Blocks, pull: f64, state: &mut State) -> bool {
        let mobility = 1.5 / self.stiffest;
        let mut traction = Vec::new();
        loop {
            self.traction(&state.displacement, &mut traction);
            let (mut largest, mut least_slip) = (0.0_f64, f64::INFINITY);
            for (i, &strength) in blocks.strength.iter().enumerate() {
                let force = traction[i] + Complex::new(pull, 0.0);
                let fallen = (state.slip[i] / blocks.slip_length).min(1.0);
                let friction = strength * (1.0 - (1.0 - blocks.ratio) * fallen);
                let size = force.length();
                let excess = size - friction;
                if excess > 0.0 {
                    let step = force.times(mobility * excess / size);
                    state.displacement[i] = state.displacement[i] + step;
                    state.slip[i] += mobility * excess;
                    largest = largest.max(excess);
                }
                if strength > 0.0 {
                    least_slip = least_slip.min(state.slip[i]);
                }
            }
            if largest < TOLERANCE {
                return true;
            }
            if least_slip > blocks.slip_length {
                return false;
            }
        }
    }
}
