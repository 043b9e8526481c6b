//! Ranks of tests, each of them a thread.

use std::sync::{Barrier, Mutex};
use std::thread;

use slipfront::Communicator;

/// The connection of a thread with the others.
struct ThreadRank<'a> {
    rank: usize,
    size: usize,
    barrier: &'a Barrier,
    largest: &'a Mutex<Vec<f64>>,
    sums: &'a Mutex<Vec<i64>>,
}

impl ThreadRank<'_> {
    /// Replaces the values of all ranks by one result for all.
    fn reduce<T: Copy>(&self, shared: &Mutex<Vec<T>>, values: &mut [T], reduce: impl Fn(T, T) -> T) {
        self.barrier.wait();
        {
            let mut shared = shared.lock().unwrap();
            if shared.is_empty() {
                shared.extend_from_slice(values);
            } else {
                assert_eq!(shared.len(), values.len(), "ranks do not do the same");
                for (shared, value) in shared.iter_mut().zip(&*values) {
                    *shared = reduce(*shared, *value);
                }
            }
        }
        self.barrier.wait();
        values.copy_from_slice(&shared.lock().unwrap());
        if self.barrier.wait().is_leader() {
            shared.lock().unwrap().clear();
        }
        self.barrier.wait();
    }
}

impl Communicator for ThreadRank<'_> {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, _: [&[f64]; 2], _: [&mut [f64]; 2], _: &mut dyn FnMut()) {
        unreachable!("nothing that is tested exchanges rows");
    }

    fn largest(&self, values: &mut [f64]) {
        self.reduce(self.largest, values, f64::max);
    }

    fn sum(&self, values: &mut [i64]) {
        self.reduce(self.sums, values, i64::wrapping_add);
    }
}

/// What `work` gives on each of so many ranks.
pub(crate) fn on_ranks<T: Send>(size: usize, work: impl Fn(&dyn Communicator) -> T + Sync) -> Vec<T> {
    let barrier = Barrier::new(size);
    let (largest, sums) = (Mutex::default(), Mutex::default());
    let ranks: Vec<ThreadRank> = (0..size)
        .map(|rank| ThreadRank {
            rank,
            size,
            barrier: &barrier,
            largest: &largest,
            sums: &sums,
        })
        .collect();
    thread::scope(|scope| {
        let work = &work;
        let threads: Vec<_> = ranks.iter().map(|rank| scope.spawn(move || work(rank))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    })
}
