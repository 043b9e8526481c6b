//! Arrays that begin on a cache line, so that no vector of eight numbers crosses a boundary between lines.

use std::ops::{Deref, DerefMut};

use super::vector::{Chunks, ChunksMut, LANES};

/// A fixed number of f64 on a 64-byte boundary.
#[derive(Debug, Default)]
pub struct Aligned {
    /// The numbers, after up to seven unused ones. The vector never grows, so that its memory never moves.
    storage: Vec<f64>,
    first: usize,
    len: usize,
}

impl Aligned {
    /// Numbers with one value.
    pub fn filled(len: usize, value: f64) -> Self {
        let storage = vec![value; len + LANES - 1];
        let first = storage.as_ptr().align_offset(64).min(LANES - 1);
        Self { storage, first, len }
    }

    /// The cache lines from element `k` on, which may be beyond the end.
    #[inline(always)]
    pub(crate) fn cache_lines(&self, k: usize) -> CacheLines {
        CacheLines(self.as_ptr().wrapping_add(k).cast())
    }
}

/// Cache lines to fetch ahead of their use. On a lattice larger than the cache the sweep would otherwise wait
/// for memory: it reads more arrays than processors prefetch by themselves.
#[derive(Clone, Copy)]
pub(crate) struct CacheLines(*const i8);

impl CacheLines {
    /// Asks the processor to fetch the line with this index.
    #[inline(always)]
    pub(crate) fn prefetch(self, line: usize) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            // SAFETY: a prefetch reads and writes nothing that the program can see, at any address.
            #[allow(unsafe_code)]
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(self.0.wrapping_add(line * LANES * size_of::<f64>()));
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = (self.0, line);
    }
}

impl Deref for Aligned {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.storage[self.first..self.first + self.len]
    }
}

impl DerefMut for Aligned {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.storage[self.first..self.first + self.len]
    }
}

/// A plane vector per element, one array per component.
#[derive(Debug, Default)]
pub struct Vectors {
    /// Components along x.
    pub x: Aligned,
    /// Components along y.
    pub y: Aligned,
}

impl Vectors {
    /// Vectors of length 0.
    pub fn zeros(len: usize) -> Self {
        Self {
            x: Aligned::filled(len, 0.0),
            y: Aligned::filled(len, 0.0),
        }
    }

    /// The vector of element `k`.
    #[inline(always)]
    pub fn at(&self, k: usize) -> [f64; 2] {
        [self.x[k], self.y[k]]
    }

    /// Sets the vector of element `k`.
    #[inline]
    pub fn set(&mut self, k: usize, [x, y]: [f64; 2]) {
        (self.x[k], self.y[k]) = (x, y);
    }
}

/// The `n` elements from `from` on, in vectors of eight.
#[inline(always)]
pub(crate) fn chunks(vectors: &Vectors, from: usize, n: usize) -> [Chunks<'_>; 2] {
    [
        vectors.x[from..from + n].as_chunks().0,
        vectors.y[from..from + n].as_chunks().0,
    ]
}

/// The `n` elements from `from` on, in vectors of eight to write to.
#[inline(always)]
pub(crate) fn chunks_mut(vectors: &mut Vectors, from: usize, n: usize) -> [ChunksMut<'_>; 2] {
    [
        vectors.x[from..from + n].as_chunks_mut().0,
        vectors.y[from..from + n].as_chunks_mut().0,
    ]
}
