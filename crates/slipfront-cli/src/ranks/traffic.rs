//! Counts of the messages between ranks.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use slipfront::Communicator;
use slipfront_base::number_format::byte_size;

/// A connection to other ranks that counts its messages.
#[derive(Debug)]
pub(super) struct Traffic {
    inner: Arc<dyn Communicator>,
    /// Messages to the neighbours.
    messages: TrafficCount,
    /// Maxima and sums over all ranks.
    reductions: TrafficCount,
}

/// Number of messages, and their total size.
#[derive(Debug, Default)]
struct TrafficCount {
    number: AtomicU64,
    bytes: AtomicU64,
}

impl TrafficCount {
    fn add<T>(&self, values: &[T]) {
        self.number.fetch_add(1, Ordering::Relaxed);
        self.bytes
            .fetch_add(size_of_val(values) as u64, Ordering::Relaxed);
    }

    /// Number of messages and their size per step, over `steps` steps.
    fn per_step(&self, steps: u64) -> (f64, String) {
        let [number, bytes] =
            [&self.number, &self.bytes].map(|count| count.load(Ordering::Relaxed) as f64 / steps as f64);
        (number, byte_size(bytes))
    }
}

impl Traffic {
    pub(super) fn count(inner: Arc<dyn Communicator>) -> Self {
        Self {
            inner,
            messages: TrafficCount::default(),
            reductions: TrafficCount::default(),
        }
    }

    /// Messages of this rank per step, in words.
    pub(super) fn per_step(&self, steps: u64) -> String {
        let (messages, sent) = self.messages.per_step(steps);
        let (reductions, reduced) = self.reductions.per_step(steps);
        format!(
            "{messages:.2} messages per step, {sent} in all; {reductions:.2} reductions per step, {reduced} in all"
        )
    }
}

impl Communicator for Traffic {
    fn rank(&self) -> usize {
        self.inner.rank()
    }

    fn size(&self) -> usize {
        self.inner.size()
    }

    fn exchange(&self, to: [&[f64]; 2], from: [&mut [f64]; 2], meanwhile: &mut dyn FnMut()) {
        for values in to.into_iter().filter(|values| !values.is_empty()) {
            self.messages.add(values);
        }
        self.inner.exchange(to, from, meanwhile);
    }

    fn largest(&self, values: &mut [f64]) {
        self.reductions.add(values);
        self.inner.largest(values);
    }

    fn sum(&self, values: &mut [i64]) {
        self.reductions.add(values);
        self.inner.sum(values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfront::communicator::Alone;

    /// Messages are counted: of 3 and 5 numbers in every step, an empty one in the other direction, and a sum
    /// in every second step.
    #[test]
    fn what_is_given_is_counted() {
        let traffic = Traffic::count(Arc::new(Alone));
        for step in 0..10 {
            traffic.exchange([&[1.0; 3], &[2.0; 5]], [&mut [0.0; 5], &mut [0.0; 3]], &mut || {});
            traffic.exchange([&[], &[3.0; 2]], [&mut [0.0; 2], &mut []], &mut || {});
            traffic.largest(&mut [0.0; 4]);
            if step % 2 == 0 {
                traffic.sum(&mut [0; 8]);
            }
        }
        assert_eq!(
            traffic.per_step(10),
            "3.00 messages per step, 80 B in all; 1.50 reductions per step, 64 B in all"
        );
    }
}
