//! Bands of rows that are shared among threads.

use crate::parallel::join;

/// Runs `work` on every band: on the threads of the pool, or one after the other on this thread.
pub(super) fn for_each_band<B: Send>(threads: usize, bands: &mut [B], work: &(impl Fn(&mut B) + Sync)) {
    // On one thread, without the pool, which may have more threads than this kernel was given.
    if threads == 1 {
        bands.iter_mut().for_each(work);
        return;
    }
    match bands {
        [] => {}
        [band] => work(band),
        _ => {
            // Splits the bands in halves, so that a free thread takes many bands at once, and seldom asks for
            // more.
            let (one, other) = bands.split_at_mut(bands.len() / 2);
            join(
                || for_each_band(threads, one, work),
                || for_each_band(threads, other, work),
            );
        }
    }
}
