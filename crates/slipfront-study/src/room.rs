//! Memory of work on several threads, compared with the memory that is available.

use slipfront_base::number_format::byte_size;

use crate::error::StudyError;

/// Refuses `threads` runs at once if there is no memory for them, and says how many there is memory for. `of` tells the memory of this
/// many at once, in bytes; `none` gives the error where there is no memory for a single one, from the text of the memory that is `available`.
///
/// # Errors
/// With both figures.
pub fn check_room(
    of: impl Fn(usize) -> f64,
    threads: usize,
    available: f64,
    none: impl FnOnce(String) -> StudyError,
) -> Result<(), StudyError> {
    let needed = of(threads);
    if needed <= available {
        return Ok(());
    }
    let fit = (1..threads).rev().find(|&fewer| of(fewer) <= available);
    let available = byte_size(available);
    Err(match fit {
        None => none(available),
        Some(fit) => StudyError::Memory {
            threads,
            needed: byte_size(needed),
            available,
            fit,
        },
    })
}
