//! The sweep, compiled for each formula of springs and each width of vectors.

use fearless_simd::{Level, dispatch};

use super::band::Band;
use super::quanta::Quanta;
use super::springs::{Differing, Series, SquareRoot};
use super::step::Step;

/// Formula for spring forces in a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Springs {
    /// The short series, for small strains of 1e-4 and less.
    ShortSeries,
    /// The long series, for strains up to 1e-2.
    LongSeries,
    /// The square root, for any strain.
    SquareRoot,
}

impl Springs {
    /// Largest strains for the short and for the long series.
    pub fn strain_limits() -> [f64; 2] {
        [Series::<3>::strain_limit(), Series::<7>::strain_limit()]
    }

    /// The fastest formula that is exact to rounding up to a strain, with these limits of the series.
    pub fn up_to(strain: f64, [short, long]: [f64; 2]) -> Self {
        if strain <= short {
            Self::ShortSeries
        } else if strain <= long {
            Self::LongSeries
        } else {
            Self::SquareRoot
        }
    }
}

/// Measures displacements and their differences along springs, see [`Band::extent`], with the vector
/// instructions of `level`.
pub fn measure_displacements(level: Level, band: &mut Band) {
    dispatch!(level, simd => band.measure_displacements(simd));
}

/// Advances a band by a step with the vector instructions of `level`.
pub fn sweep(
    level: Level,
    band: &mut Band,
    springs: Springs,
    epsilon: f64,
    step: Step,
    quanta: &Quanta,
    energies: bool,
) {
    let (short, long, root) = (
        Series::<3> { epsilon },
        Series::<7> { epsilon },
        SquareRoot { epsilon },
    );
    match (springs, band.variations.is_some()) {
        (Springs::ShortSeries, false) => {
            dispatch!(level, simd => band.sweep(simd, short, step, quanta, energies));
        }
        (Springs::LongSeries, false) => {
            dispatch!(level, simd => band.sweep(simd, long, step, quanta, energies));
        }
        (Springs::SquareRoot, false) => {
            dispatch!(level, simd => band.sweep(simd, root, step, quanta, energies));
        }
        (Springs::ShortSeries, true) => {
            dispatch!(level, simd => band.sweep(simd, Differing(short), step, quanta, energies));
        }
        // Compiling one sweep less is worth more than the time that the longer series would save at larger
        // strains.
        (Springs::LongSeries | Springs::SquareRoot, true) => {
            dispatch!(level, simd => band.sweep(simd, Differing(root), step, quanta, energies));
        }
    }
}
