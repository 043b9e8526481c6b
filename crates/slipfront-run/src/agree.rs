//! One outcome of all ranks: what fails on one of them has failed on all.
//!
//! A rank that gave up alone would leave the others waiting for it.

use std::io;

use slipfront::Communicator;
use thiserror::Error;

/// Why ranks gave up, the same on every rank.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{sentence}")]
pub struct RankFailure {
    /// The exit status of the program.
    pub status: u8,
    /// What the lowest rank that failed has to say.
    pub sentence: String,
}

/// What a rank has done if all have done it, else the failure of the lowest rank that failed. Every rank must ask.
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
    let (rank, size) = (communicator.rank(), communicator.size());
    let mut from_above = [if outcome.is_err() {
        (size - rank) as f64
    } else {
        0.0
    }];
    communicator.largest(&mut from_above);
    if from_above[0] == 0.0 {
        return outcome;
    }
    let lowest = size - from_above[0] as usize;
    let own = outcome.err().filter(|_| rank == lowest).map(|mut failure| {
        if lowest > 0 {
            failure.sentence.insert_str(0, &format!("rank {lowest}: "));
        }
        failure
    });
    // One rank gives numbers and the others zeros: the sums are its numbers.
    let mut head = own
        .as_ref()
        .map_or([0; 2], |own| [i64::from(own.status), own.sentence.len() as i64]);
    communicator.sum(&mut head);
    let mut text = vec![0; head[1] as usize];
    if let Some(own) = own {
        text = own.sentence.bytes().map(i64::from).collect();
    }
    communicator.sum(&mut text);
    let text: Vec<u8> = text.into_iter().map(|byte| byte as u8).collect();
    Err(RankFailure {
        status: head[0] as u8,
        sentence: String::from_utf8_lossy(&text).into_owned(),
    })
}

/// [`agree`] on what every rank has read or written by itself.
pub(crate) fn agree_on_io<T>(communicator: &dyn Communicator, done: io::Result<T>) -> io::Result<T> {
    let mut own = None;
    let done = done.map_err(|error| {
        let sentence = error.to_string();
        own = Some(error);
        RankFailure { status: 1, sentence }
    });
    agree(communicator, done).map_err(|failure| own.unwrap_or_else(|| io::Error::other(failure.sentence)))
}
