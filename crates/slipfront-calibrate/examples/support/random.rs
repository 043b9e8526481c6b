//! Random numbers of records, independent of those of training.

/// Pseudorandom bits (SplitMix64).
fn bits(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A number between 0 and 1.
fn unit_interval(state: &mut u64) -> f64 {
    ((bits(state) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
}

/// A standard normal number, by the Box-Muller transform.
pub(crate) fn normal(state: &mut u64) -> f64 {
    let radius = (-2.0 * unit_interval(state).ln()).sqrt();
    radius * (std::f64::consts::TAU * unit_interval(state)).cos()
}

/// True values of the unknowns of a record, as shares of their ranges.
pub(crate) fn uniform(record: usize, count: usize) -> Vec<f64> {
    let mut state = (record as u64 + 1).wrapping_mul(0xAEF1_7502_108E_F2D9);
    (0..count).map(|_| unit_interval(&mut state)).collect()
}
