//! What tests of slipfront and of crates that use it need beside the model: ranks that are threads, and what is private to the fused
//! kernel.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use crate::communicator::Communicator;
pub use crate::kernel::fused::for_tests::FusedKernel;

/// One of several ranks that are threads of this process: what a lattice of many machines does can be tried on one.
#[derive(Clone, Debug)]
pub struct Threads {
    rank: usize,
    /// To each rank, this one included.
    to: Vec<Sender<Vec<u64>>>,
    /// From each rank. Only the thread of this rank listens.
    from: Vec<Arc<Mutex<Receiver<Vec<u64>>>>>,
}

impl Threads {
    /// Does some work on `size` ranks at once, and gives what each of them returns, rank 0 first.
    ///
    /// # Panics
    /// If the work of a rank does: the others, which wait for it in vain, end as well.
    pub fn run<T: Send>(size: usize, work: impl Fn(&Threads) -> T + Sync) -> Vec<T> {
        let mut ranks: Vec<Threads> = (0..size)
            .map(|rank| Threads {
                rank,
                to: Vec::new(),
                from: Vec::new(),
            })
            .collect();
        for to in 0..size {
            for from in 0..size {
                let (sender, receiver) = channel();
                ranks[from].to.push(sender);
                ranks[to].from.push(Arc::new(Mutex::new(receiver)));
            }
        }
        let work = &work;
        thread::scope(|scope| {
            let begin = |rank| scope.spawn(move || work(&rank));
            let threads: Vec<_> = ranks.into_iter().map(begin).collect();
            let end = |thread: thread::ScopedJoinHandle<T>| {
                thread
                    .join()
                    .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            threads.into_iter().map(end).collect()
        })
    }

    fn send(&self, rank: usize, words: Vec<u64>) {
        // A rank that has gone needs nothing; who waits for it notices.
        let _ = self.to[rank].send(words);
    }

    fn receive(&self, rank: usize) -> Vec<u64> {
        let from = self.from[rank].lock().unwrap_or_else(PoisonError::into_inner);
        match from.recv() {
            Ok(words) => words,
            Err(_) => panic!("rank {} waits for rank {rank}, which has ended", self.rank),
        }
    }

    /// What every rank has, rank 0 first.
    fn gather(&self, words: &[u64]) -> impl Iterator<Item = Vec<u64>> {
        for rank in 0..self.size() {
            self.send(rank, words.to_vec());
        }
        (0..self.size()).map(|rank| self.receive(rank))
    }
}

impl Communicator for Threads {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.to.len()
    }

    fn exchange(&self, to: [&[f64]; 2], from: [&mut [f64]; 2], meanwhile: &mut dyn FnMut()) {
        let size = self.size();
        let (below, above) = ((self.rank + size - 1) % size, (self.rank + 1) % size);
        // Both may be one rank: what goes down is sent first, and what comes from above received first.
        for (rank, values) in [below, above].into_iter().zip(to) {
            if !values.is_empty() {
                self.send(rank, values.iter().map(|value| value.to_bits()).collect());
            }
        }
        meanwhile();
        for (rank, values) in [below, above].into_iter().zip(from).rev() {
            if !values.is_empty() {
                let received = self.receive(rank);
                assert_eq!(
                    received.len(),
                    values.len(),
                    "from rank {rank} to rank {}",
                    self.rank
                );
                for (value, bits) in values.iter_mut().zip(received) {
                    *value = f64::from_bits(bits);
                }
            }
        }
    }

    fn largest(&self, values: &mut [f64]) {
        let words: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        for words in self.gather(&words) {
            for (value, bits) in values.iter_mut().zip(words) {
                *value = value.max(f64::from_bits(bits));
            }
        }
    }

    fn sum(&self, values: &mut [i64]) {
        let words: Vec<u64> = values.iter().map(|value| value.cast_unsigned()).collect();
        values.fill(0);
        for words in self.gather(&words) {
            for (value, word) in values.iter_mut().zip(words) {
                *value = value.wrapping_add(word.cast_signed());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::communicator::{Alone, lowest_rank};

    /// The ring of one and of two ranks, where above and below are the same, included.
    #[test]
    fn threads_talk_as_ranks_do() {
        for size in 1..5 {
            let found = Threads::run(size, |rank| {
                let number = rank.rank() as f64;
                let (mut below, mut above) = ([0.0; 2], [0.0; 1]);
                let mut meanwhile = 0;
                // One value goes down, two go up; then nothing goes down.
                rank.exchange(
                    [&[number], &[number, -number]],
                    [&mut below, &mut above],
                    &mut || {
                        meanwhile += 1;
                    },
                );
                let mut again = [0.0];
                rank.exchange([&[], &[number]], [&mut again, &mut []], &mut || meanwhile += 1);
                let mut largest = [number, -number];
                rank.largest(&mut largest);
                let mut sum = [rank.rank() as i64, i64::MAX];
                rank.sum(&mut sum);
                (below, above, again, largest, sum, meanwhile)
            });
            for (rank, found) in found.into_iter().enumerate() {
                let (below, above) = ((rank + size - 1) % size, (rank + 1) % size);
                let (below, above, last) = (below as f64, above as f64, (size - 1) as f64);
                let sum = [(0..size as i64).sum(), i64::MAX.wrapping_mul(size as i64)];
                assert_eq!(found, ([below, -below], [above], [below], [last, -0.0], sum, 2));
            }
        }
        let mut below = [0.0; 2];
        let mut above = [0.0];
        Alone.exchange([&[1.0], &[2.0, 3.0]], [&mut below, &mut above], &mut || ());
        assert_eq!((below, above), ([2.0, 3.0], [1.0]));
    }

    /// Of every set of ranks.
    #[test]
    fn all_ranks_know_the_lowest() {
        for size in 1..5 {
            for set in 0..1_usize << size {
                let found = Threads::run(size, |rank| lowest_rank(rank, set >> rank.rank() & 1 == 1));
                let lowest = (set > 0).then_some(set.trailing_zeros() as usize);
                assert_eq!(found, vec![lowest; size], "{set:b} of {size}");
            }
        }
    }
}
