//! Loops on the one thread that there is.

use std::slice::{ChunksMut, Iter, IterMut};

// The names of rayon that this project uses, and no others: what is missing here does not compile for
// WebAssembly.

/// Number of threads that share out a loop.
pub fn current_num_threads() -> usize {
    1
}

/// Calls one function, then the other.
pub fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}

/// Combines all elements, from the first on; `identity` gives the element that changes no other.
pub fn reduce<I: Iterator>(
    elements: I,
    identity: impl Fn() -> I::Item,
    combine: impl Fn(I::Item, I::Item) -> I::Item,
) -> I::Item {
    elements.fold(identity(), combine)
}

/// Elements one after the other, which threads would share out.
pub trait IntoParallelIterator: IntoIterator + Sized {
    /// Iterates over the elements.
    fn into_par_iter(self) -> Self::IntoIter {
        self.into_iter()
    }
}

impl<I: IntoIterator> IntoParallelIterator for I {}

/// Elements of a slice one after the other.
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

/// How many elements a thread takes at once, which does not matter for one thread.
pub trait IndexedParallelIterator: Iterator + Sized {
    /// Lets a thread take at least so many elements.
    fn with_min_len(self, _least: usize) -> Self {
        self
    }

    /// Lets a thread take at most so many elements.
    fn with_max_len(self, _most: usize) -> Self {
        self
    }
}

impl<I: Iterator> IndexedParallelIterator for I {}
