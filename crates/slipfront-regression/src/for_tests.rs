//! Points and pseudorandom numbers for tests.

/// Point `run` of the unit cube, minus its mean: multiples of the roots of 2, 3 and 5, which fill the cube.
pub(crate) fn point(run: usize, d: usize) -> Vec<f64> {
    let roots = [2.0_f64, 3.0, 5.0].into_iter().take(d);
    roots
        .map(|root| (root.sqrt() * (run as f64 + 1.0)).fract() - 0.5)
        .collect()
}

pub(crate) fn cube(n: usize, d: usize) -> Vec<f64> {
    (0..n).flat_map(|run| point(run, d)).collect()
}

/// Pseudorandom numbers from 0 to 1 (SplitMix64).
pub(crate) fn chance(n: usize) -> Vec<f64> {
    let mut state = 0_u64;
    let mut next = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..n).map(|_| next()).collect()
}
