//! Loops on the only thread.

use std::slice::{ChunksMut, Iter, IterMut};

// Only the names of rayon that this project uses: code that uses others does not compile for WebAssembly.

/// Number of threads that share a loop.
pub fn current_num_threads() -> usize {
    1
}

/// Calls one function, then the other.
pub fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}

/// Combines all elements, from the first on; `identity` returns the neutral element.
pub fn reduce<I: Iterator>(
    elements: I,
    identity: impl Fn() -> I::Item,
    combine: impl Fn(I::Item, I::Item) -> I::Item,
) -> I::Item {
    elements.fold(identity(), combine)
}

/// Elements in sequence, in place of a parallel iterator.
pub trait IntoParallelIterator: IntoIterator + Sized {
    /// Iterates over the elements.
    fn into_par_iter(self) -> Self::IntoIter {
        self.into_iter()
    }
}

impl<I: IntoIterator> IntoParallelIterator for I {}

/// Elements of a slice in sequence.
pub trait ParallelSlice<T> {
    /// Iterates over the elements.
    fn par_iter(&self) -> Iter<'_, T>;
    /// Iterates over the elements, which may be changed.
    fn par_iter_mut(&mut self) -> IterMut<'_, T>;
    /// Iterates over parts of this length, the last of which may be shorter.
    fn par_chunks_mut(&mut self, length: usize) -> ChunksMut<'_, T>;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Iter<'_, T> {
        self.iter()
    }

    fn par_iter_mut(&mut self) -> IterMut<'_, T> {
        self.iter_mut()
    }

    fn par_chunks_mut(&mut self, length: usize) -> ChunksMut<'_, T> {
        self.chunks_mut(length)
    }
}

/// Number of elements that a thread takes at once; it has no effect on a single thread.
pub trait IndexedParallelIterator: Iterator + Sized {
    /// Sets the least number of elements that a thread takes.
    fn with_min_len(self, _least: usize) -> Self {
        self
    }

    /// Sets the largest number of elements that a thread takes.
    fn with_max_len(self, _most: usize) -> Self {
        self
    }
}

impl<I: Iterator> IndexedParallelIterator for I {}
