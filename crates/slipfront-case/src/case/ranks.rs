//! The ranks that make a case together.

use slipfront::Communicator;
use slipfront::communicator::{Alone, lowest_rank, text_of};

use crate::case_file::CaseError;

/// The ranks that make a case together, each for its own rows.
#[derive(Clone, Copy)]
pub struct Ranks<'a> {
    /// Connection between the ranks.
    pub communicator: &'a dyn Communicator,
    /// Number of ranks that run on this machine and share its memory.
    pub on_node: usize,
}

impl Ranks<'static> {
    /// A process that makes a case alone.
    pub const ALONE: Self = Self {
        communicator: &Alone,
        on_node: 1,
    };
}

impl Ranks<'_> {
    /// Returns `found` of this rank if no rank has failed. Otherwise all ranks return an error: that of the
    /// lowest rank with an error, which the message names unless it is rank 0, or that they were stopped.
    pub fn agree<T>(&self, found: Result<T, CaseError>) -> Result<T, CaseError> {
        self.agree_in_words(found, |rank, text| match rank {
            0 => text,
            _ => format!("rank {rank}: {text}"),
        })
    }

    /// [Agrees](Self::agree) on the results of each rank for its rows: the error is the one of reading all
    /// rows.
    pub(super) fn agree_on_rows<T>(&self, found: Result<T, CaseError>) -> Result<T, CaseError> {
        self.agree_in_words(found, |_, text| text)
    }

    fn agree_in_words<T>(
        &self,
        found: Result<T, CaseError>,
        words: impl Fn(usize, String) -> String,
    ) -> Result<T, CaseError> {
        let is_stopped = matches!(found, Err(CaseError::Stopped));
        if lowest_rank(self.communicator, is_stopped).is_some() {
            return Err(CaseError::Stopped);
        }
        let Some(lowest) = lowest_rank(self.communicator, found.is_err()) else {
            return found;
        };
        let own = found.err().filter(|_| self.communicator.rank() == lowest);
        let text = own.as_ref().map(ToString::to_string).unwrap_or_default();
        let text = text_of(self.communicator, lowest, &text);
        let own = own.filter(|_| lowest == 0);
        Err(own.unwrap_or_else(|| CaseError::OnOtherRank(words(lowest, text))))
    }
}

#[cfg(test)]
mod tests {
    use slipfront::testing::Threads;

    use super::*;

    #[test]
    fn the_first_error_is_told_by_all() {
        let long = "e\u{301}\n".repeat(100);
        let outcome = |rank: usize, failing: &[usize], stopped: Option<usize>| {
            if stopped == Some(rank) {
                return Err(CaseError::Stopped);
            }
            if failing.contains(&rank) {
                Err(CaseError::invalid(None, format!("{rank} {long}")))
            } else {
                Ok(rank)
            }
        };
        let agreed = |failing: &[usize], stopped| -> Vec<Result<usize, String>> {
            Threads::run(5, |communicator| {
                let ranks = Ranks {
                    communicator,
                    on_node: 5,
                };
                let agreed = ranks.agree(outcome(communicator.rank(), failing, stopped));
                agreed.map_err(|error| error.to_string())
            })
        };
        assert_eq!(agreed(&[], None), (0..5).map(Ok).collect::<Vec<_>>());
        for (failing, first) in [(&[0][..], 0), (&[4], 4), (&[3, 2], 2), (&[0, 1, 2, 3, 4], 0)] {
            let said = outcome(first, &[first], None).unwrap_err().to_string();
            let said = match first {
                0 => said,
                _ => format!("rank {first}: {said}"),
            };
            assert_eq!(agreed(failing, None), vec![Err(said); 5]);
        }
        assert_eq!(
            agreed(&[1], Some(3)),
            vec![Err(CaseError::Stopped.to_string()); 5]
        );
    }
}
