//! Noise of synthetic records.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// What random numbers are drawn for; each has numbers of its own.
#[derive(Clone, Copy)]
pub(crate) enum Stream {
    /// Noise of the curves of training.
    Noise = 0,
    /// Drift of the curves that the check of a record learns from.
    Drift = 1,
    /// Noise of the curves with a drift.
    DriftNoise = 2,
}

/// Generator of the numbers of one record of one training run.
fn generator(stream: Stream, run: usize, record: usize) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(b"calibrat");
    key[8..16].copy_from_slice(&(run as u64).to_le_bytes());
    key[16..24].copy_from_slice(&(record as u64).to_le_bytes());
    let mut random = ChaCha8Rng::from_seed(key);
    random.set_stream(stream as u64);
    random
}

/// The next number between 0 and 1, of 53 bits.
fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// Standard normals, by Box and Muller from two uniforms each, with sine and logarithm of `libm`.
pub(crate) fn normals(stream: Stream, run: usize, record: usize) -> impl Iterator<Item = f64> {
    let mut random = generator(stream, run, record);
    std::iter::repeat_with(move || {
        let (one, other) = (1.0 - uniform(&mut random), uniform(&mut random));
        (-2.0 * libm::log(one)).sqrt() * libm::cos(std::f64::consts::TAU * other)
    })
}

/// A number between 0 and 1 of a training run.
pub(crate) fn share(stream: Stream, run: usize) -> f64 {
    uniform(&mut generator(stream, run, 0))
}
