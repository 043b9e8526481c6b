//! A common outcome of all ranks: a failure on one of them is a failure on all.
//!
//! A rank that gave up alone would leave the others waiting for it.

use std::io;

use slipfront::Communicator;
use slipfront::communicator::{lowest_rank, text_of};
use thiserror::Error;

/// Reason why the ranks gave up; it is the same on every rank.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{sentence}")]
pub struct RankFailure {
    /// The exit status of the program.
    pub status: u8,
    /// Error of the lowest rank that failed.
    pub sentence: String,
}

/// Returns the outcome of this rank if all have succeeded, else the failure of the lowest rank that failed.
/// Every rank must call this function.
///
/// ```
/// use slipfront::communicator::Alone;
/// use slipfront_run::agree::{RankFailure, agree};
///
/// assert_eq!(agree(&Alone, Ok(5)), Ok(5));
/// let failure = RankFailure { status: 1, sentence: "no room on the disk".to_owned() };
/// assert_eq!(agree(&Alone, Err::<(), _>(failure.clone())), Err(failure));
/// ```
///
/// # Errors
/// When a rank failed; the sentence names it, unless it is rank 0.
pub fn agree<T>(communicator: &dyn Communicator, outcome: Result<T, RankFailure>) -> Result<T, RankFailure> {
    let Some(lowest) = lowest_rank(communicator, outcome.is_err()) else {
        return outcome;
    };
    let own = outcome.err().filter(|_| communicator.rank() == lowest);
    // All other ranks contribute zero, so the sum is the status of the lowest rank.
    let mut status = [own.as_ref().map_or(0, |own| i64::from(own.status))];
    communicator.sum(&mut status);
    let sentence = own.map(|own| own.sentence).unwrap_or_default();
    let sentence = text_of(communicator, lowest, &sentence);
    Err(RankFailure {
        status: status[0] as u8,
        sentence: match lowest {
            0 => sentence,
            _ => format!("rank {lowest}: {sentence}"),
        },
    })
}

/// [Agrees](agree) on the outcome of reading or writing that every rank did by itself.
pub(crate) fn agree_on_io<T>(communicator: &dyn Communicator, done: io::Result<T>) -> io::Result<T> {
    let mut own = None;
    let done = done.map_err(|error| {
        let sentence = error.to_string();
        own = Some(error);
        RankFailure { status: 1, sentence }
    });
    agree(communicator, done).map_err(|failure| own.unwrap_or_else(|| io::Error::other(failure.sentence)))
}
