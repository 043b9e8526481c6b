//! Static friction with and without texture over several seeds.

use std::collections::BTreeMap;

use super::distributed::Distributed;
use super::state::Session;
use crate::event::{EventKind, Frictions};
use crate::job::JobKind;
use crate::protocol::{Estimate, RepeatedReply, Reply};

/// Largest number of seeds.
const MAX_SEEDS: u64 = 32;

/// A computation of static friction over several seeds. Dropping it ends its jobs.
pub(super) struct Repetition {
    seeds: Distributed<u64>,
    found: SeedsFound,
}

impl Session {
    /// Begins to compute static friction of the case over `seeds` seeds; 0 ends a computation under way.
    pub(super) fn repeat(&mut self, seeds: u64) -> Result<(), String> {
        self.end_repetition();
        if seeds == 0 {
            return Ok(());
        }
        if !(2..=MAX_SEEDS).contains(&seeds) {
            return Err(format!(
                "{seeds} seeds were asked for, where there may be 2 to {MAX_SEEDS}"
            ));
        }
        self.apply_edits();
        let all: Vec<u64> = (1..=seeds).collect();
        self.repeating = Some(Repetition {
            seeds: Distributed::begin(&*self.host, self.document()?, &all, JobKind::Repeat)?,
            found: SeedsFound::empty(seeds),
        });
        Ok(())
    }

    /// Ends a computation over seeds that is under way, after a last report of its results.
    pub(super) fn end_repetition(&mut self) {
        if let Some(ended) = self.repeating.take() {
            self.host.reply(Reply::Repeated(ended.found.report(true)).json());
        }
    }

    /// Sends the results over seeds since the last call to the page.
    pub(super) fn follow_repetition(&mut self) {
        let Some(Repetition { seeds, found }) = &mut self.repeating else {
            return;
        };
        for (seed, event) in seeds.reported() {
            let frictions = match event {
                EventKind::Repeated(frictions) => frictions,
                _ => Err("the runs over seeds failed by a defect of their own".to_owned()),
            };
            found.note(seed, frictions);
        }
        while let Some(counted) = found.count_next() {
            match counted {
                Ok(report) => {
                    let finished = report.finished;
                    self.host.reply(Reply::Repeated(report).json());
                    if finished {
                        self.repeating = None;
                        return;
                    }
                }
                Err(sentence) => {
                    self.end_repetition();
                    return self.refuse("repeat", sentence);
                }
            }
        }
    }
}

/// Results for the seeds from 1 on. They are counted in the order of the seeds, whichever ends first.
/// Otherwise seeds with short runs would come first, and a mean over them would depend on the machine.
#[derive(Debug)]
struct SeedsFound {
    /// Number of seeds.
    seeds: u64,
    /// Results of the seeds from 1 on, up to the first one that is not done.
    counted: Vec<Frictions>,
    /// Results of later seeds, which wait for an earlier one.
    waiting: BTreeMap<u64, Result<Frictions, String>>,
}

impl SeedsFound {
    /// No results yet, for a computation over `seeds` seeds.
    fn empty(seeds: u64) -> Self {
        Self {
            seeds,
            counted: Vec::new(),
            waiting: BTreeMap::new(),
        }
    }

    /// Adds the result of a seed.
    fn note(&mut self, seed: u64, found: Result<Frictions, String>) {
        self.waiting.insert(seed, found);
    }

    /// Counts the next seed; none while it is not done.
    ///
    /// # Errors
    /// The error of that seed.
    fn count_next(&mut self) -> Option<Result<RepeatedReply, String>> {
        let found = self.waiting.remove(&(self.counted.len() as u64 + 1))?;
        Some(found.map(|frictions| {
            self.counted.push(frictions);
            self.report(self.counted.len() as u64 == self.seeds)
        }))
    }

    /// Means over the seeds counted up to now. Runs without a transition have no static friction: they are
    /// counted, but enter neither a mean nor a change.
    fn report(&self, finished: bool) -> RepeatedReply {
        let column = |k: usize| self.counted.iter().filter_map(move |found| *found.get(k)?);
        let changes = self.counted.iter().filter_map(|found| match found[..] {
            [Some(with), Some(without)] => Some(100.0 * (with / without - 1.0)),
            _ => None,
        });
        let runs = self.counted.iter().flatten();
        RepeatedReply {
            done: self.counted.len(),
            of: self.seeds,
            finished,
            change_percent: estimate(changes),
            with: estimate(column(0)),
            without: estimate(column(1)),
            without_transition: runs.filter(|found| found.is_none()).count(),
        }
    }
}

/// Mean and interval of values; none without values.
fn estimate(values: impl Iterator<Item = f64>) -> Option<Estimate> {
    let values: Vec<f64> = values.collect();
    Estimate::from_values(&values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reports on three seeds that end in this order. The last of them cannot be run.
    fn reports(order: [u64; 3]) -> Vec<Result<RepeatedReply, String>> {
        let mut found = SeedsFound::empty(4);
        let mut reports = Vec::new();
        for seed in order {
            let frictions = match seed {
                1 => Ok(vec![Some(0.7), Some(0.9)]),
                2 => Ok(vec![None, Some(0.8)]),
                _ => Err("the run diverges".to_owned()),
            };
            found.note(seed, frictions);
            while let Some(report) = found.count_next() {
                reports.push(report);
            }
        }
        reports
    }

    #[test]
    fn seeds_are_counted_in_their_order_whichever_ends_first() {
        let in_order = reports([1, 2, 3]);
        let [Ok(_), Ok(second), Err(_)] = &in_order[..] else {
            panic!("{in_order:?}")
        };
        assert_eq!((second.done, second.without_transition), (2, 1));
        assert_eq!(second.with.map(|with| with.mean), Some(0.7));
        for order in [[1, 3, 2], [2, 1, 3], [2, 3, 1], [3, 1, 2], [3, 2, 1]] {
            assert_eq!(reports(order), in_order, "{order:?}");
        }
    }
}
