//! Helpers for tests of slipfront and of crates that use it: ranks that are threads, private parts of the
//! fused kernel, and tests that run in their own process.
//!
//! It is in every build, so that the command and the tests are compiled from one physics.

use std::process::Command;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use crate::communicator::Communicator;
pub use crate::kernel::fused::for_tests::{FusedDevice, FusedKernel};

/// Does some work in its own process, to measure properties of a whole process: starts the test program again
/// for the test `name` alone, which calls this.
///
/// # Panics
/// If the test fails there, or no test has this name.
pub fn alone(name: &str, work: impl FnOnce()) {
    const IS_ALONE: &str = "SLIPFRONT_TEST_IS_ALONE";
    if std::env::var_os(IS_ALONE).is_some() {
        return work();
    }
    let program = std::env::current_exe().expect("the test program has a path");
    let done = Command::new(program)
        .args([name, "--exact"])
        .env(IS_ALONE, "")
        .output()
        .expect("the test program begins");
    let printed = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success() && printed.contains("1 passed"), "{printed}");
}

/// One of several ranks that are threads of this process, to test on one machine a lattice that many machines
/// share.
#[derive(Clone, Debug)]
pub struct Threads {
    rank: usize,
    /// Channels to each rank, including this one.
    to: Vec<Sender<Vec<u64>>>,
    /// Channels from each rank. Only the thread of this rank listens.
    from: Vec<Arc<Mutex<Receiver<Vec<u64>>>>>,
    seat: Arc<Seat>,
}

/// Meeting point at which all ranks exchange words: each rank is woken once, not once by every other rank.
#[derive(Debug)]
struct Meeting {
    table: Mutex<Table>,
    all_are_here: Condvar,
}

#[derive(Debug)]
struct Table {
    /// Words of each rank that has arrived.
    words: Vec<Option<Vec<u64>>>,
    n_here: usize,
    /// Number of meetings that have ended.
    n_over: u64,
    /// Words of each rank at the last meeting. The next meeting does not end before all have read them.
    latest: Arc<Vec<Vec<u64>>>,
    ended: Option<usize>,
}

/// The place of a rank at the meetings; it is removed when the rank has ended.
#[derive(Debug)]
struct Seat {
    rank: usize,
    meeting: Arc<Meeting>,
}

impl Meeting {
    fn new(size: usize) -> Self {
        let table = Table {
            words: vec![None; size],
            n_here: 0,
            n_over: 0,
            latest: Arc::default(),
            ended: None,
        };
        Self {
            table: Mutex::new(table),
            all_are_here: Condvar::new(),
        }
    }
}

/// Number of times that a rank yields to others before it sleeps until it is woken, which costs far more.
/// There are more ranks than cores, and the words that a rank waits for have mostly arrived when its turn
/// comes again.
const TURNS: usize = 16;

impl Seat {
    fn table(&self) -> MutexGuard<'_, Table> {
        self.meeting.table.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Gathers the words of every rank, rank 0 first.
    fn gather(&self, words: Vec<u64>) -> Arc<Vec<Vec<u64>>> {
        let mut table = self.table();
        table.words[self.rank] = Some(words);
        table.n_here += 1;
        if table.n_here == table.words.len() {
            table.latest = Arc::new(table.words.iter_mut().filter_map(Option::take).collect());
            (table.n_here, table.n_over) = (0, table.n_over + 1);
            self.meeting.all_are_here.notify_all();
        } else {
            let n_over = table.n_over;
            let mut n_turns = 0;
            while table.n_over == n_over {
                if let Some(ended) = table.ended {
                    panic!("rank {} waits for rank {ended}, which has ended", self.rank);
                }
                if n_turns < TURNS {
                    n_turns += 1;
                    drop(table);
                    thread::yield_now();
                    table = self.table();
                } else {
                    let woken = self.meeting.all_are_here.wait(table);
                    table = woken.unwrap_or_else(PoisonError::into_inner);
                }
            }
        }
        table.latest.clone()
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.table().ended = Some(self.rank);
        self.meeting.all_are_here.notify_all();
    }
}

impl Threads {
    /// Does some work on `size` ranks at once, and returns the result of each, rank 0 first.
    ///
    /// # Panics
    /// If the work of a rank panics: the other ranks, which would wait for it forever, end as well.
    pub fn run<T: Send>(size: usize, work: impl Fn(&Threads) -> T + Sync) -> Vec<T> {
        let meeting = Arc::new(Meeting::new(size));
        let mut ranks: Vec<Threads> = (0..size)
            .map(|rank| Threads {
                rank,
                to: Vec::new(),
                from: Vec::new(),
                seat: Arc::new(Seat {
                    rank,
                    meeting: meeting.clone(),
                }),
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
        // A rank that has ended needs nothing; a rank that waits for it notices.
        let _ = self.to[rank].send(words);
    }

    fn receive(&self, rank: usize) -> Vec<u64> {
        let from = self.from[rank].lock().unwrap_or_else(PoisonError::into_inner);
        for _ in 0..TURNS {
            if let Ok(words) = from.try_recv() {
                return words;
            }
            thread::yield_now();
        }
        match from.recv() {
            Ok(words) => words,
            Err(_) => panic!("rank {} waits for rank {rank}, which has ended", self.rank),
        }
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
        // Both may be the same rank: words to the rank below are sent first, and words from the rank above
        // received first.
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
        for words in &*self.seat.gather(words) {
            for (value, &bits) in values.iter_mut().zip(words) {
                *value = value.max(f64::from_bits(bits));
            }
        }
    }

    fn sum(&self, values: &mut [i64]) {
        let words: Vec<u64> = values.iter().map(|value| value.cast_unsigned()).collect();
        values.fill(0);
        for words in &*self.seat.gather(words) {
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

    /// Threads communicate as ranks do, also in a ring of one or two ranks, where above and below are the
    /// same.
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

    /// All ranks know the lowest rank, for every set of ranks.
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
