//! Static friction over several seeds: how a computation begins, continues and reports.

use super::repetition::{Part, Repetition};
use super::state::Session;
use crate::job::{Job, JobKind};
use crate::protocol::Reply;
use crate::repeat::SeedsFound;

/// Largest number of seeds.
const MAX_SEEDS: u64 = 32;

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
        let document = self.document()?;
        let n_parts = self.host.workers().clamp(1, seeds as usize);
        let mut parts = Vec::new();
        for first in 1..=n_parts as u64 {
            let seeds: Vec<u64> = (first..=seeds).step_by(n_parts).collect();
            let task = self
                .host
                .begin(Job::new(document.clone(), JobKind::Repeat(seeds.clone())))?;
            let seeds = seeds.into_iter();
            parts.push(Part { task, seeds });
        }
        let found = SeedsFound::none_of(seeds);
        self.repeating = Some(Repetition { parts, found });
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
        let Some(Repetition { parts, found }) = &mut self.repeating else {
            return;
        };
        parts.retain_mut(|part| part.follow(found));
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
                    let of = "repeat";
                    return self.host.reply(Reply::Refused { of, sentence }.json());
                }
            }
        }
    }
}
