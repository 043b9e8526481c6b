//! Memory of work on several threads, compared with the memory that is available.

use slipfront_base::machine::available_of;
use slipfront_base::number_format::byte_size;

use crate::error::StudyError;

/// Memory of work on several threads, in bytes.
#[derive(Clone, Debug)]
pub struct WorkMemory {
    /// Bytes that are needed for any number of threads.
    pub beside: f64,
    /// Bytes for a piece of each kind of work, and the number of pieces. Kinds of work are done one after the
    /// other.
    pub pieces: Vec<(f64, usize)>,
}

impl WorkMemory {
    /// Memory on this many threads.
    pub fn on_threads(&self, threads: usize) -> f64 {
        let pieces = self.pieces.iter();
        let at_once = pieces.map(|&(bytes, number)| threads.min(number) as f64 * bytes);
        self.beside + at_once.fold(0.0, f64::max)
    }

    /// Refuses work on `threads` threads if memory is too small. The error gives the number of threads that
    /// it is large enough for. If it is too small for a single thread, `none` makes the error from the needed
    /// and the available memory, as text.
    ///
    /// # Errors
    /// With the needed and the available memory.
    pub fn check(
        &self,
        threads: usize,
        none: impl FnOnce(String, String) -> StudyError,
    ) -> Result<(), StudyError> {
        self.compare(threads, available_of(self.on_threads(threads)), none)
    }

    /// Refuses work as [`check`](Self::check) does, on a machine with `available` bytes.
    ///
    /// # Errors
    /// With the needed and the available memory.
    pub fn compare(
        &self,
        threads: usize,
        available: f64,
        none: impl FnOnce(String, String) -> StudyError,
    ) -> Result<(), StudyError> {
        let needed = self.on_threads(threads);
        if needed <= available {
            return Ok(());
        }
        let fit = (1..threads)
            .rev()
            .find(|&fewer| self.on_threads(fewer) <= available);
        let available = byte_size(available);
        Err(match fit {
            None => none(byte_size(self.on_threads(1)), available),
            Some(fit) => StudyError::Memory {
                threads,
                needed: byte_size(needed),
                available,
                fit,
            },
        })
    }
}
