//! The vector instructions of the kernels: the widest of this processor, or narrower ones by choice. All give
//! the same bits.

use std::sync::atomic::{AtomicUsize, Ordering};

use fearless_simd::Level;

/// Names of vector instruction sets, narrow ones first: the one that every processor has, and two that some
/// x86-64 processors have.
const NAMES: [&str; 3] = ["baseline", "AVX2", "AVX-512"];

/// Index in [`NAMES`] of the widest instructions that kernels of this process may use.
static WIDEST: AtomicUsize = AtomicUsize::new(NAMES.len() - 1);

/// Reason why kernels cannot be limited to certain vector instructions.
#[derive(Debug, thiserror::Error)]
pub enum SimdWidthError {
    /// No vector instructions have this name.
    #[error("`{0}` is not a vector instruction set of slipfront: choose baseline, AVX2 or AVX-512")]
    Unknown(String),
    /// The processor lacks these instructions.
    #[error("this processor does not support {0}: its widest vector instructions are {1}")]
    Missing(&'static str, &'static str),
}

/// The vector instructions that a kernel should use.
pub(crate) fn level() -> Level {
    let own = Level::new();
    #[cfg(target_arch = "x86_64")]
    {
        let widest = WIDEST.load(Ordering::Relaxed);
        let narrower = if widest == 0 {
            own.as_sse2().map(Level::Sse2)
        } else if widest == 1 {
            own.as_avx2().map(Level::Avx2)
        } else {
            None
        };
        narrower.unwrap_or(own)
    }
    #[cfg(not(target_arch = "x86_64"))]
    own
}

/// Name of the vector instructions that kernels use, the widest of this processor unless they were limited;
/// results do not depend on them.
pub fn simd_width() -> &'static str {
    match level() {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(_) => NAMES[2],
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(_) => NAMES[1],
        _ => NAMES[0],
    }
}

/// Limits kernels that this process creates from now on to these vector instructions: `baseline` (SSE2 on
/// x86-64), `AVX2` or `AVX-512`.
///
/// # Errors
/// If the name is unknown, or the processor lacks the instructions.
///
/// ```
/// slipfront::limit_simd_width("baseline").unwrap();
/// assert_eq!(slipfront::simd_width(), "baseline");
/// assert!(slipfront::limit_simd_width("MMX").is_err());
/// ```
pub fn limit_simd_width(name: &str) -> Result<(), SimdWidthError> {
    let place = NAMES.iter().position(|known| *known == name);
    let place = place.ok_or_else(|| SimdWidthError::Unknown(name.to_owned()))?;
    let before = WIDEST.swap(place, Ordering::Relaxed);
    let found = simd_width();
    if found == name {
        return Ok(());
    }
    WIDEST.store(before, Ordering::Relaxed);
    Err(SimdWidthError::Missing(NAMES[place], found))
}
