//! What the ranks of a run, the processes that share its lattice, agree on.

use slipfront::Communicator;

/// What every rank has done by itself, once all have done it: an error if one of them has failed, so that all go on, or none.
pub(crate) fn agree<T>(communicator: &dyn Communicator, done: std::io::Result<T>) -> std::io::Result<T> {
    let mut has_failed = [f64::from(u8::from(done.is_err()))];
    communicator.largest(&mut has_failed);
    match done {
        Ok(_) if has_failed[0] > 0.0 => Err(std::io::Error::other("another rank has failed")),
        done => done,
    }
}
