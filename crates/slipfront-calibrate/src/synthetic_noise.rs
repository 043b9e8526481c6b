//! Noise of synthetic records.

use slipfront_study::draws::Draws;

/// Purpose of random numbers; each purpose has its own sequence.
#[derive(Clone, Copy)]
pub(crate) enum Stream {
    /// Noise of the curves of training.
    Noise = 0,
    /// Drift of the curves for training the test of a record.
    Drift = 1,
    /// Noise of the curves with a drift.
    DriftNoise = 2,
    /// Points that are drawn from an estimate, and noise of their curves.
    Predicted = 3,
    /// Search for the closest curve.
    Closest = 4,
    /// Noise that a record lacks.
    Missing = 5,
}

/// Random numbers of one record of one training run.
pub(crate) fn draws(stream: Stream, run: usize, record: usize) -> Draws {
    let calibration = u64::from_le_bytes(*b"calibrat");
    Draws::named([calibration, run as u64, record as u64, stream as u64])
}

/// Standard normal numbers.
pub(crate) fn normals(stream: Stream, run: usize, record: usize) -> impl Iterator<Item = f64> {
    let mut draws = draws(stream, run, record);
    std::iter::repeat_with(move || draws.normal())
}
